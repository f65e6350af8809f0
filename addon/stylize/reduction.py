# SPDX-License-Identifier: GPL-3.0-or-later
"""Reducing the triangle count with fast-simplification, attributes carried over."""

import importlib.util
from collections.abc import Callable
from dataclasses import dataclass, replace

import bpy
import numpy as np

from ..blender import mesh_io, mesh_layers
from ..blender.mesh_state import ChangedError
from ..blender.surface_map import SurfaceMap, charts
from ..blender.welding import weld_seams

FEWEST = 4
"""The triangles of a tetrahedron, the least that enclose anything."""


@dataclass
class Reducible:
    """A mesh as it is before it is reduced: its triangles, and all that lies on it."""

    old: mesh_layers.Triangulation
    layers: mesh_layers.Layers
    losses: list[str]
    """Sentences on what no reduced mesh keeps."""


@dataclass
class Reduced:
    """What a mesh becomes: points (p, 3), triangles (q, 3), and what lies on them."""

    points: np.ndarray
    faces: np.ndarray
    layers: mesh_layers.Layers
    note: str


def reason_against(mesh: bpy.types.Mesh, makes_key: bool = False) -> str | None:
    """Why the triangles of a mesh cannot be reduced, which may get shape keys first; `None` if they can."""
    if mesh.is_editmode:
        return "its triangles were not reduced, because that works only in Object Mode"
    if makes_key or mesh.shape_keys is not None:
        return "its triangles were not reduced, because the mesh has shape keys"
    if importlib.util.find_spec("fast_simplification") is None:
        return "its triangles were not reduced, because the module fast-simplification is not installed"
    return None


def read(obj: bpy.types.Object) -> Reducible:
    """Read the mesh of an object, which `reason_against` has nothing against."""
    mesh = obj.data
    triangles = mesh_io.triangles(mesh)
    old = mesh_layers.Triangulation(
        triangles,
        mesh_io.triangle_corners(mesh),
        mesh_io.triangle_faces(mesh),
        mesh_io.edges(mesh),
        mesh_io.positions(mesh).astype(np.float64),
    )
    return Reducible(old, mesh_layers.read_layers(obj), _losses(mesh, triangles))


def reduce(
    source: Reducible, coordinates: np.ndarray, ratio: float, check: Callable[[], None] = lambda: None
) -> Reduced | str:
    """Simplify a mesh that has moved to coordinates (n, 3) to `ratio` of its triangles; else why not.

    UVs, colors and other corner attributes, materials, vertex groups and point attributes are taken from
    the nearest point of the surface, edge marks from the nearest marked edge. No Blender data is touched;
    `check` is called now and then, and may raise to stop.
    """
    import fast_simplification  # noqa: PLC0415

    triangles = source.old.triangles
    coordinates = coordinates.astype(np.float64)
    # Split seams are joined: otherwise their two sides would be simplified apart, and gape.
    weld = weld_seams(coordinates, triangles)
    wanted = max(FEWEST, round(ratio * len(triangles)))
    if wanted >= len(weld.triangles):
        return f"its {len(triangles)} triangles were not reduced, because there are few enough"
    points, faces = fast_simplification.simplify(coordinates[weld.first], weld.triangles, target_count=wanted)
    points, faces = _sound(points, faces)
    if len(faces) == 0:
        return "its triangles were not reduced, because nothing would be left"
    check()
    old = replace(source.old, coordinates=coordinates)
    chart = charts(old.corners, triangles, source.layers.uv_layers())
    check()
    surface = SurfaceMap(coordinates, triangles, chart)
    check()
    layers = mesh_layers.carried(source.layers, old, surface, points, faces)
    note = "; ".join([f"reduced from {len(triangles)} to {len(faces)} triangles", *source.losses])
    return Reduced(points, faces, layers, note)


def check(obj: bpy.types.Object, source: Reducible) -> None:
    """`ChangedError` if other things lie on the mesh of an object than were read, which would be lost."""
    if not source.layers.same_as(mesh_layers.read_layers(obj)):
        raise ChangedError(
            f'"{obj.name}" was changed meanwhile, its attributes are others: it stays as it is now'
        )


def write(obj: bpy.types.Object, reduced: Reduced) -> None:
    """Give the mesh of an object its reduced faces."""
    mesh_layers.replace_faces(obj, reduced.points, reduced.faces, reduced.layers)


def _losses(mesh: bpy.types.Mesh, triangles: np.ndarray) -> list[str]:
    loose = len(mesh.vertices) - len(np.unique(triangles))
    facts = (
        (len(mesh.polygons) != len(triangles), "quads and n-gons became triangles"),
        (loose > 0, f"vertices without a face were dropped ({loose})"),
        (mesh.has_custom_normals, "custom normals were dropped"),
    )
    return [sentence for applies, sentence in facts if applies]


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
