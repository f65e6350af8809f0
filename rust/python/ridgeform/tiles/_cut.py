"""Blocks of a mesh: a balanced division of its vertices, and rings of faces around each part."""

import numpy as np

from ._store import Array

TURN = 0.61
"""The angle (radians) by which the directions of cuts turn from one level to the next. What was a border on
one level then crosses those of the next in points."""


def directions(turn: int) -> Array:
    """Three perpendicular directions of cuts, rows; oblique, so that no row of a regular mesh lies in one."""
    angles = 0.37 + TURN * np.array([turn, 0.7 * turn])
    (c, d), (s, e) = np.cos(angles), np.sin(angles)
    around = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
    over = np.array([[1.0, 0.0, 0.0], [0.0, d, e], [0.0, -e, d]])
    turned: Array = over @ around
    return turned


def bisect(points: Array, n_parts: int, turn: int = 0) -> Array:
    """The part of each point, (n,) int32: as many parts of about one size, by cuts across the longest side
    (recursive coordinate bisection, Berger and Bokhari 1987)."""
    labels = np.zeros(len(points), np.int32)
    frame = directions(turn)
    waiting = [(np.arange(len(points), dtype=np.int32), n_parts, 0)]
    while waiting:
        which, parts, first = waiting.pop()
        if parts == 1 or len(which) < 2:
            labels[which] = first
            continue
        here = np.asarray(points[which], np.float64)
        along = max((here @ direction for direction in frame), key=np.ptp)
        half = parts // 2
        cut = len(which) * half // parts
        order = np.argpartition(along, cut)
        waiting.append((which[order[:cut]], half, first))
        waiting.append((which[order[cut:]], parts - half, first + half))
    return labels


def incidence(faces: Array, n_vertices: int) -> tuple[Array, Array]:
    """The faces of every vertex v, `incident[starts[v]:starts[v + 1]]`."""
    corners = np.ascontiguousarray(faces).reshape(-1)
    starts = np.zeros(n_vertices + 1, np.int64)
    np.cumsum(np.bincount(corners, minlength=n_vertices), out=starts[1:])
    order = np.argsort(corners, kind="stable")
    order //= 3
    return starts, order.astype(np.int32)


def faces_at(starts: Array, incident: Array, vertices: Array) -> Array:
    """The faces of some vertices, each once, in order."""
    begin = np.asarray(starts[vertices])
    counts = np.asarray(starts[vertices + 1]) - begin
    ends = np.cumsum(counts)
    at = np.arange(ends[-1] if len(ends) else 0) + np.repeat(begin - (ends - counts), counts)
    return np.unique(incident[at])


def rings(
    starts: Array, incident: Array, faces: Array, owned: Array, count: int
) -> tuple[Array, Array, Array]:
    """Some faces with rings of others around them: all faces, all vertices (both in order), and whether a
    vertex is on the outermost ring, beyond which there is more."""
    known = frontier = np.unique(faces[owned])
    found = [owned]
    for _ in range(count):
        around = faces_at(starts, incident, frontier)
        found.append(around)
        frontier = np.setdiff1d(np.unique(faces[around]), known, assume_unique=True)
        known = np.union1d(known, frontier)
    all_faces = np.unique(np.concatenate(found))
    is_rim = np.zeros(len(known), bool)
    is_rim[np.searchsorted(known, frontier)] = True
    return all_faces, known, is_rim


def depths(corners: Array, is_rim: Array, most: int) -> Array:
    """How many edges each vertex is from the rim, at most `most`, (n,) int16."""
    depth = np.full(len(is_rim), most, np.int16)
    starts, incident = incidence(corners, len(is_rim))
    frontier = np.flatnonzero(is_rim)
    depth[frontier] = 0
    for distance in range(1, most):
        near = np.unique(corners[faces_at(starts, incident, frontier)])
        frontier = near[depth[near] > distance]
        depth[frontier] = distance
    return depth
