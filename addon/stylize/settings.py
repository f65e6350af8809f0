# SPDX-License-Identifier: GPL-3.0-or-later
"""The settings of stylize, and how a modeler's sliders become the paper's numbers."""

from types import SimpleNamespace
from typing import ClassVar

import numpy as np

from ..framework import shared_settings as shared
from ..framework.settings import (
    Range,
    Settings,
    angle,
    boolean,
    choice,
    chosen,
    defaults_of,
    factor,
    integer,
    items,
    number,
    vertex_group,
)

WHERE = "Where"
FINISH_OPTIONS = "Finish Options"


def movement_of(strength: float) -> float:
    """How far a surface of unit area may move at most, root mean square, at a strength from 0 to 1.

    Chosen from sheets of pictures of twelve meshes: at 0.5 (0.7 %) hands keep their fingers and figures their
    ears. The range is a factor of 63.
    """
    return 0.007 * 10.0 ** (1.8 * (strength - 0.5))


def flat_share_of(strength: float) -> float:
    """The part of the surface that a strength from 0 to 1 makes flat, unless that moves it too far.

    From the same sheets: at 0.5 (a half) a bust keeps nose and chin, a bunny its muzzle. At two
    thirds the face of the bust is gone.
    """
    return min(0.15 + 0.7 * strength, 1.0)


def first_fidelity_of(strength: float) -> float:
    """The fidelity weight η of eq. (24), on a surface of unit area, of the first step at a strength.

    Small enough that, on the same meshes, the first step makes less flat than is asked for. Three to nine
    steps lead there.
    """
    return 10.0 ** (8.55 - 4.0 * strength)


FINISHES = items(
    KEEP=("Keep Mesh", "Keep vertices and faces, and move the vertices only"),
    FACETS=(
        "Make one flat polygon of each facet, with straight ridges between them. For meshes without "
        "shape keys, in Object Mode"
    ),
    LOW_POLY=(
        "Simplify the result: flat facets need few triangles. Quads and n-gons become triangles. "
        "For meshes without shape keys, in Object Mode"
    ),
)
PLACES = items(
    POSITIONS=("Mesh", "Move the vertices, or the active shape key if there is one"),
    SHAPE_KEY=("New Shape Key", "Leave the mesh as it is and put the result into a new shape key"),
    ATTRIBUTE=(
        "Attribute and Modifier",
        "Leave the mesh as it is, put the result into an attribute, and add a modifier that blends "
        "the mesh with it by a factor or a mask",
    ),
)
UNITS = items(
    max_edge=("Longest Edge", "The unit of the paper"),
    bounding_box="The longest side of the bounding box: independent of the density of the mesh",
    area=(
        "The square root of the surface area: independent of the density of the mesh and of how the "
        "object is turned"
    ),
)


