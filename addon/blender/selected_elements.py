# SPDX-License-Identifier: GPL-3.0-or-later
"""Writing which vertices, edges and faces are selected."""

import bpy
import numpy as np

EDGES = ".select_edge"
"""Where Blender keeps which edges are selected."""


def write(mesh: bpy.types.Mesh, elements: bpy.types.bpy_prop_collection, chosen: np.ndarray) -> None:
    """Select exactly the chosen elements, a boolean for each."""
    mend(mesh)
    elements.foreach_set("select", chosen)


def mend(mesh: bpy.types.Mesh) -> None:
    """Drop a selection of edges that is none.

    In Blender 5.0 adding edges by a script, as importers do, leaves the selection as pairs of integers, and
    writing it ends the process. Without it no edge is selected.
    """
    layer = mesh.attributes.get(EDGES)
    if layer is not None and layer.data_type != "BOOLEAN":
        mesh.attributes.remove(layer)
