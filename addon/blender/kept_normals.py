# SPDX-License-Identifier: GPL-3.0-or-later
"""Custom normals where faces are replaced: those of faces that stay, and none where faces are new."""

import bpy
import numpy as np

from .carrying import Triangulation
from .polygons import Polygons


def read(mesh: bpy.types.Mesh) -> np.ndarray | None:
    """The normals (c, 3) float32 of the corners of a mesh in Object Mode, `None` if none are custom ones."""
    if not mesh.has_custom_normals:
        return None
    normals = np.empty((len(mesh.loops), 3), np.float32)
    mesh.corner_normals.foreach_get("vector", normals.ravel())
    return normals


def kept(
    normals: np.ndarray, old: Triangulation, polygons: Polygons, points: np.ndarray, faces: Polygons
) -> np.ndarray:
    """The normals (d, 3) of the corners of other faces: 0, for no custom one, where they are new.

    A face stays whose corners are, to the last bit, in the places of one before: a face of the mesh with
    `normals` (c, 3), or a triangle of one.
    """
    before = np.asarray(old.coordinates, np.float32)
    places = np.concatenate([before, np.asarray(points, np.float32)])
    _, number = np.unique(np.ascontiguousarray(places).view("V12").ravel(), return_inverse=True)
    # A face is told by the sum of its corners' numbers, made long and random: by chance no two are alike.
    label = np.random.default_rng(0).integers(0, 2**63, (2, len(places)), np.uint64)[:, number.reshape(-1)]
    triangles = Polygons.of_triangles(old.triangles)
    known = np.concatenate([_keys(polygons, label), _keys(triangles, label)])
    of_known = np.concatenate([normals, normals[old.corners.ravel()]])
    keys = _keys(faces, label[:, len(before) :])
    order = np.argsort(known, kind="stable")
    place = np.minimum(np.searchsorted(known[order], keys), len(known) - 1)
    stays = known[order[place]] == keys
    return np.where(stays[:, None], of_known[order[place]], np.float32(0.0))


def _keys(faces: Polygons, label: np.ndarray) -> np.ndarray:
    """What a corner (c,) of faces is told by: its place, and those of all corners of its face."""
    if len(faces) == 0:
        return np.empty(0, np.uint64)
    of_face = np.add.reduceat(label[0, faces.corners], faces.starts)
    return of_face[faces.faces] ^ label[1, faces.corners]


def write(mesh: bpy.types.Mesh, normals: np.ndarray | None) -> None:
    """Set the normals (d, 3) of corners; after shading and sharp edges, which they are stored relative to."""
    if normals is not None and normals.any() and len(normals) == len(mesh.loops):
        mesh.normals_split_custom_set(normals.tolist())


def note(normals: np.ndarray | None) -> str | None:
    """What a modeler should know of normals (d, 3) where faces were replaced, if there were any."""
    if normals is None:
        return None
    where = " where its faces are new" if normals.any() else ""
    return f"its custom normals were cleared{where}, so that the facets show"