class StylizeSettings(Settings):
    """The settings of stylize."""

    former: ClassVar = {
        "reduce": {True: {"finish": "LOW_POLY", "reduce_ratio": 0.25}, False: {"finish": "KEEP"}}
    }
    finish: choice("Finish", "What the result is made of", FINISHES, default="KEEP")
    reduce_ratio: factor(
        "Ratio",
        "Ratio of triangles to keep",
        default=0.12,
        min=0.001,
        soft_min=0.02,
        shown=lambda settings: settings.finish == "LOW_POLY",
        flag="--reduce",
        metavar="RATIO",
        implies={"finish": "LOW_POLY"},
    )
    facets: integer(
        "Facets",
        "Number of facets",
        Range(100, min=0, max=1_000_000, soft_min=4, soft_max=500),
        shown=lambda settings: settings.finish == "FACETS",
        implies={"finish": "FACETS"},
        otherwise="there are as many as the flow has made flat",
    )
    steps: integer(
        "Steps",
        "Maximum number of flattening steps. Fewer are done when the facets have settled, or when Strength "
        "is reached",
        Range(20, min=1, max=1000, soft_max=60),
    )
    strength: shared.strength(
        "How much of the surface becomes flat, and how far it may move for that: 0 keeps every detail, 1 "
        "leaves only the main planes"
    )
    sharpness: factor(
        "Sharpness",
        "How angular the result is: 0 gives soft, rounded transitions, 1 the hardest ridges",
        default=0.75,
    )
    strength_group: vertex_group(
        "Mask",
        "Vertex group that determines where to stylize, and how strongly. Vertices outside of it do not move",
        section=WHERE,
    )
    ridge_group: shared.RIDGE_GROUP.but(section=WHERE)
    avoid_ridges: shared.AVOID_RIDGES.but(section=WHERE)
    output: choice(
        "Result",
        "Where to put the result",
        PLACES,
        default="POSITIONS",
        section=WHERE,
        flag=None,
        switches={"--shape-key": "SHAPE_KEY", "--blend": "ATTRIBUTE"},
    )
    keep_volume: boolean(
        "Keep Volume",
        "Scale the result so that it encloses the same volume as before. For closed meshes in Object Mode",
        section=FINISH_OPTIONS,
    )
    marks: shared.MARKS.but(section=FINISH_OPTIONS, default={"SHARP"})
    mark_angle: angle(
        "Ridge Angle",
        "Minimum angle between the two faces of an edge for it to be marked as a ridge",
        Range(np.radians(20.0), min=0.0, max=np.pi),
        section=FINISH_OPTIONS,
        active=lambda settings: bool(settings.marks),
        otherwise="it is the angle that separates the edges inside facets from the ridges of this shape",
    )
    use_fidelity: shared.USE_FIDELITY
    fidelity: shared.fidelity(
        "Fidelity weight η of the flow (Rowe et al. 2024, eq. 24): larger values stay closer to the surface",
        default=500.0,
        soft_max=1e8,
    )
    scale: choice(
        "Unit",
        "Length in which the fidelity weight is measured",
        UNITS,
        default="max_edge",
        section=shared.EXPERT,
        active=shared.uses_fidelity,
    )
    coupling: shared.COUPLING
    dual: shared.DUAL
    delaunay: shared.DELAUNAY
    coarse_to_fine: shared.COARSE_TO_FINE.but(
        description="On large meshes, let the facets form on a simplified mesh first, and do only the last "
        "steps on the mesh itself. The result is the same at any density",
        active=lambda settings: not settings.use_fidelity,
    )
    solver: shared.SOLVER
    tolerance: number(
        "Tolerance",
        "Certified relative duality gap that each step must reach",
        Range(1e-3, min=0.0, max=1.0, precision=6),
        section=shared.EXPERT,
        otherwise="a step ends when nothing visible changes",
        used=True,
    )
    max_iterations: shared.MAX_ITERATIONS


PRESETS = {
    "Facets": {"steps": 20, "strength": 0.5, "sharpness": 0.75},
    "Gemstone": {"steps": 30, "strength": 0.7, "sharpness": 1.0},
    "Soft Planes": {"steps": 12, "strength": 0.4, "sharpness": 0.25},
    "Paper 2024": {
        "sharpness": 0.0,
        "use_fidelity": True,
        "fidelity": 500.0,
        "scale": "max_edge",
        "coupling": "separate",
    },
}
"""Shipped presets: clear facets; few and hard ones; broad and soft planes; the flow as published."""


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
        "fidelity": settings.fidelity if paper else first_fidelity_of(settings.strength),
        "movement": None if paper else movement_of(settings.strength),
        "flat_share": None if paper else flat_share_of(settings.strength),
        "scale": settings.scale if paper else "area",
        "sharpness": settings.sharpness,
        "coupling": settings.coupling,
        "dual": settings.dual,
        "delaunay": settings.delaunay,
        "coarse_to_fine": None if settings.coarse_to_fine else False,
        "solver": settings.solver,
        "tolerance": chosen(settings, "tolerance"),
        "max_iterations": chosen(settings, "max_iterations"),
    }
