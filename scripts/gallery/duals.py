"""Figure 9: barycenters against circumcenters, where circumcenters fail and where they do well."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import ridgeform
from known_shapes import shapes
from numpy.typing import NDArray

from . import domains, functions
from .measures import rms, table
from .scattered import farthest_points

Array = NDArray[np.float64]

KNOWN = 40
GOOD_JITTER = 0.12
"""Of the lattice step: irregular, yet all but a few triangles acute."""
DUALS = ("circumcentric", "circumcentric_or_barycentric", "barycentric")


def meshes() -> dict[str, tuple[Array, NDArray[np.int64]]]:
    """Squares cut along a diagonal (circumcenters coincide), and slightly irregular acute triangles."""
    grid, grid_faces = shapes.grid(56, 56)
    return {
        "squares with diagonals": (grid / 56 - [0.5, 0.5, 0.0], grid_faces),
        "good triangles": domains.irregular_square(57, seed=7, jitter=GOOD_JITTER),
    }


def draw(folder: Path) -> dict[str, str]:
    """Truth and one picture per dual; a gap where the circumcentric one is refused."""
    from . import panels  # noqa: PLC0415

    pictures: list[tuple[str, object]] = []
    rows = []
    for name, (vertices, faces) in meshes().items():
        mesh, truth = ridgeform.Mesh(vertices, faces), functions.roof(vertices)
        known = farthest_points(vertices, KNOWN)
        levels = panels.even_levels(truth, 14)
        look = {"size": (300, 300), "margin": 0.03, "known": vertices[known]}
        pictures.append((name, panels.flat(vertices, faces, truth, levels, **look)))
        for dual in DUALS:
            words = dual.replace("_", " ")
            try:
                solution = ridgeform.interpolate(mesh, known, truth[known], dual=dual)
            except ridgeform.RidgeformError as refusal:
                print(f"   {name}, {dual}: {refusal}", flush=True)
                pictures.append((f"{words}: refused", None))
                rows.append([name, words, "refused", ""])
                continue
            error = rms(mesh, solution.values - truth) / float(truth.std())
            pictures.append(
                (f"{words}: {error:.1%}", panels.flat(vertices, faces, solution.values, levels, **look))
            )
            rows.append([name, words, f"{error:.2%}", f"{solution.gap:.0e}"])
            print("   " + ", ".join(rows[-1]), flush=True)
    panels.page(folder / "duals.png", pictures, 4)
    return {"duals": table(["mesh", "dual", "error", "gap"], rows)}
