# SPDX-License-Identifier: GPL-3.0-or-later
"""The settings of diffusion curves, shared by the operator, the panel and the batch command."""

from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, StringProperty

from ..blender.attribute_names import search_colors, search_face_numbers


class DiffusionSettings:
    """Where the colours come from, what the regions are, and how few colours the curves may have."""

    source: EnumProperty(
        name="Colors",
        description="Where the colors come from",
        items=(
            ("ATTRIBUTE", "Color Attribute", "A color attribute of the mesh"),
            (
                "IMAGE",
                "Image Texture",
                "The image of the active material, at the vertices by the active UV map",
            ),
        ),
        default="ATTRIBUTE",
    )
    attribute: StringProperty(
        name="Color Attribute",
        description="Color attribute to draw with curves. Empty: the active one",
        search=search_colors,
    )
    regions: EnumProperty(
        name="Regions",
        description="What the curves are the borders of",
        items=(
            ("COLORS", "From Colors", "Find the regions by their colors"),
            ("MATERIALS", "Material Slots", "Faces of one material slot are a region"),
            ("ATTRIBUTE", "Face Attribute", "Faces with the same whole number in an attribute are a region"),
        ),
        default="COLORS",
    )
    region_attribute: StringProperty(
        name="Face Attribute",
        description="Attribute of whole numbers on the faces that tells the regions apart",
        search=search_face_numbers,
    )
    count: IntProperty(
        name="Count",
        description="How many regions to find. 0: as many as the colors call for",
        default=0,
        min=0,
        soft_max=64,
    )
    least_faces: IntProperty(
        name="Least Triangles",
        description="Regions of fewer triangles become part of a neighbor",
        default=20,
        min=1,
        soft_max=500,
    )
    color_error: FloatProperty(
        name="Color Tolerance",
        description="How much a color on a curve may change so that fewer different ones are needed along it",
        default=0.01,
        min=0.0,
        soft_max=0.2,
        precision=3,
    )
    rims: BoolProperty(
        name="Mesh Borders",
        description="The borders of an open mesh are curves too, with colors on their one side",
        default=False,
    )
    refine: BoolProperty(
        name="Best Colors",
        description="Improve the colors of the curves until the redrawn surface is closest to the painted "
        "one, instead of leaving them as the paper has them",
        default=True,
    )
    fidelity: FloatProperty(
        name="Fidelity",
        description="How close the colors of the curves stay to the painted ones next to them (Rowe et al. "
        "2024, eq. 27), on a surface of unit area. Matters most without Best Colors",
        default=1000.0,
        min=1e-3,
        max=1e12,
        soft_min=1.0,
        soft_max=1e6,
        precision=1,
    )
    show: BoolProperty(
        name="Show Result",
        description="Make the redrawn colors the active ones and show them in Solid shading",
        default=True,
    )
