# SPDX-License-Identifier: GPL-3.0-or-later
"""A result beside the mesh: as an attribute, with a modifier that blends the mesh with it.

The node group is made by code and marked as an asset of the file: for an asset library, an extension would
have to change the preferences.
"""

import bpy
import numpy as np

ATTRIBUTE = "ridgeform_position"
"""The attribute of vectors with the places of the result, in object space."""
GROUP = "Ridgeform Blend"
MARK = "ridgeform_blend"
"""A custom property by which a node group of ours is told from one of the same name."""
FACTOR, MASK, RESULT = "Factor", "Mask", "Result"
"""The inputs of the group."""
INPUTS = (
    (FACTOR, "NodeSocketFloat", 1.0, "How far the mesh goes to the result: 0 is the original, 1 the result"),
    (MASK, "NodeSocketFloat", 1.0, "Multiplies the factor: choose a vertex group or an attribute"),
    (RESULT, "NodeSocketString", ATTRIBUTE, "Name of the attribute with the places of the result"),
)


def node_group() -> bpy.types.NodeTree:
    """The node group, made where the file has none; what somebody has changed of it stays."""
    found = next((group for group in bpy.data.node_groups if group.get(MARK)), None)
    return found if found is not None else _made()


def _made() -> bpy.types.NodeTree:
    tree = bpy.data.node_groups.new(GROUP, "GeometryNodeTree")
    tree[MARK] = True
    tree.is_modifier = True
    sockets = tree.interface
    sockets.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    sockets.new_socket("Geometry", in_out="INPUT", socket_type="NodeSocketGeometry")
    for name, kind, default, description in INPUTS:
        socket = sockets.new_socket(name, in_out="INPUT", socket_type=kind, description=description)
        socket.default_value = default
        if kind == "NodeSocketFloat":
            socket.min_value, socket.max_value, socket.subtype = 0.0, 1.0, "FACTOR"
    nodes, links = tree.nodes, tree.links
    given = nodes.new("NodeGroupInput")
    stored = nodes.new("GeometryNodeInputNamedAttribute")
    stored.data_type = "FLOAT_VECTOR"
    place = nodes.new("GeometryNodeInputPosition")
    part = nodes.new("ShaderNodeMath")
    part.operation = "MULTIPLY"
    mix = nodes.new("ShaderNodeMix")
    mix.data_type, mix.clamp_factor = "VECTOR", True
    move = nodes.new("GeometryNodeSetPosition")
    made = nodes.new("NodeGroupOutput")
    sides = {socket.identifier: socket for socket in mix.inputs}
    mixed = next(socket for socket in mix.outputs if socket.identifier == "Result_Vector")
    for start, end in (
        (given.outputs[RESULT], stored.inputs["Name"]),
        (given.outputs[FACTOR], part.inputs[0]),
        (given.outputs[MASK], part.inputs[1]),
        (part.outputs[0], sides["Factor_Float"]),
        (place.outputs[0], sides["A_Vector"]),
        (stored.outputs["Attribute"], sides["B_Vector"]),
        (given.outputs["Geometry"], move.inputs["Geometry"]),
        # A mesh without the attribute stays as it is.
        (stored.outputs["Exists"], move.inputs["Selection"]),
        (mixed, move.inputs["Position"]),
        (move.outputs[0], made.inputs["Geometry"]),
    ):
        links.new(start, end)
    for node, place_of in zip(
        (given, stored, place, part, mix, move, made),
        ((0, 0), (220, -60), (220, -220), (220, 160), (440, -60), (660, 0), (880, 0)),
        strict=True,
    ):
        node.location = place_of
    tree.asset_mark()
    tree.asset_data.description = "Blends a mesh with a result of Ridgeform that is stored as an attribute"
    return tree


def modifier_of(obj: bpy.types.Object) -> bpy.types.Modifier | None:
    """The modifier of an object that blends, if it has one."""
    nodes = (modifier for modifier in obj.modifiers if modifier.type == "NODES")
    return next((modifier for modifier in nodes if is_blend(modifier)), None)


def is_blend(modifier: bpy.types.Modifier) -> bool:
    """Whether a modifier blends a mesh with a result."""
    return modifier.type == "NODES" and bool(modifier.node_group and modifier.node_group.get(MARK))


def add_modifier(obj: bpy.types.Object) -> bpy.types.Modifier:
    """The modifier that blends, made before all others where there is none: they work on what it gives."""
    modifier = modifier_of(obj)
    if modifier is None:
        modifier = obj.modifiers.new(GROUP, "NODES")
        modifier.node_group = node_group()
        obj.modifiers.move(len(obj.modifiers) - 1, 0)
    return modifier


def input_of(modifier: bpy.types.Modifier, name: str) -> tuple[object, str]:
    """Where the value of an input is, for a row of a panel: what has it, and the name of the property."""
    identifier = _identifier(modifier, name)
    if hasattr(modifier, "properties"):
        return getattr(modifier.properties.inputs, identifier), "value"
    return modifier, f'["{identifier}"]'


def set_input(modifier: bpy.types.Modifier, name: str, value: float | str) -> None:
    """Give an input a value."""
    identifier = _identifier(modifier, name)
    if hasattr(modifier, "properties"):
        getattr(modifier.properties.inputs, identifier).value = value
    else:
        modifier[identifier] = value
    modifier.id_data.update_tag()


def set_attribute(modifier: bpy.types.Modifier, name: str, attribute: str) -> None:
    """Have an input take an attribute, or a vertex group, in place of a value."""
    identifier = _identifier(modifier, name)
    if hasattr(modifier, "properties"):
        entry = getattr(modifier.properties.inputs, identifier)
        entry.type, entry.attribute_name = "ATTRIBUTE", attribute
    else:
        modifier[f"{identifier}_use_attribute"] = True
        modifier[f"{identifier}_attribute_name"] = attribute
    modifier.id_data.update_tag()


def _identifier(modifier: bpy.types.Modifier, name: str) -> str:
    items = modifier.node_group.interface.items_tree
    return next(item.identifier for item in items if item.name == name and item.in_out == "INPUT")


def stored(mesh: bpy.types.Mesh) -> np.ndarray | None:
    """The places (n, 3) float32 of the result that a mesh in Object Mode has, `None` without one."""
    attribute = mesh.attributes.get(ATTRIBUTE)
    if attribute is None or attribute.data_type != "FLOAT_VECTOR" or attribute.domain != "POINT":
        return None
    places = np.empty((len(attribute.data), 3), np.float32)
    attribute.data.foreach_get("vector", places.ravel())
    return places


def store(mesh: bpy.types.Mesh, places: np.ndarray | None) -> None:
    """Store places (n, 3) as the result of a mesh in Object Mode, or take away the one that it has."""
    attribute = mesh.attributes.get(ATTRIBUTE)
    if attribute is not None and (places is None or stored(mesh) is None):
        mesh.attributes.remove(attribute)
        attribute = None
    if places is not None:
        if attribute is None:
            attribute = mesh.attributes.new(ATTRIBUTE, "FLOAT_VECTOR", "POINT")
        attribute.data.foreach_set("vector", np.ascontiguousarray(places, np.float32).ravel())
    mesh.update()
