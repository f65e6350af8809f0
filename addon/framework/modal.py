# SPDX-License-Identifier: GPL-3.0-or-later
"""The modal run of a job: live preview, Esc restores, Enter keeps, status bar and cursor show progress."""

import contextlib
import traceback
from collections.abc import Callable, Sequence

import bpy
from bpy.app.handlers import persistent

from ..blender.handlers import Handlers
from ..blender.mesh_state import ChangedError
from ..blender.redraws import Redraws
from ..blender.refusals import RefusedError
from .job import hide_summary
from .pacing import Estimate, Throttle, status_line
from .run import Run

POLL_SECONDS = 0.05
STOP_SECONDS = 0.1
"""How long Blender waits for a job to stop before it goes on drawing: on large meshes it can take seconds."""
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


def abort(run: Run) -> list[str]:
    """Stop a run, wait for its thread, and put everything back; a second call does nothing.

    Returns a sentence for each mesh that could not be put back. Nothing is raised: what else may happen here
    happens while Blender opens a file, closes a window or undoes a step.
    """
    if run not in _running:
        return []
    _running.remove(run)
    run.job.cancel()
    try:
        return run.restore()
    except Exception as error:
        traceback.print_exc()
        return [f"not everything could be put back ({type(error).__name__}: {error})"]


