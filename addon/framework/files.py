# SPDX-License-Identifier: GPL-3.0-or-later
"""Reading and writing files in the formats that Blender itself reads and writes."""

from collections.abc import Callable
from pathlib import Path

import bpy


def _import_fbx(filepath: str) -> None:
    # The importer written in C++ (4.5) replaces the add-on, which later versions no longer have.
    if hasattr(bpy.types, "WM_OT_fbx_import"):
        bpy.ops.wm.fbx_import(filepath=filepath)
    else:
        bpy.ops.import_scene.fbx(filepath=filepath)


def _import_gltf(filepath: str) -> None:
    # The format stores a vertex once per normal and UV; unmerged, the surface would fall apart along its
    # seams.
    bpy.ops.import_scene.gltf(filepath=filepath, merge_vertices=True)


def _export_gltf(filepath: str) -> None:
    kind = "GLB" if filepath.lower().endswith(".glb") else "GLTF_SEPARATE"
    bpy.ops.export_scene.gltf(filepath=filepath, export_format=kind)


_USD = (lambda path: bpy.ops.wm.usd_import(filepath=path), lambda path: bpy.ops.wm.usd_export(filepath=path))
_GLTF = (_import_gltf, _export_gltf)

FORMATS: dict[str, tuple[Callable[[str], object], Callable[[str], object]]] = {
    ".blend": (
        lambda path: bpy.ops.wm.open_mainfile(filepath=path, load_ui=False),
        lambda path: bpy.ops.wm.save_as_mainfile(filepath=path, copy=True),
    ),
    ".obj": (
        lambda path: bpy.ops.wm.obj_import(filepath=path),
        lambda path: bpy.ops.wm.obj_export(filepath=path),
    ),
    ".ply": (
        lambda path: bpy.ops.wm.ply_import(filepath=path),
        lambda path: bpy.ops.wm.ply_export(filepath=path),
    ),
    ".stl": (
        lambda path: bpy.ops.wm.stl_import(filepath=path),
        lambda path: bpy.ops.wm.stl_export(filepath=path),
    ),
    ".glb": _GLTF,
    ".gltf": _GLTF,
    ".fbx": (_import_fbx, lambda path: bpy.ops.export_scene.fbx(filepath=path)),
    ".usd": _USD,
    ".usda": _USD,
    ".usdc": _USD,
    ".usdz": _USD,
}
"""How to read and how to write each kind of file, by its suffix."""


class FileError(Exception):
    """A file that cannot be read or written; the message says why."""


def check_suffix(path: Path) -> str:
    """The suffix of a path in lower case, or `FileError` if Blender has no reader and writer for it."""
    suffix = path.suffix.lower()
    if suffix not in FORMATS:
        raise FileError(
            f"{path.name}: files of this kind cannot be read or written; use one of {', '.join(FORMATS)}"
        )
    return suffix


def read_file(path: Path) -> list[bpy.types.Object]:
    """Open or import a file, alone, and return its meshes in Object Mode; `FileError` if unreadable."""
    suffix = check_suffix(path)
    if not path.is_file():
        raise FileError(f"{path} does not exist or is not a file")
    if suffix != ".blend":
        bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    _call(FORMATS[suffix][0], path)
    if bpy.context.mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")
    objects = [obj for obj in bpy.data.objects if obj.type == "MESH"]
    if not objects:
        raise FileError(f"{path.name} holds no mesh that Blender can read")
    return objects


def write_file(path: Path) -> None:
    """Write what Blender has open; makes the folder if there is none. `FileError` if it cannot be written."""
    suffix = check_suffix(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    _call(FORMATS[suffix][1], path)
    if not path.is_file():
        raise FileError(f"{path} was not written")


def _call(operator: Callable[[str], object], path: Path) -> None:
    try:
        outcome = operator(str(path))
    except (RuntimeError, AttributeError, OSError) as error:
        # Blender's importers report by raising RuntimeError, "Error: …" on several lines.
        raise FileError(f"{path.name}: {' '.join(str(error).split())}") from error
    if isinstance(outcome, set) and "CANCELLED" in outcome:
        raise FileError(f"{path.name}: Blender cancelled reading or writing it")
