# SPDX-License-Identifier: GPL-3.0-or-later
"""The settings of segmenting: what is segmented, how finely, and what is made of the segments."""

from typing import ClassVar

import numpy as np

from ..blender.attribute_names import search_names
from ..framework import shared_settings as shared
from ..framework.settings import (
    Range,
    Setting,
    Settings,
    angle,
    boolean,
    choice,
    choices,
    chosen,
    data_name,
    distance,
    factor,
    integer,
    items,
    number,
)


def of_faces(settings: object) -> bool:
    """Whether segments are faces."""
    return settings.kind == "FACES"


def of_parts(settings: object) -> bool:
    """Whether segments are parts."""
    return settings.kind == "PARTS"


def by_count(settings: object) -> bool:
    """Whether the number of segments is chosen."""
    return settings.mode == "COUNT"


def by_angle(settings: object) -> bool:
    """Whether the angle between faces says how many segments there are."""
    return of_shape(settings) and not by_count(settings)


def by_weight(settings: object) -> bool:
    """Whether the weight of the paper says so: on an attribute, where there are no angles."""
    return of_faces(settings) and settings.source == "ATTRIBUTE" and not by_count(settings)


EXPERT_OF_FACES = {"section": shared.EXPERT, "shown": of_faces}
"""Where the numbers of the functional are, which only finds faces."""


def of_shape(settings: object) -> bool:
    """Whether segments are faces of a shape."""
    return of_faces(settings) and settings.source == "SHAPE"


def may_simplify(settings: object) -> bool:
    """Whether the segments of a large mesh may be found on a simplified one."""
    return of_shape(settings) and is_plain(settings)


def is_plain(settings: object) -> bool:
    """Whether segments are found as this project does, not as the paper."""
    return settings.method == "fitted" and not settings.use_fidelity


BEND = 0.8
"""The angle (radians) at which two faces of a shape become one segment is so many times the weight λ."""


def weight_of(angle: float) -> float:
    """The weight λ of the length of borders that an angle (radians) stands for."""
    # Blender's angles have single precision.
    return round(angle / BEND, 6)


def _width(name: str, description: str, *, default: float) -> Setting:
    """A width of the bands around borders."""
    values = Range(default, min=1e-5, max=10.0, precision=4)
    return number(name, description, values, **EXPERT_OF_FACES)


KINDS = items(
    FACES=(
        "What creases and steps enclose: sides, walls, and roofs. For buildings, machine parts, and furniture"
    ),
    PARTS=(
        "Limbs, heads, and handles, cut along short lines through hollows. For characters, animals, and "
        "everything that has limbs"
    ),
)
SOURCES = items(
    SHAPE="Parts that are nearly flat or evenly curved, with borders along the ridges",
    ATTRIBUTE="Parts on which an attribute, color, or vertex group is even or rises evenly",
)
FILLETS = items(
    automatic=(
        "Each is a segment, found by the planes, spheres, cylinders, cones, and tori that faces lie on. Free "
        "shapes, such as characters, are divided where they bend"
    ),
    apart="The same also where one smooth surface would do as well: free shapes may fall into patches",
    joined="Each belongs to the larger side beside it: a box with rounded or beveled edges has six sides",
)
MODES = items(
    AUTO=("Automatic", "As many as there are, given an angle, a weight, or a coarseness"),
    COUNT="As many as you choose",
)
OUTPUTS = items(
    MATERIALS=(
        "Material Slots",
        "A slot with a color of its own for each segment. Existing slots and materials stay, those "
        "of an earlier run are used again",
    ),
    SEAMS="Mark the borders as seams for unwrapping. Existing seams are kept",
    SHARP=("Sharp Edges", "Mark the borders as sharp edges. Existing marks are kept"),
    FACE_SETS="Make each segment a face set of Sculpt Mode",
    VERTEX_GROUPS="Make a vertex group of each segment, replacing those of an earlier run",
    INDICATOR=(
        'Store where the borders are, 0 on them and 1 inside segments, in the attribute "ridgeform_indicator"'
    ),
    SHARPENED=(
        "Sharpened Surface",
        "Keep what the borders were found on, flattened between them: a shape as a new shape key, an "
        "attribute as a new one",
    ),
    OBJECTS=("Separate Objects", "Make each segment an object of its own. Only in Object Mode"),
)
BORDERS = items(
    SHARP="Edges marked as sharp",
    SEAMS="Seams",
    MATERIALS="Edges between faces of different materials",
)
METHODS = items(
    fitted=(
        "Flooded between the borders, merged where little bends, faces at a border given to the side "
        "that they fit best"
    ),
    paper="Cut where the indicator is below the threshold (Rowe et al. 2024)",
)
UNITS = items(
    extent="The size of the shape, however it is turned: for a cube its side",
    bounding_box="The longest side of the bounding box",
    area="The square root of the surface area",
    max_edge=("Longest Edge", "The longest edge"),
)


