# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether a mesh is still what a tool has read: scripts, timers and other windows can change it meanwhile."""

from collections.abc import Iterator

import bmesh
import bpy
import numpy as np

from . import mesh_io

INTERNAL = "."
"""What the names of attributes begin with that Blender keeps for itself: selection, hiding, connectivity."""


class ChangedError(Exception):
    """A mesh that is no longer what a tool has read; the message says what is different."""


class MeshState:
    """What a mesh was like when it was read or last written."""

    def __init__(self, obj: bpy.types.Object) -> None:
        """Take the state that the mesh of an object has now, in the mode that it is in."""
        self._object = obj
        self._name = obj.name
        self._mode = _mode(obj)
        self._mesh = obj.data.as_pointer()
        self._counts = _counts(obj.data)
        self._layout = _layout(obj)
        self._connections = _connections(obj)
        self._coordinates = _coordinates(obj)

    def take_coordinates(self) -> None:
        """Take the coordinates that the mesh has now for its own: the tool has just written them."""
        self._coordinates = _coordinates(self._object)

    def check(self, thorough: bool = True) -> None:
        """`ChangedError` if anything is different.

        Without `thorough` only what takes no time on a large mesh: which mesh it is, its mode, and what it is
        made of, but neither connections nor coordinates.
        """
        try:
            # The first one only: the next may not make sense any more.
            reason = next(self._differences(thorough), None)
        except ReferenceError:
            reason = "it was deleted"
        if reason is not None:
            raise ChangedError(f'"{self._name}" was changed meanwhile, {reason}: it stays as it is now')

    def _differences(self, thorough: bool) -> Iterator[str]:
        obj = self._object
        if _mode(obj) != self._mode:
            yield "its mode was switched"
        if obj.data is None or obj.data.as_pointer() != self._mesh:
            yield "it has another mesh"
        if mesh_io.is_out_of_reach(obj):
            yield "it was hidden or is no longer active, and its mode cannot be left then"
        if not obj.data.is_editable:
            yield "it cannot be edited any more"
        for what, count in _counts(obj.data).items():
            if count != self._counts[what]:
                yield f"it has {count} {what} instead of {self._counts[what]}"
        for what, names in _layout(obj).items():
            if names != self._layout[what]:
                yield f"its {what} are others"
        if not thorough:
            return
        if not obj.users_scene:
            yield "it is in no scene any more"
        if not _same(_connections(obj), self._connections):
            yield "its faces connect other vertices"
        if not _same(_coordinates(obj), self._coordinates):
            yield "its vertices were moved"


def _same(arrays: list[np.ndarray], others: list[np.ndarray]) -> bool:
    # Bits, not numbers: NaN is the same as itself.
    pairs = zip(arrays, others, strict=False)
    return len(arrays) == len(others) and all(
        np.array_equal(a.view(np.uint32), b.view(np.uint32)) for a, b in pairs
    )


def _mode(obj: bpy.types.Object) -> object:
    # A mesh is in Edit Mode for all objects that share it.
    return obj.mode, obj.data is not None and obj.data.is_editmode


def _counts(mesh: bpy.types.Mesh) -> dict[str, int]:
    if mesh.is_editmode:
        edited = bmesh.from_edit_mesh(mesh)
        return {"vertices": len(edited.verts), "edges": len(edited.edges), "faces": len(edited.faces)}
    return {"vertices": len(mesh.vertices), "edges": len(mesh.edges), "faces": len(mesh.polygons)}


def _layout(obj: bpy.types.Object) -> dict[str, object]:
    mesh, keys = obj.data, obj.data.shape_keys
    layers = (layer for layer in mesh.attributes if not layer.name.startswith(INTERNAL))
    return {
        "attributes": {(layer.name, layer.domain, layer.data_type) for layer in layers},
        "vertex groups": obj.vertex_groups.keys(),
        "shape keys": keys and (keys.key_blocks.keys(), mesh_io.active_key_index(obj), keys.use_relative),
    }


def _connections(obj: bpy.types.Object) -> list[np.ndarray]:
    mesh_io.flush_edit_mode(obj)
    starts, vertices, edges = mesh_io.face_corners(obj.data)
    return [starts, vertices, edges, mesh_io.edges(obj.data).ravel()]


def _coordinates(obj: bpy.types.Object) -> list[np.ndarray]:
    mesh_io.flush_edit_mode(obj)
    return [mesh_io.positions(obj.data).ravel(), *map(np.ravel, mesh_io.key_coordinates(obj.data).values())]
