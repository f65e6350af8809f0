"""How filling grows with the mesh and with the hole, and 500 random holes: ours only, run with the package.

    python benchmarks/holes_limits.py locality|long|stress [COUNT]

Prints one line of JSON.
"""

from __future__ import annotations

import json
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests"))

import fill_measures
import random_holes
import ridgeform
import shapes
from numpy.typing import NDArray

REPEATS = 5
GROWTH = (24, 76, 240)
"""Edges along a side of cubes of equal edge length: 1, 10 and 100 times as many vertices."""
LONG = 5000
"""Vertices of the long loops."""
STRESS = 500
"""Random holes, seeds from 0."""

Arrays = tuple[NDArray, NDArray]


def _without(vertices: NDArray, faces: NDArray, removed: NDArray) -> Arrays:
    used, index = np.unique(faces[~removed], return_inverse=True)
    return vertices[used], index.reshape(-1, 3)


def same_hole(n: int) -> Arrays:
    """A cube of edge length 1/12 with one and the same hole across an edge, whatever its size."""
    side = n / 12
    vertices, faces = shapes.cube(n, side)
    place = np.array([0.5 * side, 0.1, 0.5 * side])
    return _without(vertices, faces, np.linalg.norm(vertices[faces].mean(axis=1) - place, axis=1) < 0.4)


def locality() -> list[dict[str, Any]]:
    """The median time of filling the same hole in meshes of growing size."""
    records = []
    for n in GROWTH:
        mesh = ridgeform.Mesh(*same_hole(n))
        times = []
        for _ in range(REPEATS):
            begin = time.perf_counter()
            filled = ridgeform.fill_holes(mesh)
            times.append(time.perf_counter() - begin)
        records.append(
            {
                "vertices": mesh.n_vertices,
                "new_faces": len(filled.faces) - mesh.n_faces,
                "seconds": float(np.median(times)),
            }
        )
    return records


def slit() -> Arrays:
    """A sheet folded along a ridge, with a slit along it that is six edges wide."""
    length, width = LONG // 2, 8
    vertices, faces = shapes.grid(length + 6, 2 * width)
    middle = vertices[faces].mean(axis=1)
    beside = np.abs(vertices[:, 1] - width)
    vertices[:, 1], vertices[:, 2] = (vertices[:, 1] - width) * np.sqrt(0.5), -beside * np.sqrt(0.5)
    inside = (np.abs(middle[:, 1] - width) < 3) & (np.abs(middle[:, 0] - 0.5 * length - 3) < 0.5 * length - 3)
    return _without(vertices, faces, inside)


def ring() -> Arrays:
    """A flat ring around a round hole whose filling is millions of times as large as its faces."""
    angle = 2 * np.pi * np.arange(LONG) / LONG
    step = 2 * np.pi / LONG
    circles = [(1 + k * step) * np.stack([np.cos(angle), np.sin(angle)], axis=1) for k in range(4)]
    vertices = np.concatenate([np.c_[circle, np.zeros(LONG)] for circle in circles])
    k = np.arange(LONG)
    after = (k + 1) % LONG
    quads = np.concatenate(
        [np.stack([k, k + LONG, after + LONG, after], axis=1) + LONG * ring for ring in range(3)]
    )
    return vertices, np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])


def long() -> list[dict[str, Any]]:
    """Loops of thousands of vertices; of the ring, the outer one is its border and stays."""
    records = []
    for name, make in (("slit along a ridge", slit), ("round hole", ring)):
        mesh = ridgeform.Mesh(*make())
        loops = ridgeform.boundary_loops(mesh)
        # Both loops of the ring are equally long: the inner one starts with the first vertices.
        inner = min(loops, key=lambda loop: loop.min()) if name == "round hole" else _hole_of(mesh, loops)
        begin = time.perf_counter()
        filled = ridgeform.fill_holes(mesh, loops=[inner])
        seconds = time.perf_counter() - begin
        made = filled.faces[filled.patch >= 0]
        records.append(
            {
                "loop": name,
                "loop_vertices": len(inner),
                "new_faces": len(made),
                "worst_quality": float(fill_measures.qualities(filled.vertices, made).min()),
                "seconds": seconds,
            }
        )
    return records


def _hole_of(mesh: ridgeform.Mesh, loops: list[NDArray]) -> NDArray:
    """The loop that does not touch the ends of the sheet."""
    ends = mesh.vertices[:, 0].min(), mesh.vertices[:, 0].max()
    return next(loop for loop in loops if not np.isin(mesh.vertices[loop, 0], ends).any())


def stress(count: int = STRESS) -> dict[str, Any]:
    """Fill random holes; what is wrong with any filling, by seed."""
    wrong: dict[str, list[str]] = {}
    filled_holes, seconds = 0, []
    for seed in range(count):
        name, vertices, faces = random_holes.random_holes(seed)
        begin = time.perf_counter()
        try:
            filled = ridgeform.fill_holes(ridgeform.Mesh(vertices, faces))
        except ridgeform.RidgeformError as error:
            wrong[f"{seed}, {name}"] = [f"{type(error).__name__}: {error}"]
            continue
        seconds.append(time.perf_counter() - begin)
        after = (filled.vertices, filled.faces.astype(np.int64))
        found = random_holes.faults((vertices, faces), after, filled.patch)
        filled_holes += len(np.unique(filled.patch[filled.patch >= 0]))
        if found:
            wrong[f"{seed}, {name}"] = found
    return {
        "meshes": count,
        "holes": filled_holes,
        "wrong": wrong,
        "median_seconds": float(np.median(seconds)) if seconds else None,
        "longest_seconds": max(seconds, default=None),
    }


if __name__ == "__main__":
    kind, *rest = sys.argv[1:]
    work = {"locality": locality, "long": long, "stress": stress}[kind]
    print(json.dumps(work(*map(int, rest))))
