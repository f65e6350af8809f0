# SPDX-License-Identifier: GPL-3.0-or-later
"""Taking away what an earlier run made of its segments and this one does not."""

from collections.abc import Collection

import bpy
import numpy as np

from . import groups, layers, slots


def clear(obj: bpy.types.Object, taking: np.ndarray, outputs: Collection[str]) -> None:
    """Give the faces that take part (f,) bool back what they had, and their edges, but for these outputs.

    Vertex groups and the indicator go if all faces take part. Shape keys and objects stay: they are results
    that one goes on with.
    """
    mesh = obj.data
    if "MATERIALS" not in outputs:
        slots.give_back(mesh, taking)
    if "FACE_SETS" not in outputs:
        layers.give_back_face_sets(mesh, taking)
    stale = [kind for kind in layers.MARKS if kind not in outputs]
    if stale and layers.MARKED in mesh.attributes:
        none = np.zeros(len(mesh.edges), bool)
        layers.mark_borders(mesh, none, layers.edges_within(mesh, taking), stale)
    if not taking.all():
        return
    if "VERTEX_GROUPS" not in outputs:
        groups.remove_groups(obj)
    if "INDICATOR" not in outputs and layers.INDICATOR in mesh.attributes:
        mesh.attributes.remove(mesh.attributes[layers.INDICATOR])
