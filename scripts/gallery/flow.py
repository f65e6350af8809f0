"""Figures 4 and 14: shapes become flat in pieces, and their curvature gathers on ridges."""

from __future__ import annotations

import time
from pathlib import Path

import numpy as np
import ridgeform
from numpy.typing import NDArray

from . import domains, ways
from .measures import face_areas, share_in_tenth, table

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

STEPS = {"spot": (40, 50.0), "bust": (40, 500.0)}
"""Steps and fidelity: the paper's for its koala. Spot has shorter edges, whose longest is the unit of the
fidelity: a tenth of it."""
FACETS = 100
SIZES = {1250.0: 25, 500.0: 10, 50.0: 1}
"""Fidelities of figure 14 and how many steps take the same time of the flow with each."""
VIEWS = {"spot": (1.0, -0.6, 0.4), "bust": (0.5, -1.0, 0.2)}


def angle_defects(vertices: Array, faces: Indices) -> Array:
    """2 π less the angles around each vertex `(n,)`: the integral of the Gaussian curvature there."""
    defect = np.full(len(vertices), 2 * np.pi)
    for i in range(3):
        a, b, c = (vertices[faces[:, (i + k) % 3]] for k in range(3))
        u, v = b - a, c - a
        angle = np.arctan2(np.linalg.norm(np.cross(u, v), axis=1), (u * v).sum(axis=1))
        np.subtract.at(defect, faces[:, i], angle)
    return defect


def curvature(vertices: Array, faces: Indices) -> Array:
    """The absolute Gaussian curvature over each face `(m,)`, of what its corners have a part each."""
    corners = np.bincount(faces.ravel(), minlength=len(vertices))
    return (np.abs(angle_defects(vertices, faces)) / corners)[faces].sum(axis=1)


def bending(vertices: Array, faces: Indices) -> Array:
    """The norm of the Hessian of the positions on each face `(m,)`."""
    return ridgeform.hessian_norm(ridgeform.Mesh(vertices, faces), vertices)


def energy(vertices: Array, faces: Indices) -> float:
    """The L1 Hessian energy of the positions."""
    return float((bending(vertices, faces) * face_areas(vertices, faces)).sum())


def draw(folder: Path) -> dict[str, str]:
    """The flow in the paper's way and in ours, with the curvature below; and its step sizes."""
    from . import panels  # noqa: PLC0415

    rows, row = [], []
    for name, flow in STEPS.items():
        shape = domains.source(name)
        made = {
            name: shape,
            "the paper's flow": ways.of_paper(shape, *flow),
            "with sharpness": ways.with_sharpness(shape, *flow),
        }
        facets = ways.in_facets(shape, FACETS)
        look = {"view": VIEWS[name], "size": (300, 300), "frame": shape[0]}
        row += [(way, panels.shaded(*found, **look)) for way, found in made.items()]
        row.append((f"{FACETS} facets", panels.shaded(*facets, **look)))
        high = float(np.quantile(curvature(*shape) / face_areas(*shape), 0.95))
        for found in made.values():
            density = curvature(*found) / np.maximum(face_areas(*found), 1e-12)
            row.append(("", panels.colored(*found, density / high, **look)))
        row.append(("", None))
        for way, found in made.items():
            share = share_in_tenth(curvature(*found), face_areas(*found))
            rows.append([name, way if way != name else "as it came", f"{energy(*found):.2f}", f"{share:.2f}"])
    panels.page(folder / "flow.png", row, 4)
    return {
        "flow": table(["shape", "made by", "energy", "curvature in a tenth"], rows),
        "steps": _step_sizes(folder),
    }


def _step_sizes(folder: Path) -> str:
    from . import panels  # noqa: PLC0415

    shape = domains.source("bust")
    look = {"view": VIEWS["bust"], "size": (300, 300), "frame": shape[0]}
    high = float(np.quantile(bending(*shape), 0.9))
    rows, row = [], []
    for way, make in {"the paper's flow": ways.of_paper, "with sharpness": ways.with_sharpness}.items():
        for fidelity, steps in SIZES.items():
            begin = time.perf_counter()
            found = make(shape, steps, fidelity)
            seconds = time.perf_counter() - begin
            caption = f"{way}, {steps} steps at {fidelity:g}"
            row.append((caption, panels.colored(*found, bending(*found) / high, **look)))
            share = share_in_tenth(bending(*found) * face_areas(*found), face_areas(*found))
            rows.append([way, str(steps), f"{fidelity:g}", f"{energy(*found):.2f}", f"{share:.2f}"])
            print(f"   {caption}: {seconds:.1f} s", flush=True)
    panels.page(folder / "step_sizes.png", row, len(SIZES))
    return table(["way", "steps", "fidelity", "energy", "bending in a tenth"], rows)
