# SPDX-License-Identifier: GPL-3.0-or-later
"""Reducing the triangle count with fast-simplification, attributes carried over."""

import importlib.util
from collections.abc import Callable
from dataclasses import dataclass, replace

import bpy
import numpy as np

from ..blender import mesh_io, mesh_layers
from ..blender.mesh_state import ChangedError
from ..blender.surface_map import SurfaceMap
from ..blender.welding import weld_seams
from .kept_edges import kept_edges, regions_of
from .simplify import Simplified, simplify

FEWEST = 4
"""The triangles of a tetrahedron, the least that enclose anything."""
MORE = 1.1
"""So many times as many triangles as were asked for are worth a word."""


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


def reason_against(mesh: bpy.types.Mesh, leaves_mesh: bool = False) -> str | None:
    """Why the triangles of a mesh cannot be reduced; `None` if they can.

    `leaves_mesh`: the mesh is to stay as it is.
    """
    if mesh.is_editmode:
        return "its triangles were not reduced, because that works only in Object Mode"
    if leaves_mesh:
        return "its triangles were not reduced, because Result leaves the mesh as it is"
    if mesh.shape_keys is not None:
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
    source: Reducible,
    coordinates: np.ndarray,
    ratio: float,
    held: np.ndarray,
    check: Callable[[], None] = lambda: None,
) -> Reduced | str:
    """Simplify a mesh that has moved to coordinates (n, 3) to `ratio` of its triangles; else why not.

    Vertices `held` (n,) bool stay, and so do borders, marks, and the borders of materials and UV islands,
    which only lose vertices. UVs, colors and other corner attributes, materials, vertex groups and point
    attributes are taken from the nearest point of the surface between them. No Blender data is touched;
    `check` is called now and then, and may raise to stop.
    """
    triangles = source.old.triangles
    coordinates = coordinates.astype(np.float64)
    # Split seams are joined: otherwise their two sides would be simplified apart, and gape.
    weld = weld_seams(coordinates, triangles)
    wanted = max(FEWEST, round(ratio * len(triangles)))
    if wanted >= len(weld.triangles):
        return f"its {len(triangles)} triangles were not reduced, because there are few enough"
    old = replace(source.old, coordinates=coordinates)
    kept = kept_edges(old, source.layers, weld)
    check()
    share = wanted / len(weld.triangles)
    made = simplify(
        coordinates[weld.first], weld.triangles, kept, held=~weld.all_of(~held), ratio=share, check=check
    )
    points, faces, number = _sound(made)
    if len(faces) == 0:
        return "its triangles were not reduced, because nothing would be left"
    if len(faces) >= len(weld.triangles):
        return (
            f"its {len(triangles)} triangles were not reduced, because all of their vertices must stay "
            "(borders, marks, mask)"
        )
    check()
    # Triangles that closed up are on no chart that is asked for.
    chart = np.full(len(triangles), len(weld.triangles))
    chart[weld.rows] = kept.region
    surface = SurfaceMap(coordinates, triangles, chart)
    check()
    ends = number[made.ends]
    region = regions_of(faces, ends, made.edge, made.forward, kept)
    unknown = np.flatnonzero(region < 0)
    if len(unknown):
        region[unknown] = chart[surface.nearest(points[faces[unknown]].mean(axis=1))[0]]
    first = np.empty(len(weld.triangles) + 1, np.int64)
    first[chart] = np.arange(len(triangles))
    anchors = mesh_layers.Anchors(first[region], ends, kept.of_mesh[made.edge])
    check()
    layers = mesh_layers.carried(source.layers, old, surface, points, faces, anchors=anchors)
    said = [f"reduced from {len(triangles)} to {len(faces)} triangles"]
    if len(faces) > MORE * wanted:
        said.append(f"{wanted} were asked for, but borders, marks, and masks keep their vertices")
    return Reduced(points, faces, layers, "; ".join([*said, *source.losses]))


def check(obj: bpy.types.Object, source: Reducible) -> None:
    """`ChangedError` if other things lie on the mesh of an object than were read, which would be lost."""
    if not source.layers.same_as(mesh_layers.read_layers(obj)):
        raise ChangedError(
            f'"{obj.name}" was changed meanwhile, its attributes are others: it stays as it is now'
        )


def write(obj: bpy.types.Object, reduced: Reduced) -> np.ndarray:
    """Give the mesh of an object its reduced faces; the row of each edge (k,) as `replace_faces` has it."""
    return mesh_layers.replace_faces(obj, reduced.points, reduced.faces, reduced.layers)


def _losses(mesh: bpy.types.Mesh, triangles: np.ndarray) -> list[str]:
    loose = int((np.bincount(triangles.ravel(), minlength=len(mesh.vertices)) == 0).sum())
    facts = (
        (len(mesh.polygons) != len(triangles), "quads and n-gons became triangles"),
        (loose > 0, f"vertices without a face were dropped ({loose})"),
        (mesh.has_custom_normals, "custom normals were dropped"),
    )
    return [sentence for applies, sentence in facts if applies]


def _sound(made: Simplified) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Without faces that name a vertex twice or exist already, and vertices without a face.

    Points (p, 3), triangles (q, 3), and the number of each point before among these, -1 for none.
    """
    faces = np.asarray(made.faces, np.int64)
    ordered = np.sort(faces, axis=1)
    proper = (ordered[:, 0] != ordered[:, 1]) & (ordered[:, 1] != ordered[:, 2])
    _, first = np.unique(ordered, axis=0, return_index=True)
    once = np.zeros(len(faces), bool)
    once[first] = True
    faces = faces[proper & once]
    used, renumbered = np.unique(faces, return_inverse=True)
    number = np.full(len(made.points), -1)
    number[used] = np.arange(len(used))
    return made.points[used], renumbered.reshape(-1, 3).astype(np.int32), number