class ModalRun:
    """Mixin for operators that compute while Blender draws: call `begin_modal` from `invoke`.

    Whatever goes wrong at whatever moment comes to `_stopped`: nothing is raised to Blender.
    """

    passes_events = False
    """Whether all but Esc and Enter stays with Blender while a run goes on."""
    _timer = None
    _redraws: Redraws | None = None
    _area: int | None = None

    def finished(self, _context: bpy.types.Context, run: Run) -> set[str]:
        """Write the result of a run and report what happened; returns what the operator returns."""
        run.apply()
        if not run.done:
            self.report({"ERROR"}, "; ".join(run.errors))
            return {"CANCELLED"}
        self.report({"WARNING"} if run.errors else {"INFO"}, run.report())
        return {"FINISHED"}

    def run_at_once(self, context: bpy.types.Context, run: Run) -> set[str]:
        """Do the whole job here and now."""
        _running.append(run)
        try:
            run.job.run()
            outcome = self.finished(context, run)
            _running.remove(run)
        except Exception as error:
            return self._stopped(context, run, error)
        except BaseException:
            abort(run)
            raise
        return outcome

    def begin_modal(self, context: bpy.types.Context, run: Run) -> set[str]:
        """Start the job and hand over to `modal`."""
        try:
            self._start(run)
            manager = context.window_manager
            manager.progress_begin(0, CURSOR_RANGE)
            self._timer = manager.event_timer_add(POLL_SECONDS, window=context.window)
            # Not the area itself: touching one that was closed meanwhile would crash Blender.
            self._area = None if context.area is None else context.area.as_pointer()
            manager.modal_handler_add(self)
            self._show(context)
        except Exception as error:
            return self._stopped(context, run, error)
        return {"RUNNING_MODAL"}

    def _start(self, run: Run) -> None:
        self._run = run
        self._keeping = self._leaving = False
        self._shown = ("", "", "")
        redraws = self._redraws = self._redraws or Redraws()
        self._estimate, self._throttle = Estimate(), Throttle(POLL_SECONDS, lambda: redraws.count)
        _running.append(run)
        run.job.start()

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Handle one event."""
        run = self._run
        if run not in _running:
            self._close(context)
            return {"CANCELLED"}
        try:
            action = action_of(event.type, event.value)
            if self.passes_events and action == "ignore":
                action = "navigate"
            return self._handle(context, run, action)
        except Exception as error:
            return self._stopped(context, run, error)

    def cancel(self, context: bpy.types.Context) -> None:
        """Blender takes the operator away: the window is closed or another file is opened."""
        self._close(context)
        abort(self._run)

    def _handle(self, context: bpy.types.Context, run: Run, action: str) -> set[str]:
        if action == "navigate":
            return {"PASS_THROUGH"}
        if action == "cancel" or self._leaving:
            self._leaving = True
            if not run.job.cancel(0.0 if action == "poll" else STOP_SECONDS):
                self._show(context)
                return {"RUNNING_MODAL"}
            self._close(context)
            left = abort(run)
            self.report({"WARNING"} if left else {"INFO"}, "; ".join([self.said_of_cancel(left), *left]))
            return {"CANCELLED"}
        if action == "keep":
            self._keeping = True
            run.job.finish()
        return self._poll(context, run) if action == "poll" else {"RUNNING_MODAL"}

    def _poll(self, context: bpy.types.Context, run: Run) -> set[str]:
        """Write the result when it is there; until then show how far the job is."""
        if not (run.job.is_running or run.job.is_canceled):
            if run.back_up():
                # By itself: on a large mesh it takes as long as writing does, and Blender draws in between.
                return {"RUNNING_MODAL"}
            self._close(context)
            outcome = self.finished(context, run)
            _running.remove(run)
            return outcome
        run.watch()
        again = self.while_running(run)
        if again is not run:
            _running.remove(run)
            self._start(again)
            return {"RUNNING_MODAL"}
        if self._throttle.is_due() and not run.job.is_canceled:
            begin = self._throttle.now()
            if run.show():
                self._throttle.began(begin)
        self._show(context)
        return {"RUNNING_MODAL"}

    def while_running(self, run: Run) -> Run:
        """Called at every event while a job runs: the run to go on with, another one if this has ended."""
        return run

    def said_of_cancel(self, left: Sequence[str]) -> str:
        """What is reported after Esc, given a sentence for each mesh that could not be put back."""
        return "Canceled" if left else "Canceled: everything is as it was"

    def _stopped(self, context: bpy.types.Context, run: Run, error: Exception) -> set[str]:
        """End a run that cannot go on: thread, timer and preview go, and why is said.

        The meshes are what they were. If it was a fault of the program while results were written, what was
        written stays, with an undo step that takes it back.
        """
        self._close(context)
        left = abort(run)
        if isinstance(error, (ChangedError, RefusedError)):
            reason = str(error)
        else:
            traceback.print_exception(error)
            reason = f"{type(error).__name__}: {error}"
        if run.is_writing:
            self.report({"ERROR"}, f"Stopped while writing the result, undo takes it back: {reason}")
            return {"FINISHED"}
        sentences = [reason, *(sentence for sentence in left if sentence != reason)]
        self.report({"ERROR"}, f"Stopped: {'; '.join(sentences)}")
        return {"CANCELLED"}

    def _show(self, context: bpy.types.Context) -> None:
        job = self._run.job
        self._estimate.update(job.fraction)
        fraction, line = self._estimate.fraction, status_line(job, self._estimate)
        percent = f"{100 * fraction:.0f} %   " if fraction else ""
        header = f"Ridgeform  {percent}{line}"
        esc = "Canceling" if self._leaving else "Cancel"
        enter = "Finishing this step" if self._keeping else "Keep the result so far"
        if (header, esc, enter) == self._shown:
            # Every change is drawn, and that takes time.
            return
        self._shown = (header, esc, enter)
        context.window_manager.progress_update(int(CURSOR_RANGE * fraction))

        def draw(header: bpy.types.Header, _context: bpy.types.Context) -> None:
            row = header.layout.row(align=True)
            row.label(text=esc, icon="EVENT_ESC")
            row.label(text=enter, icon="EVENT_RETURN")
            row.label(text=line)

        if context.workspace is not None:
            context.workspace.status_text_set(draw)
        _set_header(context, self._area, header)

    def _close(self, context: bpy.types.Context) -> None:
        if self._redraws is not None:
            self._redraws.end()
            self._redraws = None
        timer, self._timer = self._timer, None
        if timer is None:
            return
        manager = context.window_manager
        for step in (
            lambda: manager.event_timer_remove(timer),
            manager.progress_end,
            lambda: context.workspace.status_text_set(None),
            lambda: _set_header(context, self._area, None),
        ):
            # A window or a workspace may be gone; the other steps are due all the same.
            with contextlib.suppress(ReferenceError, AttributeError, RuntimeError):
                step()


def _set_header(context: bpy.types.Context, area_pointer: int | None, text: str | None) -> None:
    for window in context.window_manager.windows:
        for area in window.screen.areas:
            if area.as_pointer() == area_pointer:
                area.header_text_set(text)


_running: list[Run] = []


when_aborted: list[Callable[[], None]] = []
"""What else is to be done before a file is opened or a step undone; must not raise."""


@persistent
def _abort_all(*_arguments: object) -> None:
    for run in list(_running):
        abort(run)
    for call in when_aborted:
        call()
    hide_summary()


@persistent
def _put_back_all(*_arguments: object) -> None:
    """A file that is saved while a run goes on has the meshes as they were, and no half of a result."""
    for run in list(_running):
        if run.before is not None:
            abort(run)
            continue
        try:
            run.hide()
        except Exception:
            traceback.print_exc()
            abort(run)


# Objects do not outlive a file or an undo step, so no run may.
_handlers = Handlers(load_pre=_abort_all, undo_pre=_abort_all, redo_pre=_abort_all, save_pre=_put_back_all)


def is_running() -> bool:
    """Whether a run goes on."""
    return bool(_running)


def register() -> None:
    """Have runs stopped before a file is opened or a step undone."""
    _handlers.add()


def unregister() -> None:
    """Stop the runs, and no longer watch Blender's files and undo steps."""
    _abort_all()
    _handlers.remove()
