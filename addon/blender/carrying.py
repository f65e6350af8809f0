# SPDX-License-Identifier: GPL-3.0-or-later
"""Carrying all that lies on a mesh over to faces that take the place of its own. No Blender data here."""

from dataclasses import dataclass

import numpy as np
from mathutils.bvhtree import BVHTree

from .mesh_layers import FLAGS, MARKS, MIXED, Group, Layer, Layers
from .polygons import Polygons
from .surface_map import SurfaceMap, own_unit

ON_MARK = 0.15
"""A new edge takes a mark if ends and middle lie this close to marked edges, in parts of its length."""


@dataclass
class Triangulation:
    """The loop triangles (m, 3), their corners (m, 3) and faces (m,), edges (k, 2) and coordinates (n, 3)."""

    triangles: np.ndarray
    corners: np.ndarray
    faces: np.ndarray
    edges: np.ndarray
    coordinates: np.ndarray


@dataclass
class MarkedEdges:
    """What new edges have of old ones, where that is known and not to be found by where they lie."""

    ends: np.ndarray
    """The ends (c, 2) of edges that were edges of the mesh before, or are in the place of several."""
    edge: np.ndarray
    """Which of them (c,), -1 for none."""


@dataclass
class Kept:
    """What stays as it was: the old vertex (p,), face (q,) and corner (c,) of each new one, -1 for none."""

    vertex: np.ndarray
    face: np.ndarray
    corner: np.ndarray


def carried(
    source: Layers,
    old: Triangulation,
    surface: SurfaceMap,
    points: np.ndarray,
    faces: Polygons,
    *,
    anchors: np.ndarray,
    marked: MarkedEdges | None = None,
    kept: Kept | None = None,
) -> Layers:
    """The layers of new points (p, 3) and faces, each value from the nearest old place.

    For faces and corners that is on the chart of the old triangle (q,) in `anchors`. Marks of edges are those
    of the edges `marked` and no others; without these, of marked edges where a new one lies. What is `kept`
    has its own values; nothing else is selected or hidden.
    """
    places = _Places(old, surface, points, faces, anchors=anchors, kept=kept)
    attributes = [
        Layer(layer.name, layer.data_type, layer.domain, places.values(layer, marked))
        for layer in source.attributes
    ]
    groups = [Group(group.name, group.locked, places.weights(group.weights)) for group in source.groups]
    return Layers(attributes, groups, source.active)


class _Places:
    """Where new points, faces, corners and edges lie on the old mesh."""

    def __init__(
        self,
        old: Triangulation,
        surface: SurfaceMap,
        points: np.ndarray,
        faces: Polygons,
        *,
        anchors: np.ndarray,
        kept: Kept | None,
    ) -> None:
        self._old, self._points, self._faces = old, points, faces
        if kept is None:
            kept = Kept(*(np.full(count, -1) for count in (len(points), len(faces), len(faces.corners))))
        self._kept = kept
        self._edge = self._kept_edges()
        self._new_points = np.flatnonzero(kept.vertex < 0)
        self._new_faces = np.flatnonzero(kept.face < 0)
        self._new_corners = np.flatnonzero(kept.corner < 0)
        middles = faces.middles(points)[self._new_faces]
        self._face_triangle, _ = surface.nearest_on_chart_of(anchors[self._new_faces], middles)
        self._point_triangle, self._point_weights = surface.nearest(points[self._new_points])
        of_face = np.zeros(len(faces), np.int64)
        of_face[self._new_faces] = self._face_triangle
        self._corner_triangle, self._corner_weights = surface.nearest_on_chart_of(
            of_face[faces.faces[self._new_corners]], points[faces.corners[self._new_corners]]
        )

    def _kept_edges(self) -> np.ndarray:
        """The old edge (k,) that each new one is, -1 for none."""
        ends, n = self._faces.edges, len(self._old.coordinates)
        before = np.sort(self._old.edges, axis=1).astype(np.int64) @ [n, 1]
        order = np.argsort(before)
        now = np.sort(self._kept.vertex[ends], axis=1)
        keys = now.astype(np.int64) @ [n, 1]
        place = np.minimum(np.searchsorted(before[order], keys), len(before) - 1)
        if len(before) == 0:
            return np.full(len(ends), -1)
        known = (now[:, 0] >= 0) & (before[order[place]] == keys)
        return np.where(known, order[place], -1)

    def values(self, layer: Layer, marked: MarkedEdges | None) -> np.ndarray:
        """The values of a layer."""
        old = self._old
        if layer.name in FLAGS:
            kept = {"POINT": self._kept.vertex, "EDGE": self._edge, "FACE": self._kept.face}
            return self._filled(layer, kept[layer.domain], np.zeros(1, bool))
        if layer.domain == "FACE":
            return self._filled(layer, self._kept.face, layer.values[old.faces[self._face_triangle]])
        if layer.domain == "POINT":
            made = _mixed(layer, old.triangles[self._point_triangle], self._point_weights)
            return self._filled(layer, self._kept.vertex, made)
        if layer.domain == "CORNER":
            made = _mixed(layer, old.corners[self._corner_triangle], self._corner_weights)
            return self._filled(layer, self._kept.corner, made)
        if layer.name in MARKS and marked is not None:
            return _anchored(layer, marked, self._faces.edges)
        new = self._faces.edges[self._edge < 0]
        return self._filled(layer, self._edge, _marks(layer, old, self._points, new))

    def _filled(self, layer: Layer, kept: np.ndarray, made: np.ndarray) -> np.ndarray:
        """The old values of what is kept, and those that were made for the others."""
        values = np.empty((len(kept), layer.values.shape[1]), layer.values.dtype)
        values[kept < 0] = made
        values[kept >= 0] = layer.values[kept[kept >= 0]]
        return values

    def weights(self, group: np.ndarray) -> np.ndarray:
        """The weights (p,) of a vertex group (n,)."""
        kept = self._kept.vertex
        weights = np.empty(len(kept), group.dtype)
        weights[kept < 0] = _mixed_group(
            group, self._old.triangles[self._point_triangle], self._point_weights
        )
        weights[kept >= 0] = group[kept[kept >= 0]]
        return weights


