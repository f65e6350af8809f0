# SPDX-License-Identifier: GPL-3.0-or-later
"""Segments as objects of their own."""

import bmesh
import bpy
import numpy as np

from ..blender import selected_elements
from ..blender.stored_numbers import read_ints, write_numbers
from . import layers, slots

CUT = "ridgeform_cut"
"""The edge attribute that says where a mesh was cut, while it is being separated."""


def separate(obj: bpy.types.Object, labels: np.ndarray, caps: bool = False) -> list[bpy.types.Object]:
    """Make an object of each segment; the first stays, and faces without a segment stay with it.

    All that lies on the mesh goes along; own material slots that a part does not use go. With `caps` the cuts
    are closed on both sides; borders that were open before stay open. Returns all parts.
    """
    if caps:
        write_numbers(obj.data, CUT, "INT", "EDGE", layers.border_edges(obj.data, labels).astype(np.int32))
    context = bpy.context
    active, chosen = context.view_layer.objects.active, list(context.selected_objects)
    parts = [obj]
    _select_only(obj)
    try:
        for segment in np.unique(labels[labels >= 0])[1:].tolist():
            now = read_ints(obj.data, layers.SEGMENT, "FACE", -1)
            _select_faces(obj.data, now == segment)
            before = set(context.scene.objects)
            bpy.ops.object.mode_set(mode="EDIT")
            bpy.ops.mesh.separate(type="SELECTED")
            bpy.ops.object.mode_set(mode="OBJECT")
            (made,) = set(context.scene.objects) - before
            made.name = made.data.name = f"{obj.name} {segment + 1}"
            parts.append(made)
            _select_only(obj)
    finally:
        for item in [*chosen, *parts]:
            item.select_set(True)
        context.view_layer.objects.active = active
    for part in parts:
        if caps:
            _cap(part.data)
        slots.remove_unused(part.data, slots.index_of(part.data))
    return parts


def _select_only(obj: bpy.types.Object) -> None:
    for other in bpy.context.selected_objects:
        other.select_set(False)
    obj.select_set(True)
    bpy.context.view_layer.objects.active = obj


def _select_faces(mesh: bpy.types.Mesh, chosen: np.ndarray) -> None:
    bpy.context.scene.tool_settings.mesh_select_mode = (False, False, True)
    mesh.vertices.foreach_set("select", np.zeros(len(mesh.vertices), bool))
    selected_elements.write(mesh, mesh.edges, np.zeros(len(mesh.edges), bool))
    mesh.polygons.foreach_set("hide", np.zeros(len(mesh.polygons), bool))
    mesh.polygons.foreach_set("select", chosen)
    mesh.update()


def _cap(mesh: bpy.types.Mesh) -> None:
    """Close the loops of cut edges with flat-shaded triangles between their vertices."""
    edited = bmesh.new()
    try:
        edited.from_mesh(mesh)
        layer = edited.edges.layers.int[CUT]
        edges = [edge for edge in edited.edges if edge[layer] and edge.is_boundary]
        materials = {edge: edge.link_faces[0].material_index for edge in edges}
        faces = bmesh.ops.holes_fill(edited, edges=edges, sides=0)["faces"]
        for face in faces:
            face.smooth = False
            face.material_index = next(materials[edge] for edge in face.edges if edge in materials)
        bmesh.ops.triangulate(edited, faces=faces)
        edited.edges.layers.int.remove(layer)
        edited.to_mesh(mesh)
    finally:
        edited.free()
    mesh.update()
