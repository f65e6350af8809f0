# SPDX-License-Identifier: GPL-3.0-or-later
"""The border between Blender and NumPy: reading and writing coordinates, triangles, weights and edge marks.

Coordinates are `float32` arrays (n, 3) in object space, the bits that Blender stores. What is read in Edit
Mode is the edited mesh, which `flush_edit_mode` copies into the mesh's own arrays first.
"""

import contextlib
from collections.abc import Iterable, Iterator
from typing import Protocol

import bmesh
import bpy
import numpy as np

from . import reading
from .reading import once


def flush_edit_mode(obj: bpy.types.Object) -> None:
    """Bring the arrays of a mesh in Edit Mode up to date with what is edited; does nothing in Object Mode."""
    if obj.data.is_editmode:
        obj.update_from_editmode()
        reading.forget()


def is_out_of_reach(obj: bpy.types.Object) -> bool:
    """Whether `object_mode` would leave the mesh of an object in Edit Mode, or painted, or sculpted.

    Scripts can hide what is edited, or make another object the active one.
    """
    active = bpy.context.object
    visible = active is not None and active.visible_get() and obj.visible_get()
    if obj.mode in PAINTING.values():
        return not visible
    reached = bpy.context.mode == "EDIT_MESH" and obj.mode == "EDIT" and visible
    return obj.data.is_editmode and not reached


PAINTING = {
    "PAINT_WEIGHT": "WEIGHT_PAINT",
    "PAINT_VERTEX": "VERTEX_PAINT",
    "PAINT_TEXTURE": "TEXTURE_PAINT",
    "SCULPT": "SCULPT",
}
"""Modes in which one mesh is painted or sculpted, and what they are called where they are set."""


@contextlib.contextmanager
def object_mode() -> Iterator[None]:
    """Leave the mode for all objects that are in it, and come back: much cannot be read or made there."""
    mode = PAINTING.get(bpy.context.mode, "EDIT" if bpy.context.mode == "EDIT_MESH" else None)
    active = bpy.context.view_layer.objects.active
    if active is None or not active.visible_get():
        # For a hidden object Blender enters no mode, and leaves none but Edit Mode.
        mode = None
    if mode is not None:
        bpy.ops.object.mode_set(mode="OBJECT")
        reading.forget()
    try:
        yield
    finally:
        if mode is not None:
            bpy.ops.object.mode_set(mode=mode)
            reading.forget()


@once
def triangles(mesh: bpy.types.Mesh) -> np.ndarray:
    """The loop triangles (m, 3) int32: vertices of the triangles that Blender draws for faces of any size."""
    if len(mesh.loops) == 3 * len(mesh.polygons):
        return corner_vertices(mesh).reshape(-1, 3)
    return corner_vertices(mesh)[triangle_corners(mesh)]


@once
def triangle_corners(mesh: bpy.types.Mesh) -> np.ndarray:
    """The corners (m, 3) int32 of the faces that the loop triangles use."""
    if len(mesh.loops) == 3 * len(mesh.polygons):
        return np.arange(len(mesh.loops), dtype=np.int32).reshape(-1, 3)
    mesh.calc_loop_triangles()
    corners = np.empty(3 * len(mesh.loop_triangles), np.int32)
    mesh.loop_triangles.foreach_get("loops", corners)
    return corners.reshape(-1, 3)


@once
def triangle_faces(mesh: bpy.types.Mesh) -> np.ndarray:
    """The face (m,) int32 that each loop triangle is a part of."""
    starts = _face_starts(mesh)
    sizes = np.diff(starts, append=np.int32(len(mesh.loops)))
    # Those of a face are two fewer than its corners, in the order of the faces.
    return np.repeat(np.arange(len(starts), dtype=np.int32), sizes - 2)


@once
def edges(mesh: bpy.types.Mesh) -> np.ndarray:
    """The edges (k, 2) int32."""
    ends = np.empty((len(mesh.edges), 2), np.int32)
    return _read(mesh.attributes.get(".edge_verts"), "value", mesh.edges, "vertices", ends)


