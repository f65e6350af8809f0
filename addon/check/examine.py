# SPDX-License-Identifier: GPL-3.0-or-later
"""Looking at the mesh of an object, in the mode that it is in, without changing anything."""

import time

import bpy
import numpy as np

from ..blender import mesh_io, modifiers, selection
from ..blender.selection import Needs
from ..framework.far_origin import is_rounded, step_of
from ..framework.preflight import reason_too_large, uneven_scale
from . import faults, junctions
from .arrays import MeshArrays
from .kinds import KIND, KINDS, Finding, Report

NEEDS = Needs(selection=False)
CALL = "stylize"
"""The call whose memory is asked for: the tool of the first panel."""


def examine(obj: bpy.types.Object) -> Report:
    """What is wrong with the mesh of an object for these tools."""
    begin = time.perf_counter()
    found: dict[str, Finding] = {}

    def add(name: str, elements: np.ndarray | None = None, notes: list[str] | None = None) -> None:
        count = len(notes or ()) if elements is None else len(elements)
        if count:
            found[name] = Finding(KIND[name], count, *([] if elements is None else [elements]))
            found[name].notes += notes or []

    reasons = [selection.reason_against(obj, NEEDS)]
    if reasons[0] is None:
        reasons.append(reason_too_large(obj, CALL))
    add("refused", notes=[reason for reason in reasons if reason is not None])
    if not mesh_io.is_out_of_reach(obj):
        mesh = read_arrays(obj)
        _add_elements(mesh, add)
        add("far_away", notes=_far_notes(mesh))
    add("uneven_scale", notes=_scale_notes(obj))
    add("modifiers", notes=modifiers.shape_notes(obj, creased=False))
    add("shape_keys", notes=modifiers.key_notes(obj))
    ordered = [found[kind.name] for kind in KINDS if kind.name in found]
    counts = len(obj.data.vertices), len(obj.data.polygons)
    return Report(obj.name, *counts, ordered, time.perf_counter() - begin)


def read_arrays(obj: bpy.types.Object) -> MeshArrays:
    """The arrays of the mesh of an object, with the coordinates that tools would work on."""
    mesh_io.flush_edit_mode(obj)
    mesh = obj.data
    return MeshArrays(
        mesh_io.open_coordinates(obj).original,
        mesh_io.edges(mesh),
        *mesh_io.face_corners(mesh),
        mesh_io.triangles(mesh),
        mesh_io.triangle_faces(mesh),
    )


def _add_elements(mesh: MeshArrays, add: object) -> None:
    add("not_finite", np.flatnonzero(~mesh.is_finite))
    add("loose_vertices", faults.loose_vertices(mesh))
    add("loose_edges", faults.loose_edges(mesh))
    add("nonmanifold_edges", faults.nonmanifold_edges(mesh))
    if len(mesh.triangles) == 0:
        return
    sound = faults.sound(mesh)
    target = faults.welded(sound)
    add("seams", faults.in_groups(faults.weldable(sound, target)))
    turned, one_sided = faults.orientation(sound, target)
    add("flipped_faces", turned)
    add("one_sided", one_sided)
    duplicates = faults.duplicate_faces(mesh, target)
    add("duplicate_faces", duplicates)
    add("doubled_faces", faults.doubled_faces(sound, target, duplicates))
    fans, flat = faults.of_triangles(sound, target)
    add("degenerate_faces", flat)
    add("uneven_ngons", faults.uneven_ngons(sound))
    touching, edges = junctions.edges_at(sound, target)
    add("t_junctions", np.unique(touching))
    # Where an edge ends that another vertex lies on, the surface is open, and its sides touch at the end.
    add("nonmanifold_vertices", fans[~np.isin(fans, mesh.edges[edges])])


def _scale_notes(obj: bpy.types.Object) -> list[str]:
    scales = uneven_scale(obj)
    if scales is None:
        return []
    return [f"its scale is {', '.join(f'{x:.3g}' for x in scales)} along X, Y, Z"]


def _far_notes(mesh: MeshArrays) -> list[str]:
    places = mesh.places[mesh.is_finite]
    if not is_rounded(places):
        return []
    step = step_of(places)
    part = 100.0 * step / float(np.ptp(places, axis=0).max())
    return [f"coordinates are rounded to steps of {step:.2g}, {part:.1g} % of its size, far from its origin"]
