# SPDX-License-Identifier: GPL-3.0-or-later
"""Where a patch is divided: seams that end at a hole go on through its patch, along ridges if they can."""

import heapq
from collections.abc import Collection

import numpy as np

from .surroundings import Surroundings

RIDGE_COST = 0.05
"""The cost of an edge on a ridge, in parts of its length: a seam takes any detour to follow a ridge."""
MOST_JUMPS = 0.25
"""With more jumps than this share of the border's vertices, values are noise, and no seam is looked for."""
FEW_JUMPS = 8
"""So many jumps are never too many."""


class PatchGraph:
    """The edges inside the patches, for finding the way of a seam through them."""

    def __init__(self, around: Surroundings) -> None:
        """Take the edges of the patches, with their lengths."""
        rows = np.flatnonzero(around.inside)
        ends = np.stack([around.edge_start, around.edge_end], axis=1)
        length = np.linalg.norm(around.places[ends[rows, 0]] - around.places[ends[rows, 1]], axis=1)
        self._n_edges = len(around.inside)
        self._neighbors: dict[int, list[tuple[int, int, float, bool]]] = {}
        for (a, b), row, size, ridge in zip(
            ends[rows].tolist(), rows.tolist(), length.tolist(), around.is_ridge[rows].tolist(), strict=True
        ):
            self._neighbors.setdefault(a, []).append((b, row, size, ridge))
            self._neighbors.setdefault(b, []).append((a, row, size, ridge))

    def connected(self, ends: Collection[int], only_ridges: bool = False) -> np.ndarray:
        """Edges (e,) bool of a short tree through the vertices `ends`; those out of reach are left out."""
        marked = np.zeros(self._n_edges, bool)
        remaining = sorted(ends)
        while remaining:
            tree, remaining = {remaining[0]}, set(remaining[1:])
            while remaining:
                path = self._path(tree, remaining, only_ridges)
                if not path:
                    break
                marked[[row for _, row in path]] = True
                tree.update(vertex for vertex, _ in path)
                remaining -= tree
            remaining = sorted(remaining)
        return marked

    def way_in(self, end: int, holes_border: Collection[int]) -> np.ndarray:
        """Edges (e,) bool of the shortest way from a border vertex to the vertex farthest from the border."""
        distance, _ = self._reach(set(holes_border), set(), ridge_cost=1.0)
        reached, _ = self._reach({end}, set())
        depth = {vertex: distance.get(vertex, 0.0) for vertex in reached}
        innermost = max(sorted(depth), key=depth.__getitem__)
        if depth[innermost] <= 0.0:
            return np.zeros(self._n_edges, bool)
        return self.connected([end, innermost])

    def nearest(self, sources: Collection[int]) -> dict[int, int]:
        """The nearest of some vertices, along edges, for every vertex of the patches."""
        _, came = self._reach(set(sources), set(), ridge_cost=1.0)
        nearest: dict[int, int] = {}
        for vertex, before in came.items():
            nearest[vertex] = vertex if before is None else nearest[before[0]]
        return nearest

    def _path(self, sources: set[int], targets: set[int], only_ridges: bool) -> list[tuple[int, int]]:
        """Vertices and edges from the nearest of the targets back to the sources; empty if out of reach."""
        _, came = self._reach(sources, targets, only_ridges=only_ridges)
        found = next((vertex for vertex in reversed(came) if vertex in targets), None)
        path = []
        while found is not None and came[found] is not None:
            before, row = came[found]
            path.append((found, row))
            found = before
        return path

    def _reach(
        self,
        sources: set[int],
        targets: set[int],
        ridge_cost: float = RIDGE_COST,
        only_ridges: bool = False,
    ) -> tuple[dict[int, float], dict[int, tuple[int, int] | None]]:
        """Dijkstra up to the first target: distances, and from where vertices were reached, in that order."""
        queue = [(0.0, vertex, -1, -1) for vertex in sorted(sources)]
        distance: dict[int, float] = {}
        came: dict[int, tuple[int, int] | None] = {}
        while queue:
            cost, vertex, before, row = heapq.heappop(queue)
            if vertex in distance:
                continue
            distance[vertex] = cost
            came[vertex] = None if before < 0 else (before, row)
            if vertex in targets:
                break
            for other, edge, length, ridge in self._neighbors.get(vertex, ()):
                if other not in distance and (ridge or not only_ridges):
                    step = length * (ridge_cost if ridge else 1.0)
                    heapq.heappush(queue, (cost + step, other, vertex, edge))
        return distance, came


def cut_along(around: Surroundings, graph: PatchGraph, jumps: np.ndarray) -> np.ndarray:
    """Edges (e,) bool where the patches are cut, for values that jump where border edges (b,) bool end.

    The jumps of a hole are joined through its patch. A single one, a seam that ends somewhere in the hole, is
    led to the middle. Where values jump nearly everywhere nothing is cut.
    """
    border = around.border
    cut = np.zeros(len(around.inside), bool)
    for hole in np.unique(border.hole[jumps]).tolist():
        own = border.hole == hole
        ends = np.unique(border.end[own & jumps])
        if len(ends) > max(FEW_JUMPS, MOST_JUMPS * own.sum()):
            continue
        if len(ends) == 1:
            cut |= graph.way_in(int(ends[0]), border.start[own].tolist())
        else:
            cut |= graph.connected(ends.tolist())
    return cut


def value_jumps(
    around: Surroundings, at_start: np.ndarray, at_end: np.ndarray, tolerance: float
) -> np.ndarray:
    """At the ends of which border edges (b,) bool the values beside them jump.

    `at_start` and `at_end` (b, c) are the values on the mesh's side of each border edge at its two ends.
    """
    following = around.border.following
    differ = (np.abs(at_end - at_start[following]) > tolerance).any(axis=1)
    return differ & (following >= 0)
