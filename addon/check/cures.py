# SPDX-License-Identifier: GPL-3.0-or-later
"""What cures a fault of a mesh in Object Mode, by Blender's own mesh editing: all that lies on it stays."""

from collections.abc import Callable

import bmesh
import bpy
import numpy as np

from ..blender import mesh_layers
from ..blender.refusals import RefusedError
from . import faults, junctions, splitting
from .arrays import MeshArrays
from .examine import read_arrays

NORMALS = "ridgeform_kept_normals"
"""The attribute that has custom normals while a mesh is edited."""


def cure(obj: bpy.types.Object, kind: str) -> None:
    """Cure what `examine` finds of one kind; `RefusedError` if that cannot be done here."""
    if kind == "uneven_scale":
        _apply_scale(obj)
        return
    mesh = read_arrays(obj)
    edit = EDITS[kind](mesh)
    _edit(obj.data, edit)


def _edit(mesh: bpy.types.Mesh, edit: Callable[[bmesh.types.BMesh], None]) -> None:
    """Edit a mesh, and keep its active layers and its custom normals, which hang on faces and corners."""
    active = mesh_layers.active_layers(mesh)
    normals = _keep_normals(mesh)
    edited = bmesh.new()
    try:
        edited.from_mesh(mesh)
        for elements in (edited.verts, edited.edges, edited.faces):
            elements.ensure_lookup_table()
        edit(edited)
        edited.to_mesh(mesh)
    finally:
        edited.free()
        if normals:
            _give_normals(mesh)
    mesh_layers.set_active_layers(mesh, active)
    mesh.validate()
    mesh.update()


def _keep_normals(mesh: bpy.types.Mesh) -> bool:
    """Store custom normals as vectors: Blender has them as angles from what the faces around say."""
    custom = mesh.attributes.get("custom_normal")
    if not mesh.has_custom_normals or (custom is not None and custom.data_type == "FLOAT_VECTOR"):
        return False
    values = np.empty(3 * len(mesh.loops), np.float32)
    mesh.corner_normals.foreach_get("vector", values)
    mesh.attributes.new(NORMALS, "FLOAT_VECTOR", "CORNER").data.foreach_set("vector", values)
    return True


def _give_normals(mesh: bpy.types.Mesh) -> None:
    attribute = mesh.attributes[NORMALS]
    values = np.empty(3 * len(mesh.loops), np.float32)
    attribute.data.foreach_get("vector", values)
    mesh.attributes.remove(attribute)
    mesh.normals_split_custom_set(values.reshape(-1, 3).tolist())


def _seams(mesh: MeshArrays) -> Callable[[bmesh.types.BMesh], None]:
    sound = faults.sound(mesh)
    target = faults.weldable(sound, faults.welded(sound))
    moved = np.flatnonzero(target != np.arange(len(target)))

    def edit(edited: bmesh.types.BMesh) -> None:
        verts = edited.verts
        pairs = zip(moved.tolist(), target[moved].tolist(), strict=True)
        bmesh.ops.weld_verts(edited, targetmap={verts[vertex]: verts[other] for vertex, other in pairs})

    return edit


def _flipped_faces(mesh: MeshArrays) -> Callable[[bmesh.types.BMesh], None]:
    sound = faults.sound(mesh)
    flipped = faults.orientation(sound, faults.welded(sound))[0].tolist()

    def edit(edited: bmesh.types.BMesh) -> None:
        faces = [edited.faces[face] for face in flipped]
        layers = edited.loops.layers.float_vector
        normals = [layers[name] for name in (NORMALS, "custom_normal") if name in layers]
        for corner in (corner for face in faces for corner in face.loops) if normals else ():
            for layer in normals:
                corner[layer] = -corner[layer]
        bmesh.ops.reverse_faces(edited, faces=faces, flip_multires=True)

    return edit


def _duplicate_faces(mesh: MeshArrays) -> Callable[[bmesh.types.BMesh], None]:
    doubled = faults.duplicate_faces(mesh, faults.welded(faults.sound(mesh))).tolist()

    def edit(edited: bmesh.types.BMesh) -> None:
        # Their edges and vertices go too, if no other face has them.
        faces = [edited.faces[face] for face in doubled]
        bmesh.ops.delete(edited, geom=faces, context="FACES")

    return edit


def _loose_edges(mesh: MeshArrays) -> Callable[[bmesh.types.BMesh], None]:
    loose = faults.loose_edges(mesh).tolist()

    def edit(edited: bmesh.types.BMesh) -> None:
        edges = [edited.edges[edge] for edge in loose]
        ends = {vert for edge in edges for vert in edge.verts}
        for edge in edges:
            edited.edges.remove(edge)
        for vert in ends:
            if not vert.link_edges:
                edited.verts.remove(vert)

    return edit


def _loose_vertices(mesh: MeshArrays) -> Callable[[bmesh.types.BMesh], None]:
    loose = faults.loose_vertices(mesh).tolist()

    def edit(edited: bmesh.types.BMesh) -> None:
        bmesh.ops.delete(edited, geom=[edited.verts[vertex] for vertex in loose], context="VERTS")

    return edit


def _nonmanifold_edges(mesh: MeshArrays) -> Callable[[bmesh.types.BMesh], None]:
    edges = faults.nonmanifold_edges(mesh).tolist()
    return lambda edited: splitting.split_edges(edited, [edited.edges[edge] for edge in edges])


def _nonmanifold_vertices(mesh: MeshArrays) -> Callable[[bmesh.types.BMesh], None]:
    sound = faults.sound(mesh)
    fans, _ = faults.of_triangles(sound, faults.welded(sound))
    return lambda edited: splitting.split_vertices([edited.verts[vertex] for vertex in fans.tolist()])


def _t_junctions(mesh: MeshArrays) -> Callable[[bmesh.types.BMesh], None]:
    sound = faults.sound(mesh)
    vertices, edges = junctions.edges_at(sound, faults.welded(sound))
    return lambda edited: splitting.join_junctions(edited, vertices.tolist(), edges.tolist())


def _apply_scale(obj: bpy.types.Object) -> None:
    if obj.data.users > 1:
        raise RefusedError(
            f'The mesh of "{obj.name}" is used by {obj.data.users} objects: make it single-user first'
        )
    if obj.parent is not None and np.ptp(np.abs(obj.parent.matrix_world.to_scale())) > 0.0:
        raise RefusedError(f'"{obj.name}" has its scale from its parent "{obj.parent.name}": apply it there')
    context = bpy.context.temp_override(
        active_object=obj, object=obj, selected_objects=[obj], selected_editable_objects=[obj]
    )
    with context:
        bpy.ops.object.transform_apply(location=False, rotation=False, scale=True)


EDITS = {
    "seams": _seams,
    "flipped_faces": _flipped_faces,
    "duplicate_faces": _duplicate_faces,
    "loose_edges": _loose_edges,
    "loose_vertices": _loose_vertices,
    "nonmanifold_edges": _nonmanifold_edges,
    "nonmanifold_vertices": _nonmanifold_vertices,
    "t_junctions": _t_junctions,
}
"""What edits a mesh, made from its arrays, by the kind of the fault."""
