# SPDX-License-Identifier: GPL-3.0-or-later
"""Which attributes and vertex groups can be worked on, and which one is meant when no name is given.

Nothing else is imported here, `bpy` least of all: Blender keeps the function behind a search field until the
end, and with it all that this module knows. If `bpy` is a part of that, Python cannot end without a crash
of 4.2.
"""

from .refusals import AttributeRefusedError

GROUP = "GROUP"
"""Stands for the data type of a vertex group."""
USABLE = ("FLOAT", "FLOAT2", "FLOAT_VECTOR", "FLOAT_COLOR", "BYTE_COLOR")
COLORS = ("FLOAT_COLOR", "BYTE_COLOR")
FACE_NUMBERS = ("INT", "FACE")
"""Type and domain of whole numbers on faces."""
RESERVED = {"position": "use Stylize Flat to change the shape itself"}
SHOWN = "ridgeform_shown"
"""The color attribute in which results are shown."""
_PLACES = {"CORNER": "face corners", "FACE": "faces", "EDGE": "edges"}
LONGEST_NAME = 63
"""The most bytes in a name, in every Blender from 4.2 on."""


def reason_against(name: str, data_type: str, domain: str) -> str | None:
    """Why an attribute cannot be used, and the cure; `None` if it can."""
    convert = "with Object Data ▸ Attributes ▸ Convert Attribute"
    if name in RESERVED:
        return RESERVED[name]
    if name.startswith("."):
        return "it belongs to Blender"
    if data_type not in USABLE:
        return f"its values are not decimal numbers: convert it to Float, Vector, or Color {convert}"
    if domain == "POINT" or (domain == "CORNER" and data_type in COLORS):
        return None
    return f"it is stored on {_PLACES.get(domain, domain.lower())}: convert it to the domain Vertex {convert}"


def usable_names(obj: object) -> list[str]:
    """The names of the attributes and vertex groups that can be used, for a search field."""
    names = [
        attribute.name
        for attribute in obj.data.attributes
        if reason_against(attribute.name, attribute.data_type, attribute.domain) is None
        and attribute.name != SHOWN
    ]
    return names + [group.name for group in obj.vertex_groups if group.name not in names]


def default_name(obj: object, suffixes: tuple[str, ...]) -> str:
    """What is worked on if no name is given: the active attribute, color or vertex group that can be used.

    Results, told by their suffix, are not taken for sources. `AttributeRefusedError` if there is none.
    """
    mesh, usable = obj.data, usable_names(obj)
    active = (mesh.attributes.active, mesh.color_attributes.active_color, obj.vertex_groups.active)
    for item in active:
        if item is None or item.name not in usable:
            continue
        source = next((item.name.removesuffix(end) for end in suffixes if item.name.endswith(end)), None)
        return source if source in usable else item.name
    if usable:
        return usable[0]
    raise AttributeRefusedError(
        f'"{obj.name}" has no attribute of decimal numbers or colors on its vertices, and no vertex group'
    )


def result_name(name: str, suffix: str) -> str:
    """The name of a new attribute for a result, short enough for Blender."""
    room = LONGEST_NAME - len(suffix.encode())
    return name.encode()[:room].decode(errors="ignore") + suffix


def search_names(_settings: object, context: object, _typed: str) -> list[str]:
    """What a search field offers."""
    obj = context.object
    return usable_names(obj) if obj is not None and obj.type == "MESH" else []


def search_colors(_settings: object, context: object, _typed: str) -> list[str]:
    """What a search field for colors offers."""
    obj = context.object
    return [item.name for item in obj.data.color_attributes] if obj is not None and obj.type == "MESH" else []


def search_face_numbers(_settings: object, context: object, _typed: str) -> list[str]:
    """What a search field for whole numbers on faces offers."""
    obj = context.object
    if obj is None or obj.type != "MESH":
        return []
    return [item.name for item in obj.data.attributes if (item.data_type, item.domain) == FACE_NUMBERS]