def _read(
    attribute: bpy.types.Attribute | None, key: str, items: object, slower: str, values: np.ndarray
) -> np.ndarray:
    """Fill rows of values from an attribute, or from its items by a slower way where there is none."""
    if attribute is None:
        items.foreach_get(slower, values.ravel())
    else:
        attribute.data.foreach_get(key, values.ravel())
    return values


def face_corners(mesh: bpy.types.Mesh) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """First corner of each face (f,), vertex of each corner (c,) and edge of each corner (c,), int32."""
    return _face_starts(mesh), corner_vertices(mesh), corner_edges(mesh)


@once
def corner_vertices(mesh: bpy.types.Mesh) -> np.ndarray:
    """The vertex (c,) int32 of each corner."""
    return _corner_array(mesh, ".corner_vert", "vertex_index")


@once
def corner_edges(mesh: bpy.types.Mesh) -> np.ndarray:
    """The edge (c,) int32 of each corner, which leads to the next one of the face."""
    return _corner_array(mesh, ".corner_edge", "edge_index")


@once
def _face_starts(mesh: bpy.types.Mesh) -> np.ndarray:
    if len(mesh.loops) == 3 * len(mesh.polygons):
        return np.arange(0, len(mesh.loops), 3, dtype=np.int32)
    starts = np.empty(len(mesh.polygons), np.int32)
    mesh.polygons.foreach_get("loop_start", starts)
    return starts


def _corner_array(mesh: bpy.types.Mesh, name: str, prop: str) -> np.ndarray:
    """An attribute (c,) int32 of the corners; in Edit Mode, where it is not there, by the corners' property.

    The property takes several hundred times as long.
    """
    values = np.empty(len(mesh.loops), np.int32)
    attribute = mesh.attributes.get(name)
    if attribute is None:
        mesh.loops.foreach_get(prop, values)
    else:
        attribute.data.foreach_get("value", values)
    return values


def selected_vertices(mesh: bpy.types.Mesh) -> np.ndarray:
    """Which vertices (n,) bool are selected and visible."""
    return _selected(mesh.vertices)


def selected_faces(mesh: bpy.types.Mesh) -> np.ndarray:
    """Which faces (f,) bool are selected and visible."""
    return _selected(mesh.polygons)


def _selected(elements: bpy.types.bpy_prop_collection) -> np.ndarray:
    selected, hidden = np.empty(len(elements), bool), np.empty(len(elements), bool)
    elements.foreach_get("select", selected)
    elements.foreach_get("hide", hidden)
    return selected & ~hidden


def group_weights(obj: bpy.types.Object, name: str) -> np.ndarray:
    """The weights (n,) float32 of a vertex group, 0 outside it; `KeyError` if there is no such group."""
    index = obj.vertex_groups[name].index
    weights = np.zeros(len(obj.data.vertices), np.float32)
    for vertex in obj.data.vertices:
        for element in vertex.groups:
            if element.group == index:
                weights[vertex.index] = element.weight
                break
    return weights


class Coordinates(Protocol):
    """Where a run reads the coordinates of one mesh and writes them back."""

    original: np.ndarray
    """The coordinates (n, 3) float32 as they were."""

    def write(self, coordinates: np.ndarray) -> None:
        """Store coordinates (n, 3) and have the viewport redrawn."""

    def restore(self) -> None:
        """Put back every bit that `write` changed."""


def open_coordinates(obj: bpy.types.Object) -> Coordinates:
    """The coordinates that Blender would edit: the edited mesh, the active shape key or the positions."""
    if obj.data.is_editmode:
        return _EditedCoordinates(obj)
    if obj.data.shape_keys is not None:
        return _KeyCoordinates(obj)
    return _PositionCoordinates(obj)


@once
def positions(mesh: bpy.types.Mesh) -> np.ndarray:
    """The positions (n, 3) float32 of the vertices, in Edit Mode by a slower way."""
    values = np.empty((len(mesh.vertices), 3), np.float32)
    return _read(mesh.attributes.get("position"), "vector", mesh.vertices, "co", values)


