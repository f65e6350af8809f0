# SPDX-License-Identifier: GPL-3.0-or-later
"""The images that mirrors make of a mesh, joined to it where its open border lies on their planes.

Computed on mesh and images together, the surface goes on across the planes as if the other half were there.
No Blender data here: `modifiers` reads the mirrors of an object.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

EXACT = 1e-12
"""Entries of a projection that are this close to 0 or 1 are just that, but for rounding."""

ALONG = 1e-5
"""A direction along a plane is changed by less, in parts of its length: matrices of objects have single
precision."""


@dataclass(frozen=True)
class Mirror:
    """One reflection, as Blender applies it to all that earlier ones have made."""

    matrix: np.ndarray
    """The reflection (4, 4) in the space of the object, its own inverse."""
    reach: float
    """Vertices that are closer than this to their own image are one with it."""

    def image(self, places: np.ndarray) -> np.ndarray:
        """The images of places (n, 3)."""
        return places @ self.matrix[:3, :3].T + self.matrix[:3, 3]


@dataclass(frozen=True)
class Plane:
    """A mirror's plane: its normal (3,), its offset along it, and which vertices (k,) bool lie on it."""

    normal: np.ndarray
    offset: float
    is_on: np.ndarray
    reach: float = 0.0
    """How far from it others become one with their image, too."""

    def holds(self, places: np.ndarray) -> np.ndarray:
        """Which of some places (n, 3) bool lie on it."""
        rounding = np.finfo(np.float32).eps * float(np.abs(places).max(initial=0.0))
        return np.abs(places @ self.normal - self.offset) <= max(0.5 * self.reach, rounding)


@dataclass
class Images:
    """A mesh of k vertices and l triangles with its images, the mesh's own first."""

    source: np.ndarray
    """The vertex (K,) of the mesh that each vertex is, or is the image of."""
    triangles: np.ndarray
    """All triangles (L, 3)."""
    triangle_source: np.ndarray
    """The triangle (L,) of the mesh that each is, or is the image of."""
    is_turned: np.ndarray
    """Which triangles (L,) bool name their corners in the opposite order."""
    n_vertices: int
    """How many of the vertices are the mesh's own."""
    n_triangles: int
    """How many of the triangles are."""
    maps: np.ndarray
    """Affine maps (c, 3, 4) from the place of a vertex to that of its image."""
    chart: np.ndarray
    """Which of them (K,) each vertex has."""
    pins: np.ndarray
    """Projections (p, 3, 3) of movements onto what mirrors let a vertex do; the first lets it do all."""
    pin: np.ndarray
    """Which of them each vertex (K,) has; images have the first."""
    planes: list["Plane"]
    """The planes of the mirrors that were used."""

    @property
    def is_pinned(self) -> np.ndarray:
        """Which vertices (K,) bool of the mesh lie on a plane."""
        return self.pin > 0

    def places(self, places: np.ndarray) -> np.ndarray:
        """The places (K, 3) of all vertices, given those (K, 3) of what they are images of."""
        result = places.copy()
        for number, (linear, shift) in enumerate((chart[:, :3], chart[:, 3]) for chart in self.maps):
            rows = self.chart == number
            if number > 0:
                result[rows] = places[rows] @ linear.T + shift
        return result

    def held(self, offsets: np.ndarray) -> np.ndarray:
        """What is left of movements (K, 3) of vertices that mirrors hold on their planes."""
        return np.einsum("kij,kj->ki", self.pins[self.pin], offsets)


def images_of(places: np.ndarray, triangles: np.ndarray, mirrors: Sequence[Mirror]) -> Images | None:
    """The images of places (k, 3) and triangles (l, 3) by mirrors in turn; `None` where there is no use.

    A mirror counts if an open border edge lies on its plane: a surface that only passes through it, or does
    not reach it, meets no image there.
    """
    work = _Work(places, triangles)
    for mirror in mirrors:
        work.apply(mirror)
    return work.images() if len(work.source) > len(places) else None


