# SPDX-License-Identifier: GPL-3.0-or-later
"""The operators on diffusion curves that were found: redraw from them, export them."""

from pathlib import Path

import bpy
import ridgeform
from bpy.props import BoolProperty, FloatProperty, StringProperty
from bpy_extras.io_utils import ExportHelper

from ..blender import mesh_io, selection
from ..blender.refusals import RefusedError
from ..framework.run import counted
from ..framework.writing import write_text
from . import curves_io, drawing, svg
from .redraw_curves import read_on_mesh, redraw
from .settings import SHOW


def pair_of(context: bpy.types.Context) -> tuple[bpy.types.Object, bpy.types.Object] | str:
    """The mesh object and its diffusion curves, whichever of them is active, or why there are none."""
    obj = context.object
    if curves_io.is_curves(obj):
        parent = obj.parent
        if parent is None or parent.type != "MESH":
            return f'"{obj.name}" is not a child of a mesh: parent it to the mesh that it belongs to'
        return parent, obj
    if obj is None or obj.type != "MESH":
        return "Select a mesh with diffusion curves, or the curves"
    child = curves_io.curves_of(obj)
    return (obj, child) if child is not None else f'"{obj.name}" has no diffusion curves: find them first'


class OnCurves:
    """Mixin for an operator over a mesh with diffusion curves."""

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Whether there are curves; the tooltip says why not."""
        pair = pair_of(context)
        return selection.can_start(cls, pair if isinstance(pair, str) else cls.reason_against(pair[0]))

    @classmethod
    def reason_against(cls, _obj: bpy.types.Object) -> str | None:
        """Why the mesh cannot be used."""
        return None


class RIDGEFORM_OT_redraw_diffusion_curves(OnCurves, bpy.types.Operator):  # noqa: N801
    """Redraw the colors of the mesh from its diffusion curves as they are now"""

    bl_idname = "ridgeform.redraw_diffusion_curves"
    bl_label = "Redraw from Curves"
    bl_options = {"REGISTER", "UNDO"}

    show: BoolProperty(**SHOW.keywords)

    @classmethod
    def reason_against(cls, obj: bpy.types.Object) -> str | None:
        """Why the mesh cannot be written to."""
        editable = obj.data.library is None and obj.data.override_library is None
        return None if editable else f'"{obj.name}" is linked or overridden: make its mesh local first'

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Redraw."""
        obj, child = pair_of(context)
        try:
            name = redraw(obj, child)
        except (RefusedError, ridgeform.RidgeformError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        notes = drawing.show(obj, name) if self.show else []
        curves = counted(len(child.data.curves), "curve")
        self.report({"INFO"}, "; ".join([f'Redrew "{name}" of "{obj.name}" from {curves}', *notes]))
        return {"FINISHED"}


class RIDGEFORM_OT_export_diffusion_svg(OnCurves, bpy.types.Operator, ExportHelper):  # noqa: N801
    """Draw the diffusion curves of a flat mesh into an SVG file, each with its two colors"""

    bl_idname = "ridgeform.export_diffusion_svg"
    bl_label = "Diffusion Curves (.svg)"
    filename_ext = ".svg"

    filter_glob: StringProperty(default="*.svg", options={"HIDDEN"})
    width: FloatProperty(
        name="Band Width",
        description="Width of the two bands of color of a curve, in hundredths of the drawing's longer side",
        default=0.8,
        min=0.01,
        max=20.0,
        soft_max=5.0,
    )
    fill: BoolProperty(
        name="Fill",
        description="Draw the redrawn colors of the faces under the curves",
        default=True,
    )

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Write the file."""
        obj, child = pair_of(context)
        try:
            with mesh_io.object_mode():
                _, points = read_on_mesh(obj, child)
            text = svg.drawing(obj, child, points, self.width / 100.0, self.fill)
            write_text(Path(self.filepath), text)
        except (RefusedError, ridgeform.RidgeformError, OSError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        self.report({"INFO"}, f"Wrote {counted(len(child.data.curves), 'curve')} to {self.filepath}")
        return {"FINISHED"}


def draw_buttons(layout: bpy.types.UILayout, settings: object) -> None:
    """Draw the buttons for curves that were found."""
    layout.operator("ridgeform.redraw_diffusion_curves", icon="FILE_REFRESH").show = settings.show
    layout.operator("ridgeform.color_diffusion_curves", icon="COLOR").show = settings.show
    layout.operator("ridgeform.export_diffusion_svg", text="Export SVG", icon="EXPORT")


def _draw_export(self: bpy.types.Menu, _context: bpy.types.Context) -> None:
    self.layout.operator("ridgeform.export_diffusion_svg")


def register() -> None:
    """Append the entry of the Export menu."""
    bpy.types.TOPBAR_MT_file_export.append(_draw_export)


def unregister() -> None:
    """Remove the entry of the Export menu."""
    bpy.types.TOPBAR_MT_file_export.remove(_draw_export)
