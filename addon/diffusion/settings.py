# SPDX-License-Identifier: GPL-3.0-or-later
"""The settings of diffusion curves: where colors and regions come from, and how few colors are enough."""

from ..blender.attribute_names import search_colors, search_face_numbers
from ..framework import shared_settings as shared
from ..framework.settings import Range, Settings, boolean, choice, data_name, integer, items, number


def _finds_regions(settings: object) -> bool:
    return settings.regions == "COLORS"


SHOW = boolean(
    "Show Result", "Make the redrawn colors active and show them in Solid shading", default=True, flag=None
)


SOURCES = items(
    ATTRIBUTE=("Color Attribute", "A color attribute of the mesh"),
    IMAGE=(
        "Image Texture",
        "The image of the active material, sampled at the vertices with the active UV map",
    ),
)
REGIONS = items(
    COLORS=("From Colors", "Find the regions by their colors"),
    MATERIALS=("Material Slots", "Faces with the same material slot are a region"),
    ATTRIBUTE=("Face Attribute", "Faces with the same integer in an attribute are a region"),
)


class DiffusionSettings(Settings):
    """The settings of diffusion curves."""

    source: choice(
        "Colors",
        "Where the colors come from",
        SOURCES,
        default="ATTRIBUTE",
        flag=None,
        switches={"--image": "IMAGE"},
    )
    attribute: data_name(
        "Color Attribute",
        "Color attribute to draw with curves. Empty: the active one",
        search=search_colors,
        active=lambda settings: settings.source == "ATTRIBUTE",
    )
    regions: choice("Regions", "Regions whose borders become curves", REGIONS, default="COLORS")
    region_attribute: data_name(
        "Face Attribute",
        "Integer attribute on faces that tells the regions apart",
        search=search_face_numbers,
        shown=lambda settings: settings.regions == "ATTRIBUTE",
    )
    count: integer(
        "Count",
        "Number of regions to find",
        Range(8, min=0, soft_min=1, soft_max=64),
        otherwise="as many are found as the colors call for",
        active=_finds_regions,
    )
    least_faces: integer(
        "Minimum Triangles",
        "Regions with fewer triangles are merged with a neighbor",
        Range(20, min=1, soft_max=500),
        active=_finds_regions,
    )
    color_error: number(
        "Color Tolerance",
        "How much a color on a curve may change so that fewer different colors are needed along it",
        Range(0.01, min=0.0, soft_max=0.2, precision=3),
    )
    rims: boolean(
        "Mesh Borders", "Turn the borders of an open mesh into curves too, with colors on their one side"
    )
    show: SHOW
    refine: boolean(
        "Best Colors",
        "Improve the colors of the curves until the redrawn surface is closest to the painted one, instead "
        "of leaving them as the paper has them",
        default=True,
        section=shared.EXPERT,
    )
    fidelity: shared.fidelity(
        "How close the colors of the curves stay to the painted ones next to them (Rowe et al. 2024, eq. "
        "27), on a surface of unit area. Matters most without Best Colors",
        default=1000.0,
        switched=False,
        min=1e-3,
    )
