# SPDX-License-Identifier: GPL-3.0-or-later
"""What a mesh keeps when its triangles are reduced: borders, marks, borders of materials and of UV islands.

No Blender data here. Edges are those of the welded triangles, each once.
"""

from dataclasses import dataclass

import numpy as np

from ..blender.carrying import Triangulation
from ..blender.mesh_layers import MARKS, Layer, Layers
from ..blender.welding import Weld, connected_parts


@dataclass
class KeptEdges:
    """The edges of k welded vertices and l triangles that stay, as curves that may only lose vertices."""

    ends: np.ndarray
    """Their vertices (e, 2)."""
    kind: np.ndarray
    """A number (e,) for what each is; a curve is of one kind."""
    is_open: np.ndarray
    """Which of them (e,) bool have one triangle."""
    is_fixed: np.ndarray
    """Which of them (e,) bool keep both ends, since more than two triangles or none that agree are there."""
    of_mesh: np.ndarray
    """The edge (e,) of the mesh that each is, with its marks; -1 for none."""
    beside: np.ndarray
    """The triangles (e, 2) that run along each, and that run along it the other way; -1 for none."""
    texture: np.ndarray
    """UVs (e, 2, m, 2, 2): at either end, of m maps, in the two triangles `beside`; 0 where there is none."""
    region: np.ndarray
    """The region (l,) of each triangle: all that is reached without crossing one of the edges."""


