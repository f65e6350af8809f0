# SPDX-License-Identifier: GPL-3.0-or-later
"""The surface that is computed on: split seams as one, and what a Mirror modifier adds to the mesh.

Formats that store a vertex once per normal or UV (glTF, PLY), and the Edge Split modifier, leave open
borders whose vertices lie in the same place, up to rounding. Computed as they are, the surface would tear
open along them. What is one place, and which faces are turned over, the wheel says. The images that a Mirror
modifier makes come after the mesh's own vertices and triangles (`mirroring`).
"""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
import ridgeform

from .mirroring import Images, Mirror, images_of


@dataclass
class Weld:
    """The welded mesh of a mesh: which of its vertices each vertex is, and what is left of its triangles.

    The first vertices and triangles are the mesh's own; images follow where there are any.
    """

    vertex: np.ndarray
    """The welded vertex (n,) of each vertex."""
    first: np.ndarray
    """A vertex (k,) of the mesh for each welded vertex, or the one that it is the image of."""
    triangles: np.ndarray
    """The welded triangles (l, 3), those that kept three different vertices."""
    rows: np.ndarray
    """The triangle (l,) of the mesh that each of these is, or is the image of."""
    images: Images | None = None
    """What is added by mirrors."""
    notes: list[str] = field(default_factory=list)
    """What a modeler should know of it."""

    @property
    def n_own(self) -> int:
        """How many of the welded triangles are no images."""
        return len(self.triangles) if self.images is None else self.images.n_triangles

    def places(self, coordinates: np.ndarray) -> np.ndarray:
        """Coordinates (k, 3) float64 of the welded vertices, from those (n, 3) of the mesh."""
        places = coordinates[self.first].astype(np.float64)
        return places if self.images is None else self.images.places(places)

    def moved(self, places: np.ndarray, coordinates: np.ndarray) -> np.ndarray:
        """Coordinates (n, 3) float32 of the mesh, once the welded vertices are at `places` (k, 3).

        `coordinates` (n, 3) are those before: on a mirror's plane a vertex keeps what it has of them across.
        """
        moved = np.asarray(places, np.float32)[self.vertex]
        if self.images is not None:
            before = self.places(coordinates)
            offset = self.images.held(np.asarray(places) - before)[self.vertex]
            pinned = self.images.is_pinned[self.vertex]
            # Where nothing is added the bits stay, those of -0 too.
            moved[pinned] = np.where(offset == 0.0, coordinates, coordinates + offset)[pinned]
        return moved

    def of_corners(self, values: np.ndarray) -> np.ndarray:
        """Values (l, 3) of the welded triangles' corners, from those of the mesh's own triangles."""
        if self.images is None:
            return values
        full = values[self.images.triangle_source]
        return np.where(self.images.is_turned[:, None], full[:, ::-1], full)

    def of(self, vertices: np.ndarray) -> np.ndarray:
        """The welded vertices of an array of vertices; the array itself if none were welded."""
        none = self.images is None and len(self.first) == len(self.vertex)
        return vertices if none else self.vertex[vertices]

    def all_of(self, mask: np.ndarray) -> np.ndarray:
        """Whether a mask (n,) holds for all the vertices of each welded vertex (k,)."""
        result = np.ones(len(self.first), bool)
        np.logical_and.at(result, self.vertex, mask)
        return self._with_images(result)

    def mean_of(self, values: np.ndarray) -> np.ndarray:
        """The mean of values (n,) over the vertices of each welded vertex (k,)."""
        return self.sum_of(values) / self.sum_of(np.ones(len(values)))

    def sum_of(self, values: np.ndarray) -> np.ndarray:
        """The sum of values (n,) over the vertices of each welded vertex (k,)."""
        return self._with_images(np.bincount(self.vertex, weights=values, minlength=len(self.first)))

    def _with_images(self, values: np.ndarray) -> np.ndarray:
        """Values (k,) in which images have those of what they are images of."""
        return values if self.images is None else values[self.images.source]


def weld_seams(coordinates: np.ndarray, triangles: np.ndarray) -> Weld:
    """Weld vertices on open borders whose coordinates (n, 3) are equal up to rounding; others stay."""
    _, welded, vertex = ridgeform.weld(coordinates, triangles)
    n_welded = int(vertex.max(initial=-1)) + 1
    first = np.empty(n_welded, np.int64)
    # The last one that is written stays: so the first.
    first[vertex[::-1]] = np.arange(len(vertex))[::-1]
    # Column by column: NumPy takes ten times as long along an axis of three.
    a, b, c = welded.T
    kept = (a != b) & (b != c) & (c != a)
    return Weld(vertex, first, welded if kept.all() else welded[kept], np.flatnonzero(kept))


def mirrored(weld: Weld, coordinates: np.ndarray, mirrors: Sequence[Mirror]) -> Weld:
    """The welded mesh with the images that mirrors make of it, where its border lies on their planes."""
    if not mirrors:
        return weld
    places = coordinates[weld.first].astype(np.float64)
    images = images_of(places, weld.triangles, mirrors)
    if images is None:
        return weld
    rows = weld.rows[images.triangle_source]
    return Weld(weld.vertex, weld.first[images.source], images.triangles, rows, images, weld.notes)


def seam_note(coordinates: np.ndarray, weld: Weld) -> str | None:
    """What a modeler should know of sides of seams that are not quite equal, if there are any."""
    apart = (coordinates != coordinates[weld.first[weld.vertex]]).any(axis=1)
    if not apart.any():
        return None
    count = int(apart.sum())
    what = "1 vertex lies" if count == 1 else f"{count} vertices lie"
    return f"{what} where others do, up to rounding, and went with them (Merge by Distance makes them one)"


def flip_note(weld: Weld, faces: np.ndarray) -> str | None:
    """What a modeler should know of faces that are turned against their neighbors, if there are any.

    `faces` (l,) is the face of each welded triangle.
    """
    _, flipped = ridgeform.orient(weld.triangles)
    count = len(np.unique(faces[flipped]))
    if count == 0:
        return None
    what = "1 face is" if count == 1 else f"{count} faces are"
    return (
        f"{what} turned against the faces around and went as if turned back "
        "(Mesh ▸ Normals ▸ Recalculate Outside does that)"
    )


def topology_notes(report: ridgeform.MeshReport, faces: np.ndarray) -> list[str]:
    """What a modeler should know of T-junctions and of faces that lie on others, if there are any.

    `faces` (l,) is the face of each welded triangle.
    """
    notes = []
    if count := len(report.t_junctions):
        what = "1 vertex lies" if count == 1 else f"{count} vertices lie"
        notes.append(
            f"{what} in the middle of edges of other faces (T-junctions: split these edges there, and Merge "
            "by Distance makes one surface of them)"
        )
    doubled = np.union1d(report.doubled_faces, report.duplicate_faces)
    if count := len(np.unique(faces[doubled.astype(np.int64)])):
        what = "1 face lies" if count == 1 else f"{count} faces lie"
        notes.append(f"{what} on others, as a second lid does (delete one of two)")
    return notes


def connected_parts(triangles: np.ndarray, n_vertices: int) -> np.ndarray:
    """The lowest vertex (n,) of the connected part of each vertex; triangles sharing one are joined."""
    label = np.arange(n_vertices)
    while True:
        corner = label[triangles]
        joined = label.copy()
        # Whole parts are joined, not single vertices: so few rounds are enough.
        np.minimum.at(joined, corner.ravel(), np.repeat(corner.min(axis=1), 3))
        while not np.array_equal(joined, joined[joined]):
            joined = joined[joined]
        if np.array_equal(joined, label):
            return label
        label = joined[label]
