# SPDX-License-Identifier: GPL-3.0-or-later
"""Files with coordinates far from the origin: moved there before Blender reads them, and back afterwards.

Blender has single precision, and rounds georeferenced coordinates to steps of centimeters or more. OBJ and
PLY files can hold double precision, so their coordinates are moved as such.
"""

import os
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from . import ply_head

VISIBLE = 1e-5
"""Rounding by less than this part of a mesh's size is what files of six digits have anyway."""
DIGITS = 8
"""So many digits of the size of a mesh hold all that single precision has near the origin."""


@dataclass(frozen=True)
class _Kind:
    """One kind of file: its coordinates (n, 3), a copy with other ones, and how Blender turns its axes."""

    places: Callable[[Path], np.ndarray]
    rewrite: Callable[[Path, Path, np.ndarray], None]
    to_scene: np.ndarray


def step_of(places: np.ndarray) -> float:
    """The largest step to which single precision rounds coordinates (n, 3)."""
    return float(np.spacing(np.float32(np.abs(places).max(initial=0.0))))


def is_rounded(places: np.ndarray) -> bool:
    """Whether that is visible on what is there."""
    return len(places) > 0 and step_of(places) > VISIBLE * float(np.ptp(places, axis=0).max()) > 0.0


def offset_of(path: Path, output: Path) -> np.ndarray | None:
    """How far (3,) the coordinates of a file are to be moved toward the origin; `None` if not at all.

    Only where the file to be written can hold them again. In whole units, so that digits stay digits.
    """
    kind = _KINDS.get(path.suffix.lower())
    if kind is None or output.suffix.lower() not in _KINDS:
        return None
    try:
        places = kind.places(path)
    except (OSError, ValueError, LookupError):
        # Blender says what is wrong with it.
        return None
    places = places[np.isfinite(places).all(axis=1)]
    if not is_rounded(places):
        return None
    return np.round(0.5 * (places.min(axis=0) + places.max(axis=0)))


def read_moved(path: Path, offset: np.ndarray, read: Callable[[Path], object]) -> object:
    """What `read` makes of a copy of a file whose coordinates are moved by `-offset`."""
    with tempfile.TemporaryDirectory(prefix="ridgeform-") as folder:
        copy = Path(folder) / path.name
        _KINDS[path.suffix.lower()].rewrite(path, copy, -offset)
        return read(copy)


def move_back(path: Path, source: Path, offset: np.ndarray) -> None:
    """Move the coordinates of a file that was written by an offset (3,) in the axes of `source`."""
    kind = _KINDS[path.suffix.lower()]
    turned = kind.to_scene.T @ _KINDS[source.suffix.lower()].to_scene @ offset
    moved = path.with_name(f"{path.name}.moved")
    kind.rewrite(path, moved, turned)
    os.replace(moved, path)


def _obj_places(path: Path) -> np.ndarray:
    with path.open("rb") as stream:
        words = (line.split(maxsplit=4) for line in stream if line.lstrip()[:2] in (b"v ", b"v\t"))
        return np.array([line[1:4] for line in words], np.float64).reshape(-1, 3)


def _obj_rewrite(path: Path, target: Path, offset: np.ndarray) -> None:
    size = float(np.ptp(_obj_places(path), axis=0).max())
    decimals = max(DIGITS - int(np.floor(np.log10(size))), 0)
    with path.open("rb") as stream, target.open("wb") as made:
        for line in stream:
            words = line.split()
            if words[:1] == [b"v"]:
                numbers = (float(word) + move for word, move in zip(words[1:4], offset, strict=True))
                places = [f"{number:.{decimals}f}".encode() for number in numbers]
                made.write(b" ".join([b"v", *places, *words[4:]]) + b"\n")
            elif words[:1] == [b"mtllib"] and target.parent != path.parent:
                library = path.parent / os.fsdecode(line.strip()[6:].strip())
                made.write(b"mtllib " + os.fsencode(os.path.relpath(library, target.parent)) + b"\n")
            else:
                made.write(line)


def _ply_places(path: Path) -> np.ndarray:
    rows = ply_head.read_vertices(path).rows
    return np.stack([rows[axis] for axis in "xyz"], axis=1).astype(np.float64)


def _ply_rewrite(path: Path, target: Path, offset: np.ndarray) -> None:
    found = ply_head.read_vertices(path)
    rows = found.with_doubles("xyz")
    for axis, move in zip("xyz", offset, strict=True):
        rows[axis] += move
    ply_head.write_vertices(path, target, found, rows)


_KINDS = {
    ".obj": _Kind(_obj_places, _obj_rewrite, np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])),
    ".ply": _Kind(_ply_places, _ply_rewrite, np.eye(3)),
}
