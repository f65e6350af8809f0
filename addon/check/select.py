# SPDX-License-Identifier: GPL-3.0-or-later
"""Entering Edit Mode with the elements of a fault selected, and nothing else."""

from collections.abc import Mapping

import bpy
import numpy as np

from ..blender import mesh_io, selected_elements
from .kinds import Domain, Finding

MODES = {
    Domain.VERTEX: (True, False, False),
    Domain.EDGE: (False, True, False),
    Domain.FACE: (False, False, True),
}
"""The select mode for each kind of elements."""


def select(found: Mapping[bpy.types.Object, Finding | None], domain: Domain, scene: bpy.types.Scene) -> None:
    """Enter Edit Mode with what was found selected in each object; hidden elements are shown.

    All objects in Edit Mode leave it first; `found` are those that enter it.
    """
    if bpy.context.mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")
    for obj, finding in found.items():
        mesh = obj.data
        own = {Domain.VERTEX: mesh.vertices, Domain.EDGE: mesh.edges, Domain.FACE: mesh.polygons}
        for items in own.values():
            selected_elements.write(mesh, items, np.zeros(len(items), bool))
        if finding is None:
            continue
        items = own[domain]
        chosen = np.zeros(len(items), bool)
        chosen[finding.elements] = True
        selected_elements.write(mesh, items, chosen)
        _show(mesh, domain, finding.elements)
    scene.tool_settings.mesh_select_mode = MODES[domain]
    bpy.ops.object.mode_set(mode="EDIT")


def _show(mesh: bpy.types.Mesh, domain: Domain, elements: np.ndarray) -> None:
    """Show elements that are hidden, with their edges and vertices."""
    vertices = elements
    if domain is Domain.EDGE:
        _unhide(mesh.edges, elements)
        vertices = np.unique(mesh_io.edges(mesh)[elements])
    elif domain is Domain.FACE:
        _unhide(mesh.polygons, elements)
        starts, corner_vertices, corner_edges = mesh_io.face_corners(mesh)
        chosen = np.zeros(len(starts), bool)
        chosen[elements] = True
        corners = np.repeat(chosen, np.diff(starts, append=len(corner_vertices)))
        _unhide(mesh.edges, np.unique(corner_edges[corners]))
        vertices = np.unique(corner_vertices[corners])
    _unhide(mesh.vertices, vertices)


def _unhide(items: bpy.types.bpy_prop_collection, elements: np.ndarray) -> None:
    hidden = np.empty(len(items), bool)
    items.foreach_get("hide", hidden)
    if hidden[elements].any():
        hidden[elements] = False
        items.foreach_set("hide", hidden)
