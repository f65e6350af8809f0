"""The modal run, without a window: events are handed to it one by one."""

import re
import threading
import time
from types import SimpleNamespace

import addon_kit as kit
import bpy
import layout_kit
import modal_kit
import numpy as np
import pytest
from bl_ext.user_default.ridgeform.framework import job, modal, pacing
from bl_ext.user_default.ridgeform.stylize.settings import default_settings
from bl_ext.user_default.ridgeform.stylize.tool import Stylization
from modal_kit import PATIENCE, begin, event, poll_to_the_end, poll_until


@pytest.fixture(autouse=True)
def none_left():
    """No run is left over."""
    yield
    assert modal._running == []


def start(obj, steps=2000):
    """A run that would take long, begun, with at least one step previewed."""
    before = kit.coordinates(obj)
    run = Stylization([obj], default_settings(steps=steps, use_fidelity=True, fidelity=5000.0))
    operator, context = begin(run)
    poll_until(operator, context, lambda: not np.array_equal(kit.coordinates(obj), before))
    return run, operator, context


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
    assert modal_kit.leave(operator, context, key) == {"CANCELLED"}
    assert kit.same_bits(kit.coordinates(obj), values)
    assert not run.job.is_running
    assert context.timers == 0
    assert context.status is None
    assert context.cursor[-1] == "end"


def hold(run):
    """Have the job of a run go on until the event that is returned, whatever it is asked to do."""
    gate = threading.Event()
    for task in run.job.tasks:
        task.call = lambda _progress: gate.wait(PATIENCE)
    return gate


def test_a_job_that_is_slow_to_stop_does_not_hold_blender_up():
    obj = kit.bumpy_box()
    before = kit.coordinates(obj)
    run = Stylization([obj], default_settings(steps=2))
    gate = hold(run)
    operator, context = begin(run)
    labels = layout_kit.Layout()
    for key in ("ESC", "TIMER", "ESC", "TIMER"):
        assert operator.modal(context, event(key)) == {"RUNNING_MODAL"}
    context.status(SimpleNamespace(layout=labels), None)
    assert "Canceling" in labels.labels
    assert modal.is_running()
    gate.set()
    assert poll_to_the_end(operator, context) == {"CANCELLED"}
    assert operator.reports == [("INFO", "Canceled: everything is as it was")]
    assert kit.same_bits(kit.coordinates(obj), before)
    assert not modal.is_running()
    assert context.timers == 0


@pytest.mark.parametrize("late", [0.0, 0.03])
@pytest.mark.parametrize("redraws", [0, 1, 8])
def test_drawing_takes_a_tenth_of_the_time_however_often_blender_draws(redraws, late):
    """Nor do calls that come late by themselves, since a job takes all processors, put off drawing."""
    now, poll, cost, drawn = [0.0], 0.05, 0.4, [0]
    throttle = pacing.Throttle(poll, lambda: drawn[0], lambda: now[0])
    shown, drawing, left = 0, 0.0, 0
    while now[0] < 200.0:
        if throttle.is_due():
            throttle.began(throttle.now())
            shown, left = shown + 1, redraws
        if left:
            left, drawing, now[0], drawn[0] = left - 1, drawing + cost, now[0] + cost, drawn[0] + 1
        now[0] += poll + late
    assert shown >= (0.05 * now[0] / (redraws * cost) if redraws else 500)
    assert drawing <= 0.1 * now[0] + redraws * cost


def test_what_is_written_counts_where_no_view_is_drawn():
    now = [0.0]
    throttle = pacing.Throttle(0.05, lambda: 0, lambda: now[0])
    assert throttle.is_due()
    throttle.began(now[0])
    now[0] += 1.05
    assert not throttle.is_due()
    now[0] += 9.0
    assert throttle.is_due()


def test_cancel_in_edit_mode_restores_every_bit():
    obj = kit.bumpy_box()
    before = kit.coordinates(obj)
    kit.select_only(obj, np.ones(len(before), bool))
    run = Stylization([obj], default_settings(steps=2000, use_fidelity=True, fidelity=5000.0))
    operator, context = begin(run)
    end = time.monotonic() + PATIENCE
    while not run.preview():
        assert time.monotonic() < end, "no preview"
        time.sleep(0.005)
    obj.update_from_editmode()
    assert not np.array_equal(kit.coordinates(obj), before)
    assert modal_kit.leave(operator, context) == {"CANCELLED"}
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
    operator, context = begin(run)
    assert poll_to_the_end(operator, context) == {"FINISHED"}
    after = kit.coordinates(obj)
    kit.set_coordinates(obj, before)
    bpy.ops.ridgeform.stylize(steps=2)
    assert kit.same_bits(kit.coordinates(obj), after)


def test_view_can_be_turned_meanwhile():
    _, operator, context = start(kit.bumpy_box())
    assert operator.modal(context, event("MIDDLEMOUSE")) == {"PASS_THROUGH"}
    assert operator.modal(context, event("G")) == {"RUNNING_MODAL"}
    modal_kit.leave(operator, context)


def test_status_bar_says_step_and_time():
    run, operator, context = start(kit.bumpy_box())
    line = pacing.status_line(run.job, operator._estimate)
    assert re.match(r"Box: \w+, step \d+ of at most 2000, \d+ s elapsed", line), line
    assert context.status is not None
    modal_kit.leave(operator, context)


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
    assert operator.reports[-1][0] == "ERROR"
