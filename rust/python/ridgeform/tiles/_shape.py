"""What a call is given: arrays checked and laid out in a folder, and sizes of the whole mesh."""

import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..errors import ArgumentError, MeshError
from ._levels import Work, chunks
from ._run import Executor, Report, checked
from ._store import get, put, room

SIDE_OF_EXTENT = 2.4**0.5
"""A cube's side over the root mean square distance of its surface from its center."""


@contextmanager
def working_folder(folder: str | Path | None) -> Iterator[Path]:
    """A fresh folder inside of the one given, or of the system's, that is removed at the end.

    Raises ArgumentError where there can be none.
    """
    try:
        made = tempfile.TemporaryDirectory(prefix="ridgeform-tiles-", dir=folder)
    except OSError as error:
        raise ArgumentError(f"folder: {folder} cannot be written to: {error}") from error
    with made as name:
        yield Path(name)


@contextmanager
def prepared(
    mesh: tuple[ArrayLike, ArrayLike],
    blocks: tuple[int, int],
    executor: Executor | None,
    folder: str | Path | None,
    report: Report | None,
) -> Iterator[Work]:
    """Vertices and faces laid out to be worked on in blocks of so many vertices, with so many rings around.

    Raises ArgumentError.
    """
    max_vertices, rings = blocks
    for name, given, least in (("max_vertices", max_vertices, 100), ("rings", rings, 2)):
        if not isinstance(given, int) or given < least:
            raise ArgumentError(f"{name}: is {given}; give a whole number of at least {least}")
    with working_folder(folder) as made:
        work = Work(made, max_vertices, rings, checked(executor), report)
        lay_out(work.level(0), *mesh)
        yield work


def lay_out(level: Path, vertices: ArrayLike, faces: ArrayLike) -> None:
    """Writes the mesh as level 0. Raises ArgumentError for arrays that are none."""
    level.mkdir()
    points, corners = np.asanyarray(vertices), np.asanyarray(faces)
    for name, array in (("vertices", points), ("faces", corners)):
        if array.ndim != 2 or array.shape[1] != 3:
            raise ArgumentError(f"{name}: expected an array of shape (k, 3), got {array.shape}")
    if corners.dtype.kind not in "iu":
        raise ArgumentError(f"faces: expected whole numbers, got {corners.dtype}")
    if len(points) > np.iinfo(np.int32).max:
        raise ArgumentError(
            f"vertices: has {len(points)} rows; at most {np.iinfo(np.int32).max} are possible"
        )
    copied = room(level, "vertices", np.float64, points.shape)
    for rows in chunks(len(points)):
        copied[rows] = points[rows]
        wrong = np.flatnonzero(~np.isfinite(copied[rows]).all(axis=1))
        if len(wrong):
            raise ArgumentError(f"vertices: row {rows.start + wrong[0]} is not finite; every number must be")
    copied = room(level, "faces", np.int32, corners.shape)
    for rows in chunks(len(corners)):
        portion = corners[rows]
        wrong = np.flatnonzero(((portion < 0) | (portion >= len(points))).any(axis=1))
        if len(wrong):
            face = rows.start + wrong[0]
            raise ArgumentError(
                f"faces: face {face} names vertices {portion[wrong[0]].tolist()}, there are {len(points)}"
            )
        copied[rows] = portion
    if len(corners) == 0:
        raise MeshError("the mesh has no faces")


def setting(
    level: Path, name: str, kept: str, given: ArrayLike | None, n: int, *, most: float | None = None
) -> None:
    """Writes a number for each vertex or face, where there are any, under the name `kept`.

    Raises ArgumentError for another shape, and for numbers below 0, above `most`, or not finite.
    """
    if given is None:
        return
    values = np.asanyarray(given)
    if values.shape != (n,):
        raise ArgumentError(f"{name}: expected {n} entries, shape ({n},), got {values.shape}")
    numbers = values.astype(np.float64)
    wrong = np.flatnonzero(~((numbers >= 0.0) & (numbers <= (np.inf if most is None else most))))
    if len(wrong) or not np.isfinite(numbers).all():
        i = int(wrong[0]) if len(wrong) else int(np.flatnonzero(~np.isfinite(numbers))[0])
        up_to = "" if most is None else f" and at most {most:g}"
        raise ArgumentError(f"{name}: entry {i} is {numbers[i]}; it must be finite, at least 0{up_to}")
    put(level, kept, numbers)


def held(level: Path, fixed: ArrayLike | None, n: int) -> None:
    """Writes which vertices do not move: those that are fixed, booleans or indices, or have no strength."""
    is_held = np.zeros(n, bool)
    if fixed is not None:
        given = np.asanyarray(fixed)
        if given.dtype.kind == "b" and given.shape != (n,):
            raise ArgumentError(f"fixed: expected {n} booleans, shape ({n},), got {given.shape}")
        if given.dtype.kind != "b":
            if given.ndim != 1 or (given.size and given.dtype.kind not in "iu"):
                raise ArgumentError("fixed: expected booleans, one for each vertex, or indices of vertices")
            outside = given[(given < 0) | (given >= n)]
            if len(outside):
                raise ArgumentError(f"fixed: index {outside[0]} is out of range: there are {n} vertices")
        is_held[given if given.dtype.kind == "b" else given.astype(np.int64)] = True
    strength = level / "strength.npy"
    if strength.exists():
        is_held |= get(level, "strength") <= 0.0
    if is_held.any():
        put(level, "held", is_held)


def sizes(level: Path) -> dict[str, float]:
    """The lengths that `scale` can name, and the area, of the whole mesh."""
    vertices, faces = get(level, "vertices"), get(level, "faces")
    longest = area = second = 0.0
    first = np.zeros(3)
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    center = np.asarray(vertices[faces[0, 0]])
    for rows in chunks(len(faces)):
        a, b, c = (vertices[faces[rows, i]] - center for i in range(3))
        edges = (b - a, c - b, a - c)
        longest = max(longest, *(float(np.linalg.norm(edge, axis=1).max()) for edge in edges))
        size = 0.5 * np.linalg.norm(np.cross(edges[0], -edges[2]), axis=1)
        middle = (a + b + c) / 3.0
        area += float(size.sum())
        first += size @ middle
        second += float(size @ (middle**2).sum(axis=1))
        for corner in (a, b, c):
            low, high = np.minimum(low, corner.min(axis=0)), np.maximum(high, corner.max(axis=0))
    if not area > 0.0:
        raise MeshError("no face of the mesh has an area")
    extent = max(second / area - float(((first / area) ** 2).sum()), 0.0) ** 0.5
    return {
        "max_edge": longest,
        "bounding_box": float((high - low).max()),
        "area": area**0.5,
        "extent": SIDE_OF_EXTENT * extent,
    }


def unit(found: dict[str, float], scale: Any) -> float:
    """The length that is 1. Raises ArgumentError for what is neither a word nor a length."""
    if isinstance(scale, str):
        if scale not in found:
            words = " or ".join(f'"{word}"' for word in found)
            raise ArgumentError(f'scale: "{scale}" is not known here; use {words}, or a length')
        return found[scale]
    try:
        length = float(scale)
    except (TypeError, ValueError):
        raise TypeError(f"scale: expected a word or a length, got {type(scale).__name__}") from None
    if not 0.0 < length < np.inf:
        raise ArgumentError(f"scale: is {length}; a length must be positive and finite")
    return length