class SegmentSettings(Settings):
    """The settings of segmenting."""

    former: ClassVar = {"use_count": {True: {"mode": "COUNT"}, False: {"mode": "AUTO"}}}
    follows: ClassVar = {"angle": ("length_weight", lambda weight: min(BEND * weight, np.pi))}
    kind: choice("Kind", "What counts as a segment", KINDS, default="FACES", expand=True)
    source: choice(
        "By", "What the segments are found on", SOURCES, default="SHAPE", flag=None, shown=of_faces
    )
    attribute: data_name(
        "Attribute",
        "Attribute or vertex group on which the segments are found. Empty: the active one",
        search=search_names,
        active=lambda settings: settings.source == "ATTRIBUTE",
        implies={"source": "ATTRIBUTE"},
        shown=of_faces,
    )
    mode: choice(
        "Mode", "What determines how many segments there are", MODES, default="AUTO", expand=True, flag=None
    )
    angle: angle(
        "Angle",
        "Two faces of a shape become one segment if they meet at an edge bent by less than about this "
        "angle. Larger angles give fewer segments",
        Range(
            BEND * 0.5, min=np.radians(0.005), max=np.pi, soft_min=np.radians(2.0), soft_max=np.radians(120.0)
        ),
        shown=by_angle,
    )
    fillets: choice(
        "Fillets",
        "What becomes of fillets and bevels, which round or break the edge of two sides",
        FILLETS,
        default="automatic",
        shown=of_shape,
        active=is_plain,
    )
    length_weight: number(
        "Border Weight",
        "What a border costs for its length (λ of the paper), where segments are found on an attribute. "
        "Larger values give fewer segments",
        Range(0.5, min=1e-4, max=1e4, soft_min=0.05, soft_max=3.0, precision=2),
        shown=by_weight,
    )
    coarseness: number(
        "Coarseness",
        "How good a cut must be: short against what it cuts off, and through hollows. Larger values give "
        "fewer parts. Cuts that are equally good, such as those of two arms, are made all or none",
        Range(1.0, min=0.01, max=100.0, soft_min=0.5, soft_max=4.0, precision=2),
        shown=lambda settings: of_parts(settings) and not by_count(settings),
    )
    count: integer(
        "Segments",
        "Number of segments. The weakest borders are removed first, so that fewer segments are unions of "
        "more. A mesh is computed only once",
        Range(6, min=1, max=100_000, soft_max=100),
        shown=by_count,
        flag="--segments",
        implies={"mode": "COUNT"},
    )
    outputs: choices(
        "Make",
        'What to make of the segments, besides the face attribute "ridgeform_segment"',
        OUTPUTS,
        default={"MATERIALS"},
        flag="--make",
    )
    transition: distance(
        "Transition",
        "Width of the band around a border in which the weights of vertex groups change from 0 to 1, for "
        "rigging. 0 gives every vertex the full weight of its segment",
        Range(0.0, min=0.0, soft_max=10.0, precision=3),
        active=lambda settings: "VERTEX_GROUPS" in settings.outputs,
    )
    use_caps: boolean(
        "Cap Cuts",
        "Close the cuts of separate objects with flat faces, so that they can be printed",
        active=lambda settings: "OBJECTS" in settings.outputs,
    )
    existing: choices(
        "Keep Borders",
        "Borders of the mesh that cuts follow wherever they can",
        BORDERS,
        flag="--keep-borders",
        shown=of_parts,
    )
    ridge_group: shared.RIDGE_GROUP.but(
        name="Borders",
        description="Vertex group painted where borders should run. Unpainted areas are neutral",
    )
    avoid_ridges: shared.AVOID_RIDGES.but(
        name="Avoid Borders",
        description="Keep borders away from the painted vertices instead of drawing them there",
    )
    min_faces: integer(
        "Minimum Faces",
        "Segments with fewer triangles are merged with a neighbor",
        Range(20, min=0, soft_min=1, soft_max=200),
        otherwise="it is as many as the noise of the mesh calls for",
        **EXPERT_OF_FACES,
    )
    method: choice(
        "Method",
        "How segments are made from the indicator of borders",
        METHODS,
        default="fitted",
        **EXPERT_OF_FACES,
    )
    cut_threshold: factor(
        "Threshold",
        "For the method Paper: the indicator is 1 inside a segment and falls to 0 on a border. Faces are cut "
        "apart where it is below this value: higher values cut along weaker borders as well",
        default=0.6,
        **EXPERT_OF_FACES,
        active=lambda settings: settings.method == "paper",
    )
    coarse_to_fine: shared.COARSE_TO_FINE.but(
        description="On large meshes, find the segments on a simplified mesh, and only their borders on the "
        "mesh itself. Much faster, and the segments are the same at any density",
        shown=of_faces,
        active=may_simplify,
    )
    use_fidelity: shared.USE_FIDELITY.but(
        description="Set the fidelity weight of the paper instead of finding it from the noise of the mesh",
        shown=of_faces,
    )
    fidelity: shared.fidelity(
        "Fidelity weight of the paper (Rowe et al. 2024, eq. 41): larger values stay closer to the surface, "
        "noise included",
        default=1000.0,
    ).but(shown=of_faces)
    epsilon_start: _width(
        "First Width",
        "Initial width of the bands around borders (ε of the paper), in the unit below. Halved until the "
        "last width",
        default=0.1,
    )
    epsilon_end: _width(
        "Last Width",
        "Final width of the bands around borders. The method Fitted stops at the resolution of the mesh",
        default=0.001,
    )
    scale: choice("Unit", "Length that counts as 1", UNITS, default="extent", **EXPERT_OF_FACES)
    solver: shared.SOLVER.but(shown=of_faces)
    max_iterations: shared.MAX_ITERATIONS.but(shown=of_faces)


