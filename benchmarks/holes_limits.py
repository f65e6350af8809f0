"""How filling grows with the mesh and with the hole, and 500 random holes: ours only, run with the package.

Times are processor times on one thread.

    python benchmarks/holes_limits.py locality|long|ridges|stress [COUNT]

Prints one line of JSON.
"""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Callable
from typing import Any

import numpy as np
import ridgeform
from holes_long import LOOPS, holes_border, without
from known_shapes import fill_measures, random_holes, random_ridges, shapes
from numpy.typing import NDArray

REPEATS = 5
GROWTH = (24, 76, 240)
"""Edges along a side of cubes of equal edge length: 1, 10 and 100 times as many vertices."""
HOLES = {
    "across an edge": (np.array([0.5, 0.0, 0.5]), np.array([0.0, 0.1, 0.0]), 0.4),
    "across an edge, larger": (np.array([0.5, 0.0, 0.5]), np.array([0.0, 0.1, 0.0]), 0.8),
    "in a side": (np.array([0.0, 0.0, 0.5]), np.array([0.03, 0.05, 0.0]), 0.4),
}
"""Place as part of the side, place beside it and radius."""
LONG = 5000
"""Vertices of the long loops."""
RIDGES = 100
"""Random holes across each kind of ridge, seeds from 0."""
STRESS = 500
"""Random holes, seeds from 0."""


def same_hole(n: int, hole: str) -> tuple[NDArray, NDArray]:
    """A cube of edge length 1/12 with one and the same hole, whatever its size."""
    side = n / 12
    vertices, faces = shapes.cube(n, side)
    part, beside, radius = HOLES[hole]
    middle = vertices[faces].mean(axis=1)
    return without(vertices, faces, np.linalg.norm(middle - side * part - beside, axis=1) < radius)


def seconds(work: Callable[[], object], repeats: int = REPEATS) -> float:
    """The median processor time of some work; other programs may run beside it."""
    times = []
    for _ in range(repeats):
        begin = time.process_time()
        work()
        times.append(time.process_time() - begin)
    return float(np.median(times))


def locality() -> list[dict[str, Any]]:
    """The time of filling the same hole in meshes of growing size, and of what comes before and after."""
    records = []
    for hole in HOLES:
        for n in GROWTH:
            vertices, faces = same_hole(n, hole)
            mesh = ridgeform.Mesh(vertices, faces)
            filled = [ridgeform.fill_holes(mesh, threads=1) for _ in range(REPEATS)]
            whole = iter(filled)
            records.append(
                {
                    "hole": hole,
                    "vertices": mesh.n_vertices,
                    "loop_vertices": len(filled[0].holes[0].boundary),
                    "new_faces": len(filled[0].new_faces),
                    "seconds": seconds(lambda mesh=mesh: ridgeform.fill_holes(mesh, threads=1)),
                    "reading": seconds(lambda v=vertices, f=faces: ridgeform.Mesh(v, f)),
                    "joining": seconds(lambda whole=whole: _whole(next(whole))),
                }
            )
    return records


def _whole(filled: ridgeform.Filled) -> tuple[NDArray, NDArray]:
    return filled.vertices, filled.faces


def long() -> list[dict[str, Any]]:
    """Loops of thousands of vertices."""
    records = []
    for name, make in LOOPS.items():
        mesh = ridgeform.Mesh(*make(LONG))
        loop = holes_border(name, mesh.vertices, ridgeform.boundary_loops(mesh))
        begin = time.process_time()
        filled = ridgeform.fill_holes(mesh, loops=[loop], threads=1)
        records.append(
            {
                "loop": name,
                "loop_vertices": len(loop),
                "new_faces": len(filled.new_faces),
                "worst_quality": float(fill_measures.qualities(filled.vertices, filled.new_faces).min()),
                "seconds": time.process_time() - begin,
            }
        )
    return records


def ridges(count: int = RIDGES) -> list[dict[str, Any]]:
    """How near the truth random holes across ridges are filled."""
    records = []
    for kind in random_ridges.KINDS:
        found = []
        for seed in range(count):
            holed = random_ridges.random_ridge(kind, seed)
            filled = ridgeform.fill_holes(ridgeform.Mesh(holed.vertices, holed.faces))
            filling = filled.faces[filled.patch >= 0].astype(np.int64)
            found.append(random_ridges.errors(holed, filled.vertices, filling))
        ridge, off, quality = np.array(found).T
        records.append(
            {
                "kind": kind,
                "holes": count,
                "ridge": [float(x) for x in (ridge.mean(), *np.quantile(ridge, [0.5, 0.9]), ridge.max())],
                "filling": [float(off.mean()), float(off.max())],
                "worst_quality": float(quality.min()),
            }
        )
    return records


def stress(count: int = STRESS) -> dict[str, Any]:
    """Fill random holes; what is wrong with any filling, by seed."""
    wrong: dict[str, list[str]] = {}
    filled_holes, times = 0, []
    for seed in range(count):
        name, vertices, faces = random_holes.random_holes(seed)
        begin = time.process_time()
        try:
            filled = ridgeform.fill_holes(ridgeform.Mesh(vertices, faces), threads=1)
        except ridgeform.RidgeformError as error:
            wrong[f"{seed}, {name}"] = [f"{type(error).__name__}: {error}"]
            continue
        times.append(time.process_time() - begin)
        after = (filled.vertices, filled.faces.astype(np.int64))
        found = random_holes.faults((vertices, faces), after, filled.patch)
        filled_holes += len(np.unique(filled.patch[filled.patch >= 0]))
        if found:
            wrong[f"{seed}, {name}"] = found
    return {
        "meshes": count,
        "holes": filled_holes,
        "wrong": wrong,
        "median_seconds": float(np.median(times)) if times else None,
        "longest_seconds": max(times, default=None),
    }


if __name__ == "__main__":
    kind, *rest = sys.argv[1:]
    work = {"locality": locality, "long": long, "ridges": ridges, "stress": stress}[kind]
    print(json.dumps(work(*map(int, rest))))
