# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator `ridgeform.stylize`."""

import bpy
from bpy.props import BoolProperty

from .. import selection
from ..settings import SETTING_NAMES, StylizeSettings
from ..tools.stylize import RefusedError, Stylization
from ..ui.stylize_settings import draw_settings
from .modal import ModalRun


class RIDGEFORM_OT_stylize(StylizeSettings, ModalRun, bpy.types.Operator):  # noqa: N801
    """Make the selected meshes piecewise flat, with crisp ridges"""

    bl_idname = "ridgeform.stylize"
    bl_label = "Stylize Flat"
    bl_options = {"REGISTER", "UNDO", "PRESET"}

    from_panel: BoolProperty(
        name="From Panel",
        description="Take the settings of the sidebar panel",
        default=False,
        options={"HIDDEN", "SKIP_SAVE"},
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Whether there is a mesh to work on; the tooltip says why not."""
        reason = selection.reason_disabled(context)
        if reason is not None:
            cls.poll_message_set(reason)
        return reason is None

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Do the whole job at once."""
        run = self._prepared(context)
        if run is None:
            return {"CANCELLED"}
        run.job.run()
        return self.finished(context, run)

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        """Run with a live preview."""
        run = self._prepared(context)
        return {"CANCELLED"} if run is None else self.begin_modal(context, run)

    def finished(self, _context: bpy.types.Context, run: Stylization) -> set[str]:
        """Write the result and report what happened."""
        run.apply()
        if not run.steps_done and run.errors:
            self.report({"ERROR"}, "; ".join(run.errors))
            return {"CANCELLED"}
        # Redo repeats what was kept, not what was asked for.
        self.steps = max(run.steps_done, 1)
        self.report({"WARNING"} if run.errors else {"INFO"}, run.report())
        return {"FINISHED"}

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the redo panel."""
        draw_settings(self.layout, self, context.object)

    def _prepared(self, context: bpy.types.Context) -> Stylization | None:
        if self.from_panel:
            for name in SETTING_NAMES:
                setattr(self, name, getattr(context.scene.ridgeform_stylize, name))
            # From now on these are the operator's own, for the redo panel to change.
            self.from_panel = False
        chosen = selection.usable(selection.mesh_objects(context))
        try:
            return Stylization(chosen.objects, self, chosen.skipped)
        except RefusedError as refusal:
            self.report({"ERROR"}, str(refusal))
            return None
