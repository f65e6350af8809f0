"""Figure 6: a function with ridges, known at scattered points, on a square and on a body in space."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import ridgeform
from numpy.typing import NDArray

from . import distances, domains, functions
from .measures import NAMES, bending_in_tenth, rms, table

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

SQUARE_SIDE = 64
KNOWN_IN_SQUARE = 40
KNOWN_ON_SPOT = 150
TURN = np.radians(33.0)


def farthest_points(vertices: Array, count: int, first: int = 0) -> Indices:
    """Indices of points each of which is as far as possible from those before it."""
    chosen = [first]
    distance = np.linalg.norm(vertices - vertices[first], axis=1)
    while len(chosen) < count:
        chosen.append(int(distance.argmax()))
        distance = np.minimum(distance, np.linalg.norm(vertices - vertices[chosen[-1]], axis=1))
    return np.array(chosen)


def turned(vertices: Array, angle: float) -> Array:
    """Vertices turned about z."""
    c, s = np.cos(angle), np.sin(angle)
    return vertices @ np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]).T


def change_by_turning(vertices: Array, faces: Indices, known: Indices, truth: Array, energy: str) -> float:
    """How much the result changes when the mesh is turned about z, relative to the spread of the truth."""
    here, there = (
        ridgeform.interpolate(
            ridgeform.Mesh(placed, faces), known, truth[known], energy=energy, tolerance=1e-4
        ).values
        for placed in (vertices, turned(vertices, TURN))
    )
    return rms(ridgeform.Mesh(vertices, faces), here - there) / float(truth.std())


def draw(folder: Path) -> dict[str, str]:
    """Two rows: truth, L2, L1 of Stein et al. 2018, ours."""
    from . import panels  # noqa: PLC0415

    square, square_faces = domains.irregular_square(SQUARE_SIDE, seed=3)
    spot, spot_faces = domains.source("spot")
    fronts = distances.surface_distance(spot, spot_faces, distances.nearest(spot, distances.SPOT_SOURCES))
    problems = {
        "square": (square, square_faces, functions.roof(square), KNOWN_IN_SQUARE),
        "Spot": (spot, spot_faces, fronts, KNOWN_ON_SPOT),
    }
    pictures: list[tuple[str, object]] = []
    rows = []
    for name, (vertices, faces, truth, count) in problems.items():
        mesh = ridgeform.Mesh(vertices, faces)
        known = farthest_points(vertices, count)
        levels = panels.even_levels(truth, 14)
        look: dict[str, object] = {"size": (300, 300), "margin": 0.03}
        draw_one = panels.flat
        if name == "Spot":
            draw_one, look = panels.painted, look | {"view": distances.SPOT_VIEW}
        pictures.append(
            (
                "truth and known points",
                draw_one(vertices, faces, truth, levels, known=vertices[known], **look),
            )
        )
        smooth = "l2_hessian" if name == "square" else "l2_curved_hessian"
        for energy in (smooth, "l1_hessian_stein2018", "l1_hessian"):
            solution = ridgeform.interpolate(mesh, known, truth[known], energy=energy)
            error = rms(mesh, solution.values - truth) / float(truth.std())
            pictures.append(
                (
                    f"{NAMES[energy]}: {error:.1%}",
                    draw_one(vertices, faces, solution.values, levels, known=vertices[known], **look),
                )
            )
            change = change_by_turning(vertices, faces, known, truth, energy)
            bent = bending_in_tenth(mesh, solution.values)
            rows.append([f"{name}, {NAMES[energy]}", f"{error:.1%}", f"{bent:.0%}", f"{change:.0e}"])
            rows[-1].append(f"{solution.gap:.1e}" if energy.startswith("l1") else "exact")
            print("   " + ", ".join(rows[-1]), flush=True)
    panels.page(folder / "scattered.png", pictures, 4)
    header = ["problem", "error", "bending in a tenth of the area", "change when turned by 33°", "gap"]
    return {"scattered": table(header, rows)}
