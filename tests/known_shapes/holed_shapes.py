"""Shapes with a hole cut into them, and what was there before: the truth that a filling is measured against.

The same arguments give the same bits: all randomness is seeded.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from . import shapes
from .fill_measures import boundary_edges, point_distances

Points = NDArray[np.float64]
Faces = NDArray[np.int64]

Place = tuple[Points, float]
"""Where a hole is cut: its center and radius."""

RIDGE_STEP = 0.005
"""Distance of the true ridge points: far below every edge length in use."""
BEND = np.cos(np.radians(30.0))
"""Edges that bend by less are no ridge: the flat pieces, and the sides of a finely meshed curve."""
JITTER = 0.22
"""How far `irregular` moves a vertex, in its shortest edges: beyond a quarter, triangles begin to fold."""
FLIPS = 0.4
"""The share of the edges that `irregular` flips where that leaves no sliver."""
LEAST_ANGLE = np.radians(18.0)
"""No triangle that a flip makes has a smaller one."""


@dataclass(frozen=True)
class Solid:
    """A closed mesh of a shape that is known exactly."""

    vertices: Points
    faces: Faces
    ridge: Points
    """Points `(k, 3)` along all true ridges; none on a smooth shape."""
    distance: Callable[[Points], Points]
    """The unsigned distance of points `(p, 3)` to the true surface."""
    onto: Callable[[Points], Points]
    """Points near the surface brought back onto it, those on ridges staying on their ridge."""


@dataclass(frozen=True)
class Holed:
    """A solid with holes."""

    vertices: Points
    faces: Faces
    before: tuple[Points, Faces]
    """The mesh that nothing was taken from: what a perfect filling at this density looks like."""
    ridge: Points
    """The true ridge points `(k, 3)` that were cut away."""
    distance: Callable[[Points], Points]
    """As in `Solid`."""
    edge: float
    """The mean edge length."""


def _segments(ends: NDArray) -> Points:
    """Points along straight pieces `(k, 2, 3)`."""
    parts = []
    for a, b in ends:
        t = np.linspace(0.0, 1.0, max(2, int(np.linalg.norm(b - a) / RIDGE_STEP) + 1))
        parts.append(a + t[:, None] * (b - a))
    return np.concatenate(parts) if parts else np.zeros((0, 3))


def _normals(vertices: Points, faces: Faces) -> Points:
    a, b, c = (vertices[faces[:, i]] for i in range(3))
    normal = np.cross(b - a, c - a)
    return normal / np.linalg.norm(normal, axis=1, keepdims=True)


def _edge_pairs(faces: Faces) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """The edges `(k, 2)` with two faces, and those faces `(k, 2)`."""
    halfedges = np.sort(faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    order = np.lexsort((halfedges[:, 0], halfedges[:, 1]))
    same = (halfedges[order][1:] == halfedges[order][:-1]).all(axis=1)
    first = np.flatnonzero(same)
    return halfedges[order][first], np.stack([order[first], order[first + 1]], axis=1) // 3


def polyhedron(coarse: shapes.Shape, fine: shapes.Shape) -> Solid:
    """A solid with flat sides: the same surface in as few triangles as it takes, and as fine as wanted."""
    vertices, faces = coarse
    normals = _normals(vertices, faces)
    edges, sides = _edge_pairs(faces)
    creased = (normals[sides[:, 0]] * normals[sides[:, 1]]).sum(axis=1) < BEND
    own = _normals(*fine)
    spread = np.zeros((len(fine[0]), 3, 3))
    for i in range(3):
        np.add.at(spread, fine[1][:, i], own[:, :, None] * own[:, None, :])
    size, direction = np.linalg.eigh(spread)
    # Along directions that no face around it faces, a vertex may move without leaving its sides.
    free = direction * (size < 1e-6)[:, None, :]
    allowed = free @ free.transpose(0, 2, 1)
    home = fine[0]

    def onto(points: Points) -> Points:
        return home + np.einsum("nij,nj->ni", allowed, points - home)

    return Solid(
        *fine, _segments(vertices[edges[creased]]), lambda p: point_distances(p, vertices, faces), onto
    )


def cube(n: int) -> Solid:
    """`shapes.cube(n)`, side 2."""
    return polyhedron(shapes.cube(1), shapes.cube(n))


def step(n: int) -> Solid:
    """`shapes.l_shape(n // 2)`: unit cells in an L, one concave edge."""
    return polyhedron(shapes.l_shape(1), shapes.l_shape(n // 2))


def roof(n: int, rise: float = 0.5) -> Solid:
    """A cube with its top raised to a gable along y: the ridge at z = 1 + `rise` bends by `2 atan(rise)`."""

    def raised(shape: shapes.Shape) -> shapes.Shape:
        vertices, faces = shape
        lift = rise * (1 - np.abs(vertices[:, 0])) * 0.5 * (vertices[:, 2] + 1)
        return vertices + np.stack([np.zeros(len(lift)), np.zeros(len(lift)), lift], axis=1), faces

    even = n + n % 2
    return polyhedron(raised(shapes.cube(2)), raised(shapes.cube(even)))


def cylinder(n: int) -> Solid:
    """Radius 1, height 2, edges of about `2 / n`: two curved ridges."""
    segments, rings = round(np.pi * n), max(2, n // 2)
    vertices, faces = shapes.cylinder(segments, n, rings)
    radius = np.hypot(vertices[:, 0], vertices[:, 1])
    on_side, on_cap = radius > 1 - 1e-9, np.abs(vertices[:, 2]) > 1 - 1e-9

    def onto(points: Points) -> Points:
        moved = points.copy()
        moved[on_side, :2] /= np.linalg.norm(moved[on_side, :2], axis=1, keepdims=True)
        moved[on_cap, 2] = np.sign(vertices[on_cap, 2])
        return moved

    def distance(points: Points) -> Points:
        q = np.stack([np.hypot(points[:, 0], points[:, 1]), np.abs(points[:, 2])], axis=1) - 1
        return np.abs(np.linalg.norm(np.maximum(q, 0), axis=1) + np.minimum(q.max(axis=1), 0))

    angle = np.linspace(0, 2 * np.pi, int(2 * np.pi / RIDGE_STEP))
    rim = np.stack([np.cos(angle), np.sin(angle), np.ones_like(angle)], axis=1)
    return Solid(vertices, faces, np.concatenate([rim, rim * [1, 1, -1]]), distance, onto)


def sphere(n: int) -> Solid:
    """Radius 1, edges of about `2 / n`: no ridge."""
    vertices, faces = shapes.icosphere(2 if n <= 10 else 3 if n <= 20 else 4)
    return Solid(
        vertices,
        faces,
        np.zeros((0, 3)),
        lambda points: np.abs(np.linalg.norm(points, axis=1) - 1),
        lambda points: points / np.linalg.norm(points, axis=1, keepdims=True),
    )


def irregular(solid: Solid, seed: int) -> Solid:
    """The same surface with its vertices moved along it at random and many of its flat edges flipped."""
    rng = np.random.default_rng(seed)
    edges, _ = _edge_pairs(solid.faces)
    length = np.linalg.norm(solid.vertices[edges[:, 0]] - solid.vertices[edges[:, 1]], axis=1)
    shortest = np.full(len(solid.vertices), np.inf)
    np.minimum.at(shortest, edges.ravel(), np.repeat(length, 2))
    size = JITTER * shortest[:, None]
    moved = solid.onto(solid.vertices + size * rng.uniform(-1, 1, solid.vertices.shape))
    faces = _flipped(moved, solid.faces, rng)
    return Solid(moved, faces, solid.ridge, solid.distance, solid.onto)


def _angles(a: Points, b: Points, c: Points) -> list[float]:
    def at(p: Points, q: Points, r: Points) -> float:
        u, v = q - p, r - p
        return float(np.arctan2(np.linalg.norm(np.cross(u, v)), u @ v))

    return [at(a, b, c), at(b, c, a), at(c, a, b)]


def _flipped(vertices: Points, faces: Faces, rng: np.random.Generator) -> Faces:
    """Faces with a random share of the edges flipped that lie flat and leave no sliver."""
    faces = faces.copy()
    edges, pairs = _edge_pairs(faces)
    present = {tuple(edge) for edge in edges.tolist()}
    touched = np.zeros(len(faces), bool)
    for k in rng.permutation(len(edges))[: int(FLIPS * len(edges))].tolist():
        (i, j), (f, g) = edges[k], pairs[k]
        if touched[f] or touched[g]:
            continue
        # In the order of face f: the edge goes from a to b, c is opposite in f and d in g.
        row = faces[f].tolist()
        a = i if row[(row.index(i) + 1) % 3] == j else j
        b = i + j - a
        c, d = (int(sum(faces[h]) - a - b) for h in (f, g))
        if tuple(sorted((c, d))) in present:
            continue
        new = np.array([[a, d, c], [d, b, c]])
        bend = _normals(vertices, np.concatenate([new, faces[[f, g]]]))
        if (bend @ bend.T).min() < BEND:
            continue
        if min(angle for face in new for angle in _angles(*vertices[face])) < LEAST_ANGLE:
            continue
        faces[f], faces[g] = new
        present.add(tuple(sorted((c, d))))
        touched[[f, g]] = True
    return faces


def cut(solid: Solid, places: list[Place], seed: int = 0, *, stretch: float = 1.0) -> Holed:
    """The solid without its faces around `places`, see `removed_faces`, and turned at random.

    Seed 0 leaves it as it stands.
    """
    vertices, faces = solid.vertices, solid.faces
    removed = removed_faces(vertices, faces, places, seed, stretch=stretch)
    turn = np.eye(3) if seed == 0 else shapes.random_rotation(seed)
    used, index = np.unique(faces[~removed], return_inverse=True)
    gone = solid.ridge[_lost(solid.ridge, vertices, faces, removed)]
    return Holed(
        vertices[used] @ turn.T,
        index.reshape(-1, 3).astype(np.int64),
        (vertices @ turn.T, faces),
        gone @ turn.T,
        lambda points: solid.distance(points @ turn),
        shapes.mean_edge_length(vertices, faces),
    )


def removed_faces(
    vertices: Points, faces: Faces, places: list[Place], seed: int = 0, *, stretch: float = 1.0
) -> NDArray[np.bool_]:
    """Which faces `(m,)` lie around places; with `stretch` above 1 that much longer than wide, at random.

    Loops never touch themselves: faces go until each border vertex has two border edges, and so does all that
    was cut off from the largest part.
    """
    rng = np.random.default_rng(seed)
    removed = np.zeros(len(faces), bool)
    middle = vertices[faces].mean(axis=1)
    root = np.sqrt(stretch)
    for center, radius in places:
        axis = rng.standard_normal(3)
        axis /= np.linalg.norm(axis)
        away = middle - center
        along = away @ axis
        across2 = np.maximum((away**2).sum(axis=1) - along**2, 0)
        removed |= np.sqrt(along**2 / root**2 + across2 * root**2) < radius
    return _without_bow_ties(faces, removed)


def _lost(points: Points, vertices: Points, faces: Faces, removed: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Which points `(p,)` are nearer to a removed face than to every kept one."""
    to_removed = point_distances(points, vertices, faces[removed])
    longest = np.linalg.norm(vertices[faces] - vertices[np.roll(faces, 1, axis=1)], axis=2).max()
    lost = to_removed < longest
    lost[lost] = to_removed[lost] < point_distances(points[lost], vertices, faces[~removed]) - 1e-9
    return lost


def _without_bow_ties(faces: Faces, removed: NDArray[np.bool_]) -> NDArray[np.bool_]:
    removed = removed.copy()
    while True:
        kept = np.flatnonzero(~removed)
        largest = _largest_part(faces[kept])
        removed[kept[~largest]] = True
        vertex, count = np.unique(boundary_edges(faces[~removed]), return_counts=True)
        pinched = vertex[count > 2]
        if len(pinched) == 0:
            return removed
        removed |= np.isin(faces, pinched).any(axis=1)


def _largest_part(faces: Faces) -> NDArray[np.bool_]:
    """Which faces are in the part, joined over edges, that has most."""
    label = np.arange(len(faces))
    _, pairs = _edge_pairs(faces)
    while True:
        low = label[pairs].min(axis=1)
        new = label.copy()
        np.minimum.at(new, label[pairs[:, 0]], low)
        np.minimum.at(new, label[pairs[:, 1]], low)
        new = new[new]
        if np.array_equal(new, label):
            break
        label = new
    part, count = np.unique(label, return_counts=True)
    return label == part[count.argmax()]
