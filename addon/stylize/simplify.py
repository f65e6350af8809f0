# SPDX-License-Identifier: GPL-3.0-or-later
"""Simplifying triangles with fast-simplification, while curves and vertices that must stay do so.

No Blender data here.
"""

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import ridgeform

from .collapse import Fans
from .curves import Curve, dropped, find_curves
from .kept_edges import KeptEdges

FEWEST = 4
"""The triangles of a tetrahedron, the least that enclose anything."""
REST = 0.5
"""Away from what must stay, no fewer triangles than this part of those asked for are left."""
REACH = 0.125
"""A torn place is first kept within this part of the longest edge there. Of a skull with thin walls, reduced
to 2 %, what is left lies 0.009 of its size off in the mean with 0.1, 0.025 with 0.25, and 0.029 with 0.5; at
12 % the three differ by a tenth."""
WIDENINGS = 4
"""How often the circle around a torn place becomes twice as wide."""
TOO_LITTLE = 0.95
"""A step that leaves more than this part of the triangles was asked for too much, and the next is asked for
less."""
LEAST_STEP = 0.99
"""A step that is to leave this part of the triangles away from torn places is the smallest."""


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
    whole, wanted = _Triangles(points, faces), max(FEWEST, round(ratio * len(faces)))
    curves = find_curves(kept, points, held)
    locked = held.copy()
    locked[kept.ends] = True
    # A triangle mesh has two triangles for each vertex, one for those on open borders.
    worth = np.full(len(points), 2.0)
    worth[kept.ends[kept.is_open]] = 1.0
    own = _Share(whole, ratio, wanted, worth[locked].sum(), locked)
    points, faces, number = decimate(points, faces, locked, own.target(whole, locked, 1.0))
    check()
    chosen = dropped(curves, kept, _size(points), np.sqrt(ratio))
    faces, gone = _thinned(points, faces, curves, number, chosen)
    check()
    locked &= ~gone
    number = np.where(locked, number, -1)
    still = np.zeros(len(points), bool)
    still[number[number >= 0]] = True
    own = _Share(whole, ratio, wanted, worth[locked].sum(), locked)
    target = max(wanted, own.target(_Triangles(points, faces), still, REST))
    points, faces, again = decimate(points, faces, still, target)
    number = np.where(number >= 0, again[number], -1)
    rows = [_edges_of(curve, number) for curve in curves]
    ends, edge, forward = (np.concatenate(column) for column in zip(*rows, strict=True)) if rows else _NONE
    return Simplified(points, faces, ends, edge, forward)


_NONE = (np.empty((0, 2), np.int64), np.empty(0, np.int64), np.empty(0, bool))


def _size(points: np.ndarray) -> float:
    return float(np.ptp(points, axis=0).max(initial=0.0))


def _lengths(corners: np.ndarray) -> np.ndarray:
    """The lengths (q, 3) of the sides of triangles with these corners (q, 3, 3)."""
    return np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2)


@dataclass
class _Triangles:
    """Points (p, 3) and triangles (q, 3)."""

    points: np.ndarray
    faces: np.ndarray

    def odd(self) -> np.ndarray:
        """The vertices (p,) bool around which triangles are no surface, or are there twice."""
        report = ridgeform.Mesh(self.points, self.faces.astype(np.int32)).report
        odd = np.zeros(len(self.points), bool)
        odd[report.nonmanifold_edges] = True
        odd[report.nonmanifold_vertices] = True
        odd[self.faces[report.duplicate_faces]] = True
        return odd

    def longest(self, vertices: np.ndarray) -> float:
        """The length of the longest edge of triangles with one of these vertices."""
        here = self.faces[np.isin(self.faces, vertices).any(axis=1)]
        return float(_lengths(self.points[here]).max(initial=0.0))


@dataclass
class _Share:
    """What is left of `whole` beside what stays, when `ratio` of all is asked for."""

    whole: _Triangles
    ratio: float
    wanted: int
    stay: float
    """The triangles that the vertices which stay must have."""
    locked: np.ndarray
    """Which vertices (k,) bool of the whole these are."""

    def target(self, made: _Triangles, still: np.ndarray, share: float) -> int:
        """The triangles to ask for, so that so much is left of what would be beside.

        By the vertices that stay; and by the triangles of `made` that must stay beside those (`still` (p,)
        bool there), which may be more, and by what is as far from them as edges become long.
        """
        by_vertices = self.stay + share * (self.wanted - self.ratio * self.stay)
        if not still.any():
            return round(by_vertices)
        least = len(_collapsed(made, still, FEWEST)[0].faces)
        return max(round(by_vertices), round(least + share * self.ratio * self._n_far()))

    def _n_far(self) -> int:
        """How many triangles lie farther from what stays than half an edge is long then."""
        mean = float(_lengths(self.whole.points[self.whole.faces]).mean())
        places = self.whole.points[self.locked]
        near = _around(self.whole.points, places, 0.5 * mean / np.sqrt(self.ratio))
        return int((~near[self.whole.faces]).all(axis=1).sum())


