# SPDX-License-Identifier: GPL-3.0-or-later
"""Reading and writing files in the formats that Blender itself reads and writes."""

import contextlib
import re
import traceback
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import bpy
import numpy as np

from ..blender.refusals import RefusedError
from . import far_origin
from .completeness import check_whole
from .completeness_blend import IncompleteError
from .writing import Protected, write_whole

UNSAFE = re.compile(r"[^\w .-]|^\.+")
"""What makes the name of an image more than the name of a file."""
RAISED = re.compile(r"\w+(Error|Exception): ")
"""How the line of a traceback begins that says what was raised."""


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
    with _plain_image_names():
        bpy.ops.export_scene.gltf(filepath=filepath, export_format=kind)


@contextlib.contextmanager
def _plain_image_names() -> Iterator[None]:
    """Have no image called like a path: Blender 5.2 writes one called "../wood" outside the folder."""
    names = {image: image.name for image in bpy.data.images if UNSAFE.search(image.name)}
    try:
        for image, name in names.items():
            image.name = UNSAFE.sub("_", name)
        yield
    finally:
        for image, name in names.items():
            image.name = name


@dataclass(frozen=True)
class Format:
    """How Blender reads and writes one kind of file."""

    read: Callable[[str], object]
    write: Callable[[str], object]
    several: bool = False
    """Whether materials, images or numbers go into files of their own, beside it."""


_USD = Format(
    lambda path: bpy.ops.wm.usd_import(filepath=path), lambda path: bpy.ops.wm.usd_export(filepath=path), True
)

FORMATS: dict[str, Format] = {
    ".blend": Format(
        # Scripts in a file are somebody else's: they do not run, whatever the preferences say.
        lambda path: bpy.ops.wm.open_mainfile(filepath=path, load_ui=False, use_scripts=False),
        lambda path: bpy.ops.wm.save_as_mainfile(filepath=path, copy=True),
    ),
    ".obj": Format(
        lambda path: bpy.ops.wm.obj_import(filepath=path),
        lambda path: bpy.ops.wm.obj_export(filepath=path),
        True,
    ),
    ".ply": Format(
        lambda path: bpy.ops.wm.ply_import(filepath=path), lambda path: bpy.ops.wm.ply_export(filepath=path)
    ),
    ".stl": Format(
        lambda path: bpy.ops.wm.stl_import(filepath=path), lambda path: bpy.ops.wm.stl_export(filepath=path)
    ),
    ".glb": Format(_import_gltf, _export_gltf),
    ".gltf": Format(_import_gltf, _export_gltf, True),
    ".fbx": Format(_import_fbx, lambda path: bpy.ops.export_scene.fbx(filepath=path)),
    ".usd": _USD,
    ".usda": _USD,
    ".usdc": _USD,
    ".usdz": _USD,
}
"""How to read and how to write each kind of file, by its suffix."""


Moved = tuple[Path, np.ndarray]
"""The file that was read with its coordinates moved, and the offset (3,)."""


class FileError(Exception):
    """A file that cannot be read or written; the message says why."""


def sentence_of(error: Exception) -> str:
    """What a record says of an error; a fault of the program is printed, as the other files go on."""
    if isinstance(error, FileError | RefusedError):
        return str(error)
    traceback.print_exception(error)
    return f"{type(error).__name__}: {error}"


def check_suffix(path: Path) -> str:
    """The suffix of a path in lower case, or `FileError` if Blender has no reader and writer for it."""
    suffix = path.suffix.lower()
    if suffix not in FORMATS:
        raise FileError(
            f"{path.name}: files of this kind cannot be read or written; use one of {', '.join(FORMATS)}"
        )
    return suffix


def read_file(path: Path, offset: np.ndarray | None = None) -> list[bpy.types.Object]:
    """Open or import a file, alone, and return its meshes in Object Mode; `FileError` if unreadable.

    With an `offset` (3,) in the file's axes, its coordinates are moved by `-offset` before.
    """
    suffix = check_suffix(path)
    if not path.is_file():
        raise FileError(f"{path} does not exist or is not a file")
    if suffix != ".blend":
        bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    try:
        if offset is None:
            _call(FORMATS[suffix].read, str(path))
        else:
            far_origin.read_moved(path, offset, lambda copy: _call(FORMATS[suffix].read, str(copy)))
    except _OperatorError as error:
        raise FileError(f"{path.name}: {error}") from error
    if bpy.context.mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")
    objects = [obj for obj in bpy.data.objects if obj.type == "MESH"]
    if not objects:
        raise FileError(f"{path.name} holds no mesh that Blender can read")
    return objects


def write_file(path: Path, protected: Protected | None = None, moved: Moved | None = None) -> None:
    """Write what Blender has open, moved back if it was moved; makes the folder if there is none.

    `FileError` if it cannot be written or is `protected`; what was there before is as it was then.
    """
    kind = FORMATS[check_suffix(path)]

    def export(hidden: str) -> None:
        _call(kind.write, hidden)
        if moved is not None:
            # One that is not whole is refused, with the reason, by who called this.
            with contextlib.suppress(IncompleteError, FileNotFoundError):
                check_whole(Path(hidden))
                far_origin.move_back(Path(hidden), *moved)

    try:
        write_whole(path, export, kind.several, protected)
    except (_OperatorError, IncompleteError, OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) and error.strerror else error
        raise FileError(f"{path} was not written: {reason}") from error


def files_in_use() -> list[Path]:
    """The files that the open one refers to: images, libraries, caches."""
    return [Path(path) for path in bpy.utils.blend_paths(absolute=True)]


class _OperatorError(Exception):
    """What an operator says on a file that it cannot read or write."""


def _call(operator: Callable[[str], object], path: str) -> None:
    try:
        outcome = operator(path)
    except (RuntimeError, AttributeError, OSError) as error:
        raise _OperatorError(_reason(error)) from error
    if isinstance(outcome, set) and "CANCELLED" in outcome:
        raise _OperatorError("Blender cancelled it")


def _reason(error: Exception) -> str:
    """What an operator says: "Error: ..." on several lines, or a traceback of which one line counts."""
    lines = str(error).splitlines()
    raised = [line for line in lines if RAISED.match(line)]
    return raised[-1] if raised and "Traceback" in lines[0] else " ".join(" ".join(lines).split())
