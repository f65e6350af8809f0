# SPDX-License-Identifier: GPL-3.0-or-later
"""The border between Blender and NumPy where a mesh gets other faces: what it was, what it becomes."""

from dataclasses import dataclass, replace

import bpy
import numpy as np

from . import kept_normals, mesh_io, mesh_layers, selected_elements
from .carrying import Triangulation
from .mesh_layers import ATTRIBUTE_KINDS, Layers
from .mesh_state import ChangedError
from .polygons import Polygons


@dataclass
class Before:
    """A mesh as it is before its faces are replaced: its triangles, and all that lies on it."""

    old: Triangulation
    polygons: Polygons
    """Its faces."""
    layers: Layers
    normals: np.ndarray | None
    """The normals (c, 3) of its corners, if it has custom ones."""

    @property
    def n_loose(self) -> int:
        """How many vertices have no face."""
        used = np.bincount(self.old.triangles.ravel(), minlength=len(self.old.coordinates))
        return int((used == 0).sum())

    def kept_normals(self, points: np.ndarray, faces: Polygons, coordinates: np.ndarray) -> np.ndarray | None:
        """The normals (d, 3) of the corners of other faces, given the mesh's coordinates (n, 3) of now."""
        if self.normals is None:
            return None
        old = replace(self.old, coordinates=coordinates)
        return kept_normals.kept(self.normals, old, self.polygons, points, faces)


@dataclass
class Rebuilt:
    """What a mesh becomes: points (p, 3), faces, and what lies on them, edges in the order of the faces'."""

    points: np.ndarray
    faces: Polygons
    layers: Layers
    note: str = ""
    """What is to be said of it."""
    normals: np.ndarray | None = None
    """The normals (d, 3) of its corners, 0 where they are not custom ones; `None` where none were before."""


def reason_against(mesh: bpy.types.Mesh, leaves_mesh: bool = False) -> str | None:
    """Why the faces of a mesh cannot be replaced; `None` if they can.

    `leaves_mesh`: the mesh is to stay as it is.
    """
    if mesh.is_editmode:
        return "that works only in Object Mode"
    if leaves_mesh:
        return "Result leaves the mesh as it is"
    if mesh.shape_keys is not None:
        return "the mesh has shape keys"
    return None


def read(obj: bpy.types.Object) -> Before:
    """Read the mesh of an object in Object Mode."""
    mesh = obj.data
    of_triangles = mesh_io.triangle_corners(mesh)
    old = Triangulation(
        mesh_io.corner_vertices(mesh)[of_triangles],
        of_triangles,
        mesh_io.triangle_faces(mesh),
        mesh_io.edges(mesh),
        mesh_io.positions(mesh).astype(np.float64),
    )
    starts, corners, _ = mesh_io.face_corners(mesh)
    return Before(old, Polygons(corners, starts), mesh_layers.read_layers(obj), kept_normals.read(mesh))


def check(obj: bpy.types.Object, before: Before) -> None:
    """`ChangedError` if other things lie on the mesh of an object than were read, which would be lost."""
    if not before.layers.same_as(mesh_layers.read_layers(obj)):
        raise ChangedError(
            f'"{obj.name}" was changed meanwhile, its attributes are others: it stays as it is now'
        )


def write(obj: bpy.types.Object, made: Rebuilt) -> np.ndarray:
    """Give the mesh of an object other points, faces and layers; its materials stay.

    Returned is the row (k,) in the edges of the faces of each edge of the mesh. Normals come last, by
    `kept_normals.write`, when edges are marked.
    """
    mesh, faces = obj.data, made.faces
    mesh.clear_geometry()
    mesh.vertices.add(len(made.points))
    mesh.edges.add(len(faces.loose))
    mesh.loops.add(len(faces.corners))
    mesh.polygons.add(len(faces))
    mesh.vertices.foreach_set("co", np.ascontiguousarray(made.points, np.float32).ravel())
    mesh.edges.foreach_set("vertices", np.ascontiguousarray(faces.loose, np.int32).ravel())
    mesh.polygons.foreach_set("loop_start", np.ascontiguousarray(faces.starts, np.int32))
    mesh.loops.foreach_set("vertex_index", np.ascontiguousarray(faces.corners, np.int32))
    mesh.update(calc_edges=True)
    selected_elements.mend(mesh)
    edge_rows = _edge_rows(mesh, faces.edges)
    for layer in made.layers.attributes:
        values = layer.values[edge_rows] if layer.domain == "EDGE" else layer.values
        attribute = mesh.attributes.get(layer.name)
        if attribute is None:
            attribute = mesh.attributes.new(layer.name, layer.data_type, layer.domain)
        attribute.data.foreach_set(ATTRIBUTE_KINDS[layer.data_type][0], np.ascontiguousarray(values).ravel())
    mesh_layers.write_groups(obj, made.layers.groups, made.layers.active["group"])
    mesh_layers.set_active_layers(mesh, made.layers.active)
    if mesh.validate():
        edge_rows = _edge_rows(mesh, faces.edges)
    mesh.update()
    return edge_rows


def _edge_rows(mesh: bpy.types.Mesh, ends: np.ndarray) -> np.ndarray:
    """The row in `ends`, which are sorted, of each edge of the mesh: Blender numbers edges as it likes."""
    made = np.empty(2 * len(mesh.edges), np.int32)
    mesh.edges.foreach_get("vertices", made)
    keys = (
        rows[:, 0].astype(np.int64) * len(mesh.vertices) + rows[:, 1]
        for rows in (ends, np.sort(made.reshape(-1, 2)))
    )
    return np.searchsorted(*keys)
