# SPDX-License-Identifier: GPL-3.0-or-later
"""What a mesh becomes whose own vertices and faces go onto facets. No Blender data here."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import ridgeform

from ..blender.carrying import Kept, carried
from ..blender.mesh_layers import Layer
from ..blender.mirroring import Plane
from ..blender.polygons import Polygons
from ..blender.rebuilding import Before, Rebuilt
from ..blender.surface_map import SurfaceMap
from ..blender.welding import Weld
from . import facet_places
from .ridges import face_normals

DIAGONAL = 1e6
"""How much dearer than along an edge a border is through a face of more than three corners, which it would
bend: so much that faces are whole before anything else merges."""


def kept(
    before: Before,
    weld: Weld,
    found: ridgeform.Faceted,
    coordinates: np.ndarray,
    *,
    planes: Sequence[Plane],
    flags: Sequence[Layer],
    flips: bool,
) -> tuple[Rebuilt, np.ndarray, Kept]:
    """The mesh at coordinates (n, 3) on the facets that were found for it, and the facet (q,) of each face.

    All of it stays, vertices in their order; `flips`: with the edges flipped that would fold faces. Faces
    that such an edge parts become triangles. The facet is -1 for faces that stay where they are. `planes` are
    those of mirrors that borders lie on, `flags` what is selected and hidden.
    """
    points = on_facets(weld, found, coordinates, planes)
    corners = before.old.corners.copy()
    if flips:
        corners[weld.rows] = before.old.corners[weld.rows].ravel()[np.asarray(found.kept_corners)]
    label = np.full(len(corners), -1, np.int64)
    label[weld.rows] = np.where(found.labels < found.n_facets, found.labels, -1)
    faces, stays, facets = _faces(before, corners, label, points)
    old = replace(before.old, coordinates=coordinates.astype(np.float64))
    surface = SurfaceMap(old.coordinates, old.triangles, np.zeros(len(old.triangles), np.int64))
    layers = replace(before.layers, attributes=[*before.layers.attributes, *flags])
    first = np.searchsorted(old.faces, stays.face)
    values = carried(layers, old, surface, points, faces, anchors=first, kept=stays)
    normals = before.kept_normals(points, faces, coordinates)
    note = _note(found, faces, facets, points, len(faces) - len(before.polygons))
    return Rebuilt(points, faces, values, note, normals), facets, stays


def along_faces(
    corners: np.ndarray, starts: np.ndarray, sizes: np.ndarray, weights: np.ndarray | None = None
) -> np.ndarray | None:
    """Edge weights (l, 3), or `None`, with which facets do not run through faces that stay whole.

    `corners` (l, 3) are those of triangles, `starts` and `sizes` (l,) say where the corners of their faces
    begin, and how many these have.
    """
    if (sizes == 3).all():
        return weights
    # Column i is the edge opposite corner i.
    one, other = (corners[:, [1, 2, 0]] - starts[:, None], corners[:, [2, 0, 1]] - starts[:, None])
    apart = (one - other) % sizes[:, None]
    is_diagonal = (apart != 1) & (apart != sizes[:, None] - 1)
    return np.where(is_diagonal, DIAGONAL, 1.0) * (1.0 if weights is None else weights)


def on_facets(
    weld: Weld, found: ridgeform.Faceted, coordinates: np.ndarray, planes: Sequence[Plane]
) -> np.ndarray:
    """The coordinates (n, 3) float32 of the mesh's own vertices on the facets that were found for it."""
    places = weld.places(coordinates)
    there = facet_places.kept_on_planes(found, places, weld.triangles, planes)
    still = (there == places).all(axis=1)[weld.vertex]
    return np.where(still[:, None], coordinates, weld.moved(there, coordinates)).astype(np.float32)


def _faces(
    before: Before, corners: np.ndarray, label: np.ndarray, points: np.ndarray
) -> tuple[Polygons, Kept, np.ndarray]:
    """The faces with the corners (m, 3) of their triangles, where they come from, and the facet (q,) of each.

    `label` (m,) is that of each triangle. A face with corners of others is divided into its triangles.
    """
    old, polygons = before.old, before.polygons
    is_divided = np.zeros(len(polygons), bool)
    is_divided[old.faces[(polygons.faces[corners] != old.faces[:, None]).any(axis=1)]] = True
    row = np.flatnonzero(is_divided[old.faces])
    whole = np.flatnonzero(~is_divided)
    order = np.argsort(np.concatenate([whole, old.faces[row]]), kind="stable")
    sizes = np.concatenate([polygons.sizes[whole], np.full(len(row), 3)])[order]
    starts = np.cumsum(sizes) - sizes
    pieces = np.concatenate([np.flatnonzero(~is_divided[polygons.faces]), corners[row].ravel()])
    sizes_before = np.concatenate([polygons.sizes[whole], np.full(len(row), 3)])
    first = (np.cumsum(sizes_before) - sizes_before)[order]
    corner = pieces[np.repeat(first - starts, sizes) + np.arange(len(pieces))]
    face = np.concatenate([whole, old.faces[row]])[order]
    triangles = polygons.corners[corners]
    a, b, c = (points[triangles[:, i]].astype(np.float64) for i in range(3))
    largest = np.argsort(np.linalg.norm(np.cross(b - a, c - a), axis=1), kind="stable")
    facet = np.full(len(polygons), -1, np.int64)
    # The last one that is written stays: the largest.
    facet[old.faces[largest]] = label[largest]
    facets = np.concatenate([facet[whole], label[row]])[order]
    n = len(old.coordinates)
    with_face = polygons.edges.astype(np.int64) @ [n, 1]
    is_loose = ~np.isin(np.sort(old.edges, axis=1).astype(np.int64) @ [n, 1], with_face)
    made = Polygons(polygons.corners[corner], starts, old.edges[is_loose])
    return made, Kept(np.arange(n), face, corner), facets


def _note(
    found: ridgeform.Faceted, faces: Polygons, facets: np.ndarray, points: np.ndarray, n_more: int
) -> str:
    """What a modeler should know of faces and the facet (q,) of each."""
    normals = face_normals(points.astype(np.float64), faces.starts, faces.corners)
    planes = np.asarray(found.planes)[:, :3]
    turned = (facets >= 0) & (np.einsum("ij,ij->i", normals, planes[facets]) < 0.0)
    said = []
    if turned.any():
        word = "1 face is" if turned.sum() == 1 else f"{turned.sum()} faces are"
        said.append(f"{word} folded over within their facet: the mesh is too coarse there, or too uneven")
    if n_more > 0:
        said.append("faces at edges that were flipped became triangles")
    return "; ".join(said)
