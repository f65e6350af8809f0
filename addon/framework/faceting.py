# SPDX-License-Identifier: GPL-3.0-or-later
"""What a mesh becomes whose faces give way to facets: new faces, what stays, and what lies on them."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import bpy
import numpy as np
import ridgeform

from ..blender import kept_normals, mesh_io, mesh_layers, modifiers, rebuilding
from ..blender.carrying import Kept, carried
from ..blender.mesh_layers import Layer
from ..blender.mirroring import Plane
from ..blender.polygons import Polygons
from ..blender.rebuilding import Before, Rebuilt
from ..blender.surface_map import SurfaceMap
from ..blender.welding import Weld, connected_parts, mirrored
from . import facet_places, keeping
from .results import Results

FLAT = "sharp_face"
"""The face attribute of flat shading."""


@dataclass
class Facetable:
    """A mesh as it is before facets are made of it."""

    before: Before
    weld: Weld
    """Its surface, without images of mirrors."""
    taking: np.ndarray
    """Which faces (f,) bool take part."""
    flags: list[Layer]
    """What is selected and hidden."""
    planes: list[Plane]
    """The planes of Mirror modifiers that borders lie on."""

    def options(self) -> dict[str, np.ndarray]:
        """The argument of `ridgeform.facet` that says which faces take part."""
        faces = self.taking[self.before.old.faces[self.weld.rows]]
        return {} if faces.all() else {"faces": faces}


@dataclass
class FacetMesh:
    """What a mesh becomes, and the facet (q,) of each face, -1 for those that stay."""

    rebuilt: Rebuilt
    facets: np.ndarray

    def ridges(self) -> np.ndarray:
        """Which edges (k,) bool lie between two facets."""
        faces = self.rebuilt.faces
        of_corner = self.facets[faces.faces]
        made = of_corner >= 0
        edge, label = faces.corner_edges[made], of_corner[made]
        low, high = np.full(len(faces.edges), np.iinfo(np.int64).max), np.full(len(faces.edges), -1)
        np.minimum.at(low, edge, label)
        np.maximum.at(high, edge, label)
        return (high >= 0) & (low < high)


def read(obj: bpy.types.Object, weld: Weld, taking: np.ndarray) -> Facetable:
    """Read the mesh of an object in Object Mode, of which faces `taking` (f,) bool take part."""
    coordinates = mesh_io.positions(obj.data)
    images = mirrored(weld, coordinates, modifiers.mirrors(obj, coordinates)).images
    planes = [] if images is None else images.planes
    return Facetable(rebuilding.read(obj), weld, taking, mesh_layers.read_flags(obj.data), planes)


_known = Results()


def forget() -> None:
    """Let go of the results that are kept."""
    _known.forget()


def facets_of(
    source: Facetable,
    mesh: ridgeform.Mesh,
    coordinates: np.ndarray,
    *,
    facets: int | None = None,
    error: float | None = None,
    edge_weights: np.ndarray | None = None,
    topology: str = "POLYGONS",
    flips: bool = True,
    keep_volume: bool = False,
    symmetric: str | None = None,
    coarse_to_fine: bool = True,
    flat: bool = True,
    progress: ridgeform.Progress | None = None,
    check: Callable[[], None] = lambda: None,
) -> tuple[ridgeform.Faceted, FacetMesh]:
    """The facets of a mesh at coordinates (n, 3), `mesh` in the wheel, and what it becomes as by `faceted`.

    Other numbers of facets of the same mesh start from what was found for it before.
    """
    options = source.options()
    if edge_weights is not None:
        options["edge_weights"] = edge_weights
    # Only what was asked for is a part of what a result is found by.
    if topology == "KEPT":
        options["keep_triangles"] = True
    if keep_volume:
        options["keep_volume"] = True
    if symmetric is not None:
        options["symmetric"] = symmetric.lower()
    if not coarse_to_fine:
        options["coarse_to_fine"] = False
    wanted = {"facets": facets, "error": error, "progress": progress}
    found, is_known = _known.of(mesh, options, lambda: ridgeform.facet(mesh, **options, **wanted))
    if is_known:
        found = found.at(**wanted)
    check()
    if topology == "KEPT":
        made, labels, stays = keeping.kept(
            source.before,
            source.weld,
            found,
            coordinates,
            planes=source.planes,
            flags=source.flags,
            flips=flips,
        )
        _set_flags(made.layers, stays, made.faces, labels >= 0 if flat else None)
        return found, FacetMesh(made, labels)
    return found, faceted(source, found, coordinates, topology=topology, flat=flat, check=check)


def notes(found: ridgeform.Faceted, made: Rebuilt, wanted: int | None) -> list[str]:
    """What a modeler should know of facets, of which `wanted` were asked for."""
    said = [note for note in (kept_normals.note(made.normals), made.note) if note]
    if wanted is not None and found.n_facets != wanted:
        why = ": with fewer, thin parts, handles, or holes would pass through each other"
        nearest = f"{found.n_facets} are what comes nearest{why if found.n_facets > wanted else ''}"
        said.append(f"{wanted} facets were asked for, {nearest}")
    if found.n_crossings:
        pairs = (
            "1 pair of facets passes"
            if found.n_crossings == 1
            else f"{found.n_crossings} pairs of facets pass"
        )
        said.append(f"{pairs} through each other: ask for more facets")
    if found.status == "stopped":
        said.append("stopped early, the result so far is kept")
    return said


def faceted(
    source: Facetable,
    found: ridgeform.Faceted,
    coordinates: np.ndarray,
    *,
    topology: str = "POLYGONS",
    flat: bool = True,
    check: Callable[[], None] = lambda: None,
) -> FacetMesh:
    """What the mesh becomes with the facets that were found when it was at coordinates (n, 3).

    `topology`: what facets are made of, an item of the setting. `flat`: facets are shaded flat. No Blender
    data is touched; `check` is called now and then, and may raise to stop.
    """
    faces, facets = _faces_of(found, topology)
    old = replace(source.before.old, coordinates=coordinates.astype(np.float64))
    places = source.weld.places(coordinates)
    stay = _Staying(source, old, found, faces, places)
    check()
    points = facet_places.on_planes(found, places, source.planes)
    rebuilt, kept, number = stay.joined(faces, points)
    facets = np.concatenate([np.full(len(rebuilt) - len(number), -1), facets[number]])
    points = stay.points
    check()
    chart, anchors = _charts(source, old, found, facets)
    surface = SurfaceMap(old.coordinates, old.triangles, chart)
    unknown = np.flatnonzero((anchors < 0) & (facets >= 0))
    if len(unknown):
        anchors[unknown] = surface.nearest(rebuilt.middles(points)[unknown])[0]
    check()
    everything = replace(source.before.layers, attributes=source.before.layers.attributes + source.flags)
    layers = carried(everything, old, surface, points, rebuilt, anchors=anchors, kept=kept)
    _set_flags(layers, kept, rebuilt, facets >= 0 if flat else None)
    normals = source.before.kept_normals(points, rebuilt, coordinates)
    return FacetMesh(Rebuilt(points, rebuilt, layers, normals=normals), facets)


def _faces_of(found: ridgeform.Faceted, topology: str) -> tuple[Polygons, np.ndarray]:
    """The faces of a result and the facet (q,) of each: polygons, but for those that touch themselves."""
    as_triangles = Polygons.of_triangles(np.asarray(found.faces))
    if topology == "TRIANGLES":
        return as_triangles, np.asarray(found.face_facets)
    polygons = Polygons(np.asarray(found.polygon_vertices), np.asarray(found.polygon_starts)[:-1])
    facets = np.asarray(found.polygon_facets)
    size = len(found.vertices)
    _, first = np.unique(polygons.faces * size + polygons.corners, return_index=True)
    once = np.zeros(len(polygons.corners), bool)
    once[first] = True
    # Blender has no face that names a vertex twice.
    divided = np.isin(facets, facets[polygons.faces[~once]])
    if topology == "QUADS":
        divided |= (polygons.sizes != 4) | (np.bincount(facets)[facets] > 1)
    if not divided.any():
        return polygons, facets
    whole, part = ~divided, np.isin(found.face_facets, facets[divided])
    corners = np.concatenate([polygons.corners[whole[polygons.faces]], found.faces[part].ravel()])
    sizes = np.concatenate([polygons.sizes[whole], np.full(int(part.sum()), 3)])
    made = Polygons(corners, np.cumsum(sizes) - sizes)
    return made, np.concatenate([facets[whole], np.asarray(found.face_facets)[part]])


class _Staying:
    """What of a mesh stays: faces that take no part, those beside them that did not change, loose parts."""

    def __init__(
        self,
        source: Facetable,
        old: rebuilding.Triangulation,
        found: ridgeform.Faceted,
        faces: Polygons,
        places: np.ndarray,
    ) -> None:
        self._source, self._old, self._found = source, old, found
        weld, taking = source.weld, source.taking
        fixed = np.zeros(len(weld.first), bool)
        fixed[weld.triangles[~taking[old.faces[weld.rows]]]] = True
        origins = np.asarray(found.origins)
        self._unmoved = (np.asarray(found.vertices) == places[origins]).all(axis=1)
        candidates = np.flatnonzero(fixed[weld.triangles].any(axis=1))
        single = np.flatnonzero(faces.sizes == 3)
        rows = faces.corners[faces.starts[single][:, None] + np.arange(3)]
        single = single[self._unmoved[rows].all(axis=1)]
        rows = rows[self._unmoved[rows].all(axis=1)]
        there, self.replaced = _matches(weld.triangles[candidates], origins[rows])
        missing = np.zeros(len(taking), bool)
        missing[old.faces[weld.rows[candidates[~there]]]] = True
        if (missing & ~taking).any():
            raise ridgeform.RidgeformError("Faces that were to stay have changed")
        beside = np.zeros(len(taking), bool)
        beside[old.faces[weld.rows[candidates]]] = True
        self.faces = ~taking | (beside & ~missing)
        """Which faces (f,) bool stay."""
        of_staying = self.faces[old.faces[weld.rows[candidates]]]
        _, gone = _matches(weld.triangles[candidates[of_staying]], origins[rows])
        self._gone = np.zeros(len(faces), bool)
        self._gone[single[gone]] = True

    def joined(self, faces: Polygons, points: np.ndarray) -> tuple[Polygons, Kept, np.ndarray]:
        """All faces, those that stay first, what is kept, and which of the found faces come after them."""
        source, old, weld = self._source, self._old, self._source.weld
        n, polygons = len(old.coordinates), source.before.polygons
        corner = np.flatnonzero(self.faces[polygons.faces])
        used = np.zeros(n, bool)
        used[polygons.corners] = True
        stays = ~used
        stays[polygons.corners[corner]] = True
        vertex = np.flatnonzero(stays)
        new_number = np.full(n, -1)
        new_number[vertex] = np.arange(len(vertex))
        at_weld = np.full(len(weld.first), -1)
        at_weld[weld.vertex[vertex]] = np.arange(len(vertex))
        number = np.flatnonzero(~self._gone)
        made = self._gone[faces.faces] == 0
        origins = np.asarray(self._found.origins)
        of_found = np.where(self._unmoved, at_weld[origins], -1)
        fresh = np.zeros(len(points), bool)
        fresh[faces.corners[made]] = True
        fresh &= of_found < 0
        of_found[fresh] = len(vertex) + np.arange(int(fresh.sum()))
        corners = np.concatenate([new_number[polygons.corners[corner]], of_found[faces.corners[made]]])
        sizes = np.concatenate([polygons.sizes[self.faces], faces.sizes[number]])
        loose = new_number[old.edges[self._loose()]]
        self.points = np.concatenate([old.coordinates[vertex], points[fresh]]).astype(np.float32)
        """The places (p, 3) of all vertices, those that stay first."""
        kept = Kept(
            _followed(vertex, int(fresh.sum())),
            _followed(np.flatnonzero(self.faces), len(number)),
            _followed(corner, int(made.sum())),
        )
        return Polygons(corners, np.cumsum(sizes) - sizes, loose), kept, number

    def _loose(self) -> np.ndarray:
        """Which edges (e,) bool have no face."""
        n = len(self._old.coordinates)
        with_face = self._source.before.polygons.edges.astype(np.int64) @ [n, 1]
        return ~np.isin(np.sort(self._old.edges, axis=1).astype(np.int64) @ [n, 1], with_face)


def _followed(kept: np.ndarray, count: int) -> np.ndarray:
    return np.concatenate([kept, np.full(count, -1)])


def _matches(one: np.ndarray, other: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Which triangles (a, 3) and (b, 3) have the same vertices as one of the others."""
    rows = np.sort(np.concatenate([one, other]).astype(np.int64), axis=1)
    _, number = np.unique(rows, axis=0, return_inverse=True)
    number = number.reshape(-1)
    here, there = number[: len(one)], number[len(one) :]
    return np.isin(here, there), np.isin(there, here)


