# SPDX-License-Identifier: GPL-3.0-or-later
"""The curves of kept edges, and which of their vertices matter least. No Blender data here."""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from .kept_edges import KeptEdges

EXACT = 1e-6
"""A vertex that lies on the line between others but for this part of the size of the mesh is not missed:
coordinates have single precision."""

SPREAD = 1e-7
"""What the middle of a line counts for its length: less than what is not missed."""


@dataclass
class Curve:
    """A path of kept edges of one kind."""

    vertices: np.ndarray
    """Its vertices (c,) in turn; the first again at the end of a closed one."""
    edges: np.ndarray
    """Its edges (c - 1,)."""
    forward: np.ndarray
    """Which of them (c - 1,) bool run along it from their first end to their second."""
    weight: np.ndarray
    """How far (c,) the curve leaves its place without each vertex, in space and in texture; infinite at the
    ends."""


def find_curves(kept: KeptEdges, points: np.ndarray, held: np.ndarray) -> list[Curve]:
    """The curves of kept edges on points (k, 3); they end at junctions and at vertices `held` (k,) bool."""
    n = len(points)
    degree = np.bincount(kept.ends.ravel(), minlength=n)
    least, most = np.full(n, np.iinfo(np.int64).max), np.full(n, -1, np.int64)
    for column in (0, 1):
        np.minimum.at(least, kept.ends[:, column], kept.kind)
        np.maximum.at(most, kept.ends[:, column], kept.kind)
    is_end = held | (degree != 2) | (least != most)
    is_end[kept.ends[kept.is_fixed]] = True
    curves = []
    for path, edges in _Paths(kept.ends, is_end).all():
        curves += _parted(path, edges, kept, points)
    return curves


class _Paths:
    """The paths of edges (e, 2) between vertices `is_end` (k,) bool, and those that close up without any."""

    def __init__(self, ends: np.ndarray, is_end: np.ndarray) -> None:
        self._ends, self._is_end = ends.tolist(), is_end.tolist()
        self._used = [False] * len(self._ends)
        self._at: dict[int, list[int]] = {}
        for edge, pair in enumerate(self._ends):
            for vertex in pair:
                self._at.setdefault(vertex, []).append(edge)

    def all(self) -> Iterator[tuple[list[int], list[int]]]:
        """The vertices and edges of each."""
        for start in sorted(self._at, key=lambda vertex: (not self._is_end[vertex], vertex)):
            for edge in self._at[start]:
                if not self._used[edge]:
                    yield self._walk(start, edge)

    def _walk(self, start: int, edge: int) -> tuple[list[int], list[int]]:
        path, edges = [start], []
        while True:
            self._used[edge] = True
            a, b = self._ends[edge]
            path.append(b if path[-1] == a else a)
            edges.append(edge)
            here = path[-1]
            if self._is_end[here] or here == start:
                return path, edges
            edge = next(other for other in self._at[here] if other != edge)


def _parted(path: list[int], edges: list[int], kept: KeptEdges, points: np.ndarray) -> list[Curve]:
    """The curve of a path, or its parts: where UVs of the two edges at a vertex differ, it ends.

    A closed one is parted at three vertices, far from each other, so that it stays a loop.
    """
    vertices, rows = np.array(path), np.array(edges)
    forward = kept.ends[rows, 0] == vertices[:-1]
    texture = _texture(rows, forward, kept, points[vertices])
    cuts = {0, len(path) - 1}
    cuts |= set((1 + np.flatnonzero((texture[:-1, 1] != texture[1:, 0]).any(axis=1))).tolist())
    if path[0] == path[-1]:
        far = np.linalg.norm(points[vertices] - points[vertices[0]], axis=1)
        second = int(far.argmax())
        along = points[vertices[second]] - points[vertices[0]]
        off = np.linalg.norm(np.cross(points[vertices] - points[vertices[0]], along), axis=1)
        cuts |= {second, int(off.argmax())}
    curves = []
    ordered = sorted(cuts)
    for a, b in pairwise(ordered):
        # Within a part the UVs at a vertex are those before it as well as those behind it.
        there = np.concatenate([texture[a:b, 0], texture[b - 1 : b, 1]])
        weight = _weights(np.concatenate([points[vertices[a : b + 1]], there], axis=1))
        curves.append(Curve(vertices[a : b + 1], rows[a:b], forward[a:b], weight))
    return curves


def _texture(rows: np.ndarray, forward: np.ndarray, kept: KeptEdges, places: np.ndarray) -> np.ndarray:
    """UVs (c - 1, 2, s) at the ends of the edges `rows` of a path at `places` (c, 3), made as long as it."""
    texture = kept.texture[rows].copy()
    texture[~forward] = texture[~forward][:, ::-1, :, ::-1]
    length = np.linalg.norm(np.diff(places, axis=0), axis=1).sum()
    lengths = np.linalg.norm(texture[:, 1] - texture[:, 0], axis=3).sum(axis=0)
    scale = np.divide(length, lengths, out=np.zeros_like(lengths), where=lengths > 0)
    return (texture * scale[:, :, None]).reshape(len(rows), 2, -1)


def _weights(places: np.ndarray) -> np.ndarray:
    """How far (c,) a path of places (c, d) leaves itself without each vertex, by Douglas and Peucker (1973).

    No vertex weighs more than the one whose removal comes after it: those above any limit are those that
    their method keeps with it.
    """
    weights = np.full(len(places), np.inf)
    spans = [(0, len(places) - 1)]
    while spans:
        a, b = spans.pop()
        if b - a < 2:
            continue
        along = places[b] - places[a]
        inner = places[a + 1 : b] - places[a]
        squared = along @ along
        share = np.clip(inner @ along / squared, 0.0, 1.0) if squared > 0 else np.zeros(len(inner))
        off = np.linalg.norm(inner - share[:, None] * along, axis=1)
        # On a line, where none is off, the one in the middle matters most: so those that stay are spread.
        off += SPREAD * share * (1.0 - share) * np.sqrt(squared)
        middle = int(off.argmax())
        weights[a + 1 + middle] = min(off[middle], weights[a], weights[b])
        spans += [(a, a + 1 + middle), (a + 1 + middle, b)]
    return weights


def dropped(curves: list[Curve], kept: KeptEdges, size: float, share: float) -> list[np.ndarray]:
    """Which vertices (c,) bool each curve loses, when a share of those that are no ends is to stay.

    Those that weigh least, on open borders only where they lie on the line between others: a neighbor that
    ends there has the same line, whatever is done to it.
    """
    outer = [bool(kept.is_open[curve.edges].all()) for curve in curves]
    chosen = [np.zeros(len(curve.vertices), bool) for curve in curves]
    for kind in (False, True):
        members = [number for number in range(len(curves)) if outer[number] == kind]
        if not members:
            continue
        weights = np.concatenate([curves[number].weight for number in members])
        count = int((1.0 - share) * np.isfinite(weights).sum())
        mask = np.zeros(len(weights), bool)
        mask[np.argsort(weights, kind="stable")[:count]] = True
        if kind:
            mask &= weights <= EXACT * size
        starts = np.cumsum([0, *(len(curves[number].vertices) for number in members)])
        for number, start in zip(members, starts[:-1].tolist(), strict=True):
            chosen[number] = mask[start : start + len(curves[number].vertices)]
    return chosen
