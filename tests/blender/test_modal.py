"""The modal run, without a window: events are handed to it one by one."""

import time
from types import SimpleNamespace

import addon_kit as kit
import bpy
import numpy as np
import pytest
from bl_ext.user_default.ridgeform.framework import job, modal
from bl_ext.user_default.ridgeform.stylize.settings import default_settings
from bl_ext.user_default.ridgeform.stylize.tool import Stylization

PATIENCE = 60.0


@pytest.fixture(autouse=True)
def none_left():
    """No run is left over."""
    yield
    assert modal._running == []


class FakeOperator(modal.ModalRun):
    """What Blender would make of the mixin, with its reports kept."""

    def __init__(self):
        """Begin without reports."""
        self.reports = []

    def report(self, level, message):
        """Keep a report."""
        self.reports.append((level, message))

    def finished(self, context, run):
        """Write the result."""
        run.apply()
        return {"FINISHED"}


class FakeContext:
    """The parts of a context that a modal run uses, with what it showed."""

    def __init__(self):
        """Begin with nothing shown."""
        self.window, self.area = None, None
        self.timers, self.cursor, self.status = 0, [], None
        self.window_manager = SimpleNamespace(
            event_timer_add=self._add, event_timer_remove=self._remove, 
            modal_handler_add=lambda _operator: None,
            windows=(),
            progress_begin=lambda low, high: self.cursor.append(low),
            progress_update=self.cursor.append, progress_end=lambda: self.cursor.append("end"),
        )  # fmt: skip
        self.workspace = SimpleNamespace(status_text_set=self._set_status)

    def _add(self, _seconds, window):
        self.timers += 1
        return "timer"

    def _remove(self, _timer):
        self.timers -= 1

    def _set_status(self, draw):
        self.status = draw


def event(kind, value="PRESS"):
    return SimpleNamespace(type=kind, value=value)


def start(obj, steps=2000):
    """A run that would take long, begun, with at least one step previewed."""
    before = kit.coordinates(obj)
    run = Stylization([obj], default_settings(steps=steps, use_fidelity=True, fidelity=5000.0))
    operator, context = FakeOperator(), FakeContext()
    assert operator.begin_modal(context, run) == {"RUNNING_MODAL"}
    end = time.monotonic() + PATIENCE
    while np.array_equal(kit.coordinates(obj), before):
        assert time.monotonic() < end, "no preview"
        assert operator.modal(context, event("TIMER")) == {"RUNNING_MODAL"}
        time.sleep(0.005)
    return run, operator, context


def poll_to_the_end(operator, context):
    end = time.monotonic() + PATIENCE
    while True:
        assert time.monotonic() < end, "the run does not end"
        result = operator.modal(context, event("TIMER"))
        if result != {"RUNNING_MODAL"}:
            return result
        time.sleep(0.005)


def test_what_events_mean():
    assert modal.action_of("TIMER", "NOTHING") == "poll"
    assert modal.action_of("ESC", "PRESS") == modal.action_of("RIGHTMOUSE", "PRESS") == "cancel"
    assert modal.action_of("RET", "PRESS") == modal.action_of("NUMPAD_ENTER", "PRESS") == "keep"
    assert modal.action_of("ESC", "RELEASE") == modal.action_of("LEFTMOUSE", "PRESS") == "ignore"
    assert modal.action_of("WHEELUPMOUSE", "PRESS") == "navigate"


@pytest.mark.parametrize("key", ["ESC", "RIGHTMOUSE"])
def test_cancel_restores_every_bit(key):
    obj = kit.bumpy_box()
    values = kit.coordinates(obj)
    values[0, 0] = -0.0
    kit.set_coordinates(obj, values)
    run, operator, context = start(obj)
    assert operator.modal(context, event(key)) == {"CANCELLED"}
    assert kit.same_bits(kit.coordinates(obj), values)
    assert not run.job.is_running
    assert context.timers == 0
    assert context.status is None
    assert context.cursor[-1] == "end"


def test_cancel_in_edit_mode_restores_every_bit():
    obj = kit.bumpy_box()
    before = kit.coordinates(obj)
    kit.select_only(obj, np.ones(len(before), bool))
    run = Stylization([obj], default_settings(steps=2000, use_fidelity=True, fidelity=5000.0))
    operator, context = FakeOperator(), FakeContext()
    operator.begin_modal(context, run)
    end = time.monotonic() + PATIENCE
    while not run.preview():
        assert time.monotonic() < end, "no preview"
        time.sleep(0.005)
    obj.update_from_editmode()
    assert not np.array_equal(kit.coordinates(obj), before)
    assert operator.modal(context, event("ESC")) == {"CANCELLED"}
    bpy.ops.object.mode_set(mode="OBJECT")
    assert kit.same_bits(kit.coordinates(obj), before)


def test_enter_keeps_what_is_there():
    obj = kit.bumpy_box()
    before = kit.coordinates(obj)
    run, operator, context = start(obj)
    assert operator.modal(context, event("RET")) == {"RUNNING_MODAL"}
    assert poll_to_the_end(operator, context) == {"FINISHED"}
    (entry,) = job.last_summary()
    assert entry["status"] == "stopped"
    assert 0 < entry["steps"] < 2000
    assert run.kept_settings()["steps"] == entry["steps"]
    after = kit.coordinates(obj)
    assert not np.array_equal(after, before)
    kit.set_coordinates(obj, before)
    bpy.ops.ridgeform.stylize(steps=entry["steps"], use_fidelity=True, fidelity=5000.0)
    assert kit.same_bits(kit.coordinates(obj), after)


def test_the_end_of_the_run_is_the_end_of_the_operator():
    obj = kit.bumpy_box()
    before = kit.coordinates(obj)
    run = Stylization([obj], default_settings(steps=2))
    operator, context = FakeOperator(), FakeContext()
    operator.begin_modal(context, run)
    assert poll_to_the_end(operator, context) == {"FINISHED"}
    after = kit.coordinates(obj)
    kit.set_coordinates(obj, before)
    bpy.ops.ridgeform.stylize(steps=2)
    assert kit.same_bits(kit.coordinates(obj), after)


def test_view_can_be_turned_meanwhile():
    _, operator, context = start(kit.bumpy_box())
    assert operator.modal(context, event("MIDDLEMOUSE")) == {"PASS_THROUGH"}
    assert operator.modal(context, event("G")) == {"RUNNING_MODAL"}
    operator.modal(context, event("ESC"))


def test_status_bar_says_step_energy_and_gap():
    run, operator, context = start(kit.bumpy_box())
    line = modal.status_line(run.job)
    assert "Box" in line
    assert "step" in line
    assert "energy" in line
    assert "gap" in line
    assert context.status is not None
    operator.modal(context, event("ESC"))


def test_opening_a_file_stops_the_run():
    run, operator, context = start(kit.bumpy_box())
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    assert not run.job.is_running
    operator.cancel(context)
    assert context.timers == 0


def test_closing_the_window_restores():
    obj = kit.bumpy_box()
    before = kit.coordinates(obj)
    run, operator, context = start(obj)
    operator.cancel(context)
    assert not run.job.is_running
    assert kit.same_bits(kit.coordinates(obj), before)


def test_a_deleted_object_ends_the_run():
    obj = kit.bumpy_box()
    run, operator, context = start(obj)
    bpy.data.objects.remove(obj)
    assert poll_to_the_end(operator, context) == {"CANCELLED"}
    assert not run.job.is_running
    assert operator.reports[-1][0] == {"ERROR"}
