# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator that gives diffusion curves other colors, and redraws the mesh from them."""

import bpy
import numpy as np
import ridgeform
from bpy.props import BoolProperty, EnumProperty, FloatVectorProperty

from ..blender.refusals import RefusedError
from ..framework.run import counted
from . import curves_io, drawing
from .operator import OnCurves, pair_of
from .redraw_curves import redraw
from .settings import SHOW


class RIDGEFORM_OT_color_diffusion_curves(OnCurves, bpy.types.Operator):  # noqa: N801
    """Give the selected points of diffusion curves another color, and redraw the mesh"""

    bl_idname = "ridgeform.color_diffusion_curves"
    bl_label = "Color Curves"
    bl_options = {"REGISTER", "UNDO"}

    color: FloatVectorProperty(
        name="Color",
        description="Color beside the curves",
        subtype="COLOR",
        size=4,
        min=0.0,
        soft_max=1.0,
        default=(0.8, 0.8, 0.8, 1.0),
    )
    sides: EnumProperty(
        name="Side",
        description="Side of the curves that takes the color, as seen along them from outside",
        items=(
            ("LEFT", "Left", "On the left of the curves"),
            ("RIGHT", "Right", "On the right of the curves"),
            ("BOTH", "Both", "On both sides"),
        ),
        default="LEFT",
    )
    show: BoolProperty(**SHOW.keywords)

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        """Begin with the color that the selection has, and ask for another."""
        _, child = pair_of(context)
        chosen = curves_io.selected_points(child.data)
        if chosen.any():
            side = curves_io.RIGHT if self.sides == "RIGHT" else curves_io.LEFT
            self.color = curves_io.point_values(child.data, side, len(chosen), 4)[chosen].mean(axis=0)
        return context.window_manager.invoke_props_dialog(self)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Color and redraw; nothing is changed where that cannot be."""
        obj, child = pair_of(context)
        chosen = curves_io.selected_points(child.data)
        if not chosen.any():
            self.report({"ERROR"}, f'Nothing of "{child.name}" is selected: select points in Edit Mode')
            return {"CANCELLED"}
        names = {"LEFT": (curves_io.LEFT,), "RIGHT": (curves_io.RIGHT,)}
        names = names.get(self.sides, (curves_io.LEFT, curves_io.RIGHT))
        before = {name: curves_io.point_values(child.data, name, len(chosen), 4) for name in names}
        for name, colors in before.items():
            curves_io.write_colors(child.data, name, np.where(chosen[:, None], self.color[:], colors))
        try:
            name = redraw(obj, child)
        except (RefusedError, ridgeform.RidgeformError) as error:
            for side, colors in before.items():
                curves_io.write_colors(child.data, side, colors)
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        notes = drawing.show(obj, name) if self.show else []
        self.report({"INFO"}, "; ".join([f"Colored {counted(int(chosen.sum()), 'point')}", *notes]))
        return {"FINISHED"}
