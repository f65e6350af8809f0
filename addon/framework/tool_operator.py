# SPDX-License-Identifier: GPL-3.0-or-later
"""What the operators of all tools share: when they can start, whence their settings, how they run."""

from typing import ClassVar

import bpy
from bpy.props import BoolProperty

from ..blender import selection
from .modal import ModalRun
from .run import RefusedError, Run
from .shared_settings import setting_names


class ToolOperator(ModalRun):
    """Mixin for an operator over one tool; the class itself also has the tool's settings among its bases."""

    # Not more exactly: what typing is given it keeps, with all that hangs on it, and Blender 4.2 as a module
    # then crashes when Python ends.
    tool: ClassVar[type]
    """The tool: a kind of `Run`."""
    settings: ClassVar[type]
    """The class of the tool's settings."""
    panel: ClassVar[str]
    """The name of the scene's property with the settings of the sidebar panel."""

    from_panel: BoolProperty(
        name="From Panel",
        description="Take the settings of the sidebar panel",
        default=False,
        options={"HIDDEN", "SKIP_SAVE"},
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Whether there is a mesh to work on; the tooltip says why not."""
        reason = selection.reason_disabled(context, cls.tool.needs)
        if reason is not None:
            cls.poll_message_set(reason)
        return reason is None

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Do the whole job at once."""
        run = self._prepared(context)
        return {"CANCELLED"} if run is None else self.run_at_once(context, run)

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        """Run while Blender goes on drawing."""
        run = self._prepared(context)
        return {"CANCELLED"} if run is None else self.begin_modal(context, run)

    def _prepared(self, context: bpy.types.Context) -> Run | None:
        if self.from_panel:
            for name in setting_names(self.settings):
                setattr(self, name, getattr(getattr(context.scene, self.panel), name))
            # From now on these are the operator's own, for the redo panel to change.
            self.from_panel = False
        chosen = selection.usable(selection.mesh_objects(context), self.tool.needs)
        try:
            return self.tool(chosen.objects, self, chosen.skipped)
        except RefusedError as refusal:
            self.report({"ERROR"}, str(refusal))
            return None
