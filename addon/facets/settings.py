# SPDX-License-Identifier: GPL-3.0-or-later
"""The settings of facets: how many, what they are made of, and where."""

from ..framework import shared_settings as shared
from ..framework.settings import Range, Settings, boolean, choice, integer, items, number, vertex_group

WHERE = "Where"


def by_count(settings: object) -> bool:
    """Whether the number of facets is chosen."""
    return settings.mode == "COUNT"


def by_error(settings: object) -> bool:
    """Whether the distance from the mesh is."""
    return settings.mode == "ERROR"


def keeps_faces(settings: object) -> bool:
    """Whether the mesh keeps its own."""
    return settings.topology == "KEPT"


def makes_faces(settings: object) -> bool:
    """Whether it gets others."""
    return not keeps_faces(settings)


def has_halves(settings: object) -> bool:
    """Whether the facets of one half are mirrored."""
    return makes_faces(settings) and settings.symmetric != "NONE"


def may_simplify(settings: object) -> bool:
    """Whether a simplified mesh can say where the facets of a large one are."""
    is_plain = makes_faces(settings) and not has_halves(settings) and not settings.keep_volume
    return is_plain and not (settings.ridge_group or settings.strength_group)


MODES = items(
    AUTO="As many as the shape gives evidence for",
    COUNT="As many as you choose",
    ERROR="As many as it takes to stay that close to the mesh",
)
TOPOLOGIES = items(
    POLYGONS="One flat n-gon for each facet; several where it has a hole",
    TRIANGLES="Triangles in the plane of each facet",
    QUADS="A quad for each facet with four corners, triangles for the others",
    KEPT="The vertices and faces that the mesh has, each on its facet: only where they are changes",
)


SYMMETRIES = items(
    NONE="Facets as the shape suggests on each side",
    AUTO="Across the first axis that the mesh is symmetric across",
    X="Across the X axis of the object",
    Y="Across the Y axis of the object",
    Z="Across the Z axis of the object",
)


class FacetSettings(Settings):
    """The settings of facets."""

    mode: choice(
        "Mode", "What determines how many facets there are", MODES, default="AUTO", expand=True, flag=None
    )
    facets: integer(
        "Facets",
        "Number of facets. A mesh is computed only once, then other numbers are quick",
        Range(60, min=1, max=1_000_000, soft_min=4, soft_max=500),
        shown=by_count,
        flag="--facets",
        implies={"mode": "COUNT"},
    )
    error: number(
        "Error",
        "Distance from the mesh that is allowed, root mean square, in percent of its size (the diagonal of "
        "its bounding box)",
        Range(0.5, min=0.0001, max=100.0, soft_min=0.05, soft_max=5.0, precision=2),
        subtype="PERCENTAGE",
        shown=by_error,
        flag="--error",
        metavar="PERCENT",
        implies={"mode": "ERROR"},
    )
    topology: choice("Topology", "What facets are made of", TOPOLOGIES, default="POLYGONS")
    shape_key: boolean(
        "Shape Key",
        "Store the result as a new shape key, without flipped edges and marks. A mesh with shape keys always "
        "gets one",
        shown=keeps_faces,
        flag="--shape-key",
    )
    symmetric: choice(
        "Symmetric",
        "Make facets of one half and mirror them. The mesh must be symmetric across the plane through its "
        "origin or its middle",
        SYMMETRIES,
        default="NONE",
        shown=makes_faces,
        flag="--symmetric",
    )
    keep_volume: boolean(
        "Keep Volume",
        "Move the facets so that they enclose the same volume as the mesh, which must be closed",
        flag="--keep-volume",
    )
    marks: shared.MARKS.but(
        default={"SHARP"},
        description="Mark the edges between facets; with Sharp, facets are shaded flat. Existing marks stay",
    )
    mark_seams: boolean("Seams", "Mark the edges between facets as seams for unwrapping", flag="--seams")
    strength_group: vertex_group(
        "Mask",
        "Vertex group that determines where to make facets. Faces with a vertex outside of it stay as they "
        "are",
        section=WHERE,
    )
    ridge_group: shared.RIDGE_GROUP.but(
        section=WHERE, description="Vertex group painted where ridges should run. Unpainted areas are neutral"
    )
    avoid_ridges: shared.AVOID_RIDGES.but(section=WHERE)
    coarse_to_fine: shared.COARSE_TO_FINE.but(
        description="Find the facets of a large mesh on a simplified one. Many times as fast, and as near. "
        "Not with Kept, Symmetric, Keep Volume, ridges, or a mask",
        active=may_simplify,
    )


PRESETS = {
    "Auto": {"mode": "AUTO", "facets": 60},
    "Low Poly": {"mode": "COUNT", "facets": 150},
    "Gemstone": {"mode": "COUNT", "facets": 30},
    "Close Fit": {"mode": "ERROR", "error": 0.1},
}
"""Shipped presets: what the shape suggests; a game prop; few and large; hardly to be told from the mesh."""