def _write_positions(mesh: bpy.types.Mesh, coordinates: np.ndarray) -> None:
    mesh.attributes["position"].data.foreach_set(
        "vector", np.ascontiguousarray(coordinates, np.float32).ravel()
    )


def _read_key(key: bpy.types.ShapeKey) -> np.ndarray:
    # Blender 5.2 takes any length for that of a key without points.
    values = np.empty(3 * len(key.data) if key.id_data.user.vertices else 0, np.float32)
    key.data.foreach_get("co", values)
    return values.reshape(-1, 3)


def key_coordinates(mesh: bpy.types.Mesh) -> dict[str, np.ndarray]:
    """The coordinates (n, 3) float32 of each shape key, by name; none without shape keys."""
    return {} if mesh.shape_keys is None else {key.name: _read_key(key) for key in mesh.shape_keys.key_blocks}


def _write_key(key: bpy.types.ShapeKey, coordinates: np.ndarray) -> None:
    key.data.foreach_set("co", np.ascontiguousarray(coordinates, np.float32).ravel())


class _PositionCoordinates:
    def __init__(self, obj: bpy.types.Object) -> None:
        self._object = obj
        self.original = positions(obj.data)

    def write(self, coordinates: np.ndarray) -> None:
        _write_positions(self._object.data, coordinates)
        self._object.data.update()

    def restore(self) -> None:
        self.write(self.original)


class _KeyCoordinates:
    """The active shape key; keys that are relative to it move along, as when Blender edits a basis."""

    def __init__(self, obj: bpy.types.Object) -> None:
        self._object = obj
        keys = obj.data.shape_keys
        active = active_key_index(obj)
        self._active = active
        self._moves_mesh = keys.key_blocks[active] == keys.reference_key
        self._mesh_original = positions(obj.data)
        self._dependent = {
            index: _read_key(keys.key_blocks[index]) for index in _dependent_keys(keys, active)
        }
        self.original = _read_key(keys.key_blocks[active])

    def write(self, coordinates: np.ndarray) -> None:
        coordinates = np.asarray(coordinates, np.float32)
        offset = coordinates - self.original
        self._store(coordinates, {index: key + offset for index, key in self._dependent.items()}, coordinates)

    def restore(self) -> None:
        self._store(self.original, self._dependent, self._mesh_original)

    def _store(self, active: np.ndarray, dependent: dict[int, np.ndarray], positions: np.ndarray) -> None:
        blocks = self._object.data.shape_keys.key_blocks
        _write_key(blocks[self._active], active)
        for index, coordinates in dependent.items():
            _write_key(blocks[index], coordinates)
        if self._moves_mesh:
            _write_positions(self._object.data, positions)
        self._object.data.update()


def active_key_index(obj: bpy.types.Object) -> int:
    """The index of the shape key that is edited: the active one, or the reference key if none is active."""
    active = obj.active_shape_key
    return 0 if active is None else obj.data.shape_keys.key_blocks.find(active.name)


def _dependent_keys(keys: bpy.types.Key, active: int) -> list[int]:
    """The indices of the keys that are relative to the active one, directly or through others."""
    if not keys.use_relative:
        return []
    blocks = keys.key_blocks
    relative_to = [blocks.find(block.relative_key.name) for block in blocks]
    marked = {active}
    grown = True
    while grown:
        new = {index for index, base in enumerate(relative_to) if base in marked and index not in marked}
        marked |= new
        grown = bool(new)
    return sorted(marked - {active})


