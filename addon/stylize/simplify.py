# SPDX-License-Identifier: GPL-3.0-or-later
"""Simplifying triangles with fast-simplification, while curves and vertices that must stay do so.

No Blender data here.
"""

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from .collapse import Fans
from .curves import Curve, dropped, find_curves
from .kept_edges import KeptEdges

REST = 0.5
"""Away from what must stay, no fewer triangles than this part of those asked for are left."""


@dataclass
class Simplified:
    """Points (p, 3) and triangles (q, 3), and what they have of the kept edges."""

    points: np.ndarray
    faces: np.ndarray
    ends: np.ndarray
    """The ends (c, 2) of the edges of what is left of the curves."""
    edge: np.ndarray
    """A kept edge (c,) that each was."""
    forward: np.ndarray
    """Whether (c,) that ran from the first end to the second."""


def simplify(
    points: np.ndarray,
    faces: np.ndarray,
    kept: KeptEdges,
    *,
    held: np.ndarray,
    ratio: float,
    check: Callable[[], None] = lambda: None,
) -> Simplified:
    """Simplify triangles (m, 3) on points (k, 3) to about `ratio` of them.

    Vertices `held` (k,) bool stay where they are, and so do those of kept edges, of which so many are taken
    off the curves as the edges of the surface become longer. The rest makes up for what stays, unless less
    than a share of `REST` were left of it: there are more triangles then.
    """
    wanted = max(4, round(ratio * len(faces)))
    curves = find_curves(kept, points, held)
    locked = held.copy()
    locked[kept.ends] = True
    # A triangle mesh has two triangles for each vertex, one for those on open borders.
    worth = np.full(len(points), 2.0)
    worth[kept.ends[kept.is_open]] = 1.0
    stay = worth[locked].sum()
    points, faces, number = decimate(points, faces, locked, wanted + round((1.0 - ratio) * stay))
    check()
    chosen = dropped(curves, kept, _size(points), np.sqrt(ratio))
    faces, gone = _thinned(points, faces, curves, number, chosen)
    check()
    locked &= ~gone
    number = np.where(locked, number, -1)
    still = np.zeros(len(points), bool)
    still[number[number >= 0]] = True
    stay = worth[locked].sum()
    target = max(wanted, round(stay + REST * (wanted - ratio * stay)))
    points, faces, again = decimate(points, faces, still, target)
    number = np.where(number >= 0, again[number], -1)
    rows = [_edges_of(curve, number) for curve in curves]
    ends, edge, forward = (np.concatenate(column) for column in zip(*rows, strict=True)) if rows else _NONE
    return Simplified(points, faces, ends, edge, forward)


_NONE = (np.empty((0, 2), np.int64), np.empty(0, np.int64), np.empty(0, bool))


def _size(points: np.ndarray) -> float:
    return float(np.ptp(points, axis=0).max(initial=0.0))


def decimate(
    points: np.ndarray, faces: np.ndarray, locked: np.ndarray, target: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Points (p, 3), triangles (q, 3) of `target` or a few less, and the number (k,) of each locked vertex.

    fast-simplification leaves open borders alone, and with them all edges that end there, when it is told to.
    A triangle of its own at each locked vertex, a fin that hangs on it by this vertex alone, makes a border
    of it. Fins come last, before and after: so their first vertices say where the locked ones went.
    """
    import fast_simplification  # noqa: PLC0415

    used = np.zeros(len(points), bool)
    used[faces] = True
    anchors = np.flatnonzero(locked & used)
    number = np.full(len(points), -1)
    if target >= len(faces):
        kept = np.flatnonzero(used)
        number[kept] = np.arange(len(kept))
        return points[kept], number[faces], np.where(locked, number, -1)
    first = len(points) + 2 * np.arange(len(anchors))
    size = _size(points)
    tips = np.repeat(points[anchors], 2, axis=0) + np.tile(size * np.eye(3)[:2], (len(anchors), 1))
    fins = np.stack([anchors, first, first + 1], axis=1)
    new, made = fast_simplification.simplify(
        np.concatenate([points, tips]),
        np.concatenate([faces, fins]).astype(np.int32),
        target_count=target + len(fins),
        preserve_border=True,
    )
    n_faces = len(made) - len(fins)
    used, faces = np.unique(made[:n_faces], return_inverse=True)
    place = np.full(len(new), -1)
    place[used] = np.arange(len(used))
    number[anchors] = place[made[n_faces:, 0]]
    return new[used], faces.reshape(-1, 3), number


def _thinned(
    points: np.ndarray,
    faces: np.ndarray,
    curves: list[Curve],
    number: np.ndarray,
    chosen: list[np.ndarray],
) -> tuple[np.ndarray, np.ndarray]:
    """The triangles without the chosen vertices of curves, and which vertices (k,) are gone.

    Vertices that weigh least go first, each into its nearer neighbor on the curve, or the other one.
    """
    fans = Fans(points, faces)
    gone = np.zeros(len(number), bool)
    order, before, behind = [], {}, {}
    for row, (curve, mask) in enumerate(zip(curves, chosen, strict=True)):
        vertices = curve.vertices.tolist()
        order += [(curve.weight[place], vertices[place], row) for place in np.flatnonzero(mask).tolist()]
        for a, b in pairwise(vertices):
            behind[row, a], before[row, b] = b, a
    for _, vertex, row in sorted(order):
        one, other = before[row, vertex], behind[row, vertex]
        here = points[number[vertex]]
        sides = sorted((one, other), key=lambda end: float(np.linalg.norm(points[number[end]] - here)))
        if any(fans.collapse(int(number[vertex]), int(number[side])) for side in sides):
            gone[vertex] = True
            behind[row, one], before[row, other] = other, one
    return np.array([face for face in fans.faces if face is not None], np.int64).reshape(-1, 3), gone


def _edges_of(curve: Curve, number: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """What is left of a curve: ends (c, 2), an edge (c,) of each, and whether (c,) it runs that way."""
    left = np.flatnonzero(number[curve.vertices] >= 0)
    places = number[curve.vertices[left]]
    return np.stack([places[:-1], places[1:]], axis=1), curve.edges[left[:-1]], curve.forward[left[:-1]]
