"""Figure 10: one hole in a function, filled in at growing resolutions of half a tube and of a body."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import ridgeform
from numpy.typing import NDArray

from . import distances, domains, functions
from .measures import rms, table

Array = NDArray[np.float64]

LEVELS = 2
"""Midpoint subdivisions of the coarsest mesh."""
COARSEST = 20
"""Vertices along a side of the tube's coarsest mesh."""


@dataclass(frozen=True)
class Case:
    """A function on a family of meshes, unknown in a ball."""

    name: str
    meshes: list[domains.Shape]
    truths: list[Array]
    center: tuple[float, float, float]
    radius: float
    view: tuple[float, float, float]
    levels: int


def cases() -> list[Case]:
    """Half a tube, with the function of the flat square; and Spot, with fronts that meet."""
    flat = domains.refinements(domains.irregular_square(COARSEST, seed=8), LEVELS)
    tube = [(domains.rolled(vertices), faces) for vertices, faces in flat]
    spot = domains.refinements(domains.source("spot_low_resolution"), LEVELS)
    # Subdivision puts new vertices behind the old ones, so one function serves all.
    finest, finest_faces = spot[-1]
    sources = distances.nearest(finest, distances.SPOT_SOURCES)
    fronts = distances.surface_distance(finest, finest_faces, sources)
    return [
        Case(
            "half a tube",
            tube,
            [functions.roof(vertices) for vertices, _ in flat],
            (0.06, -0.14, 0.31),
            0.2,
            (0.15, -0.8, 1.0),
            14,
        ),
        Case(
            "Spot",
            spot,
            [fronts[: len(vertices)] for vertices, _ in spot],
            (-0.38, -0.3, 0.85),
            0.25,
            distances.SPOT_VIEW,
            12,
        ),
    ]


def draw(folder: Path) -> dict[str, str]:
    """A row for each case: the truth on the finest mesh with the hole, and ours on every mesh."""
    from . import panels  # noqa: PLC0415

    pictures, rows = [], []
    for case in cases():
        look = {"view": case.view, "size": (290, 280), "margin": 0.03}
        levels = panels.even_levels(case.truths[-1], case.levels)
        filled = []
        for (vertices, faces), truth in zip(case.meshes, case.truths, strict=True):
            mesh = ridgeform.Mesh(vertices, faces)
            missing = np.linalg.norm(vertices - case.center, axis=1) < case.radius
            known = np.flatnonzero(~missing)
            hole = missing[faces].any(axis=1)
            errors = {}
            for energy in ("l1_hessian", "l2_curved_hessian"):
                values = ridgeform.interpolate(mesh, known, truth[known], energy=energy).values
                errors[energy] = rms(mesh, values - truth, missing) / float(truth.std())
                if energy == "l1_hessian":
                    picture = panels.painted(vertices, faces, values, levels, hole=hole, **look)
                    filled.append((f"{len(vertices)} vertices: {errors[energy]:.1%}", picture))
            counts = [case.name, str(len(vertices)), str(int(missing.sum()))]
            rows.append([*counts, *(f"{error:.1%}" for error in errors.values())])
            print("   " + ", ".join(rows[-1]), flush=True)
        shown = panels.painted(vertices, faces, truth, levels, hole=hole, **look)
        pictures += [("truth; unknown in red", shown), *filled]
    panels.page(folder / "resolutions.png", pictures, 4)
    header = ["surface", "vertices", "unknown", "L1 Hessian (ours)", "L2 Hessian, curved"]
    return {"resolutions": table(header, rows)}
