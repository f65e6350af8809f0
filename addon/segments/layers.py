# SPDX-License-Identifier: GPL-3.0-or-later
"""Segments as attributes, face sets and edge marks."""

from collections.abc import Iterable

import bpy
import numpy as np

from ..blender import mesh_io
from ..blender.stored_numbers import read_ints, write_numbers

SEGMENT = "ridgeform_segment"
"""The face attribute with the segments."""
INDICATOR = "ridgeform_indicator"
MARKED = "ridgeform_marked"
"""The edge attribute that says which marks are ours: a bit for each of `MARKS`."""
FACE_SET = ".sculpt_face_set"
KEPT_SET = "ridgeform_face_set"
"""The face attribute with the face sets that faces had before segments took them."""
MARKS = {"SEAMS": (1, "use_seam"), "SHARP": (2, "use_edge_sharp")}
"""Kinds of marks: their bit, and Blender's name of the flag."""


def merged_labels(mesh: bpy.types.Mesh, labels: np.ndarray, taking: np.ndarray) -> np.ndarray:
    """Labels (f,) for the attribute: the new ones after the old ones of faces that took no part."""
    if taking.all():
        return labels
    kept = read_ints(mesh, SEGMENT, "FACE", -1)
    first = 1 + kept[~taking].max(initial=-1)
    return np.where(taking & (labels >= 0), labels + first, np.where(taking, -1, kept)).astype(np.int32)


def write_face_sets(mesh: bpy.types.Mesh, labels: np.ndarray, taking: np.ndarray) -> None:
    """Make each segment a face set, with numbers above those of faces that took no part."""
    sets = read_ints(mesh, FACE_SET, "FACE", 1)
    if KEPT_SET not in mesh.attributes:
        write_numbers(mesh, KEPT_SET, "INT", "FACE", sets)
    first = 1 + sets[~taking].max(initial=0)
    sets[taking] = labels[taking] + first
    write_numbers(mesh, FACE_SET, "INT", "FACE", sets)


def give_back_face_sets(mesh: bpy.types.Mesh, faces: np.ndarray) -> None:
    """Give faces (f,) bool the face sets back that they had before segments took them."""
    if KEPT_SET not in mesh.attributes:
        return
    kept = read_ints(mesh, KEPT_SET, "FACE", 1)
    write_numbers(mesh, FACE_SET, "INT", "FACE", np.where(faces, kept, read_ints(mesh, FACE_SET, "FACE", 1)))
    if faces.all():
        mesh.attributes.remove(mesh.attributes[KEPT_SET])
        if (kept == 1).all():
            mesh.attributes.remove(mesh.attributes[FACE_SET])


def border_edges(mesh: bpy.types.Mesh, labels: np.ndarray) -> np.ndarray:
    """Which edges (k,) bool lie between faces of two segments; faces with the label -1 do not count."""
    _, _, edge = mesh_io.face_corners(mesh)
    corner_labels = labels[corner_faces(mesh)]
    counts = corner_labels >= 0
    low = np.full(len(mesh.edges), np.iinfo(np.int32).max)
    high = np.full(len(mesh.edges), -1)
    np.minimum.at(low, edge[counts], corner_labels[counts])
    np.maximum.at(high, edge[counts], corner_labels[counts])
    return (high >= 0) & (low < high)


def mark_borders(mesh: bpy.types.Mesh, borders: np.ndarray, free: np.ndarray, kinds: Iterable[str]) -> None:
    """Mark border edges (k,) bool; of the marks that a run has made, those on other `free` edges go."""
    ours = read_ints(mesh, MARKED, "EDGE", 0)
    for kind in kinds:
        bit, flag = MARKS[kind]
        marked = np.zeros(len(mesh.edges), bool)
        mesh.edges.foreach_get(flag, marked)
        stale = (ours & bit > 0) & free & ~borders
        marked &= ~stale
        ours[stale] &= ~bit
        ours[borders & ~marked] |= bit
        mesh.edges.foreach_set(flag, marked | borders)
    write_numbers(mesh, MARKED, "INT", "EDGE", ours)
    if not ours.any():
        mesh.attributes.remove(mesh.attributes[MARKED])


def edges_within(mesh: bpy.types.Mesh, taking: np.ndarray) -> np.ndarray:
    """Which edges (k,) bool have only faces that take part."""
    _, _, edge = mesh_io.face_corners(mesh)
    within = np.ones(len(mesh.edges), bool)
    within[edge[~taking[corner_faces(mesh)]]] = False
    return within


def corner_faces(mesh: bpy.types.Mesh) -> np.ndarray:
    """The face (c,) of each corner."""
    totals = np.empty(len(mesh.polygons), np.int32)
    mesh.polygons.foreach_get("loop_total", totals)
    return np.repeat(np.arange(len(totals)), totals)