def _charts(
    source: Facetable, old: rebuilding.Triangulation, found: ridgeform.Faceted, facets: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """The chart (m,) of each old triangle: facet, material and UV island; and one (q,) for each face.

    For a face that is a triangle on the chart that its facet takes its values from: of the material with the
    most area on it the island with the most; -1 where it has none.
    """
    weld, layers = source.weld, source.before.layers
    m = len(old.triangles)
    material = np.zeros(m, np.int64)
    for layer in layers.attributes:
        if layer.name == "material_index" and layer.domain == "FACE":
            material = layer.values[old.faces, 0].astype(np.int64)
    label = np.full(m, -1, np.int64)
    label[weld.rows] = found.labels
    rows = np.stack([label, material, _islands(old, layers, label)], axis=1)
    charts, chart = np.unique(rows, axis=0, return_inverse=True)
    chart = chart.reshape(-1)
    a, b, c = (old.coordinates[old.triangles[:, corner]] for corner in range(3))
    area = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)
    size = np.bincount(chart, weights=area)
    _, kind = np.unique(charts[:, :2], axis=0, return_inverse=True)
    of_kind = np.bincount(kind.reshape(-1), weights=size)[kind.reshape(-1)]
    # Sorted by facet, then material, then island: the last entry of a facet is the one wanted.
    order = np.lexsort((size, of_kind, charts[:, 0]))
    best = np.full(len(found.planes), -1)
    order = order[charts[order, 0] >= 0]
    best[charts[order, 0]] = order
    first = np.empty(len(charts), np.int64)
    first[chart] = np.arange(m)
    anchors = np.where(facets >= 0, best[facets], -1)
    return chart, np.where(anchors >= 0, first[anchors], -1)


