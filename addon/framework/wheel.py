# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether the native module fits this add-on."""

import tomllib
from pathlib import Path

import ridgeform

_MANIFEST = Path(__file__).parents[1] / "blender_manifest.toml"


def check_version() -> None:
    """Raise `RuntimeError` if the installed wheel is not of the version that the manifest names."""
    wanted = tomllib.loads(_MANIFEST.read_text(encoding="utf-8"))["version"]
    found = ridgeform.__version__
    if found != wanted:
        raise RuntimeError(
            f"Ridgeform {wanted} found version {found} of its native module. Restart Blender; "
            "if that does not help, remove the extension, restart Blender and install it again."
        )
