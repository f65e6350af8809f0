# SPDX-License-Identifier: GPL-3.0-or-later
"""The settings of Fill Holes."""

import numpy as np

from ..framework import shared_settings as shared
from ..framework.settings import Range, Settings, boolean, choice, chosen, distance, factor, integer, items

SHAPES = items(
    AUTO=(
        "Automatic",
        "Flat where the mesh stands steeply around a planar rim, as at a missing side of a box or at "
        "the cut end of a tube, ridges where some end at the hole, and smooth everywhere else",
    ),
    SHARP="Flat planes that meet in ridges",
    SMOOTH="No ridges",
    # Last: files store the place of a choice among the others.
    FLAT="In the plane of the rim",
)
MATERIALS = items(
    CONTINUE=(
        "Continue the materials around the hole. Where two of them meet, the border runs along a "
        "ridge of the patch if possible"
    ),
    MAJORITY=("One", "Use the most common material around the hole"),
)


class HoleSettings(Settings):
    """The settings of Fill Holes."""

    max_edges: integer(
        "Maximum Edges",
        "Maximum number of edges around a hole for it to be filled",
        Range(100, min=0, soft_min=3),
        otherwise="holes of any size are filled",
    )
    outer: boolean(
        "Outer Border",
        "Fill the outer border of an open sheet as well. In Edit Mode, a border selected alone is always "
        "filled",
    )
    shape: choice("Shape", "What the patch looks like", SHAPES, default="AUTO")
    sharpness: factor(
        "Sharpness",
        "How angular a sharp patch is: 0 is the flow of the paper, without ridges drawn through the mesh, 1 "
        "gives the hardest ridges",
        default=0.5,
        active=lambda settings: settings.shape == "SHARP",
    )
    edge_length: distance(
        "Edge Length",
        "Length of the edges in the patch, in the units of the object",
        Range(0.1, min=0.0, precision=4),
        otherwise="it is that of the edges around the hole",
        metavar="LENGTH",
    )
    material: choice(
        "Material",
        "Material of the patch",
        MATERIALS,
        default="CONTINUE",
        flag=None,
        switches={"--one-material": "MAJORITY"},
    )
    marks: shared.MARKS.but(
        description="Mark the ridges of the patch. Marks that end at the hole always continue along them"
    )
    iterations: integer(
        "Steps",
        "Maximum number of flow steps",
        Range(50, min=1, soft_max=200),
        section=shared.EXPERT,
        metavar="STEPS",
    )
    fidelity: shared.fidelity(
        "Fidelity weight η of the flow (Rowe et al. 2024, eq. 24): larger values stay closer to the smooth "
        "patch that it starts from",
        default=50.0,
        switched=False,
    )
    coupling: shared.COUPLING.but(description="How the coordinates share ridges")


PRESETS = {
    "Automatic": {
        "shape": "AUTO",
        "sharpness": 0.5,
        "use_edge_length": False,
        "material": "CONTINUE",
        "marks": set(),
        "iterations": 50,
        "fidelity": 50.0,
        "coupling": "joint",
    },
    "Hard Ridges": {"shape": "SHARP", "sharpness": 1.0, "marks": {"SHARP"}},
    "Smooth": {"shape": "SMOOTH"},
}
"""Shipped presets: the defaults; planes and the hardest ridges, marked sharp; no ridges."""


def hole_options(settings: object) -> dict[str, object]:
    """The arguments of `ridgeform.fill_holes` that the settings stand for, the same for every mesh."""
    return {
        "edge_length": chosen(settings, "edge_length"),
        "iterations": settings.iterations,
        "fidelity": settings.fidelity,
        "shape": settings.shape.lower(),
        "sharpness": settings.sharpness if settings.shape == "SHARP" else "auto",
        "coupling": settings.coupling,
    }


def ridge_mask(edges: np.ndarray, ridges: np.ndarray, n_vertices: int) -> np.ndarray:
    """Which edges (k, 2) are among the ridges (r, 2): (k,) bool."""
    keys = (np.sort(rows, axis=1).astype(np.int64) @ (n_vertices, 1) for rows in (edges, ridges))
    return np.isin(*keys)
