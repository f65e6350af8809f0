# SPDX-License-Identifier: GPL-3.0-or-later
"""Facets of a shape on its own faces: where these are as large as facets, a flow only rounds it off."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import ridgeform

from ..blender.mirroring import Plane
from ..blender.polygons import Polygons
from ..blender.welding import Weld
from ..framework import keeping
from ..framework.ridges import Edges, face_normals


@dataclass
class OwnFaces:
    """A mesh whose vertices can go onto facets while its faces stay."""

    weld: Weld
    """Its surface, without images of mirrors."""
    faces: np.ndarray
    """The face (l,) of each welded triangle."""
    corners: np.ndarray
    """Its corners (l, 3) among those of all faces."""
    polygons: Polygons
    """All faces."""
    planes: Sequence[Plane]
    """The planes of mirrors that borders lie on."""


@dataclass
class OnFacets:
    """The coordinates (n, 3) float32 of such a mesh on its facets, and the normal (f, 3) of each face's."""

    coordinates: np.ndarray
    n_facets: int
    normals: np.ndarray
    """Not a number where a face does not take part."""

    def ridges(self, edges: Edges, least: float | None = None) -> np.ndarray:
        """Which edges (k,) bool lie between facets; if an angle (radians) is given, those that meet at it.

        What lies within a facet may be folded there, or without area.
        """
        sides = edges.sides(np.arange(len(self.normals)))
        normals = self.normals[np.maximum(sides, 0)]
        half = 0.5 * np.linalg.norm(normals[:, 0] - normals[:, 1], axis=1)
        known = (sides >= 0).all(axis=1) & ~np.isnan(half)
        angles = 2.0 * np.arcsin(np.clip(half, 0.0, 1.0, where=known, out=np.zeros_like(half)))
        are_ridges = angles > 0.0 if least is None else angles >= least
        return np.where(known, are_ridges, edges.ridges(self.coordinates, least))


def put_onto_facets(
    own: OwnFaces,
    coordinates: np.ndarray,
    taking: np.ndarray,
    error: float,
    *,
    coarse_to_fine: bool,
    progress: ridgeform.Progress | None = None,
) -> OnFacets:
    """The mesh at coordinates (n, 3) float32 on as many facets as keep as near to it as an error says.

    Only the welded triangles `taking` (l,) bool take part; all that others have stays in every bit.
    """
    weld = own.weld
    starts, sizes = own.polygons.starts[own.faces], own.polygons.sizes[own.faces]
    mesh = ridgeform.Mesh(weld.places(coordinates), weld.triangles)
    options = {} if taking.all() else {"faces": taking}
    if not coarse_to_fine:
        options["coarse_to_fine"] = False
    count = int(ridgeform.facet(mesh, error=error, progress=progress, **options).n_facets)
    # By an error, facets that fold the mesh's own faces would be divided, and not joined again.
    found = ridgeform.facet(
        mesh,
        facets=count,
        keep_triangles=True,
        edge_weights=keeping.along_faces(own.corners, starts, sizes),
        progress=progress,
        **options,
    )
    points = keeping.on_facets(weld, found, coordinates, own.planes)
    starts = 3 * np.arange(len(weld.triangles))
    areas = np.linalg.norm(face_normals(weld.places(points), starts, weld.triangles.ravel()), axis=1)
    largest = np.argsort(areas, kind="stable")
    largest = largest[np.asarray(found.labels)[largest] < found.n_facets]
    normals = np.full((own.faces.max(initial=-1) + 1, 3), np.nan)
    # The last one that is written stays: the largest of a face.
    normals[own.faces[largest]] = np.asarray(found.planes)[np.asarray(found.labels)[largest], :3]
    return OnFacets(points, int(found.n_facets), normals)
