# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel stays bound to the last result: a changed setting starts again from the original.

After a run in a window its tool, its original and the values of the panel are kept here. A timer looks at
the panel; when a value is another one and rests, the operator `ridgeform.change_result` puts the original
back and runs the tool again. All of it ends with Apply, another run, an undo step, another file, or any
change of a mesh by another hand.
"""

import traceback
from dataclasses import dataclass
from types import SimpleNamespace

import bpy

from ..blender.mesh_state import ChangedError
from ..blender.refusals import RefusedError
from . import modal
from .modal import STOP_SECONDS, ModalRun
from .run import Run
from .settings import values_of
from .tool import Tool

LOOK_SECONDS = 0.1
"""How often the panel is looked at; a value that is the same twice rests."""


@dataclass
class Bound:
    """A result that the panel is bound to."""

    tool: Tool
    scene: str
    """The name of the scene with the panel's settings."""
    run: Run
    """The run whose result is there now."""
    values: SimpleNamespace
    """The panel's values that it stands for."""
    seen: SimpleNamespace | None = None
    """Other values that the panel had when it was looked at last."""

    @property
    def panel(self) -> bpy.types.PropertyGroup | None:
        """The settings of the panel, `None` if the scene is gone."""
        scene = bpy.data.scenes.get(self.scene)
        return None if scene is None else getattr(scene, self.tool.scene_property)

    def changed(self) -> SimpleNamespace | None:
        """The values of the panel, if they are others than those of the result and rest."""
        values = values_of(self.tool.settings, self.panel)
        if values == self.values:
            self.seen = None
            return None
        rests, self.seen = values == self.seen, values
        return values if rests else None

    def set_panel(self) -> None:
        """Give the panel the values of the result that is there."""
        panel = self.panel
        if panel is not None:
            for name, value in vars(self.values).items():
                if getattr(panel, name) != value:
                    setattr(panel, name, value)


_bound: Bound | None = None


def current(tool: Tool | None = None) -> Bound | None:
    """What is bound, if it is a result of this tool."""
    return _bound if _bound is not None and tool in (None, _bound.tool) else None


def can_bind(tool: Tool, run: Run) -> bool:
    """Whether the panel can be bound to what a run will write: in Object Mode, where all can be put back."""
    return tool.stays_bound and all(part.object.mode == "OBJECT" for part in run.parts)


def bind(tool: Tool, scene: bpy.types.Scene, run: Run) -> None:
    """Bind the panel to the result of a run that has kept its original."""
    global _bound  # noqa: PLW0603
    _bound = Bound(tool, scene.name, run, run.settings)
    _keep_settings(_bound, run)
    if not bpy.app.timers.is_registered(_look):
        bpy.app.timers.register(_look, first_interval=LOOK_SECONDS)
    redraw()


def _keep_settings(held: Bound, run: Run) -> None:
    for name, value in run.kept_settings().items():
        setattr(run.settings, name, value)
        setattr(held.panel, name, value)


def release() -> None:
    """End it: what is there stays, and the original is forgotten."""
    global _bound  # noqa: PLW0603
    if _bound is not None:
        _bound.run.forget()
        _bound = None
        redraw()


def redraw() -> None:
    """Have the sidebars drawn again."""
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                area.tag_redraw()


def look() -> bool:
    """Look at the panel and the meshes; whether a changed setting is to start the tool again."""
    if _bound is None or modal.is_running():
        return False
    if _bound.panel is None:
        release()
        return False
    try:
        _bound.run.watch()
    except ChangedError:
        release()
        return False
    return _bound.changed() is not None


def _look() -> float | None:
    try:
        if look():
            _start_again()
    except Exception:
        # Nothing may come out of a timer; the result stays as it is.
        traceback.print_exc()
        release()
    return None if _bound is None else LOOK_SECONDS


def _start_again() -> None:
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                with bpy.context.temp_override(window=window, area=area):
                    bpy.ops.ridgeform.change_result("INVOKE_DEFAULT")
                return


