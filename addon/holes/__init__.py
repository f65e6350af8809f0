# SPDX-License-Identifier: GPL-3.0-or-later
"""Fill Holes: patches, and what lies on a mesh continued into them."""

from ..framework.tool import Feature, Tool
from .settings import PRESETS
from .tool import HoleFilling

FEATURE = Feature(
    tools=(
        Tool(
            description="Fill holes and bring back the ridges that end there. In Edit Mode, those with a "
            "selected border edge",
            icon="MESH_GRID",
            run=HoleFilling,
            page="manual_holes",
            finds="Repair",
            scene="ridgeform_holes",
            presets=PRESETS,
        ),
    )
)
