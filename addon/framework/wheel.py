# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether the native module fits this add-on."""

import tomllib
from pathlib import Path

import ridgeform

_MANIFEST = Path(__file__).parents[1] / "blender_manifest.toml"


def misfit() -> str | None:
    """Why the module that is loaded is not the one that this add-on came with; `None` if it is.

    An extension that is installed over another one is enabled in the same session, in which the module of
    that one stays loaded. A wheel of the same version that is of no build, as `pip` installs it, will do.
    """
    manifest = tomllib.loads(_MANIFEST.read_text(encoding="utf-8"))
    wanted, found = manifest["version"], ridgeform.__version__
    if wanted.startswith("@"):
        # A checkout, with gaps that only a package fills.
        return None
    for path in manifest["wheels"]:
        name, build, *_ = path.rpartition("/")[2].split("-")
        loaded = getattr(ridgeform, "__build__", found)
        if name == "ridgeform" and found == wanted and "+" in build and "+" in loaded:
            wanted, found = build, loaded
    if found == wanted:
        return None
    return (
        f"Ridgeform {wanted} found version {found} of its native module. Restart Blender; "
        "if that does not help, remove the extension, restart Blender and install it again."
    )
