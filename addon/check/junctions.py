# SPDX-License-Identifier: GPL-3.0-or-later
"""T-junctions: vertices on the border of a surface that lie on another open edge, between its ends."""

import numpy as np

from .arrays import MeshArrays

ROUNDING = 1e-5
"""How far off the edge a vertex may be, in parts of the size of all borders, as the wheel says."""
OF_EDGE = 0.1
"""And in parts of the edge."""
AT_ONCE = 1_000_000
"""Pairs of a vertex and an edge that are measured at a time, for the memory's sake."""


def open_edges(mesh: MeshArrays, target: np.ndarray) -> np.ndarray:
    """Edges with one face, also after vertices are welded to their targets (n,)."""
    single = np.flatnonzero(mesh.faces_at_edges == 1)
    ends = np.sort(target[mesh.edges[single]].astype(np.int64), axis=1)
    _, row, counts = np.unique(ends @ [len(target), 1], return_inverse=True, return_counts=True)
    return single[(counts[row.ravel()] == 1) & (ends[:, 0] != ends[:, 1])]


def edges_at(mesh: MeshArrays, target: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The T-junctions that the wheel finds, and the edge that each lies on: vertices (j,) and edges (j,).

    Vertices are welded to their targets (n,); of several that are one, the first is meant. One may lie on two
    edges.
    """
    vertices = mesh.report.t_junctions.astype(np.int64)
    edges = open_edges(mesh, target) if len(vertices) else np.empty(0, np.int64)
    if len(edges) == 0:
        return np.empty(0, np.int64), np.empty(0, np.int64)
    ends = target[mesh.edges[edges]].astype(np.int64)
    border = mesh.places[ends].astype(np.float64)
    a, b = border[:, 0], border[:, 1]
    lengths = np.linalg.norm(b - a, axis=1)
    size, farthest = np.ptp(border.reshape(-1, 3), axis=0).max(), np.abs(border).max()
    reach = np.minimum(max(ROUNDING * size, 4.0 * np.finfo(np.float32).eps * farthest), OF_EDGE * lengths)
    found = [np.empty((0, 2), np.int64)]
    for vertex, edge in _near_pairs(mesh.places[vertices].astype(np.float64), a, b, lengths):
        along = b[edge] - a[edge]
        offset = mesh.places[vertices[vertex]] - a[edge]
        part = (offset * along).sum(axis=1) / (along**2).sum(axis=1)
        apart = np.linalg.norm(offset - part[:, None] * along, axis=1)
        inside = np.minimum(part, 1.0 - part) * lengths[edge] > reach[edge]
        hit = (apart <= reach[edge]) & inside & (vertices[vertex][:, None] != ends[edge]).all(axis=1)
        found.append(np.stack([vertices[vertex[hit]], edges[edge[hit]]], axis=1))
    pairs = np.unique(np.concatenate(found), axis=0)
    pairs = pairs[~_of_own_face(mesh, target, pairs)]
    return pairs[:, 0], pairs[:, 1]


def _near_pairs(places: np.ndarray, a: np.ndarray, b: np.ndarray, lengths: np.ndarray) -> object:
    """Yield vertices and edges that share a cell of a grid: one grid for all edges of about one length."""
    origin = places.min(axis=0)
    octave = np.ceil(np.log2(np.maximum(lengths, lengths.max() * 1e-9))).astype(int)
    for power in np.unique(octave):
        # Twice as wide as the edge, so that it touches two cells along each axis at most, reach and all.
        width = 2.0 ** (power + 1)
        rows = np.flatnonzero(octave == power)
        at = np.floor((places - origin) / width)
        order, keys = _sorted_keys(at)
        margin = OF_EDGE * lengths[rows][:, None]
        low = np.floor((np.minimum(a[rows], b[rows]) - margin - origin) / width)
        high = np.floor((np.maximum(a[rows], b[rows]) + margin - origin) / width)
        cells = [(low + (high - low) * [i & 1, i >> 1 & 1, i >> 2 & 1]) for i in range(8)]
        cell_keys = np.stack([_keys(cell) for cell in cells], axis=1)
        # One cell may be named several times, where the edge crosses no side of it.
        cell_keys.sort(axis=1)
        fresh = np.ones(cell_keys.shape, bool)
        fresh[:, 1:] = cell_keys[:, 1:] != cell_keys[:, :-1]
        edge, column = np.nonzero(fresh)
        key = cell_keys[edge, column]
        first, last = (np.searchsorted(keys, key, side=side) for side in ("left", "right"))
        counts = last - first
        begin = 0
        ends = np.cumsum(counts)
        while begin < len(counts):
            done = ends[begin - 1] if begin else 0
            end = max(int(np.searchsorted(ends, done + AT_ONCE)), begin + 1)
            here = counts[begin:end]
            total = int(here.sum())
            if total:
                steps = np.arange(total) - np.repeat(np.cumsum(here) - here, here)
                vertex = order[np.repeat(first[begin:end], here) + steps]
                yield vertex, np.repeat(rows[edge[begin:end]], here)
            begin = end


def _sorted_keys(cells: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    keys = _keys(cells)
    order = np.argsort(keys, kind="stable")
    return order, keys[order]


def _keys(cells: np.ndarray) -> np.ndarray:
    """A number for each cell (p, 3); others may have it too, which only costs time."""
    whole = cells.astype(np.int64).astype(np.uint64)
    primes = np.array([0x9E3779B97F4A7C15, 0xC2B2AE3D27D4EB4F, 0x165667B19E3779F9], np.uint64)
    return whole[:, 0] * primes[0] ^ whole[:, 1] * primes[1] ^ whole[:, 2] * primes[2]


def _of_own_face(mesh: MeshArrays, target: np.ndarray, pairs: np.ndarray) -> np.ndarray:
    """Whether vertices are corners of the face of their edge: such a face has no area, but no gap either."""
    if len(pairs) == 0:
        return np.zeros(0, bool)
    corners = np.flatnonzero(np.isin(mesh.corner_edges, pairs[:, 1]))
    face_of_edge = np.full(len(mesh.edges), -1, np.int64)
    face_of_edge[mesh.corner_edges[corners]] = mesh.faces_of_corners(corners)
    own = face_of_edge[pairs[:, 1]]
    taking = np.zeros(len(mesh.starts), bool)
    taking[own] = True
    faces = np.repeat(np.arange(len(mesh.starts)), mesh.sizes)
    of_these = taking[faces]
    n = len(target)
    named = faces[of_these] * n + target[mesh.corner_vertices[of_these]]
    return np.isin(own * n + pairs[:, 0], named)
