"""Figure 11: scattered data on meshes of slivers, without and with intrinsic Delaunay flips."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import ridgeform

from . import domains, functions
from .measures import rms, table
from .scattered import farthest_points

SIDE = 48
STRETCH = 8.0
KNOWN = 40
INSET = (0.0, 0.1, 0.12)
"""Center and half the side of the part of the square of which the edges are drawn."""
TILTED = (0.45, -1.0, 0.8)


def draw(folder: Path) -> dict[str, str]:
    """A row for the flat mesh and one for the rolled one: mesh, truth, without and with flips."""
    from . import panels  # noqa: PLC0415

    square, faces = domains.stretched_square(SIDE, STRETCH, seed=6)
    truth = functions.roof(square)
    known = farthest_points(square, KNOWN)
    levels = panels.even_levels(truth, 14)
    pictures: list[tuple[str, object]] = []
    rows = []
    for name, vertices in {"square": square, "half a tube": domains.rolled(square)}.items():
        mesh = ridgeform.Mesh(vertices, faces)
        look: dict[str, object] = {"size": (300, 270), "margin": 0.03}
        look |= {"lit": False, **panels.FROM_ABOVE} if name == "square" else {"view": TILTED}
        part = vertices[np.abs(square[:, :2] - INSET[:2]).max(axis=1) < INSET[2]]
        picture = panels.wireframe(vertices, faces, **(look | {"frame": part}))
        pictures.append((f"part of the mesh of {len(vertices)} vertices", picture))
        look["known"] = vertices[known]
        pictures.append(("truth and known points", panels.painted(vertices, faces, truth, levels, **look)))
        for delaunay in (False, True):
            solution = ridgeform.interpolate(mesh, known, truth[known], delaunay=delaunay)
            error = rms(mesh, solution.values - truth) / float(truth.std())
            words = "with flips" if delaunay else "without flips"
            drawn_faces = ridgeform.intrinsic_delaunay(mesh).faces if delaunay else faces
            picture = panels.painted(vertices, drawn_faces, solution.values, levels, **look)
            pictures.append((f"{words}: {error:.1%}", picture))
            rows.append([name, words, f"{error:.1%}", f"{solution.gap:.0e}", str(solution.iterations)])
            print("   " + ", ".join(rows[-1]), flush=True)
    panels.page(folder / "slivers.png", pictures, 4, shades=32)
    return {"slivers": table(["mesh", "intrinsic Delaunay", "error", "gap", "iterations"], rows)}
