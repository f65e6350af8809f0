# SPDX-License-Identifier: GPL-3.0-or-later
"""The modal run of a job: live preview, Esc restores, Enter keeps, status bar and cursor show progress."""

from collections.abc import Sequence
from typing import Protocol

import bpy
from bpy.app.handlers import persistent

from .job import Job

POLL_SECONDS = 0.05
CURSOR_RANGE = 1000
NAVIGATION = {
    "MIDDLEMOUSE",
    "WHEELUPMOUSE",
    "WHEELDOWNMOUSE",
    "TRACKPADPAN",
    "TRACKPADZOOM",
    "MOUSEROTATE",
    "MOUSESMARTZOOM",
    "NDOF_MOTION",
    "NUMPAD_0",
    "NUMPAD_1",
    "NUMPAD_2",
    "NUMPAD_3",
    "NUMPAD_4",
    "NUMPAD_5",
    "NUMPAD_6",
    "NUMPAD_7",
    "NUMPAD_8",
    "NUMPAD_9",
    "NUMPAD_PERIOD",
    "NUMPAD_PLUS",
    "NUMPAD_MINUS",
}
"""Events that stay with Blender, so that the view can be turned while a job runs."""


class Run(Protocol):
    """What a tool gives to be run: its job, and what to do with it on the main thread."""

    job: Job
    done: Sequence[object]
    """What has a result."""
    errors: Sequence[str]
    """A sentence for each mesh that failed."""

    def preview(self) -> bool:
        """Show how far the job is; whether there was something new."""

    def restore(self) -> None:
        """Put everything back as it was."""

    def apply(self) -> None:
        """Write the result."""

    def report(self) -> str:
        """What happened, in one line."""


def action_of(event_type: str, value: str) -> str:
    """What an event means to a run: `cancel`, `keep`, `poll`, `navigate` or `ignore`."""
    if event_type == "TIMER":
        return "poll"
    if event_type in NAVIGATION:
        return "navigate"
    if value != "PRESS":
        return "ignore"
    if event_type in {"ESC", "RIGHTMOUSE"}:
        return "cancel"
    if event_type in {"RET", "NUMPAD_ENTER"}:
        return "keep"
    return "ignore"


def abort(run: Run) -> None:
    """Stop a run, wait for its thread, and put everything back; a second call does nothing."""
    if run not in _running:
        return
    _running.remove(run)
    run.job.cancel()
    run.restore()


def status_line(job: Job) -> str:
    """Where a job is, for the status bar: which mesh, step or iteration, energy and gap."""
    task = job.current
    progress = task.progress
    parts = [f"{task.name}: {progress.stage or 'starting'}", f"{task.counted} {progress.iteration}"]
    if progress.energy is not None:
        parts.append(f"energy {progress.energy:.4g}")
    if progress.gap is not None:
        parts.append(f"gap {progress.gap:.1g}")
    return ", ".join(parts)


class ModalRun:
    """Mixin for operators that compute while Blender draws: call `begin_modal` from `invoke`."""

    def finished(self, _context: bpy.types.Context, run: Run) -> set[str]:
        """Write the result of a run and report what happened; returns what the operator returns."""
        run.apply()
        if not run.done:
            self.report({"ERROR"}, "; ".join(run.errors))
            return {"CANCELLED"}
        self.report({"WARNING"} if run.errors else {"INFO"}, run.report())
        return {"FINISHED"}

    def begin_modal(self, context: bpy.types.Context, run: Run) -> set[str]:
        """Start the job and hand over to `modal`."""
        self._run = run
        self._keeping = False
        _running.append(run)
        run.job.start()
        manager = context.window_manager
        manager.progress_begin(0, CURSOR_RANGE)
        self._timer = manager.event_timer_add(POLL_SECONDS, window=context.window)
        # Not the area itself: touching one that was closed meanwhile would crash Blender.
        self._area = None if context.area is None else context.area.as_pointer()
        manager.modal_handler_add(self)
        self._show(context)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Handle one event."""
        run = self._run
        if run not in _running:
            self._close(context)
            return {"CANCELLED"}
        action = action_of(event.type, event.value)
        if action == "navigate":
            return {"PASS_THROUGH"}
        if action == "cancel":
            self._close(context)
            abort(run)
            self.report({"INFO"}, "Cancelled: everything is as it was")
            return {"CANCELLED"}
        if action == "keep":
            self._keeping = True
            run.job.finish()
        if action == "poll":
            return self._poll(context, run)
        return {"RUNNING_MODAL"}

    def cancel(self, context: bpy.types.Context) -> None:
        """Blender takes the operator away: the window is closed or another file is opened."""
        self._close(context)
        abort(self._run)

    def _poll(self, context: bpy.types.Context, run: Run) -> set[str]:
        try:
            if run.job.is_running:
                run.preview()
                self._show(context)
                return {"RUNNING_MODAL"}
            self._close(context)
            _running.remove(run)
            return self.finished(context, run)
        except ReferenceError:
            self._close(context)
            abort(run)
            self.report({"ERROR"}, "Stopped, because an object was deleted meanwhile")
            return {"CANCELLED"}

    def _show(self, context: bpy.types.Context) -> None:
        job = self._run.job
        line = status_line(job)
        context.window_manager.progress_update(int(CURSOR_RANGE * job.fraction))
        hint = "Finishing this step" if self._keeping else "Keep what is there"

        def draw(header: bpy.types.Header, _context: bpy.types.Context) -> None:
            row = header.layout.row(align=True)
            row.label(text="Cancel", icon="EVENT_ESC")
            row.label(text=hint, icon="EVENT_RETURN")
            row.label(text=line)

        context.workspace.status_text_set(draw)
        _set_header(context, self._area, f"Ridgeform  {100 * job.fraction:.0f} %   {line}")

    def _close(self, context: bpy.types.Context) -> None:
        if self._timer is None:
            return
        manager = context.window_manager
        manager.event_timer_remove(self._timer)
        self._timer = None
        manager.progress_end()
        if context.workspace is not None:
            context.workspace.status_text_set(None)
        _set_header(context, self._area, None)


def _set_header(context: bpy.types.Context, area_pointer: int | None, text: str | None) -> None:
    for window in context.window_manager.windows:
        for area in window.screen.areas:
            if area.as_pointer() == area_pointer:
                area.header_text_set(text)


_running: list[Run] = []


@persistent
def _abort_all(*_arguments: object) -> None:
    for run in list(_running):
        abort(run)


# Objects do not outlive a file or an undo step, so no run may.
_HANDLERS = (bpy.app.handlers.load_pre, bpy.app.handlers.undo_pre, bpy.app.handlers.redo_pre)


def register() -> None:
    """Have runs stopped before a file is opened or a step undone."""
    for handlers in _HANDLERS:
        handlers.append(_abort_all)


def unregister() -> None:
    """Stop the runs, and no longer watch Blender's files and undo steps."""
    _abort_all()
    for handlers in _HANDLERS:
        handlers.remove(_abort_all)
