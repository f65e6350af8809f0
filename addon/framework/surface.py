# SPDX-License-Identifier: GPL-3.0-or-later
"""What the wheel gets of the mesh of an object: its surface, split seams welded, and painted weights."""

from collections.abc import Callable
from dataclasses import dataclass

import bpy
import numpy as np
import ridgeform

from ..blender import mesh_io, modifiers
from ..blender.refusals import RefusedError
from ..blender.welding import Weld, flip_note, mirrored, seam_note, topology_notes, weld_seams
from .shared_settings import edge_weights_of, ridge_weights_of


@dataclass
class Surface:
    """What the wheel gets of a mesh: its welded vertices and triangles, and a weight (l,) per triangle."""

    weld: Weld
    mesh: ridgeform.Mesh
    face_weights: np.ndarray | None = None


def surface_of(obj: bpy.types.Object, whole: bool = False) -> Surface:
    """The surface of an object in Object Mode; `RefusedError` if the wheel cannot use it.

    `whole`: with the images that Mirror modifiers make of it.
    """
    coordinates = mesh_io.open_coordinates(obj).original
    weld, _ = welded(obj, coordinates, whole)
    try:
        mesh = ridgeform.Mesh(weld.places(coordinates), weld.triangles)
    except ridgeform.RidgeformError as error:
        raise RefusedError(f'"{obj.name}": {error}') from error
    weld.notes += topology_notes(mesh.report, mesh_io.triangle_faces(obj.data)[weld.rows])
    return Surface(weld, mesh)


def half_notes(obj: bpy.types.Object, surface: Surface, what: str) -> list[str]:
    """What a modeler should know of half a mesh when a tool does not see what Mirror modifiers add to it."""
    coordinates = mesh_io.open_coordinates(obj).original
    whole = mirrored(surface.weld, coordinates, modifiers.mirrors(obj, coordinates))
    if whole.images is None:
        return []
    return [
        f"{what} the half without its mirror image, which ends at the plane (apply the Mirror modifier for "
        "the whole)"
    ]


def welded(obj: bpy.types.Object, coordinates: np.ndarray, whole: bool = False) -> tuple[Weld, np.ndarray]:
    """The mesh of an object with its seams welded, and all its loop triangles (m, 3) int32.

    `whole`: with the images that Mirror modifiers make of it.

    `RefusedError` for a mesh without faces, or with a coordinate (n, 3) that is not a finite number.
    """
    triangles = mesh_io.triangles(obj.data)
    if len(triangles) == 0:
        raise RefusedError(f'"{obj.name}" has no faces')
    if not np.isfinite(coordinates).all():
        broken = np.flatnonzero(~np.isfinite(coordinates).all(axis=1))
        raise RefusedError(
            f'Vertex {broken[0]} of "{obj.name}" has a coordinate that is not a finite number '
            f"({len(broken)} in all): delete or move it"
        )
    weld = weld_seams(coordinates, triangles)
    notes = (seam_note(coordinates, weld), flip_note(weld, mesh_io.triangle_faces(obj.data)[weld.rows]))
    weld.notes = [note for note in notes if note is not None]
    if whole:
        weld.notes += modifiers.mirror_notes(obj, coordinates)
        weld = mirrored(weld, coordinates, modifiers.mirrors(obj, coordinates))
    return weld, triangles


def group_weights(obj: bpy.types.Object, name: str) -> np.ndarray:
    """The weights (n,) of a vertex group, 0 outside it; `RefusedError` if the object has no such group."""
    if name not in obj.vertex_groups:
        raise RefusedError(f'"{obj.name}" has no vertex group "{name}"')
    return mesh_io.group_weights(obj, name)


def painted_ridges(
    obj: bpy.types.Object, settings: object, triangles: np.ndarray, weld: Weld
) -> np.ndarray | None:
    """The weights (l,) that ridge paint gives the welded triangles, given all triangles (m, 3).

    `None` without paint; `RefusedError` if the object has no such group.
    """
    return _painted(ridge_weights_of, obj, settings, triangles, weld)


def painted_edges(
    obj: bpy.types.Object, settings: object, triangles: np.ndarray, weld: Weld
) -> np.ndarray | None:
    """The weights (l, 3) that ridge paint gives the edges of the welded triangles, as `painted_ridges`."""
    return _painted(edge_weights_of, obj, settings, triangles, weld)


def _painted(
    weights_of: Callable[[np.ndarray, np.ndarray, bool], np.ndarray],
    obj: bpy.types.Object,
    settings: object,
    triangles: np.ndarray,
    weld: Weld,
) -> np.ndarray | None:
    if not settings.ridge_group:
        return None
    painted = group_weights(obj, settings.ridge_group)
    return weights_of(painted, triangles[weld.rows], settings.avoid_ridges)
