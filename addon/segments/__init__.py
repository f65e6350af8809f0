# SPDX-License-Identifier: GPL-3.0-or-later
"""Segment: the parts of a shape or an attribute, and what is made of them on a mesh in Object Mode.

`labels` (f,) int32 are the segments of the faces, -1 for none; `taking` (f,) bool says which faces took part,
all others keep what they have.
"""

from ..framework.tool import Feature, Tool
from .operator import RIDGEFORM_OT_restore_materials, draw_restore
from .settings import PRESETS
from .tool import Segmenting, forget

FEATURE = Feature(
    tools=(
        Tool(
            description="Divide meshes, or the selected faces, into the parts that a person would name, "
            "along their ridges",
            icon="MATERIAL",
            run=Segmenting,
            page="manual_segment",
            quick=("mode", "count"),
            presets=PRESETS,
            draw_more=draw_restore,
        ),
    ),
    operators=(RIDGEFORM_OT_restore_materials,),
    unregister=forget,
)
