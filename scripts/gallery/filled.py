"""Figures 3 and 20 (right), and 16: holes across ridges, filled smoothly, by the paper, and by ours."""

from __future__ import annotations

import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import ridgeform
from known_shapes import holed_shapes, shapes
from known_shapes.fill_measures import point_distances
from numpy.typing import NDArray

from . import domains
from .measures import table

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

WAYS = {
    "smooth start": {"iterations": 0},
    "the paper's flow": {"sharpness": 0.0},
    "ours": {},
}
"""What `fill_holes` is called with, besides the paper's iterations and fidelity where it names some."""
PATCH = (0.75, 0.36, 0.1)
"""Linear RGB of the patches."""
RIM_HOLES = ((0.6, -0.5, 1.5), (-0.3, -1.0, 1.2))
"""Directions in which the bust reaches farthest at the middle of a hole: on the rim of its crown."""

ROOF_HOLE = (0.0, 0.0, 0.3)
"""Middle and radius of the hole in the roof, from above."""


@dataclass(frozen=True)
class Open:
    """A mesh with holes."""

    vertices: Array
    faces: Indices
    lost: Array
    """Points `(k, 3)` that were cut away: of the true ridges, or all vertices where these are not known."""
    view: tuple[float, float, float]
    paper: dict[str, float]
    """The paper's iterations and fidelity."""


def horseshoe(n: int = 88, across: int = 10, high: int = 8) -> holed_shapes.Solid:
    """A bar of rectangular section bent to a U: curved ridges, inside and outside of the bend."""
    vertices, faces = _bar(n, across, high)
    ridge = _bar_edges(4000)
    nowhere = np.zeros_like
    # Bending turns the bar inside out.
    return holed_shapes.Solid(_bent(vertices), faces[:, ::-1], _bent(ridge), nowhere, nowhere)


def _bar(n: int, across: int, high: int) -> shapes.Shape:
    """The surface of a box from (0, 0, 0) to (1, 1, 1) in so many squares a side, each two triangles."""
    counts = np.array((n, across, high))
    cells = []
    for axis in range(3):
        u, v = ((axis + 1) % 3, (axis + 2) % 3)
        i, j = np.meshgrid(np.arange(counts[u]), np.arange(counts[v]), indexing="ij")
        for end in (0, counts[axis]):
            corner = np.zeros((4, i.size, 3), int)
            corner[..., axis] = end
            for k, (a, b) in enumerate(((0, 0), (1, 0), (1, 1), (0, 1))):
                corner[k, :, u], corner[k, :, v] = i.ravel() + a, j.ravel() + b
            cells.append((corner if end else corner[::-1]).transpose(1, 0, 2))
    quads = np.concatenate(cells)
    places, index = np.unique(quads.reshape(-1, 3), axis=0, return_inverse=True)
    quads = index.reshape(-1, 4)
    return places / counts, np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])


def _bar_edges(n: int) -> Array:
    """Points along the four long edges of the bar."""
    at = np.linspace(0, 1, n)
    return np.concatenate([np.c_[at, np.full(n, y), np.full(n, z)] for y in (0.0, 1.0) for z in (0.0, 1.0)])


def _bent(points: Array) -> Array:
    """Straight legs of length 1.5, a half circle of middle radius 1, a section of 0.7 by 0.5."""
    leg, radius = 1.5, 1.0
    along = points[:, 0] * (2 * leg + np.pi * radius) - leg
    angle = np.clip(along / radius, 0.0, np.pi)
    straight = np.where(along < 0, along, np.where(along > np.pi * radius, along - np.pi * radius, 0.0))
    out = radius + 0.7 * (points[:, 1] - 0.5)
    x = out * np.cos(angle) - straight * np.sin(angle)
    y = out * np.sin(angle) + straight * np.cos(angle)
    return np.stack([x, y, 0.5 * (points[:, 2] - 0.5)], axis=1)