PRESETS = {
    "Faces": {"kind": "FACES", "length_weight": 0.5, "angle": BEND * 0.5},
    "Parts": {"kind": "PARTS", "coarseness": 1.0, "mode": "AUTO"},
    "Large Parts": {"kind": "FACES", "length_weight": 1.2, "angle": BEND * 1.2},
    "Details": {"kind": "FACES", "length_weight": 0.2, "angle": BEND * 0.2},
    "Paper 2024": {
        "kind": "FACES",
        "method": "paper",
        "mode": "AUTO",
        "use_min_faces": True,
        "min_faces": 20,
        "use_fidelity": True,
        "fidelity": 1000.0,
        "cut_threshold": 0.6,
        "epsilon_start": 0.1,
        "epsilon_end": 0.001,
        "scale": "bounding_box",
    },
}
"""Shipped presets: the faces that a person would name; limbs; few and large faces; borders along weak ridges
as well; the method as published."""


def segment_options(settings: object) -> dict[str, object]:
    """The keyword arguments of `ridgeform.segment` that the settings stand for, the same for every mesh.

    Without `n_segments`: any number is taken from the hierarchy of one result.
    """
    return {
        "length_weight": weight_of(settings.angle) if settings.source == "SHAPE" else settings.length_weight,
        "fidelity": settings.fidelity if settings.use_fidelity else None,
        "epsilon_start": settings.epsilon_start,
        "epsilon_end": settings.epsilon_end,
        "cut_threshold": settings.cut_threshold,
        "min_faces": chosen(settings, "min_faces"),
        "method": settings.method,
        "fillets": settings.fillets if may_simplify(settings) else "automatic",
        "scale": settings.scale,
        "coarse_to_fine": None if settings.coarse_to_fine else False,
        "solver": settings.solver,
        "max_iterations": chosen(settings, "max_iterations"),
    }


def parts_options(settings: object) -> dict[str, object]:
    """The keyword arguments of `ridgeform.parts` that the settings stand for, the same for every mesh."""
    return {"coarseness": settings.coarseness}
