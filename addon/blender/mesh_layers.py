# SPDX-License-Identifier: GPL-3.0-or-later
"""The border between Blender and NumPy for what lies on a mesh: attributes, vertex groups, active layers."""

from collections.abc import Iterable
from dataclasses import dataclass, field

import bpy
import numpy as np

# Blender's name of the value, its type, and how many of it one element has. Text has no fast access and is
# left out.
ATTRIBUTE_KINDS = {
    "FLOAT": ("value", np.float32, 1),
    "INT": ("value", np.int32, 1),
    "INT8": ("value", np.int32, 1),
    "BOOLEAN": ("value", bool, 1),
    "FLOAT2": ("vector", np.float32, 2),
    "FLOAT_VECTOR": ("vector", np.float32, 3),
    "FLOAT_COLOR": ("color", np.float32, 4),
    "BYTE_COLOR": ("color", np.float32, 4),
    "INT32_2D": ("value", np.int32, 2),
    "QUATERNION": ("value", np.float32, 4),
    "FLOAT4X4": ("value", np.float32, 16),
}
MIXED = {"FLOAT", "FLOAT2", "FLOAT_VECTOR", "FLOAT_COLOR", "BYTE_COLOR"}
"""Types whose values can be mixed; of others one is taken."""
# Custom normals are stored relative to the faces that they were made for.
_TOPOLOGY = {"position", "custom_normal", ".edge_verts", ".corner_vert", ".corner_edge"}
SEAMS = {".uv_seam", "uv_seam"}
"""The edge attribute of UV seams, in older and newer versions of Blender."""
MARKS = SEAMS | {"sharp_edge", "crease_edge", "bevel_weight_edge", "freestyle_edge"}
"""The attributes of edges that are marks: of those that stay, an edge has just what it had."""
_HIDDEN = SEAMS | {".sculpt_face_set", ".sculpt_mask"}

FLAGS = {f".{what}_{of}" for what in ("select", "hide") for of in ("vert", "edge", "poly")}
"""The attributes that say what is selected and hidden."""


@dataclass
class Layer:
    """One attribute: its values (k, components), and how Blender names and stores it."""

    name: str
    data_type: str
    domain: str
    values: np.ndarray


@dataclass
class Group:
    """One vertex group: name, whether it is locked, weights (n,) with NaN where a vertex is not in it."""

    name: str
    locked: bool
    weights: np.ndarray


@dataclass
class Layers:
    """All that lies on a mesh: attributes, vertex groups, and which layers are active."""

    attributes: list[Layer]
    groups: list[Group] = field(default_factory=list)
    active: dict[str, str | int] = field(default_factory=dict)

    def same_as(self, other: "Layers") -> bool:
        """Whether attributes and vertex groups are the same, and their values too."""
        named = [
            [(layer.name, layer.domain, layer.data_type, layer.values) for layer in layers.attributes]
            + [(group.name, "", "", group.weights) for group in layers.groups]
            for layers in (self, other)
        ]
        return len(named[0]) == len(named[1]) and all(
            # Bytes, not numbers: NaN is the same as itself.
            one[:3] == two[:3] and one[3].tobytes() == two[3].tobytes()
            for one, two in zip(*named, strict=True)
        )

    def uv_layers(self) -> list[np.ndarray]:
        """The UV maps (c, 2)."""
        return [
            layer.values
            for layer in self.attributes
            if layer.domain == "CORNER" and layer.data_type == "FLOAT2"
        ]


def read_layers(obj: bpy.types.Object) -> Layers:
    """Read all but coordinates and faces from the mesh of an object in Object Mode."""
    return Layers(
        read_attributes(obj.data),
        _read_groups(obj),
        active_layers(obj.data) | {"group": obj.vertex_groups.active_index},
    )


def read_attributes(mesh: bpy.types.Mesh) -> list[Layer]:
    """The attributes of a mesh in Object Mode, without coordinates and faces and what is Blender's own."""
    return _read(
        attribute
        for attribute in mesh.attributes
        if attribute.name not in _TOPOLOGY
        and (attribute.name in _HIDDEN or not attribute.name.startswith("."))
        and attribute.data_type in ATTRIBUTE_KINDS
    )


def read_flags(mesh: bpy.types.Mesh) -> list[Layer]:
    """What is selected and hidden of a mesh in Object Mode; all flags of a kind are off where none is."""
    return _read(
        attribute
        for attribute in mesh.attributes
        # See `selected_elements.mend`.
        if attribute.name in FLAGS and attribute.data_type == "BOOLEAN"
    )


def _read(found: Iterable[bpy.types.Attribute]) -> list[Layer]:
    attributes = []
    for attribute in found:
        prop, dtype, size = ATTRIBUTE_KINDS[attribute.data_type]
        values = np.empty(len(attribute.data) * size, dtype)
        attribute.data.foreach_get(prop, values)
        attributes.append(
            Layer(attribute.name, attribute.data_type, attribute.domain, values.reshape(-1, size))
        )
    return attributes


def _read_groups(obj: bpy.types.Object) -> list[Group]:
    n = len(obj.data.vertices)
    groups = [
        Group(group.name, group.lock_weight, np.full(n, np.nan, np.float32)) for group in obj.vertex_groups
    ]
    for vertex in obj.data.vertices if groups else ():
        for element in vertex.groups:
            groups[element.group].weights[vertex.index] = element.weight
    return groups


def write_groups(obj: bpy.types.Object, groups: list[Group], active: int) -> None:
    """Make vertex groups on an object whose mesh has none; `active` is the index of the active one."""
    for group in groups:
        made = obj.vertex_groups.new(name=group.name)
        made.lock_weight = group.locked
        for vertex in np.flatnonzero(~np.isnan(group.weights)).tolist():
            made.add([vertex], float(group.weights[vertex]), "REPLACE")
    if groups:
        obj.vertex_groups.active_index = active


def active_layers(mesh: bpy.types.Mesh) -> dict[str, str]:
    """The names of the active UV maps and colors of a mesh, in use and for rendering."""
    colors = mesh.color_attributes
    shown = colors.render_color_index
    render_uv = next((layer.name for layer in mesh.uv_layers if layer.active_render), "")
    return {
        "uv": mesh.uv_layers.active.name if mesh.uv_layers.active else "",
        "uv_render": render_uv,
        "color": colors.active_color_name,
        "color_render": colors[shown].name if 0 <= shown < len(colors) else "",
    }


def set_active_layers(mesh: bpy.types.Mesh, active: dict[str, str | int]) -> None:
    """Make UV maps and colors active again, those that are there."""
    if active["uv"] in mesh.uv_layers:
        mesh.uv_layers.active = mesh.uv_layers[active["uv"]]
    if active["uv_render"] in mesh.uv_layers:
        mesh.uv_layers[active["uv_render"]].active_render = True
    if active["color"] in mesh.color_attributes:
        mesh.color_attributes.active_color_name = active["color"]
    if active["color_render"] in mesh.color_attributes:
        mesh.color_attributes.render_color_index = mesh.color_attributes.find(active["color_render"])
