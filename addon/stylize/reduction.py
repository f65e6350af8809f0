# SPDX-License-Identifier: GPL-3.0-or-later
"""Reducing the triangle count with fast-simplification, attributes carried over."""

import importlib.util
from types import ModuleType

import bpy
import numpy as np

from ..blender import mesh_io, mesh_layers
from ..blender.surface_map import SurfaceMap, charts
from ..blender.welding import weld_seams

FEWEST = 4
"""The triangles of a tetrahedron, the least that enclose anything."""


def reduce_mesh(obj: bpy.types.Object, ratio: float) -> str | None:
    """Simplify the mesh of an object to `ratio` of its triangles; Object Mode only, meshes without shape
    keys only.

    UVs, colors and other corner attributes, materials, vertex groups and point attributes are taken from
    the nearest point of the surface as it was, edge marks from the nearest marked edge. Returns what a
    modeler should know, or why it was not done, or `None`.
    """
    mesh = obj.data
    if mesh.is_editmode:
        return "its triangles were not reduced, because that works only in Object Mode"
    if mesh.shape_keys is not None:
        return "its triangles were not reduced, because the mesh has shape keys"
    simplifier = _simplifier()
    if simplifier is None:
        return "its triangles were not reduced, because the module fast-simplification is not installed"
    triangles = mesh_io.triangles(mesh)
    coordinates = mesh_io.open_coordinates(obj).original.astype(np.float64)
    # Split seams are joined: otherwise their two sides would be simplified apart, and gape.
    weld = weld_seams(coordinates, triangles)
    wanted = max(FEWEST, round(ratio * len(triangles)))
    if wanted >= len(weld.triangles):
        return f"its {len(triangles)} triangles were not reduced, because there are few enough"
    points, faces = simplifier.simplify(coordinates[weld.first], weld.triangles, target_count=wanted)
    points, faces = _sound(points, faces)
    if len(faces) == 0:
        return "its triangles were not reduced, because nothing would be left"
    losses = _losses(mesh, triangles)
    corners = mesh_io.triangle_corners(mesh)
    source = mesh_layers.read_layers(obj)
    surface = SurfaceMap(coordinates, triangles, charts(corners, triangles, source.uv_layers()))
    layers = mesh_layers.carried(
        source,
        mesh_layers.Triangulation(
            triangles, corners, mesh_io.triangle_faces(mesh), mesh_io.edges(mesh), coordinates
        ),
        surface,
        points,
        faces,
    )
    mesh_layers.replace_faces(obj, points, faces, layers)
    return "; ".join([f"reduced from {len(triangles)} to {len(faces)} triangles", *losses])


def _losses(mesh: bpy.types.Mesh, triangles: np.ndarray) -> list[str]:
    loose = len(mesh.vertices) - len(np.unique(triangles))
    facts = (
        (len(mesh.polygons) != len(triangles), "quads and n-gons became triangles"),
        (loose > 0, f"vertices without a face were dropped ({loose})"),
        (mesh.has_custom_normals, "custom normals were dropped"),
    )
    return [sentence for applies, sentence in facts if applies]


def _simplifier() -> ModuleType | None:
    if importlib.util.find_spec("fast_simplification") is None:
        return None
    import fast_simplification  # noqa: PLC0415

    return fast_simplification


def _sound(points: np.ndarray, faces: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Drop faces that name a vertex twice or that exist already, and vertices without a face."""
    faces = np.asarray(faces, np.int64)
    ordered = np.sort(faces, axis=1)
    proper = (ordered[:, 0] != ordered[:, 1]) & (ordered[:, 1] != ordered[:, 2])
    _, first = np.unique(ordered, axis=0, return_index=True)
    once = np.zeros(len(faces), bool)
    once[first] = True
    faces = faces[proper & once]
    used, renumbered = np.unique(faces, return_inverse=True)
    return np.asarray(points)[used], renumbered.reshape(-1, 3).astype(np.int32)
