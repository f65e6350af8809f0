# SPDX-License-Identifier: GPL-3.0-or-later
"""The settings of stylize, and how a modeler's sliders become the paper's numbers."""

from types import SimpleNamespace

import numpy as np
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, StringProperty

from ..framework.shared_settings import RidgeSettings, SolverSettings, defaults_of


def fidelity_of(strength: float) -> float:
    """The fidelity weight η of eq. (24), on a surface of unit area, that a strength from 0 to 1 stands for.

    Chosen from a sheet of pictures of thirteen meshes: at 0.35 a bust keeps eyes and lips, at 0.5 nose, brows
    and chin, and figures their fingers and ears; from 0.65 on such features go.
    """
    return 10.0 ** (9.25 - 4.0 * strength)


class StylizeSettings(RidgeSettings, SolverSettings):
    """The settings of stylize, shared by the operator, the sidebar panel, presets and the batch command."""

    steps: IntProperty(
        name="Steps",
        description="How often the flattening step is repeated. More steps give larger and flatter facets",
        default=20,
        min=1,
        max=1000,
        soft_max=60,
    )
    strength: FloatProperty(
        name="Strength",
        description="How far each step may move the surface: 0 keeps every detail, 1 leaves only the main "
        "planes",
        default=0.5,
        min=0.0,
        max=1.5,
        soft_max=1.0,
        subtype="FACTOR",
    )
    sharpness: FloatProperty(
        name="Sharpness",
        description="How angular the result is: 0 gives soft, rounded transitions, 1 the hardest ridges",
        default=0.75,
        min=0.0,
        max=1.0,
        subtype="FACTOR",
    )
    strength_group: StringProperty(
        name="Mask",
        description="Vertex group that says where and how strongly to stylize. Vertices that are not in it "
        "stay where they are",
    )
    output: EnumProperty(
        name="Result",
        description="Where the result goes",
        items=(
            ("POSITIONS", "Mesh", "Move the vertices, or the active shape key if there is one"),
            ("SHAPE_KEY", "New Shape Key", "Leave the mesh as it is and put the result into a new shape key"),
        ),
        default="POSITIONS",
    )
    keep_volume: BoolProperty(
        name="Keep Volume",
        description="Scale the result so that it encloses as much as before. For closed meshes in Object "
        "Mode",
        default=False,
    )
    marks: EnumProperty(
        name="Mark Ridges",
        description="Mark the edges along the ridges. Marks that exist are kept",
        items=(
            ("SHARP", "Sharp", "Mark ridges as sharp edges"),
            ("CREASE", "Crease", "Give ridges a full subdivision crease"),
            ("BEVEL", "Bevel", "Give ridges a full bevel weight"),
        ),
        options={"ENUM_FLAG"},
        default=set(),
    )
    mark_angle: FloatProperty(
        name="Ridge Angle",
        description="Edges with at least this angle between their two faces are marked as ridges",
        default=np.radians(20.0),
        min=0.0,
        max=np.pi,
        subtype="ANGLE",
    )
    reduce: BoolProperty(
        name="Reduce Triangles",
        description="Simplify the result: flat facets need few triangles. Quads and n-gons become triangles",
        default=False,
    )
    reduce_ratio: FloatProperty(
        name="Ratio",
        description="The share of the triangles that is left",
        default=0.25,
        min=0.001,
        max=1.0,
        soft_min=0.02,
        subtype="FACTOR",
    )
    use_fidelity: BoolProperty(
        name="Set Fidelity",
        description="Set the fidelity weight of the paper instead of the strength",
        default=False,
    )
    fidelity: FloatProperty(
        name="Fidelity",
        description="Fidelity weight η of the flow (Rowe et al. 2024, eq. 24): larger stays closer to the "
        "surface",
        default=500.0,
        min=1e-6,
        max=1e12,
        soft_min=1.0,
        soft_max=1e8,
        precision=1,
    )
    scale: EnumProperty(
        name="Unit",
        description="The length that the fidelity weight is measured in",
        items=(
            ("max_edge", "Longest Edge", "The unit of the paper"),
            (
                "bounding_box",
                "Bounding Box",
                "The longest side of the bounding box: independent of the mesh's density",
            ),
            (
                "area",
                "Area",
                "The square root of the surface's area: independent of the mesh's density and of how it is "
                "turned",
            ),
        ),
        default="max_edge",
    )
    tolerance: FloatProperty(
        name="Tolerance",
        description="Certified relative duality gap that each step must reach. 0 stops as soon as nothing "
        "visible changes",
        default=0.0,
        min=0.0,
        max=1.0,
        precision=6,
    )


def default_settings(**changes: object) -> SimpleNamespace:
    """The settings of stylize as a plain object with Blender's defaults, for use without an operator.

    Raises `TypeError` for a name that is not a setting.
    """
    return defaults_of(StylizeSettings, **changes)


def stylize_options(settings: object) -> dict[str, object]:
    """The keyword arguments of `ridgeform.stylize` that the settings stand for, the same for every mesh."""
    paper = settings.use_fidelity
    return {
        "iterations": settings.steps,
        "fidelity": settings.fidelity if paper else fidelity_of(settings.strength),
        "scale": settings.scale if paper else "area",
        "sharpness": settings.sharpness,
        "coupling": settings.coupling,
        "dual": settings.dual,
        "delaunay": settings.delaunay,
        "solver": settings.solver,
        "tolerance": settings.tolerance or None,
        "max_iterations": settings.max_iterations or None,
    }
