# SPDX-License-Identifier: GPL-3.0-or-later
"""Edited meshes made one surface: parted where several meet, joined where a vertex lies on an open edge."""

from collections.abc import Sequence
from itertools import combinations

import bmesh
from mathutils import Vector

SAME = 3
"""Digits of a cosine by which two pairs of faces continue each other as well, as at a cube's edge."""


def split_edges(edited: bmesh.types.BMesh, edges: Sequence[bmesh.types.BMEdge]) -> None:
    """Part the faces at edges that have more than two, but for the pairs that continue each other best."""
    pairs = [pair for edge in edges for pair in _continuing(edge)]
    around = {vert.index for edge in edges for vert in edge.verts}
    # Corners stay what they are while vertices are parted.
    ends = [(one, one.link_loop_next, other.link_loop_next, other) for one, other in pairs]
    faces = {face for edge in edges for vert in edge.verts for face in vert.link_faces}
    corners = [corner for face in faces for corner in face.loops if corner.vert.index in around]
    bmesh.ops.split_edges(edited, edges=list(edges))
    joined = _Union()
    for a, b, also_a, also_b in ends:
        joined.unite(a.vert, also_a.vert)
        joined.unite(b.vert, also_b.vert)
    targets = joined.targets()
    if targets:
        bmesh.ops.weld_verts(edited, targetmap=targets)
    split_vertices({corner.vert for corner in corners if corner.is_valid})


def split_vertices(verts: Sequence[bmesh.types.BMVert]) -> None:
    """Give each fan of faces around a vertex a vertex of its own."""
    for vert in verts:
        bmesh.utils.vert_separate(vert, ())


def join_junctions(edited: bmesh.types.BMesh, vertices: Sequence[int], edges: Sequence[int]) -> None:
    """Cut edges at the vertices that lie on them, and make one of each vertex and its cut."""
    on_edge: dict[int, list[int]] = {}
    for vertex, edge in zip(vertices, edges, strict=True):
        on_edge.setdefault(edge, []).append(vertex)
    touching = [(edited.edges[edge], [edited.verts[vertex] for vertex in on]) for edge, on in on_edge.items()]
    joined = _Union()
    for edge, verts in touching:
        start, end = edge.verts
        begin, along = start.co.copy(), end.co - start.co
        parts = sorted(
            (((vert.co - begin).dot(along) / along.length_squared, vert) for vert in verts),
            key=lambda entry: entry[0],
        )
        done, rest = 0.0, edge
        for part, vert in parts:
            _, made = bmesh.utils.edge_split(rest, start, (part - done) / (1.0 - done))
            made.co = vert.co
            joined.unite(vert, made)
            rest = next(other for other in made.link_edges if end in other.verts)
            done, start = part, made
    bmesh.ops.weld_verts(edited, targetmap=joined.targets())


def _continuing(edge: bmesh.types.BMEdge) -> list[tuple[bmesh.types.BMLoop, bmesh.types.BMLoop]]:
    """Pairs of the corners at an edge whose faces continue each other, each corner once.

    The flatter the better; of equally flat ones those whose faces bound the smaller solid angle, so that
    two solids with a common edge come apart.
    """
    ranked = []
    for one, other in combinations(edge.link_loops, 2):
        if one.vert == other.vert:
            # They run along the edge in the same sense: on one surface, one of the two is turned over.
            continue
        into, into_other = _inward(one), _inward(other)
        is_reflex = one.face.normal.dot(into_other) > 0.0
        ranked.append((round(into.dot(into_other), SAME), is_reflex, one, other))
    pairs, taken = [], set()
    for *_, one, other in sorted(ranked, key=lambda entry: entry[:2]):
        if one not in taken and other not in taken:
            taken |= {one, other}
            pairs.append((one, other))
    return pairs


def _inward(corner: bmesh.types.BMLoop) -> Vector:
    """The direction from an edge into a face, at a right angle to the edge."""
    along = corner.link_loop_next.vert.co - corner.vert.co
    return corner.face.normal.cross(along).normalized()


class _Union:
    """Vertices that are to be one."""

    def __init__(self) -> None:
        self._root: dict[bmesh.types.BMVert, bmesh.types.BMVert] = {}

    def _find(self, vert: bmesh.types.BMVert) -> bmesh.types.BMVert:
        while self._root.setdefault(vert, vert) != vert:
            vert = self._root[vert]
        return vert

    def unite(self, vert: bmesh.types.BMVert, other: bmesh.types.BMVert) -> None:
        """Make one of two; the first stays where it is."""
        root, other_root = self._find(vert), self._find(other)
        if root != other_root:
            self._root[other_root] = root

    def targets(self) -> dict[bmesh.types.BMVert, bmesh.types.BMVert]:
        """What each vertex that goes becomes."""
        roots = {vert: self._find(vert) for vert in self._root}
        return {vert: root for vert, root in roots.items() if vert != root}