class _EditedCoordinates:
    """The mesh in Edit Mode; its active shape key, if any, is what is edited."""

    def __init__(self, obj: bpy.types.Object) -> None:
        self._object = obj
        mesh = obj.data
        if mesh.shape_keys is not None:
            self.original = _read_key(mesh.shape_keys.key_blocks[active_key_index(obj)])
        else:
            values = np.empty(3 * len(mesh.vertices), np.float32)
            mesh.vertices.foreach_get("co", values)
            self.original = values.reshape(-1, 3)
        self._current = self.original

    def write(self, coordinates: np.ndarray) -> None:
        coordinates = np.ascontiguousarray(coordinates, np.float32)
        # Bits are compared, not numbers: so that restoring also tells 0 from -0.
        changed = np.flatnonzero((coordinates.view(np.uint32) != self._current.view(np.uint32)).any(axis=1))
        edited = bmesh.from_edit_mesh(self._object.data)
        edited.verts.ensure_lookup_table()
        for index, position in zip(changed.tolist(), coordinates[changed].tolist(), strict=True):
            edited.verts[index].co = position
        edited.normal_update()
        bmesh.update_edit_mesh(self._object.data, loop_triangles=True, destructive=False)
        self._current = coordinates

    def restore(self) -> None:
        self.write(self.original)


def add_shape_key(obj: bpy.types.Object, coordinates: np.ndarray, name: str) -> bpy.types.ShapeKey:
    """Store coordinates (n, 3) as a new active shape key, relative to the key that was active, with value 1.

    A mesh without shape keys gets its Basis first. Object Mode only.
    """
    if obj.data.shape_keys is None:
        obj.shape_key_add(name="Basis", from_mix=False)
    blocks = obj.data.shape_keys.key_blocks
    base = blocks[active_key_index(obj)].name
    key = obj.shape_key_add(name=name, from_mix=False)
    _write_key(key, coordinates)
    key.relative_key = blocks[base]
    key.value = 1.0
    obj.active_shape_key_index = len(blocks) - 1
    obj.data.update()
    return key


EDGE_MARKS = {
    "SHARP": ("sharp_edge", "BOOLEAN"),
    "CREASE": ("crease_edge", "FLOAT"),
    "BEVEL": ("bevel_weight_edge", "FLOAT"),
}
"""Blender's attribute and its type for each kind of edge mark."""


def mark_edges(mesh: bpy.types.Mesh, ridges: np.ndarray, kinds: Iterable[str]) -> None:
    """Mark the edges (k,) bool with each of the kinds of `EDGE_MARKS`; other edges keep their marks."""
    for kind in kinds:
        if mesh.is_editmode:
            _mark_edited_edges(mesh, ridges, kind)
        else:
            _mark_edge_attribute(mesh, ridges, kind)
    if not mesh.is_editmode:
        mesh.update()


def mark_seams(mesh: bpy.types.Mesh, borders: np.ndarray) -> None:
    """Mark the edges (k,) bool of a mesh in Object Mode as seams; other edges keep their marks."""
    marked = np.zeros(len(mesh.edges), bool)
    mesh.edges.foreach_get("use_seam", marked)
    mesh.edges.foreach_set("use_seam", marked | borders)


def _mark_edge_attribute(mesh: bpy.types.Mesh, ridges: np.ndarray, kind: str) -> None:
    name, data_type = EDGE_MARKS[kind]
    attribute = mesh.attributes.get(name) or mesh.attributes.new(name, data_type, "EDGE")
    values = np.empty(len(mesh.edges), bool if data_type == "BOOLEAN" else np.float32)
    attribute.data.foreach_get("value", values)
    values[ridges] = 1
    attribute.data.foreach_set("value", values)


def _mark_edited_edges(mesh: bpy.types.Mesh, ridges: np.ndarray, kind: str) -> None:
    edited = bmesh.from_edit_mesh(mesh)
    name, _ = EDGE_MARKS[kind]
    layer = None
    if kind != "SHARP":
        layer = edited.edges.layers.float.get(name) or edited.edges.layers.float.new(name)
    edited.edges.ensure_lookup_table()
    for index in np.flatnonzero(ridges).tolist():
        edge = edited.edges[index]
        if layer is None:
            edge.smooth = False
        else:
            edge[layer] = 1.0
    bmesh.update_edit_mesh(mesh, loop_triangles=False, destructive=False)
