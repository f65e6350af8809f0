# SPDX-License-Identifier: GPL-3.0-or-later
"""The operators of all tools: when they can start, where their settings come from, how they run."""

import contextlib
from typing import ClassVar

import bpy
from bpy.props import BoolProperty

from ..blender import mesh_io, selection
from ..blender.refusals import NothingToDoError, RefusedError
from . import bound, former, rows
from .job import hide_summary, shown_summary, store_summary
from .modal import ModalRun
from .run import Run
from .settings import properties_of, setting_names, values_of
from .tool import Tool

QUICK = 0.5
"""Seconds that Blender may stand still: a redo is done while it waits."""


class ToolOperator(ModalRun):
    """Mixin for an operator over one tool, which has the tool's settings as its properties."""

    # Not more exactly: what typing is given it keeps, with all that hangs on it, and Blender 4.2 as a module
    # then crashes when Python ends.
    tool: ClassVar[object]
    """The `Tool`."""

    _painting: str | None = None
    """The mode to go back to, one that paints or sculpts."""

    from_panel: BoolProperty(
        name="From Panel",
        description="Use the settings of the sidebar panel",
        default=False,
        options={"HIDDEN", "SKIP_SAVE"},
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Whether there is a mesh to work on; the tooltip says why not."""
        return selection.can_start(cls, selection.reason_disabled(context, cls.tool.run.needs))

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Do the whole job at once."""
        run = self._prepared(context)
        if run is not None and self.options.is_repeat:
            self._tell_panel(context)
            self._keep_original(run)
        outcome = {"CANCELLED"} if run is None else self.run_at_once(context, run)
        return self._back(context, outcome)

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        """Run while Blender goes on drawing, with the panel's values for all that is not given."""
        bound.release()
        former.take_given(self.properties, self.tool.settings)
        self._ask_panel(context)
        run = self._prepared(context)
        if run is not None:
            self._keep_original(run)
        outcome = {"CANCELLED"} if run is None else self.begin_modal(context, run)
        return self._back(context, outcome)

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Handle one event."""
        return self._back(context, super().modal(context, event))

    def _back(self, context: bpy.types.Context, outcome: set[str]) -> set[str]:
        """Go back to the mode that the run was started in, if it is over; returns the outcome."""
        painting = self._painting
        if painting is not None and outcome & {"FINISHED", "CANCELLED"}:
            self._painting = None
            # What was painted may be gone, or hidden.
            with contextlib.suppress(RuntimeError):
                bpy.ops.object.mode_set(mode=painting)
        return outcome

    def _keep_original(self, run: Run) -> None:
        run.keeps_original = self._painting is None and bound.can_bind(self.tool, run)

    def finished(self, context: bpy.types.Context, run: Run) -> set[str]:
        """Write the result and report what happened."""
        outcome = super().finished(context, run)
        if outcome == {"FINISHED"}:
            for name, value in run.kept_settings().items():
                setattr(self, name, value)
            if run.keeps_original:
                bound.bind(self.tool, context.scene, run)
        return outcome

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the redo panel: the main rows, where a redo takes no time that one would notice."""
        layout, tool = rows.split(self.layout), self.tool
        seconds = sum(entry["seconds"] for entry in shown_summary() if entry["tool"] == tool.run.name)
        if seconds <= QUICK:
            rows.draw_section(layout, self, tool.settings, "", context.object)
            return
        for name in tool.quick:
            rows.draw_setting(layout, self, name, tool.settings.declared[name], context.object)
        text = f"Took {seconds:.1f} s: change the settings in the sidebar (N)"
        self.layout.label(text=text, icon="INFO")

    def _ask_panel(self, context: bpy.types.Context) -> None:
        """Take the panel's values for all that is not given, and give it the others: they are one set."""
        panel = getattr(context.scene, self.tool.scene_property)
        former.take_given(panel, self.tool.settings)
        for name in setting_names(self.tool.settings):
            if self.properties.is_property_set(name, ghost=False) and not self.from_panel:
                setattr(panel, name, getattr(self, name))
            else:
                setattr(self, name, getattr(panel, name))
        # From now on these are the operator's own, for the redo panel to change.
        self.from_panel = False

    def _tell_panel(self, context: bpy.types.Context) -> None:
        """Give the panel the values of the redo panel."""
        panel = getattr(context.scene, self.tool.scene_property)
        for name in setting_names(self.tool.settings):
            setattr(panel, name, getattr(self, name))

    def _prepared(self, context: bpy.types.Context) -> Run | None:
        if self.from_panel:
            self._ask_panel(context)
        former.take_given(self.properties, self.tool.settings)
        chosen = selection.usable(selection.mesh_objects(context), self.tool.run.needs)
        self._painting = mesh_io.PAINTING.get(context.mode)
        if self._painting is not None:
            # There Blender keeps what it draws of the mesh.
            bpy.ops.object.mode_set(mode="OBJECT")
        try:
            # A plain object: a job reads it in a thread of its own, where Blender's must not be touched.
            return self.tool.run(chosen.objects, values_of(self.tool.settings, self), chosen.skipped)
        except NothingToDoError as nothing:
            store_summary([nothing.figures])
            hide_summary()
            self.report({"INFO"}, str(nothing))
            return None
        except RefusedError as refusal:
            self.report({"ERROR"}, str(refusal))
            return None


def operator_class(tool: Tool) -> type:
    """The operator of a tool, `RIDGEFORM_OT_<name>`."""
    own = {
        "bl_idname": tool.idname,
        "bl_label": tool.label,
        "bl_description": tool.description,
        "bl_options": {"REGISTER", "UNDO"},
        "tool": tool,
        "__annotations__": former.given_properties_of(tool.settings) | properties_of(tool.settings),
        "__module__": __name__,
        "__doc__": tool.description,
    }
    return type(f"RIDGEFORM_OT_{tool.name}", (ToolOperator, bpy.types.Operator), own)
