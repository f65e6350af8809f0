# SPDX-License-Identifier: GPL-3.0-or-later
"""The settings of Fill Holes."""

import numpy as np
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty


class HoleSettings:
    """The settings of Fill Holes: for the operator, the sidebar panel, presets and the batch command."""

    max_edges: IntProperty(
        name="Largest Hole",
        description="Fill holes with at most this many edges around them. 0 fills holes of any size",
        default=0,
        min=0,
    )
    outer: BoolProperty(
        name="Outer Border",
        description="Fill the outer border of an open sheet as well. In Edit Mode one that alone is selected "
        "is filled in any case",
        default=False,
    )
    shape: EnumProperty(
        name="Shape",
        description="What the patch looks like",
        items=(
            (
                "AUTO",
                "Automatic",
                "Ridges where they end at the hole, smooth where the mesh around is smooth",
            ),
            ("SHARP", "Sharp", "Flat planes that meet in ridges"),
            ("SMOOTH", "Smooth", "No ridges"),
        ),
        default="AUTO",
    )
    sharpness: FloatProperty(
        name="Sharpness",
        description="How angular a sharp patch is: 0 is the flow of the paper, without ridges drawn through "
        "the mesh, 1 gives the hardest ridges",
        default=0.5,
        min=0.0,
        max=1.0,
        subtype="FACTOR",
    )
    edge_length: FloatProperty(
        name="Edge Length",
        description="Length of the edges in the patch, in the object's own units. 0 takes that of the edges "
        "around the hole",
        default=0.0,
        min=0.0,
        subtype="DISTANCE",
        precision=4,
    )
    material: EnumProperty(
        name="Material",
        description="The material of the patch",
        items=(
            (
                "CONTINUE",
                "Continue",
                "The materials around the hole go on: where two of them meet, the border runs along a "
                "ridge of the patch if it can",
            ),
            ("MAJORITY", "One", "The material that most of the hole's border has"),
        ),
        default="CONTINUE",
    )
    marks: EnumProperty(
        name="Mark Ridges",
        description="Mark the ridges of the patch. Marks that end at the hole go on along its ridges in any "
        "case",
        items=(
            ("SHARP", "Sharp", "Mark ridges as sharp edges"),
            ("CREASE", "Crease", "Give ridges a full subdivision crease"),
            ("BEVEL", "Bevel", "Give ridges a full bevel weight"),
        ),
        options={"ENUM_FLAG"},
        default=set(),
    )
    iterations: IntProperty(
        name="Steps",
        description="The most flow steps",
        default=50,
        min=1,
        soft_max=200,
    )
    fidelity: FloatProperty(
        name="Fidelity",
        description="Fidelity weight η of the flow (Rowe et al. 2024, eq. 24): larger stays closer to the "
        "smooth patch that it starts from",
        default=50.0,
        min=1e-6,
        max=1e12,
        soft_min=1.0,
        soft_max=1e6,
        precision=1,
    )
    coupling: EnumProperty(
        name="Coupling",
        description="How the coordinates share ridges",
        items=(
            ("joint", "Joint", "One norm over all coordinates: the result does not depend on the axes"),
            ("separate", "Separate", "Each coordinate by itself, as in the paper"),
        ),
        default="joint",
    )


def hole_options(settings: object) -> dict[str, object]:
    """The arguments of `ridgeform.fill_holes` that the settings stand for, the same for every mesh."""
    return {
        "edge_length": settings.edge_length or None,
        # Without a step of the flow the smooth patch that it starts from is left.
        "iterations": 0 if settings.shape == "SMOOTH" else settings.iterations,
        "fidelity": settings.fidelity,
        "sharpness": {"AUTO": "auto", "SMOOTH": 0.0, "SHARP": settings.sharpness}[settings.shape],
        "coupling": settings.coupling,
    }


def ridge_mask(edges: np.ndarray, ridges: np.ndarray, n_vertices: int) -> np.ndarray:
    """Which edges (k, 2) are among the ridges (r, 2): (k,) bool."""
    keys = (np.sort(rows, axis=1).astype(np.int64) @ (n_vertices, 1) for rows in (edges, ridges))
    return np.isin(*keys)