def _mixed(layer: Layer, elements: np.ndarray, weights: np.ndarray) -> np.ndarray:
    values = layer.values[elements]
    if layer.data_type in MIXED:
        return np.einsum("ijk,ij->ik", values, weights).astype(layer.values.dtype)
    return values[np.arange(len(elements)), weights.argmax(axis=1)]


def _mixed_group(group: np.ndarray, elements: np.ndarray, weights: np.ndarray) -> np.ndarray:
    values = group[elements]
    mixed = (np.nan_to_num(values) * weights).sum(axis=1)
    member = ~np.isnan(values[np.arange(len(elements)), weights.argmax(axis=1)])
    return np.where(member, mixed, np.nan)


def _anchored(layer: Layer, marked: MarkedEdges, ends: np.ndarray) -> np.ndarray:
    """The values of marks on edges `ends` (k, 2), which are sorted."""
    values = np.zeros((len(ends), layer.values.shape[1]), layer.values.dtype)
    known = marked.edge >= 0
    n = int(ends.max(initial=0)) + 1
    keys = np.sort(marked.ends[known], axis=1).astype(np.int64) @ [n, 1]
    rows = np.searchsorted(ends.astype(np.int64) @ [n, 1], keys)
    values[rows] = layer.values[marked.edge[known]]
    return values


def _marks(layer: Layer, old: Triangulation, points: np.ndarray, ends: np.ndarray) -> np.ndarray:
    rows = np.flatnonzero(layer.values.any(axis=1))
    values = np.zeros((len(ends), layer.values.shape[1]), layer.values.dtype)
    if len(rows) == 0:
        return values
    unit = own_unit(old.coordinates[old.edges[rows]])
    lines = [(a, b, b) for a, b in old.edges[rows].tolist()]
    tree = BVHTree.FromPolygons(np.ldexp(old.coordinates, -unit).tolist(), lines, all_triangles=True)
    points = np.ldexp(points, -unit)
    lengths = np.linalg.norm(points[ends[:, 0]] - points[ends[:, 1]], axis=1)
    middles = points[ends].mean(axis=1)
    for row, (a, b) in enumerate(ends.tolist()):
        reach = ON_MARK * lengths[row]
        hits = [tree.find_nearest(place.tolist(), reach) for place in (points[a], points[b], middles[row])]
        if all(hit[0] is not None for hit in hits):
            values[row] = layer.values[rows[hits[2][2]]]
    return values