def decimate(
    points: np.ndarray, faces: np.ndarray, locked: np.ndarray, target: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Points (p, 3), triangles (q, 3) of `target` or a few less, and the number (k,) of each locked vertex.

    fast-simplification collapses edges without asking whether that ties together what is apart, as the sides
    of a thin finger. Where it did, it begins anew, and the vertices around such places are kept; what they
    are too many is for further steps. Where that does not help, more triangles stay.
    """
    whole = made = _Triangles(points, faces)
    number = np.arange(len(points))
    share = target / max(1, len(faces))
    while len(made.faces) > target and share < LEAST_STEP:
        here = np.zeros(len(made.points), bool)
        here[number[locked & (number >= 0)]] = True
        step = _untorn(made, here, max(share, target / len(made.faces)), whole, target)
        if step is None or len(step[0].faces) > TOO_LITTLE * len(made.faces):
            share = np.sqrt(share)
        if step is not None and len(step[0].faces) < len(made.faces):
            made, number = step[0], np.where(locked & (number >= 0), step[1][number], -1)
            if step[2] <= target:
                break
    return made.points, made.faces, np.where(locked, number, -1)


def _untorn(
    before: _Triangles, locked: np.ndarray, share: float, whole: _Triangles, target: int
) -> tuple[_Triangles, np.ndarray, int] | None:
    """What is left with the vertices kept around which it would be torn, and how many triangles that was to
    be; None where it always is.

    They are to be `target`. But away from vertices that are kept, no less than `share` of them is left, and
    no less than `REST` of what `target` triangles of the `whole` would be there: the rest does not make up
    for what those have too many, however many steps there are.
    """
    kept, torn_there = locked.copy(), np.zeros(len(whole.points), bool)
    for widening in range(WIDENINGS):
        beside = int((kept & ~locked)[before.faces].any(axis=1).sum())
        away = len(whole.faces) - int(torn_there[whole.faces].any(axis=1).sum())
        rest = max(share * (len(before.faces) - beside), REST * target * away / len(whole.faces))
        asked = max(target, beside + round(rest))
        made, number = _collapsed(before, kept, asked)
        torn, lost = _torn(made, before, number), _lost(before, kept, number)
        if not len(torn) + len(lost):
            return made, np.where(locked, number, -1), asked
        places = np.concatenate([made.points[torn], before.points[lost]])
        reach = REACH * 2.0**widening * max(made.longest(torn), before.longest(lost))
        kept |= _around(before.points, places, reach)
        torn_there |= _around(whole.points, places, reach)
    return None


def _collapsed(before: _Triangles, locked: np.ndarray, target: int) -> tuple[_Triangles, np.ndarray]:
    """What fast-simplification makes of triangles, and the number (k,) of each locked vertex in that.

    It leaves open borders alone, and with them all edges that end there, when it is told to. A triangle of
    its own at each locked vertex, a fin that hangs on it by this vertex alone, makes a border of it. Fins
    come last, before and after: so their first vertices say where the locked ones went.
    """
    import fast_simplification  # noqa: PLC0415

    points, faces = before.points, before.faces
    used = np.zeros(len(points), bool)
    used[faces] = True
    anchors = np.flatnonzero(locked & used)
    number = np.full(len(points), -1)
    if target >= len(faces):
        kept = np.flatnonzero(used)
        number[kept] = np.arange(len(kept))
        return _Triangles(points[kept], number[faces]), np.where(locked, number, -1)
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
    return _Triangles(new[used], faces.reshape(-1, 3)), number


def _torn(made: _Triangles, before: _Triangles, number: np.ndarray) -> np.ndarray:
    """The vertices at which triangles were tied together, or are there twice, unless it was so before."""
    odd = made.odd()
    if odd.any():
        known = number[np.flatnonzero(before.odd())]
        odd[known[known >= 0]] = False
    return np.flatnonzero(odd)


def _lost(before: _Triangles, kept: np.ndarray, number: np.ndarray) -> np.ndarray:
    """The vertices that were to stay, but have no triangle left: all of theirs closed up."""
    gone = kept & (number < 0)
    return (
        np.flatnonzero(gone & np.isin(np.arange(len(gone)), before.faces)) if gone.any() else np.empty(0, int)
    )


def _around(points: np.ndarray, centers: np.ndarray, reach: float) -> np.ndarray:
    """Which points (k,) bool lie in cells of a grid of this width that have a center, or in those beside."""
    low = points.min(axis=0) - reach
    cells, there = (np.floor((some - low) / reach).astype(np.int64) for some in (points, centers))
    beside = np.stack(np.meshgrid(*[[-1, 0, 1]] * 3), axis=-1).reshape(-1, 1, 3) + there
    height, width = cells[:, 1:].max(axis=0) + 2
    names = [(part[..., 0] * height + part[..., 1]) * width + part[..., 2] for part in (cells, beside)]
    return np.isin(names[0], names[1])


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
