# SPDX-License-Identifier: GPL-3.0-or-later
"""Facet: flat polygons with straight ridges in place of the faces of a mesh, as many as wanted."""

from ..framework import faceting
from ..framework.tool import Feature, Tool
from .settings import PRESETS
from .tool import Faceting

FEATURE = Feature(
    tools=(
        Tool(
            description="Make flat polygons with straight ridges of the selected meshes, as few as you want",
            icon="MESH_ICOSPHERE",
            run=Faceting,
            page="manual_facet",
            finds="Planar, Low Poly, Decimate",
            quick=("mode", "facets", "error"),
            stays_bound=True,
            presets=PRESETS,
        ),
    ),
    unregister=faceting.forget,
)
