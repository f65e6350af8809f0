# SPDX-License-Identifier: GPL-3.0-or-later
"""The settings of segmenting, shared by the operator, the panel, presets and the batch command."""

from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, StringProperty

from ..blender.attribute_names import search_names
from ..framework.shared_settings import RidgeSettings, SolverChoice

OUTPUTS = (
    (
        "MATERIALS",
        "Material Slots",
        "A slot with a colour of its own for each segment. Slots and materials that exist stay, those of an "
        "earlier run are used again",
    ),
    ("SEAMS", "Seams", "Mark the borders as seams for unwrapping. Seams that exist are kept"),
    ("SHARP", "Sharp Edges", "Mark the borders as sharp edges. Marks that exist are kept"),
    ("FACE_SETS", "Face Sets", "Make each segment a face set of Sculpt Mode"),
    ("VERTEX_GROUPS", "Vertex Groups", "Make a vertex group of each segment; those of an earlier run go"),
    (
        "INDICATOR",
        "Indicator",
        'Store where borders are, 0 on them and 1 inside segments, in the attribute "ridgeform_indicator"',
    ),
    (
        "SHARPENED",
        "Sharpened Surface",
        "Keep what the borders were found on, flattened between them: the shape as a new shape key, an "
        "attribute as a new one",
    ),
    ("OBJECTS", "Separate Objects", "Make each segment an object of its own. For Object Mode"),
)
"""What can be made of segments, besides the face attribute."""


class SegmentSettings(RidgeSettings, SolverChoice):
    """What is segmented, how finely, and what is made of it."""

    source: EnumProperty(
        name="By",
        description="What the segments are found on",
        items=(
            ("SHAPE", "Shape", "Parts that are nearly flat or evenly curved, with borders along the ridges"),
            (
                "ATTRIBUTE",
                "Attribute",
                "Parts on which an attribute, a colour or a vertex group is even or rises evenly",
            ),
        ),
        default="SHAPE",
    )
    attribute: StringProperty(
        name="Attribute",
        description="Attribute or vertex group that the segments are found on. Empty: the active one",
        search=search_names,
    )
    length_weight: FloatProperty(
        name="Border Cost",
        description="What a border costs for its length (λ of the paper). Two parts of a shape become one "
        "segment if they meet at an edge that bends by less than an angle of about 0.8 of this (0.5: 23°). "
        "Larger gives fewer segments, smaller more",
        default=0.5,
        min=1e-4,
        max=1e4,
        soft_min=0.05,
        soft_max=3.0,
        precision=2,
    )
    use_count: BoolProperty(
        name="Set Number",
        description="Ask for a number of segments",
        default=False,
    )
    count: IntProperty(
        name="Segments",
        description="How many segments there shall be. The weakest borders go first, so that fewer segments "
        "are unions of more. The same mesh is computed once only",
        default=6,
        min=1,
        max=100_000,
        soft_max=100,
    )
    outputs: EnumProperty(
        name="Make",
        description='What is made of the segments, besides the face attribute "ridgeform_segment"',
        items=OUTPUTS,
        options={"ENUM_FLAG"},
        default={"MATERIALS"},
    )
    min_faces: IntProperty(
        name="Least Faces",
        description="Segments of fewer triangles are joined to a neighbour. 0: as many as the noise of the "
        "mesh asks for",
        default=0,
        min=0,
        soft_max=200,
    )
    method: EnumProperty(
        name="Method",
        description="How segments come from the indicator of borders",
        items=(
            (
                "fitted",
                "Fitted",
                "Flooded between the borders, joined where little bends, faces at a border given to the side "
                "that they fit best",
            ),
            ("paper", "Paper", "Cut where the indicator is below the threshold (Rowe et al. 2024)"),
        ),
        default="fitted",
    )
    cut_threshold: FloatProperty(
        name="Threshold",
        description="For the method Paper: the indicator is 1 inside a segment and falls to 0 on a border. "
        "Faces are cut apart where it is below this: higher cuts along weaker borders as well",
        default=0.6,
        min=0.0,
        max=1.0,
        subtype="FACTOR",
    )
    use_fidelity: BoolProperty(
        name="Set Fidelity",
        description="Set the fidelity weight of the paper, instead of finding it from the noise of the mesh",
        default=False,
    )
    fidelity: FloatProperty(
        name="Fidelity",
        description="Fidelity weight of the paper (Rowe et al. 2024, eq. 41): larger stays closer to "
        "the surface, noise included",
        default=1000.0,
        min=1e-6,
        max=1e12,
        soft_min=1.0,
        soft_max=1e6,
        precision=1,
    )
    epsilon_start: FloatProperty(
        name="First Width",
        description="Width of the bands around borders at first (ε of the paper), in the unit below; halved "
        "until the last width",
        default=0.1,
        min=1e-5,
        max=10.0,
        precision=4,
    )
    epsilon_end: FloatProperty(
        name="Last Width",
        description="Width of the bands around borders at the end. The method Fitted goes no lower than the "
        "mesh is fine",
        default=0.001,
        min=1e-5,
        max=10.0,
        precision=4,
    )
    scale: EnumProperty(
        name="Unit",
        description="The length that counts as 1",
        items=(
            ("extent", "Extent", "The size of the shape, however it is turned: for a cube its side"),
            ("bounding_box", "Bounding Box", "The longest side of the bounding box"),
            ("area", "Area", "The square root of the surface's area"),
            ("max_edge", "Longest Edge", "The longest edge"),
        ),
        default="extent",
    )


def segment_options(settings: object) -> dict[str, object]:
    """The keyword arguments of `ridgeform.segment` that the settings stand for, the same for every mesh.

    Without `n_segments`: any number is taken from the hierarchy of one result.
    """
    return {
        "length_weight": settings.length_weight,
        "fidelity": settings.fidelity if settings.use_fidelity else None,
        "epsilon_start": settings.epsilon_start,
        "epsilon_end": settings.epsilon_end,
        "cut_threshold": settings.cut_threshold,
        "min_faces": settings.min_faces or None,
        "method": settings.method,
        "scale": settings.scale,
        "solver": settings.solver,
        "max_iterations": settings.max_iterations or None,
    }
