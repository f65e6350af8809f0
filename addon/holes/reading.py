# SPDX-License-Identifier: GPL-3.0-or-later
"""The border between Blender and NumPy for patches: reading a mesh and what lies on it. Object Mode only."""

import bpy
import numpy as np

from ..blender import mesh_io, mesh_layers
from ..blender.welding import Weld
from .extension import Source
from .surroundings import ring_triangles

FLAT = "sharp_face"
"""Blender's attribute of the faces that are not shaded smooth."""


def read_source(
    mesh: bpy.types.Mesh, coordinates: np.ndarray, triangles: np.ndarray, weld: Weld, rims: np.ndarray
) -> Source:
    """Read a mesh with coordinates (n, 3), those of `reference_coordinates`, and loop triangles (m, 3).

    Of vertex groups only what lies around `rims` (r,) is read, welded vertices.
    """
    ring = np.intersect1d(np.flatnonzero(ring_triangles(weld.of(triangles), rims)), weld.rows)
    near = np.unique(triangles[ring])
    return Source(
        coordinates,
        triangles,
        triangles[ring],
        mesh_io.triangle_corners(mesh)[ring],
        mesh_io.triangle_faces(mesh)[ring],
        mesh_io.edges(mesh),
        weld,
        _read_attributes(mesh),
        mesh_io.key_coordinates(mesh),
        near,
        _read_weights(mesh, near),
        _read_normals(mesh),
    )


def reference_coordinates(mesh: bpy.types.Mesh) -> np.ndarray:
    """Coordinates (n, 3) float32 of a mesh: those of its reference key if it has shape keys."""
    if mesh.shape_keys is not None:
        return mesh_io.key_coordinates(mesh)[mesh.shape_keys.reference_key.name]
    values = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.attributes["position"].data.foreach_get("vector", values)
    return values.reshape(-1, 3)


def picked_edges(mesh: bpy.types.Mesh) -> np.ndarray:
    """The edges (k, 2) that are selected and visible."""
    selected, hidden = np.empty(len(mesh.edges), bool), np.empty(len(mesh.edges), bool)
    mesh.edges.foreach_get("select", selected)
    mesh.edges.foreach_get("hide", hidden)
    return mesh_io.edges(mesh)[selected & ~hidden]


def _read_attributes(mesh: bpy.types.Mesh) -> list[mesh_layers.Layer]:
    layers = mesh_layers.read_attributes(mesh)
    if not any(layer.name == FLAT for layer in layers):
        # Without the attribute all faces are smooth; new ones would not be.
        smooth = np.zeros((len(mesh.polygons), 1), bool)
        layers.append(mesh_layers.Layer(FLAT, "BOOLEAN", "FACE", smooth))
    return layers


def _read_weights(mesh: bpy.types.Mesh, vertices: np.ndarray) -> dict[int, np.ndarray]:
    weights: dict[int, np.ndarray] = {}
    for row, vertex in enumerate(vertices.tolist()):
        for element in mesh.vertices[vertex].groups:
            of_group = weights.setdefault(element.group, np.zeros(len(vertices), np.float32))
            of_group[row] = element.weight
    return weights


def _read_normals(mesh: bpy.types.Mesh) -> np.ndarray | None:
    if not mesh.has_custom_normals:
        return None
    values = np.empty(3 * len(mesh.loops), np.float32)
    mesh.corner_normals.foreach_get("vector", values)
    return values.reshape(-1, 3)
