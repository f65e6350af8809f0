# SPDX-License-Identifier: GPL-3.0-or-later
"""Finding the ridges: edges with a large angle between their two faces."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..blender.mirroring import Plane


@dataclass(frozen=True)
class Edges:
    """The edges of a mesh: their ends (k, 2), and of faces of any size what `edge_angles` takes."""

    ends: np.ndarray
    corners: tuple[np.ndarray, np.ndarray, np.ndarray]
    planes: Sequence[Plane] = ()
    """The planes across which mirrors continue the mesh."""

    def ridges(self, coordinates: np.ndarray, least: float | np.ndarray | None = None) -> np.ndarray:
        """Which edges (k,) bool are bent by at least an angle (radians), or what parts them from the others.

        `coordinates` (n, 3); the angle may be one for each edge.
        """
        angles = edge_angles(coordinates, self.corners, len(self.ends))
        for plane in self.planes:
            self._bend_on(plane, coordinates, angles)
        if least is None:
            lengths = np.linalg.norm(coordinates[self.ends[:, 0]] - coordinates[self.ends[:, 1]], axis=1)
            least = dividing_angle(angles, lengths.astype(np.float64))
        return (angles >= 0) & (angles >= least)

    def sides(self, of_faces: np.ndarray) -> np.ndarray:
        """What the two faces of each edge have (k, 2), of what each face has (f,).

        -1 where there are not two.
        """
        pairs, first, second, face = _with_two_faces(self.corners, len(self.ends))
        sides = np.full((len(self.ends), 2), -1, np.int64)
        sides[pairs] = of_faces[face[np.stack([first, second], axis=1)]]
        return sides

    def on_planes(self, coordinates: np.ndarray) -> np.ndarray:
        """Which edges (k,) bool are open and lie on the plane of a mirror."""
        found = np.zeros(len(self.ends), bool)
        for plane in self.planes:
            found |= self._open_on(plane, coordinates)
        return found

    def _open_on(self, plane: Plane, coordinates: np.ndarray) -> np.ndarray:
        count = np.bincount(self.corners[2], minlength=len(self.ends))
        return (count == 1) & plane.holds(coordinates.astype(np.float64))[self.ends].all(axis=1)

    def _bend_on(self, plane: Plane, coordinates: np.ndarray, angles: np.ndarray) -> None:
        """Enter how far (k,) the faces at open edges on a mirror's plane are bent against their images."""
        starts, vertices, corner_edges = self.corners
        corner = np.flatnonzero(self._open_on(plane, coordinates)[corner_edges])
        face = np.searchsorted(starts, corner, side="right") - 1
        normals = face_normals(coordinates, starts, vertices)[face]
        lengths = np.linalg.norm(normals, axis=1)
        corner, normals, lengths = corner[lengths > 0], normals[lengths > 0], lengths[lengths > 0]
        across = np.clip(np.abs(normals @ plane.normal) / lengths, 0.0, 1.0)
        angles[corner_edges[corner]] = 2.0 * np.arcsin(across)


def face_normals(coordinates: np.ndarray, starts: np.ndarray, vertices: np.ndarray) -> np.ndarray:
    """Newell's normals (f, 3) of faces of any size, as long as twice their area.

    Faces are given by the start of each in the corner arrays (f,) and the vertex of each corner (c,).
    """
    if len(starts) == 0:
        return np.empty((0, 3))
    following = np.arange(1, len(vertices) + 1)
    following[np.append(starts[1:], len(vertices)) - 1] = starts
    # Relative to one corner of each face: otherwise faces far from the origin lose their digits.
    sizes = np.diff(np.append(starts, len(vertices)))
    corners = coordinates.astype(np.float64)[vertices]
    corners -= np.repeat(corners[starts], sizes, axis=0)
    return np.add.reduceat(np.cross(corners, corners[following]), starts, axis=0)


def _with_two_faces(
    corners: tuple[np.ndarray, np.ndarray, np.ndarray], n_edges: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """The edges (p,) that have two faces, the corner (p,) of either at them, the face (c,) of each corner."""
    starts, vertices, corner_edges = corners
    face = np.repeat(np.arange(len(starts)), np.diff(np.append(starts, len(vertices))))
    order = np.argsort(corner_edges, kind="stable")
    count = np.bincount(corner_edges, minlength=n_edges)
    pairs = np.flatnonzero(count == 2)
    begin = (np.cumsum(count) - count)[pairs]
    return pairs, order[begin], order[begin + 1], face


def edge_angles(
    coordinates: np.ndarray, corners: tuple[np.ndarray, np.ndarray, np.ndarray], n_edges: int
) -> np.ndarray:
    """The angle (n_edges,) in radians between the two faces of each edge.

    -1 for edges with one face or more than two, and for those beside a face without area. Two faces that run
    along the edge the same way (disagreeing normals) are compared as if one was turned over.
    """
    starts, vertices, _ = corners
    normals = face_normals(coordinates, starts, vertices)
    pairs, first, second, face = _with_two_faces(corners, n_edges)
    a, b = normals[face[first]], normals[face[second]]
    b = np.where((vertices[first] == vertices[second])[:, None], -b, b)
    # atan2 stays exact for tiny angles, where the arc cosine does not.
    sine = np.linalg.norm(np.cross(a, b), axis=1)
    cosine = np.einsum("ij,ij->i", a, b)
    has_area = (np.einsum("ij,ij->i", a, a) > 0) & (np.einsum("ij,ij->i", b, b) > 0)
    angles = np.full(n_edges, -1.0)
    angles[pairs] = np.where(has_area, np.arctan2(sine, cosine), -1.0)
    return angles


def dividing_angle(angles: np.ndarray, lengths: np.ndarray) -> float:
    """The angle (radians) that parts the edges within facets from the ridges between them.

    Otsu's threshold (1979): the two classes of edges whose means lie farthest apart for their sizes, each
    edge with its length as weight. On roots of angles, since within facets they spread over decades: 4 to 9
    degrees on scans and subdivided meshes after the flow, 14 on meshes of a few hundred vertices, where the
    angles themselves give 30 and their logarithms 1.

    `angles` (e,) in radians, those below 0 do not count; `lengths` (e,). Infinite where all angles are alike.
    """
    counted = (angles >= 0) & (lengths > 0)
    order = np.argsort(angles[counted])
    roots, weights = np.sqrt(angles[counted][order]), lengths[counted][order]
    if len(roots) < 2 or roots[0] == roots[-1]:
        return np.inf
    size, total = np.cumsum(weights), np.cumsum(weights * roots)
    below, above = size[:-1], size[-1] - size[:-1]
    between = (total[:-1] * size[-1] - total[-1] * below) ** 2 / (below * above)
    # Where angles are equal no threshold can part them.
    between[roots[1:] == roots[:-1]] = -1.0
    k = int(between.argmax())
    return float(((roots[k] + roots[k + 1]) / 2.0) ** 2)
