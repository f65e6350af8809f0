"""Figure 7: noise on functions on a surface, taken away with every energy at its best fidelity."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import ridgeform
from numpy.typing import NDArray
from ridgeform import Solution

from . import distances, domains
from .measures import NAMES, bending_in_tenth, best_fit, rms, table

Array = NDArray[np.float64]
Pixels = NDArray[np.uint8]

NOISE = 0.25
"""Standard deviation of the noise, as a share of that of the truth."""
CHOICES = {
    NAMES["l2_curved_hessian"]: ("l2_curved_hessian", 0.0),
    NAMES["l1_hessian_stein2018"]: ("l1_hessian_stein2018", 0.0),
    NAMES["l1_edge_laplacian"]: ("l1_edge_laplacian", 0.0),
    NAMES["l1_hessian"]: ("l1_hessian", 0.0),
    "ours, sharpness 0.5": ("l1_hessian", 0.5),
}
SHOWN_FROM = 1.08
"""Height from which the bust is shown: its crown, where three fronts meet."""


def draw(folder: Path) -> dict[str, str]:
    """Truth and noise, L2, L1 of Stein et al. 2018, ours without and with sharpness."""
    from . import panels  # noqa: PLC0415

    vertices, faces = domains.source("bust")
    mesh, truth = (
        ridgeform.Mesh(vertices, faces),
        distances.surface_distance(vertices, faces, distances.nearest(vertices, distances.BUST_SOURCES)),
    )
    noisy = truth + np.random.default_rng(4).normal(scale=NOISE * truth.std(), size=len(truth))
    noise = rms(mesh, noisy - truth)
    levels = panels.even_levels(truth, 14)
    look = {"view": distances.BUST_VIEW, "size": (296, 246), "margin": 0.02}
    look["frame"] = vertices[vertices[:, 2] > SHOWN_FROM]

    def shown(values: Array) -> Pixels:
        return panels.painted(vertices, faces, values, levels, **look)

    pictures = [("truth", shown(truth)), ("noise", shown(noisy))]
    rows = []
    for words, (energy, sharpness) in CHOICES.items():

        def denoised(fidelity: float, energy: str = energy, sharpness: float = sharpness) -> Solution:
            return ridgeform.denoise(mesh, noisy, fidelity=fidelity, energy=energy, sharpness=sharpness)

        fit = best_fit(denoised, lambda values: rms(mesh, values - truth) / noise, energy)
        values = fit.solution.values
        if energy != "l1_edge_laplacian":
            pictures.append((f"{words}: {fit.error:.1%}", shown(values)))
        rows.append(
            [words, f"{fit.error:.1%}", f"{fit.fidelity:.3g}", f"{bending_in_tenth(mesh, values):.0%}"]
        )
        print("   " + ", ".join(rows[-1]), flush=True)
    panels.page(folder / "surfaces.png", pictures, 3, shades=32)
    return {"surfaces": table(["energy", "noise left", "fidelity", "bending in a tenth of the area"], rows)}
