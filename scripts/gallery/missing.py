"""Figure 12: a function with ridges, unknown in disks, filled in with every energy."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import ridgeform
from numpy.typing import NDArray

from . import domains, functions
from .measures import NAMES, rms, table

Array = NDArray[np.float64]

SIDE = 72
HOLES = ((-0.22, 0.30, 0.13), (0.07, -0.16, 0.16), (0.26, 0.22, 0.13), (-0.30, -0.22, 0.1))
"""Center and radius of the disks in which nothing is known: on two ridges and on two slopes."""
ENERGIES = ("l2_hessian", "l2_laplacian", "l1_edge_laplacian", "l1_hessian_stein2018", "l1_hessian")
SHARPNESS = 1.0


def unknown(vertices: Array) -> NDArray[np.bool_]:
    """The vertices in the holes."""
    return np.any([np.hypot(vertices[:, 0] - x, vertices[:, 1] - y) < r for x, y, r in HOLES], axis=0)


def draw(folder: Path) -> dict[str, str]:
    """Truth with the holes, and each energy's filling."""
    from . import panels  # noqa: PLC0415

    vertices, faces = domains.irregular_square(SIDE, seed=5)
    mesh, truth = ridgeform.Mesh(vertices, faces), functions.roof(vertices)
    missing = unknown(vertices)
    known = np.flatnonzero(~missing)
    hole = missing[faces].any(axis=1)
    levels = panels.even_levels(truth, 20)
    look = {"size": (300, 300), "margin": 0.03, "hole": hole}
    pictures = [("truth; unknown in red", panels.flat(vertices, faces, truth, levels, **look))]
    rows = []
    solutions = {NAMES[energy]: (energy, 0.0) for energy in ENERGIES}
    solutions[f"ours, sharpness {SHARPNESS:g}"] = ("l1_hessian", SHARPNESS)
    for words, (energy, sharpness) in solutions.items():
        solution = ridgeform.interpolate(mesh, known, truth[known], energy=energy, sharpness=sharpness)
        difference = solution.values - truth
        error = rms(mesh, difference, missing) / float(truth.std())
        worst = float(np.abs(difference).max()) / float(truth.std())
        pictures.append(
            (f"{words}: {error:.2%}", panels.flat(vertices, faces, solution.values, levels, **look))
        )
        rows.append([words, f"{error:.2%}", f"{worst:.1%}", f"{solution.gap:.0e}"])
        print("   " + ", ".join(rows[-1]), flush=True)
    panels.page(folder / "missing.png", pictures, 4)
    return {"missing": table(["energy", "error in the holes", "greatest error", "gap"], rows)}