def kept_edges(old: Triangulation, layers: Layers, weld: Weld) -> KeptEdges:
    """Find what stays of a mesh."""
    triangles = weld.triangles.astype(np.int64)
    halves = _Halves(triangles, len(weld.first))
    corners = old.corners[weld.rows]
    uvs = layers.uv_layers()
    split = np.zeros(len(halves.first), bool)
    for layer in uvs:
        split[halves.paired] |= _jumps(halves, layer[corners.ravel()])
    material = _materials(layers, old.faces[weld.rows])
    pair = np.sort(np.stack([material[halves.first // 3], material[halves.second // 3]], axis=1), axis=1)
    marks, of_mesh = _marks(old, layers, weld, halves)
    is_open, is_odd = halves.count == 1, ~halves.paired & (halves.count != 1)
    kept = is_open | is_odd | split | (pair[:, 0] != pair[:, 1]) | marks.any(axis=1)
    rows = np.concatenate([np.stack([is_open, is_odd, split], axis=1), pair, marks], axis=1)[kept]
    beside = np.stack([halves.first, np.where(halves.paired, halves.second, -3)], axis=1)[kept]
    return KeptEdges(
        halves.ends[kept],
        np.unique(rows, axis=0, return_inverse=True)[1].reshape(-1),
        is_open[kept],
        is_odd[kept],
        of_mesh[kept],
        beside // 3,
        _texture(beside, [layer[corners.ravel()] for layer in uvs]),
        _regions(halves, kept, len(triangles)),
    )


class _Halves:
    """The sides of triangles (l, 3), paired to edges; side h of 3 l starts at corner h."""

    def __init__(self, triangles: np.ndarray, n_vertices: int) -> None:
        starts, stops = triangles.ravel(), np.roll(triangles, -1, axis=1).ravel()
        keys = np.minimum(starts, stops) * n_vertices + np.maximum(starts, stops)
        order = np.argsort(keys, kind="stable")
        self.keys, at, self.count = np.unique(keys[order], return_index=True, return_counts=True)
        self.n_vertices = n_vertices
        self.first = order[at]
        """A side (e,) of each edge."""
        self.second = order[np.minimum(at + 1, len(order) - 1)]
        """Another one; the same where there is none."""
        self.second[self.count == 1] = self.first[self.count == 1]
        self.ends = np.stack([starts[self.first], stops[self.first]], axis=1)
        self.paired = (self.count == 2) & (starts[self.first] == stops[self.second])
        """Which edges (e,) bool have two triangles that run along them in opposite ways."""


def _after(sides: np.ndarray) -> np.ndarray:
    """The corners at which sides end."""
    return sides - sides % 3 + (sides + 1) % 3


def _jumps(halves: _Halves, values: np.ndarray) -> np.ndarray:
    """Whether values (3 l, c) of corners differ across each edge with two triangles."""
    first, second = halves.first[halves.paired], halves.second[halves.paired]
    differ = (values[first] != values[_after(second)]) | (values[_after(first)] != values[second])
    return differ.any(axis=1)


def _materials(layers: Layers, faces: np.ndarray) -> np.ndarray:
    for layer in layers.attributes:
        if layer.name == "material_index" and layer.domain == "FACE":
            return layer.values[faces, 0].astype(np.int64)
    return np.zeros(len(faces), np.int64)


def _is_mark(layer: Layer) -> bool:
    """Whether edges carry a mark that stays: where most are sharp, that is flat shading, and no feature."""
    if layer.name == "sharp_edge" and np.mean(layer.values) > 0.5:
        return False
    return layer.name in MARKS


def _marks(old: Triangulation, layers: Layers, weld: Weld, halves: _Halves) -> tuple[np.ndarray, np.ndarray]:
    """The values (e, c) of marks on each edge, and the edge of the mesh (e,) that has them."""
    ends = np.sort(weld.vertex[old.edges], axis=1)
    keys = ends[:, 0].astype(np.int64) * halves.n_vertices + ends[:, 1]
    kinds = [layer for layer in layers.attributes if layer.domain == "EDGE" and _is_mark(layer)]
    values = np.zeros((len(old.edges), sum(layer.values.shape[1] for layer in kinds)))
    if kinds:
        values = np.concatenate([layer.values for layer in kinds], axis=1).astype(np.float64)
    place = np.minimum(np.searchsorted(halves.keys, keys), len(halves.keys) - 1)
    here = np.flatnonzero(halves.keys[place] == keys)
    # Of the two sides of a split edge, the marked one is written last.
    here = here[np.argsort(values[here].any(axis=1), kind="stable")]
    of_mesh = np.full(len(halves.keys), -1)
    of_mesh[place[here]] = here
    marks = np.where(of_mesh[:, None] >= 0, values[of_mesh], 0.0)
    return marks, of_mesh


def _texture(beside: np.ndarray, uvs: list[np.ndarray]) -> np.ndarray:
    """UVs (e, 2, m, 2, 2) at the ends of edges with sides `beside` (e, 2), below 0 for none."""
    texture = np.zeros((len(beside), 2, len(uvs), 2, 2))
    for number, values in enumerate(uvs):
        for side in (0, 1):
            sides = np.maximum(beside[:, side], 0)
            at = np.stack([values[sides], values[_after(sides)]], axis=1)
            # The second triangle runs along the edge the other way.
            at = at[:, ::-1] if side else at
            texture[:, :, number, side] = np.where((beside[:, side] >= 0)[:, None, None], at, 0.0)
    return texture


def _regions(halves: _Halves, kept: np.ndarray, n_triangles: int) -> np.ndarray:
    across = halves.paired & ~kept
    joined = np.stack([halves.first[across], halves.second[across]], axis=1) // 3
    return connected_parts(joined[:, [0, 1, 1]], n_triangles)


def regions_of(
    faces: np.ndarray, ends: np.ndarray, edge: np.ndarray, forward: np.ndarray, kept: KeptEdges
) -> np.ndarray:
    """The region (q,) of other triangles (q, 3), which have edges `ends` (c, 2) where kept edges were.

    `edge` (c,) are these kept edges, and `forward` (c,) bool says which run the same way. -1 where none is
    around.
    """
    n = int(faces.max(initial=0)) + 1
    faces = faces.astype(np.int64)
    starts, stops = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    beside = np.where(forward[:, None], kept.beside[edge], kept.beside[edge][:, ::-1])
    keys = np.concatenate([ends @ [n, 1], ends @ [1, n]])
    there = np.concatenate([beside[:, 0], beside[:, 1]])
    order = np.argsort(keys, kind="stable")
    keys, there = keys[order], there[order]
    wanted = starts * n + stops
    place = np.minimum(np.searchsorted(keys, wanted), len(keys) - 1) if len(keys) else np.zeros_like(wanted)
    known = keys[place] == wanted if len(keys) else np.zeros(len(wanted), bool)
    halves = _Halves(faces, n)
    crossed = halves.paired & ~known[halves.first]
    joined = np.stack([halves.first[crossed], halves.second[crossed]], axis=1) // 3
    part = connected_parts(joined[:, [0, 1, 1]], len(faces))
    region = np.full(len(faces), -1)
    sides = np.flatnonzero(known)
    sides = sides[there[place[sides]] >= 0]
    region[part[sides // 3]] = kept.region[there[place[sides]]]
    return region[part]
