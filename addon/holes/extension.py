# SPDX-License-Identifier: GPL-3.0-or-later
"""All that lies on a mesh, continued into the patches that fill its holes. No Blender data here."""

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from ..blender.attribute_io import limited
from ..blender.attribute_names import GROUP
from ..blender.mesh_layers import MIXED, SEAMS, Layer
from ..blender.welding import Weld
from .continuation import Continuation
from .surroundings import Patch, Surroundings

PATCH_NAME = "ridgeform_patch"
"""The face attribute that numbers the patches from 1 on; 0 are the faces that no patch holds."""


@dataclass
class Source:
    """A mesh of n vertices and what lies on it, as it was read."""

    coordinates: np.ndarray
    """Coordinates (n, 3) float32."""
    triangles: np.ndarray
    """Loop triangles (m, 3)."""
    ring: np.ndarray
    """The triangles (r, 3) around the holes."""
    ring_corners: np.ndarray
    """Their corners (r, 3)."""
    ring_faces: np.ndarray
    """The face (r,) of each."""
    edges: np.ndarray
    """Edges (k, 2)."""
    weld: Weld
    """The mesh with its split seams joined."""
    attributes: list[Layer]
    keys: dict[str, np.ndarray] = field(default_factory=dict)
    """Coordinates (n, 3) of each shape key."""
    near: np.ndarray = field(default_factory=lambda: np.empty(0, np.int64))
    """The vertices (v,), ascending, whose weights were read: those around the holes."""
    weights: dict[int, np.ndarray] = field(default_factory=dict)
    """For each vertex group that has any of them, their weights (v,), 0 where a vertex is not in it."""
    normals: np.ndarray | None = None
    """Normals (c, 3) of the corners, if the mesh has custom ones."""


@dataclass
class Extension:
    """What is appended to a mesh: values of the new elements, in their order."""

    patch: Patch
    edges: np.ndarray
    """Edges (q, 2) inside the patches; the new ones of the mesh."""
    attributes: list[Layer] = field(default_factory=list)
    keys: dict[str, np.ndarray] = field(default_factory=dict)
    """Coordinates (k, 3) of the new vertices in each shape key."""
    weights: dict[int, np.ndarray] = field(default_factory=dict)
    """Weights (k,) of the new vertices in each vertex group."""
    normals: np.ndarray | None = None
    """Normals (3 p, 3) of the new corners."""


class CancelledError(Exception):
    """The run was cancelled between two layers."""


def extend(source: Source, patch: Patch, material: str, is_cancelled: Callable[[], bool]) -> Extension:
    """Continue everything on a mesh into a patch; `material` is "CONTINUE" or "MAJORITY"."""
    around = Surroundings(source.coordinates, source.ring, source.weld, patch)
    work = _Work(source, patch, around, Continuation(around), material)
    result = Extension(patch, work.edges())
    for layer in source.attributes:
        if is_cancelled():
            raise CancelledError
        if layer.name != PATCH_NAME:
            result.attributes.append(Layer(layer.name, layer.data_type, layer.domain, work.layer(layer)))
    for name, coordinates in source.keys.items():
        offset = coordinates.astype(np.float64) - source.coordinates
        result.keys[name] = patch.points + work.of_points(offset)
    for group, weights in source.weights.items():
        full = np.zeros((len(source.coordinates), 1), np.float32)
        full[source.near, 0] = weights
        result.weights[group] = limited(GROUP, work.of_points(full))[:, 0]
    if source.normals is not None:
        result.normals = work.of_corners(source.normals)
    return result


@dataclass
class _Work:
    source: Source
    patch: Patch
    around: Surroundings
    continuation: Continuation
    material: str

    def layer(self, layer: Layer) -> np.ndarray:
        """The values of a layer on the new elements."""
        if layer.domain == "EDGE":
            return self._of_edges(layer)
        if layer.domain == "FACE":
            beside = layer.values[self.source.ring_faces]
            if layer.name == "material_index" and self.material == "MAJORITY":
                return self.continuation.majority(beside)
            return self.continuation.faces(beside)
        if layer.data_type not in MIXED:
            return self._nearest(layer)
        values = self.of_points(layer.values) if layer.domain == "POINT" else self.of_corners(layer.values)
        return limited(layer.data_type, values).astype(layer.values.dtype)

    def of_points(self, values: np.ndarray) -> np.ndarray:
        """Values (k, c) of the new vertices from those (n, c) of the mesh's."""
        return self.continuation.points(values[self.source.ring.ravel()])

    def of_corners(self, values: np.ndarray) -> np.ndarray:
        """Values (3 p, c) of the new corners from those (l, c) of the mesh's."""
        return self.continuation.corners(values[self.source.ring_corners.ravel()])

    def edges(self) -> np.ndarray:
        """The edges (q, 2) inside the patches, in vertices of the mesh."""
        rows = np.flatnonzero(self.around.inside)
        corners = np.stack([self.around.start_corners[rows, 0], self.around.end_corners[rows, 0]], axis=1)
        return self.patch.triangles.ravel()[corners - 3 * self.around.n_ring]

    def _nearest(self, layer: Layer) -> np.ndarray:
        around = self.around
        corner = self.continuation.nearest_corners()
        if layer.domain == "CORNER":
            return layer.values[self.source.ring_corners.ravel()[corner]]
        vertex = around.triangles[around.n_ring :].ravel()
        new = around.is_new[vertex]
        values = np.zeros((int(around.is_new.sum()), layer.values.shape[1]), layer.values.dtype)
        at = self.source.ring.ravel()[corner[new]]
        values[around.new_index[vertex[new]]] = layer.values[at]
        return values

    def _of_edges(self, layer: Layer) -> np.ndarray:
        """Marks that end at a hole go on along ridges of its patch; seams also where there is no ridge."""
        around, border = self.around, self.around.border
        values = np.zeros((int(around.inside.sum()), layer.values.shape[1]), layer.values.dtype)
        marked = np.flatnonzero(layer.values.any(axis=1))
        ends = np.searchsorted(around.vertex, self.source.weld.vertex[self.source.edges[marked]])
        ends = np.minimum(ends, len(around.vertex) - 1)
        here = around.vertex[ends] == self.source.weld.vertex[self.source.edges[marked]]
        size = len(around.vertex)
        key = ends.min(axis=1) * size + ends.max(axis=1)
        of_border = np.minimum(border.start, border.end) * size + np.maximum(border.start, border.end)
        here &= ~np.isin(key, of_border)[:, None]
        on_border = here & np.isin(ends, border.start)
        marks = self.continuation.marks(np.unique(ends[on_border]), layer.name not in SEAMS)
        rows = marks[around.inside]
        if rows.any():
            values[rows] = layer.values[marked[on_border.any(axis=1)]].max(axis=0)
        return values
