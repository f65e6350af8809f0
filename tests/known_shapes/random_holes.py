"""Random holes in ten meshes, and what must be true of any filling of them."""

from __future__ import annotations

import functools
from collections.abc import Callable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from . import fill_measures, holed_shapes, shapes

Points = NDArray[np.float64]
Faces = NDArray[np.int64]

SOURCES = Path(__file__).parents[2] / "blend_fixtures/sources"
FOLDED = np.cos(np.radians(175.0))
"""Two faces that turn back on each other by more are taken for flipped: no ridge in use is as sharp."""
LEAST_QUALITY = 1e-4
"""`fill_measures.qualities` of a triangle counted as degenerate: ten thousand times as long as high."""


def _bust() -> shapes.Shape:
    with np.load(SOURCES / "bust.npz") as data:
        return data["vertices"].astype(float), data["faces"].astype(np.int64)


def _irregular(solid: holed_shapes.Solid) -> shapes.Shape:
    other = holed_shapes.irregular(solid, 5)
    return other.vertices, other.faces


def _noisy(shape: shapes.Shape) -> shapes.Shape:
    vertices, faces = shape
    return shapes.add_noise(vertices, faces, 0.1, seed=3), faces


MESHES: dict[str, Callable[[], shapes.Shape]] = {
    "cube": lambda: shapes.cube(14),
    "noisy cube": lambda: _noisy(shapes.cube(12)),
    "step, irregular": lambda: _irregular(holed_shapes.step(16)),
    "staircase": lambda: shapes.staircase(3, 5),
    "roof, irregular": lambda: _irregular(holed_shapes.roof(12)),
    "cylinder, irregular": lambda: _irregular(holed_shapes.cylinder(14)),
    "sphere": lambda: shapes.icosphere(3),
    "torus": lambda: shapes.torus(40, 18),
    "dodecahedron, noisy": lambda: _noisy(shapes.dodecahedron(3)),
    "bust": _bust,
}
"""Closed shapes with flat, sharp, round and noisy places, and a scan with borders of its own."""


@functools.cache
def mesh(name: str) -> shapes.Shape:
    """One of `MESHES`, without vertices that no face uses."""
    vertices, faces = MESHES[name]()
    used, index = np.unique(faces, return_inverse=True)
    return vertices[used], index.reshape(-1, 3)


def random_holes(seed: int) -> tuple[str, Points, Faces]:
    """A mesh by name with one to four holes, round or long, small or large: all drawn from the seed."""
    name = list(MESHES)[seed % len(MESHES)]
    vertices, faces = mesh(name)
    rng = np.random.default_rng(seed)
    size = np.ptp(vertices, axis=0).max()
    count = rng.integers(1, 5)
    places = [
        (vertices[rng.integers(len(vertices))], size * rng.uniform(0.04, 0.28 / np.sqrt(count)))
        for _ in range(count)
    ]
    removed = holed_shapes.removed_faces(vertices, faces, places, seed, stretch=rng.uniform(1.0, 3.0))
    used, index = np.unique(faces[~removed], return_inverse=True)
    return name, vertices[used], index.reshape(-1, 3)


def loops(faces: Faces) -> int:
    """How many boundary loops a mesh has whose border vertices have two border edges each."""
    follower = dict(fill_measures.boundary_edges(faces).tolist())
    count = 0
    while follower:
        count += 1
        vertex = next(iter(follower))
        while vertex in follower:
            vertex = follower.pop(vertex)
    return count


def faults(before: tuple[Points, Faces], after: tuple[Points, Faces], patch: NDArray) -> list[str]:
    """What is wrong with a filling, in words; `patch` is -1 for old faces and else the hole of a face.

    Old vertices and faces come first, to the bit; no new face is degenerate or folded over; manifold stays
    manifold; the loops of the holes are closed.
    """
    (vertices, faces), (points, triangles) = before, after
    found = []
    if not np.array_equal(points[: len(vertices)], vertices):
        found.append("old vertices moved")
    if not np.array_equal(triangles[: len(faces)], faces):
        found.append("old faces changed")
    if (patch[: len(faces)] != -1).any() or (patch[len(faces) :] < 0).any():
        found.append("faces are taken for what they are not")
    if not np.isfinite(points).all():
        return [*found, "a coordinate is not finite"]
    unused = np.setdiff1d(np.arange(len(vertices), len(points)), triangles)
    if len(unused):
        found.append(f"{len(unused)} new vertices have no face")
    new = triangles[len(faces) :]
    poor = (fill_measures.qualities(points, new) < LEAST_QUALITY).sum()
    if poor:
        found.append(f"{poor} new faces are degenerate")
    folded = _folds(points, triangles)
    folded = folded[(folded >= len(faces)).any(axis=1)]
    if len(folded):
        found.append(f"{len(folded)} new faces are folded over")
    if fill_measures.nonmanifold_edges(triangles) > fill_measures.nonmanifold_edges(faces):
        found.append("new edges are not manifold")
    if len(fill_measures.nonmanifold_vertices(triangles)) > len(fill_measures.nonmanifold_vertices(faces)):
        found.append("new vertices are not manifold")
    closed = len(np.unique(patch[len(faces) :]))
    if loops(triangles) != loops(faces) - closed:
        found.append(f"{closed} holes are said to be filled, but {loops(triangles)} loops are left")
    return found


def _folds(points: Points, triangles: Faces) -> NDArray:
    """Pairs `(k, 2)` of faces at an edge that lie on each other."""
    halfedges = np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    order = np.lexsort((halfedges[:, 0], halfedges[:, 1]))
    same = np.flatnonzero((halfedges[order][1:] == halfedges[order][:-1]).all(axis=1))
    pairs = np.stack([order[same], order[same + 1]], axis=1) // 3
    a, b, c = (points[triangles[:, i]] for i in range(3))
    normal = np.cross(b - a, c - a)
    length = np.linalg.norm(normal, axis=1, keepdims=True)
    unit = np.divide(normal, length, out=np.zeros_like(normal), where=length > 0)
    return pairs[(unit[pairs[:, 0]] * unit[pairs[:, 1]]).sum(axis=1) < FOLDED]