class ChangingRun(ModalRun):
    """Mixin for the operator that starts again from the original."""

    passes_events = True

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Do it at once."""
        run = self._again()
        return self._settled({"CANCELLED"} if run is None else self.run_at_once(context, run))

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        """Do it while Blender goes on drawing."""
        run = self._again()
        return self._settled({"CANCELLED"} if run is None else self.begin_modal(context, run))

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Handle one event."""
        outcome = self._settled(super().modal(context, event))
        if event.type != "ESC":
            return outcome
        # A slider that is still dragged gets it, too: otherwise it would go on, and set its value again.
        return (outcome - {"RUNNING_MODAL"}) | {"PASS_THROUGH"}

    def finished(self, context: bpy.types.Context, run: Run) -> set[str]:
        """Write the new result; the one before comes back if there is none."""
        outcome = super().finished(context, run)
        if outcome == {"FINISHED"}:
            _bound.run, _bound.values, _bound.seen = run, run.settings, None
            _keep_settings(_bound, run)
            run.before = None
        else:
            run.before.write_again()
        return outcome

    def said_of_cancel(self, left: list[str]) -> str:
        """What is reported after Esc."""
        return "Canceled" if left else "Canceled: back to the last result"

    def _settled(self, outcome: set[str]) -> set[str]:
        """Have the panel say what is there: after the end the values of the result that came back."""
        if outcome == {"CANCELLED"} and _bound is not None:
            try:
                _bound.run.check_meshes()
                _bound.set_panel()
            except ChangedError:
                release()
        if outcome != {"RUNNING_MODAL"}:
            redraw()
        return outcome

    def while_running(self, run: Run) -> Run:
        """Begin once more where a setting was changed meanwhile."""
        if _bound is None or _bound.panel is None:
            raise ChangedError("The scene of the panel is gone")
        panel = values_of(_bound.tool.settings, _bound.panel)
        rests, _bound.seen = panel == _bound.seen, panel
        if not (run.job.is_canceled or (rests and panel != run.settings)):
            return run
        if not run.job.cancel(0.0 if run.job.is_canceled else STOP_SECONDS):
            return run
        run.rewind()
        return self._made(run.before, panel)

    def _again(self) -> Run | None:
        held = _bound.run
        try:
            held.unapply()
        except ChangedError as change:
            release()
            self.report({"INFO"}, str(change))
            return None
        try:
            return self._made(held, values_of(_bound.tool.settings, _bound.panel))
        except RefusedError as refusal:
            held.write_again()
            self.report({"WARNING"}, str(refusal))
            return None

    def _made(self, held: Run, values: SimpleNamespace) -> Run:
        run = type(held)([part.object for part in held.parts], values)
        run.before, run.keeps_original = held, True
        return run


class _WhileBound:
    """Mixin for operators on the result that the panel is bound to."""

    @classmethod
    def poll(cls, _context: bpy.types.Context) -> bool:
        """Whether the panel is bound to a result."""
        return _bound is not None and not modal.is_running()


class RIDGEFORM_OT_change_result(_WhileBound, ChangingRun, bpy.types.Operator):  # noqa: N801
    """Start again from the original, with the settings that the panel has now"""

    bl_idname = "ridgeform.change_result"
    bl_label = "Change Result"
    # Not REGISTER: the redo panel is that of the first run, and goes back to before it.
    bl_options = {"UNDO", "INTERNAL"}


class RIDGEFORM_OT_apply_result(_WhileBound, bpy.types.Operator):  # noqa: N801
    """Keep the result as it is: settings no longer change it"""

    bl_idname = "ridgeform.apply_result"
    bl_label = "Apply"
    bl_options = {"INTERNAL"}

    def execute(self, _context: bpy.types.Context) -> set[str]:
        """End it."""
        release()
        return {"FINISHED"}


OPERATORS = (RIDGEFORM_OT_change_result, RIDGEFORM_OT_apply_result)


def register() -> None:
    """Have it end before a file is opened or a step undone."""
    modal.when_aborted.append(release)


def unregister() -> None:
    """End it, and take away the timer."""
    release()
    modal.when_aborted.remove(release)
    if bpy.app.timers.is_registered(_look):
        bpy.app.timers.unregister(_look)
