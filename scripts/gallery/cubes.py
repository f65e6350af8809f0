"""Figure 13: planes that follow the shape, beside cubic stylization, whose planes follow the axes."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from known_shapes import shapes
from numpy.typing import NDArray

from . import domains, ways
from .measures import table

Array = NDArray[np.float64]

STEPS = {"spot": (43, 50.0), "bust": (43, 500.0)}
"""Steps and fidelity: the paper's for its hand; as in `flow`, a tenth of the fidelity for Spot."""
CUBENESS = 0.2
"""MeshLab's default."""
FACETS = 100
VIEWS = {"spot": (1.0, -0.6, 0.4), "bust": (0.5, -1.0, 0.2)}
WAYS = {
    "cubic stylization": lambda shape, _: ways.in_cubes(shape, CUBENESS),
    "the paper's flow": lambda shape, flow: ways.of_paper(shape, *flow),
    "with sharpness": lambda shape, flow: ways.with_sharpness(shape, *flow),
}


def laid_onto(points: Array, others: Array) -> Array:
    """Points `(n, 3)` moved rigidly to where they are nearest to the others (Kabsch 1976)."""
    middle, other = points.mean(axis=0), others.mean(axis=0)
    u, _, vt = np.linalg.svd((points - middle).T @ (others - other))
    mirror = np.diag([1.0, 1.0, np.sign(np.linalg.det(u @ vt))])
    return (points - middle) @ (u @ mirror @ vt) + other


def draw(folder: Path) -> dict[str, str]:
    """Every shape as it stands, and turned before and back after."""
    from . import panels  # noqa: PLC0415

    rows, row = [], []
    turn = shapes.random_rotation(5)
    for name, view in VIEWS.items():
        vertices, faces = domains.source(name)
        look = {"view": view, "size": (240, 240), "frame": vertices}
        stands = {way: make((vertices, faces), STEPS[name])[0] for way, make in WAYS.items()}
        turned = {
            way: laid_onto(make((vertices @ turn.T, faces), STEPS[name])[0] @ turn, stands[way])
            for way, make in WAYS.items()
        }
        facets = ways.in_facets((vertices, faces), FACETS)
        row.append((name, panels.shaded(vertices, faces, **look)))
        row += [(way, panels.shaded(found, faces, **look)) for way, found in stands.items()]
        row.append((f"{FACETS} facets", panels.shaded(*facets, **look)))
        row.append(("turned before, back after", None))
        row += [("", panels.shaded(found, faces, **look)) for found in turned.values()]
        other = ways.in_facets((vertices @ turn.T, faces), FACETS)
        row.append(("", panels.shaded(other[0] @ turn, other[1], **look)))
        for way, found in stands.items():
            apart = shapes.root_mean_square(np.linalg.norm(found - turned[way], axis=1))
            moved = shapes.root_mean_square(np.linalg.norm(found - vertices, axis=1))
            rows.append([name, way, f"{moved / np.ptp(vertices, axis=0).max():.3f}", f"{apart / moved:.2g}"])
    panels.page(folder / "cubes.png", row, 2 + len(WAYS))
    return {"cubes": table(["shape", "made by", "moved", "turned: apart"], rows)}
