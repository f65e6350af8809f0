# SPDX-License-Identifier: GPL-3.0-or-later
"""What writing a result replaces of a mesh beside its coordinates: edge marks, shape keys, faces."""

import bmesh
import bpy
import numpy as np

from . import blending, mesh_io, mesh_layers, selected_elements


class MeshBackup:
    """The marks of a mesh in Object Mode, how many shape keys it has, and its faces if they are replaced.

    Nothing of it is in Blender's file: it does not outlive an undo step, and nothing is saved.
    """

    def __init__(self, obj: bpy.types.Object, faces: bool) -> None:
        """Take what the mesh of an object has now."""
        self._object = obj
        mesh = obj.data
        self._marks = {name: _edge_values(mesh, name) for name, _ in mesh_io.EDGE_MARKS.values()}
        self._n_keys = 0 if mesh.shape_keys is None else len(mesh.shape_keys.key_blocks)
        self._active_key = obj.active_shape_key_index
        self._result = blending.stored(mesh)
        self._blends = blending.modifier_of(obj) is not None
        self._faces: bmesh.types.BMesh | None = None
        if faces:
            # The whole mesh with all that lies on it, as Blender itself copies it.
            self._faces = bmesh.new()
            self._faces.from_mesh(mesh)
            self._active = mesh_layers.active_layers(mesh)
            self._flags = [_flags(items) for items in _elements(mesh)]

    def put_back(self) -> None:
        """Put it back; coordinates are not a part of it."""
        mesh = self._object.data
        if self._faces is not None:
            self._faces.to_mesh(mesh)
            mesh_layers.set_active_layers(mesh, self._active)
            # The copy has made these agree with each other.
            for items, flags in zip(_elements(mesh), self._flags, strict=True):
                for name, values in flags.items():
                    # Newer versions make an attribute of what is set, even if nothing is hidden.
                    if np.array_equal(values, _flags(items)[name]):
                        continue
                    if name == "select":
                        selected_elements.write(mesh, items, values)
                    else:
                        items.foreach_set(name, values)
        self._remove_keys()
        for name, values in self._marks.items():
            attribute = mesh.attributes.get(name)
            if values is None:
                if attribute is not None:
                    mesh.attributes.remove(attribute)
            elif attribute is not None:
                attribute.data.foreach_set("value", values)
        self._put_back_result()
        mesh.update()

    def _put_back_result(self) -> None:
        now = blending.stored(self._object.data)
        if (now is None) != (self._result is None) or not np.array_equal(now, self._result):
            blending.store(self._object.data, self._result)
        modifier = blending.modifier_of(self._object)
        if modifier is not None and not self._blends:
            self._object.modifiers.remove(modifier)

    def _remove_keys(self) -> None:
        keys = self._object.data.shape_keys
        if keys is None or len(keys.key_blocks) == self._n_keys:
            return
        if self._n_keys == 0:
            self._object.shape_key_clear()
            return
        for key in list(keys.key_blocks)[self._n_keys :]:
            self._object.shape_key_remove(key)
        self._object.active_shape_key_index = self._active_key


def _elements(mesh: bpy.types.Mesh) -> tuple[bpy.types.bpy_prop_collection, ...]:
    return mesh.vertices, mesh.edges, mesh.polygons


def _flags(items: bpy.types.bpy_prop_collection) -> dict[str, np.ndarray]:
    flags = {}
    for name in ("hide", "select"):
        flags[name] = np.empty(len(items), bool)
        items.foreach_get(name, flags[name])
    return flags


def _edge_values(mesh: bpy.types.Mesh, name: str) -> np.ndarray | None:
    attribute = mesh.attributes.get(name)
    if attribute is None:
        return None
    values = np.empty(len(mesh.edges), bool if attribute.data_type == "BOOLEAN" else np.float32)
    attribute.data.foreach_get("value", values)
    return values
