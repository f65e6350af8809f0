# SPDX-License-Identifier: GPL-3.0-or-later
"""Segments as vertex groups, with full weights or with soft transitions for rigging."""

import bpy
import numpy as np

from ..blender import mesh_io
from . import layers

GROUP = "ridgeform_segment_"
"""What names of vertex groups begin with; the number of the segment follows."""


def write_groups(obj: bpy.types.Object, labels: np.ndarray, transition: float = 0.0) -> None:
    """Make each segment of all labels (f,) a vertex group, and take away those of an earlier run.

    With a `transition` the weights change from 0 to 1 over a band of this width around the borders, measured
    along edges in the units of the object, and those of a vertex sum to 1.
    """
    remove_groups(obj)
    for segment, weights in segment_weights(obj.data, labels, transition).items():
        group = obj.vertex_groups.new(name=f"{GROUP}{segment}")
        for weight in np.unique(weights[weights > 0]).tolist():
            group.add(np.flatnonzero(weights == weight).tolist(), weight, "REPLACE")


def remove_groups(obj: bpy.types.Object) -> None:
    """Take away the vertex groups of segments."""
    for group in [group for group in obj.vertex_groups if _is_own(group.name)]:
        obj.vertex_groups.remove(group)


def _is_own(name: str) -> bool:
    return name.startswith(GROUP) and name.removeprefix(GROUP).isdecimal()


def segment_weights(mesh: bpy.types.Mesh, labels: np.ndarray, transition: float) -> dict[int, np.ndarray]:
    """For each segment of labels (f,) the weights (n,) of the vertices.

    A vertex at a distance d of less than w, half the transition, from a segment that it is not in has
    1 - d / w of it, and 1 of its own; the weights are divided by their sum. On a border they are equal.
    """
    vertices = mesh_io.corner_vertices(mesh)
    corner_labels = labels[layers.corner_faces(mesh)]
    members = {
        segment: np.unique(vertices[corner_labels == segment])
        for segment in np.unique(labels[labels >= 0]).tolist()
    }
    weights = {}
    for segment, inside in members.items():
        distances = np.full(len(mesh.vertices), np.inf)
        distances[inside] = 0.0
        if transition > 0:
            _spread(mesh, distances, 0.5 * transition)
        share = 1.0 - distances / (0.5 * transition) if transition > 0 else distances == 0
        weights[segment] = np.maximum(share, 0.0)
    if transition > 0:
        total = sum(weights.values())
        for share in weights.values():
            np.divide(share, total, out=share, where=total > 0)
            # Weights are kept in single precision; so few different ones are written at once.
            np.round(share, 3, out=share)
    return weights


def _spread(mesh: bpy.types.Mesh, distances: np.ndarray, limit: float) -> None:
    """Lower `distances` (n,) to those along edges from where they are 0, as far as the limit."""
    ends = mesh_io.edges(mesh)
    points = mesh_io.positions(mesh)
    lengths = np.linalg.norm(points[ends[:, 0]] - points[ends[:, 1]], axis=1)
    while True:
        before = distances.copy()
        for here, there in ((0, 1), (1, 0)):
            reached = distances[ends[:, here]] + lengths
            near = reached < limit
            np.minimum.at(distances, ends[near, there], reached[near])
        if np.array_equal(before, distances):
            return
