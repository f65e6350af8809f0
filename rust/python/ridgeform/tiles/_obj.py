"""Positions and faces of Wavefront OBJ files; everything else in them is passed on as it is."""

from itertools import pairwise
from pathlib import Path

import numpy as np

from ..errors import ArgumentError
from ._store import Array


def read(path: Path) -> tuple[Array, Array]:
    """The vertices and the triangles of a file; larger faces are cut into fans. Raises ArgumentError."""
    vertices: list[list[float]] = []
    faces: list[tuple[int, int, int]] = []
    number = 0
    try:
        with path.open(encoding="utf-8", errors="replace") as lines:
            for line in lines:
                number += 1
                words = line.split()
                if not words:
                    continue
                if words[0] == "v":
                    vertices.append([float(word) for word in words[1:4]])
                elif words[0] == "f":
                    given = [int(word.partition("/")[0]) for word in words[1:]]
                    corners = [i - 1 if i > 0 else len(vertices) + i for i in given]
                    faces += [(corners[0], b, c) for b, c in pairwise(corners[1:])]
        points = np.array(vertices, np.float64).reshape(-1, 3)
    except ValueError as error:
        raise ArgumentError(f"folder: {path}, line {number}: {error}") from error
    return points, np.array(faces, np.int32).reshape(-1, 3)


def write(source: Path, target: Path, points: Array) -> None:
    """The file with other positions; whatever follows the three numbers of a vertex stays."""
    rows = iter(points.tolist())
    with (
        source.open(encoding="utf-8", errors="surrogateescape", newline="") as lines,
        target.open("w", encoding="utf-8", errors="surrogateescape", newline="") as out,
    ):
        for line in lines:
            if line.split(maxsplit=1)[:1] != ["v"]:
                out.write(line)
                continue
            rest = line.split()[4:]
            # repr gives the shortest text that is read as the same bits.
            numbers = [repr(x) for x in next(rows)]
            out.write(" ".join(["v", *numbers, *rest]) + "\n")
