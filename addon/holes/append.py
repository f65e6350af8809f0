# SPDX-License-Identifier: GPL-3.0-or-later
"""The border between Blender and NumPy for patches: appending them to a mesh, with all that lies on it.

Object Mode only.
"""

import bpy
import numpy as np

from ..blender import mesh_io
from ..blender.mesh_layers import ATTRIBUTE_KINDS, Layer
from .extension import PATCH_NAME, Extension
from .growing import grow


def append(obj: bpy.types.Object, extension: Extension) -> np.ndarray:
    """Append new triangles to the mesh of an object and select just them; returns their edges (k,) bool.

    What the mesh has keeps its place and every bit; only custom normals, which Blender stores relative to the
    faces, are stored anew.
    """
    mesh = obj.data
    sizes = _Sizes(mesh)
    normals = sharp = None
    if extension.normals is not None:
        normals, sharp = _corner_normals(mesh), _sharp_edges(mesh)
    made = grow(obj, extension)
    for layer in extension.attributes:
        values = layer.values[made] if layer.domain == "EDGE" else layer.values
        _write_tail(_attribute(mesh, layer), values, sizes.of(layer.domain))
    _number_patches(mesh, extension.patch.hole, sizes.faces)
    if normals is not None:
        mesh.normals_split_custom_set(np.concatenate([normals, _unit(extension.normals)]).tolist())
        _restore_sharp_edges(mesh, sharp)
    touched = _select_tail(mesh, sizes)
    mesh.update()
    return touched


class _Sizes:
    """How many elements a mesh has."""

    def __init__(self, mesh: bpy.types.Mesh) -> None:
        self.vertices, self.edges = len(mesh.vertices), len(mesh.edges)
        self.corners, self.faces = len(mesh.loops), len(mesh.polygons)

    def of(self, domain: str) -> int:
        return {"POINT": self.vertices, "EDGE": self.edges, "CORNER": self.corners, "FACE": self.faces}[
            domain
        ]


def _attribute(mesh: bpy.types.Mesh, layer: Layer) -> bpy.types.Attribute:
    """The attribute of a layer; a BMesh drops some of Blender's own that are nowhere set."""
    return mesh.attributes.get(layer.name) or mesh.attributes.new(layer.name, layer.data_type, layer.domain)


def _write_tail(attribute: bpy.types.Attribute, values: np.ndarray, start: int) -> None:
    """Write values (t, c) to the elements of an attribute from `start` on."""
    prop, dtype, size = ATTRIBUTE_KINDS[attribute.data_type]
    full = np.empty(len(attribute.data) * size, dtype)
    attribute.data.foreach_get(prop, full)
    full[start * size : (start + len(values)) * size] = values.ravel()
    attribute.data.foreach_set(prop, full)


def _number_patches(mesh: bpy.types.Mesh, hole: np.ndarray, first: int) -> None:
    attribute = mesh.attributes.get(PATCH_NAME)
    if attribute is None or (attribute.data_type, attribute.domain) != ("INT", "FACE"):
        attribute = mesh.attributes.new(PATCH_NAME, "INT", "FACE")
    numbers = np.empty(len(mesh.polygons), np.int32)
    attribute.data.foreach_get("value", numbers)
    numbers[first:] = hole + 1 + max(int(numbers[:first].max(initial=0)), 0)
    attribute.data.foreach_set("value", numbers)


def _corner_normals(mesh: bpy.types.Mesh) -> np.ndarray:
    values = np.empty(3 * len(mesh.loops), np.float32)
    mesh.corner_normals.foreach_get("vector", values)
    return values.reshape(-1, 3)


def _unit(vectors: np.ndarray) -> np.ndarray:
    """Vectors (k, 3) of length 1; Blender takes 0 for its own normal."""
    length = np.linalg.norm(vectors, axis=1, keepdims=True)
    return np.divide(vectors, length, out=np.zeros_like(vectors), where=length > 0)


def _sharp_edges(mesh: bpy.types.Mesh) -> np.ndarray:
    values = np.empty(len(mesh.edges), bool)
    mesh.edges.foreach_get("use_edge_sharp", values)
    return values


def _restore_sharp_edges(mesh: bpy.types.Mesh, old: np.ndarray) -> None:
    """Setting custom normals marks edges sharp where normals jump: the mesh's own keep the marks they had."""
    values = _sharp_edges(mesh)
    values[: len(old)] = old
    mesh.edges.foreach_set("use_edge_sharp", values)


def _select_tail(mesh: bpy.types.Mesh, sizes: _Sizes) -> np.ndarray:
    """Select the faces from `sizes.faces` on, their edges and vertices, nothing else; returns those edges."""
    vertices, edges = mesh_io.corner_vertices(mesh), mesh_io.corner_edges(mesh)
    of_vertices, of_edges, of_faces = (
        np.zeros(len(kind), bool) for kind in (mesh.vertices, mesh.edges, mesh.polygons)
    )
    of_vertices[vertices[sizes.corners :]] = True
    of_edges[edges[sizes.corners :]] = True
    of_faces[sizes.faces :] = True
    _write_booleans(mesh, ".select_vert", "POINT", of_vertices)
    _write_booleans(mesh, ".select_edge", "EDGE", of_edges)
    _write_booleans(mesh, ".select_poly", "FACE", of_faces)
    return of_edges


def _write_booleans(mesh: bpy.types.Mesh, name: str, domain: str, values: np.ndarray) -> None:
    attribute = mesh.attributes.get(name) or mesh.attributes.new(name, "BOOLEAN", domain)
    attribute.data.foreach_set("value", values)
