# SPDX-License-Identifier: GPL-3.0-or-later
"""Check: what is wrong with a mesh for these tools, before one of them runs.

For scripts: `bl_ext.user_default.ridgeform.check.examine(obj)` gives a report on an object, and `last()` what
`bpy.ops.ridgeform.check()` has found.
"""

from ..framework.tool import Feature
from .command import COMMAND
from .examine import examine
from .known import last, register, unregister
from .operators import OPERATORS, RIDGEFORM_OT_check
from .panel import RIDGEFORM_PT_check, draw_line

__all__ = ("FEATURE", "examine", "last")

FEATURE = Feature(
    tools=(),
    operators=OPERATORS,
    panels=(RIDGEFORM_PT_check,),
    menu=((RIDGEFORM_OT_check.bl_idname, "VIEWZOOM"),),
    commands=(COMMAND,),
    draw_line=draw_line,
    register=register,
    unregister=unregister,
)