class _Work:
    """What the mirrors up to now have made."""

    def __init__(self, places: np.ndarray, triangles: np.ndarray) -> None:
        self.own, self.own_triangles = len(places), len(triangles)
        self.places, self.triangles = places, triangles.astype(np.int64)
        self.source, self.triangle_source = np.arange(len(places)), np.arange(len(triangles))
        self.is_turned = np.zeros(len(triangles), bool)
        self.maps = [np.eye(4)]
        self.chart = np.zeros(len(places), np.int64)
        # The mirrors, as bits, on whose planes the mesh's own vertices lie.
        self.on = np.zeros(len(places), np.int64)
        self.used: list[Mirror] = []

    def apply(self, mirror: Mirror) -> None:
        image = mirror.image(self.places)
        joined = np.linalg.norm(image - self.places, axis=1) < mirror.reach
        border = _border_edges(self.triangles, len(self.places))
        if not joined[border].all(axis=1).any():
            return
        self.on[joined[: self.own]] |= 1 << len(self.used)
        self.used.append(mirror)
        count = len(self.places)
        alone = np.flatnonzero(~joined)
        number = np.arange(count)
        number[alone] = count + np.arange(len(alone))
        middle = 0.5 * (np.eye(4) + mirror.matrix)
        self._compose(joined, middle)
        charts = self.chart[alone]
        self.chart = np.concatenate([self.chart, charts])
        made = np.zeros(len(self.chart), bool)
        made[count:] = True
        self._compose(made, mirror.matrix)
        held = np.where(joined[:, None], 0.5 * (image + self.places), self.places)
        self.places = np.concatenate([held, image[alone]])
        self.source = np.concatenate([self.source, self.source[alone]])
        # A face within the plane is its own image.
        seen = ~joined[self.triangles].all(axis=1)
        self.triangles = np.concatenate([self.triangles, number[self.triangles[seen]][:, ::-1]])
        self.triangle_source = np.concatenate([self.triangle_source, self.triangle_source[seen]])
        self.is_turned = np.concatenate([self.is_turned, ~self.is_turned[seen]])

    def _compose(self, rows: np.ndarray, matrix: np.ndarray) -> None:
        """Follow the maps of vertices `rows` (K,) bool by another one."""
        for chart in np.unique(self.chart[rows]).tolist():
            self.maps.append(matrix @ self.maps[chart])
            self.chart[rows & (self.chart == chart)] = len(self.maps) - 1

    def images(self) -> Images:
        kinds, pin = np.unique(np.append(self.on, 0), return_inverse=True)
        pins = np.stack([self._projection(int(kind)) for kind in kinds])
        full = np.zeros(len(self.source), np.int64)
        full[: self.own] = pin[:-1]
        return Images(
            self.source,
            self.triangles.astype(np.int32),
            self.triangle_source,
            self.is_turned,
            self.own,
            self.own_triangles,
            np.stack(self.maps)[:, :3],
            self.chart,
            pins,
            full,
            [self._plane(bit, mirror) for bit, mirror in enumerate(self.used)],
        )

    def _plane(self, bit: int, mirror: Mirror) -> Plane:
        """Where a reflection leaves points alone: (1 - R) x = t, whose rows differ in size only."""
        out, sizes, across = np.linalg.svd(np.eye(3) - mirror.matrix[:3, :3])
        normal = across[0]
        for value in (0.0, 1.0, -1.0):
            normal[np.abs(normal - value) < EXACT] = value
        offset = float(out[:, 0] @ mirror.matrix[:3, 3] / sizes[0])
        return Plane(normal, offset, self.on >> bit & 1 > 0, mirror.reach)

    def _projection(self, mirrors: int) -> np.ndarray:
        """The projection (3, 3) onto the directions that all mirrors of a set of bits leave alone."""
        across = [np.zeros((3, 3))]
        for bit, mirror in enumerate(self.used):
            if mirrors >> bit & 1:
                across.append(np.eye(3) - mirror.matrix[:3, :3])
        _, sizes, rows = np.linalg.svd(np.concatenate(across))
        free = rows[sizes < ALONG]
        projection = free.T @ free
        for value in (0.0, 1.0):
            projection[np.abs(projection - value) < EXACT] = value
        return projection


def _border_edges(triangles: np.ndarray, n_vertices: int) -> np.ndarray:
    """The edges (b, 2) with one triangle."""
    ends = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    keys = np.sort(ends, axis=1) @ [n_vertices, 1]
    _, first, count = np.unique(keys, return_index=True, return_counts=True)
    return ends[first[count == 1]]
