"""Figure 20 (left): one sphere in two layouts, and how far what comes out depends on them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from known_shapes import shapes
from known_shapes.fill_measures import point_distances
from numpy.typing import NDArray

from . import ways
from .measures import table

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

STEPS, FIDELITY = 250, 500.0
FACETS = 30
WAYS = {
    "the paper's flow": lambda shape: ways.of_paper(shape, STEPS, FIDELITY),
    "with sharpness": lambda shape: ways.with_sharpness(shape, STEPS, FIDELITY),
    f"{FACETS} facets": lambda shape: ways.in_facets(shape, FACETS),
}
VIEW = (0.6, -1.0, 0.5)


def spheres() -> dict[str, tuple[Array, Indices]]:
    """The unit sphere as a cube that was blown up, and in circles of latitude."""
    vertices, faces = shapes.cube(16)
    return {
        "cube sphere": (vertices / np.linalg.norm(vertices, axis=1, keepdims=True), faces),
        "UV sphere": shapes.uv_sphere(56, 28),
    }


def apart(one: tuple[Array, Indices], other: tuple[Array, Indices]) -> float:
    """The distance of two surfaces, root mean square over the vertices of both."""
    there, back = point_distances(one[0], *other), point_distances(other[0], *one)
    return float(np.sqrt(0.5 * ((there**2).mean() + (back**2).mean())))


def on_grid(name: str, vertices: Array, faces: Indices) -> float:
    """How much of the bend is in edges within ten degrees of the lines of the layout; 0.22 by chance."""
    sides = np.sort(faces[:, [[1, 2], [2, 0], [0, 1]]].reshape(-1, 2), axis=1)
    edges, of = np.unique(sides, axis=0, return_inverse=True)
    pairs = (np.argsort(of, kind="stable").reshape(-1, 2)) // 3
    a, b, c = (vertices[faces[:, i]] for i in range(3))
    normals = np.cross(b - a, c - a)
    one, other = normals[pairs[:, 0]], normals[pairs[:, 1]]
    bend = np.arctan2(np.linalg.norm(np.cross(one, other), axis=1), (one * other).sum(axis=1))
    ends = vertices[edges]
    along, middle = ends[:, 1] - ends[:, 0], ends.mean(axis=1)
    length = np.linalg.norm(along, axis=1)
    lines = LINES[name](middle)
    near = np.abs((lines * along[:, None]).sum(axis=2)) >= np.cos(np.radians(10.0)) * length[:, None]
    return float((bend * length)[near.any(axis=1)].sum() / (bend * length).sum())


def _of_cube(points: Array) -> Array:
    """The two directions `(n, 2, 3)` of the cube's lines at points of the sphere: great circles."""
    axis = np.abs(points).argmax(axis=1)
    others = np.eye(3)[np.stack([(axis + 1) % 3, (axis + 2) % 3], axis=1)]
    # In the plane of one coordinate and the point's own direction, along the sphere.
    outward = points / np.linalg.norm(points, axis=1, keepdims=True)
    along = others - (others * outward[:, None]).sum(axis=2, keepdims=True) * outward[:, None]
    return along / np.linalg.norm(along, axis=2, keepdims=True)


def _of_circles(points: Array) -> Array:
    """The directions `(n, 2, 3)` of meridian and parallel."""
    around = np.column_stack([-points[:, 1], points[:, 0], np.zeros(len(points))])
    around /= np.maximum(np.linalg.norm(around, axis=1, keepdims=True), 1e-12)
    up = np.cross(points / np.linalg.norm(points, axis=1, keepdims=True), around)
    return np.stack([around, up], axis=1)


LINES = {"cube sphere": _of_cube, "UV sphere": _of_circles}


def draw(folder: Path) -> dict[str, str]:
    """Both layouts in every way."""
    from . import panels  # noqa: PLC0415

    given = spheres()
    made = {way: {name: make(shape) for name, shape in given.items()} for way, make in WAYS.items()}
    row = []
    for name, (vertices, faces) in given.items():
        look = {"view": VIEW, "size": (300, 300), "frame": vertices}
        row.append((f"{name}, {len(vertices)} vertices", panels.wireframe(vertices, faces, **look)))
        row += [(way, panels.shaded(*found[name], **look)) for way, found in made.items()]
    panels.page(folder / "layouts.png", row, 1 + len(WAYS))
    rows = [
        [
            way,
            *(f"{on_grid(name, *shape):.2f}" for name, shape in found.items()),
            f"{apart(*found.values()):.4f}",
        ]
        for way, found in made.items()
    ]
    header = ["made by", *(f"{name}: bend along its lines" for name in given), "apart"]
    return {"layouts": table(header, rows)}