def _islands(old: rebuilding.Triangulation, layers: mesh_layers.Layers, label: np.ndarray) -> np.ndarray:
    """The UV island (m,) of each triangle within its label (m,).

    It is what is reached over vertices with the same UVs, without going around by other labels: the two sides
    of a seam can be one island elsewhere.
    """
    uvs = layers.uv_layers()
    if not uvs:
        return np.zeros(len(old.triangles), np.int64)
    corners = old.corners.ravel()
    places = np.concatenate([layer[corners] for layer in uvs], axis=1)
    vertices = np.unique(old.coordinates[old.triangles.ravel()], axis=0, return_inverse=True)[1]
    rows = np.concatenate([np.repeat(label, 3)[:, None], vertices.reshape(-1, 1), places], axis=1)
    joined, number = np.unique(rows, axis=0, return_inverse=True)
    number = number.reshape(-1, 3)
    return connected_parts(number, len(joined))[number[:, 0]]


def _set_flags(layers: mesh_layers.Layers, kept: Kept, faces: Polygons, flat: np.ndarray | None) -> None:
    """Show and select what is new, and shade faces `flat` (q,) bool flat."""
    staying = np.zeros(len(faces.edges), bool)
    staying[faces.corner_edges[kept.corner >= 0]] = True
    new = {"POINT": kept.vertex < 0, "EDGE": ~staying, "FACE": kept.face < 0}
    for layer in layers.attributes:
        if layer.name in mesh_layers.FLAGS:
            layer.values[new[layer.domain]] = layer.name.startswith(".select")
    if flat is None:
        return
    shading = next((layer for layer in layers.attributes if layer.name == FLAT), None)
    if shading is None:
        shading = Layer(FLAT, "BOOLEAN", "FACE", np.zeros((len(faces), 1), bool))
        layers.attributes.append(shading)
    shading.values[flat] = True
