"""Install the built extension into an empty Blender profile, as a user would, under the bpy package."""

import atexit
import importlib
import os
import shutil
import sys
import tempfile
from pathlib import Path
from types import ModuleType

EXTENSION = "bl_ext.user_default.ridgeform"
BUNDLED_MODULES = ("ridgeform", "fast_simplification", "tqdm")


def empty_profile() -> Path:
    """Make Blender take an empty folder for the user's; it is removed at the end of this process."""
    if "bpy" in sys.modules:
        raise RuntimeError("The profile must be chosen before bpy is imported")
    folder = Path(tempfile.mkdtemp(prefix="ridgeform-profile-"))
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    os.environ["BLENDER_USER_RESOURCES"] = str(folder)
    return folder


def install_extension(path: Path, profile: Path) -> ModuleType:
    """Install and enable a zip; returns the add-on. `RuntimeError` if it or a bundled wheel is not in use."""
    import bpy  # noqa: PLC0415

    bpy.ops.extensions.package_install_files(
        filepath=str(path.resolve()), repo="user_default", enable_on_install=True
    )
    # A zip for another platform "finishes" without effect.
    if EXTENSION not in bpy.context.preferences.addons:
        raise RuntimeError(f"Blender {bpy.app.version_string} installed {path.name} but did not enable it")
    for name in BUNDLED_MODULES:
        where = Path(importlib.import_module(name).__file__)
        if not where.is_relative_to(profile):
            raise RuntimeError(f"{name} comes from {where}, not from a wheel of the extension")
    return sys.modules[EXTENSION]