def curved_roof(n: int = 56) -> Open:
    """A tent over a square whose four sides are curved: two ridges that cross, an X, in a hole."""
    points, step = domains.irregular_points(n, seed=2), 1.0 / (n - 1)
    off = np.abs(np.abs(points[:, 0]) - np.abs(points[:, 1])) > 0.8 * step
    at = np.linspace(-0.5, 0.5, n)
    on = np.concatenate([np.column_stack([at, at]), np.column_stack([at, -at])[np.abs(at) > 0.1 * step]])
    plane, faces = domains.triangulated(np.concatenate([points[off], on]))
    vertices = _on_roof(2.0 * plane[:, :2])
    away = np.hypot(*(vertices[faces].mean(axis=1)[:, :2] - ROOF_HOLE[:2]).T)
    used, index = np.unique(faces[away > ROOF_HOLE[2]], return_inverse=True)
    along = np.linspace(-1.0, 1.0, 4000)
    ridge = np.concatenate([_on_roof(np.column_stack([along, sign * along])) for sign in (1, -1)])
    lost = ridge[np.hypot(*(ridge[:, :2] - ROOF_HOLE[:2]).T) < 0.9 * ROOF_HOLE[2]]
    return Open(vertices[used], index.reshape(-1, 3), lost, (0.5, -0.8, 0.9), _paper(80, 100.0))


def _on_roof(plane: Array) -> Array:
    """Points of the tent over points `(n, 2)` of the square [-1, 1]²."""
    farther = np.abs(plane).max(axis=1)
    return np.column_stack([plane, 1.0 - 0.4 * farther - 0.5 * farther**2])


def cases() -> dict[str, Open]:
    """The meshes of both figures."""
    cube = holed_shapes.cut(
        holed_shapes.irregular(holed_shapes.cube(16), 3), [((1.0, 0.1, 1.0), 0.55)], seed=5
    )
    turn = shapes.random_rotation(5)
    shoe = holed_shapes.cut(
        horseshoe(), [((0.0, 1.35, 0.25), 0.3), ((0.65, -0.7, 0.25), 0.3), ((-0.95, 0.95, 0.25), 0.25)]
    )
    vertices, faces = domains.source("bust")
    radius = 0.07 * np.ptp(vertices[:, 2])
    places = [(vertices[(vertices @ np.array(way)).argmax()], radius) for way in RIM_HOLES]
    removed = holed_shapes.removed_faces(vertices, faces, places)
    used, index = np.unique(faces[~removed], return_inverse=True)
    gone = np.setdiff1d(np.arange(len(vertices)), used)
    bust = Open(vertices[used], index.reshape(-1, 3), vertices[gone], (0.3, -1.0, 0.6), _paper(40, 1000.0))
    return {
        "cube": Open(
            cube.vertices, cube.faces, cube.ridge, tuple(turn @ (1.0, -0.55, 0.8)), _paper(100, 100.0)
        ),
        "horseshoe": Open(shoe.vertices, shoe.faces, shoe.ridge, (0.5, -0.6, 1.0), _paper(80, 100.0)),
        "bust": bust,
        "roof": curved_roof(),
    }


def _paper(iterations: int, fidelity: float) -> dict[str, float]:
    return {"iterations": iterations, "fidelity": fidelity}


def draw(folder: Path) -> dict[str, str]:
    """A row of pictures per mesh, and the distance of the true ridges to the fillings."""
    import pictures  # noqa: PLC0415

    from . import panels  # noqa: PLC0415

    row, rows = [], []
    for name, case in cases().items():
        mesh = ridgeform.Mesh(case.vertices, case.faces)
        look = {"view": case.view, "size": (300, 300), "frame": case.vertices}
        row.append(
            (f"{name}: {case.faces.shape[0]} faces", pictures.render(case.vertices, case.faces, **look))
        )
        distances = []
        for way, options in WAYS.items():
            paper = case.paper if way == "the paper's flow" else {}
            begin = time.perf_counter()
            filled = ridgeform.fill_holes(mesh, **(paper | options))
            seconds = time.perf_counter() - begin
            new = filled.patch >= 0
            color = np.where(new[:, None], PATCH, pictures.CLAY)
            row.append(
                (
                    way,
                    pictures.render(filled.vertices, filled.faces, color=color, **look),
                )
            )
            far = point_distances(case.lost, filled.vertices, filled.faces[new])
            distances.append(f"{far.mean():.4f}")
            print(f"   {name}, {way}: {distances[-1]} in {seconds:.1f} s, {filled!r}", flush=True)
        rows.append([name, *distances])
    panels.page(folder / "filled.png", row, 1 + len(WAYS))
    return {"filled": table(["mean distance to the patch", *WAYS], rows)}
