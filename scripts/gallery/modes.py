"""Figure 5: the lowest vibration modes of the L2 and of the L1 Hessian, on a square and on a catenoid."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import ridgeform
from numpy.typing import NDArray

from . import domains
from .measures import NAMES, bending_in_tenth, table

Array = NDArray[np.float64]

COUNT = 6
NOTHING = 1e-6
"""Energies below are zero but for rounding."""
ENERGIES = {
    "square": ("l2_hessian", "l1_hessian"),
    "catenoid": ("l2_hessian", "l1_hessian"),
}
SQUARE_SIDE = 56
CATENOID_AROUND = 96
TILTED = (0.4, -1.0, 0.5)


def signed(modes: Array) -> Array:
    """Each column with the sign that makes the value of greatest size positive: pictures do not flip."""
    peak = np.abs(modes).argmax(axis=0)
    return modes * np.sign(modes[peak, np.arange(modes.shape[1])])


def draw(folder: Path) -> dict[str, str]:
    """A row of modes per surface and energy."""
    from addon.blender import ramp  # noqa: PLC0415

    from . import panels  # noqa: PLC0415

    row: list[tuple[str, object]] = []
    rows = []
    surfaces = {
        "square": domains.irregular_square(SQUARE_SIDE, seed=2),
        "catenoid": domains.catenoid(CATENOID_AROUND, seed=2, height=1.2),
    }
    for name, (vertices, faces) in surfaces.items():
        mesh = ridgeform.Mesh(vertices, faces)
        for energy in ENERGIES[name]:
            modes = signed(ridgeform.vibration_modes(mesh, COUNT, energy=energy))
            costs = [ridgeform.energy(mesh, mode, kind=energy) for mode in modes.T]
            print(f"   {name}, {energy}: " + ", ".join(f"{cost:.3g}" for cost in costs), flush=True)
            for k, mode in enumerate(modes.T):
                reach = float(np.abs(mode).max())
                levels = np.linspace(-1, 1, 16)[1:-1] * reach
                look = {"size": (172, 160), "margin": 0.04, "colors": ramp.DIVERGING}
                if name == "square":
                    picture = panels.flat(vertices, faces, mode, levels, **look)
                else:
                    picture = panels.painted(vertices, faces, mode, levels, view=TILTED, **look)
                cost = costs[k] if costs[k] > NOTHING else 0.0
                norm = "L1" if energy == "l1_hessian" else "L2"
                row.append((f"{norm}, mode {k}: {cost:.3g}", picture))
            bent = [
                f"{bending_in_tenth(mesh, mode):.0%}" if cost > NOTHING else "none"
                for mode, cost in zip(modes.T, costs, strict=True)
            ]
            rows.append([f"{name}, {NAMES[energy]}", *bent])
    panels.page(folder / "modes.png", row, COUNT, shades=32)
    return {"modes": table(["bending in a tenth of the area", *(f"mode {k}" for k in range(COUNT))], rows)}
