"""The modal run of the tools on attributes: nothing is written before the end, or after a cancellation."""

import time
from types import SimpleNamespace

import addon_kit as kit
import bpy
import modal_kit
import numpy as np
import pytest
from bl_ext.user_default.ridgeform.attributes.denoise import Denoising
from bl_ext.user_default.ridgeform.attributes.interpolate import Interpolation
from bl_ext.user_default.ridgeform.attributes.modes import VibrationModes
from bl_ext.user_default.ridgeform.attributes.settings import (
    DenoiseSettings,
    InterpolateSettings,
    ModesSettings,
)
from bl_ext.user_default.ridgeform.blender.attribute_names import SHOWN
from bl_ext.user_default.ridgeform.framework import pacing
from bl_ext.user_default.ridgeform.framework.settings import defaults_of
from modal_kit import begin, event, poll_to_the_end

TOOLS = {
    "denoise": (Denoising, DenoiseSettings, {"sharpness": 1.0}),
    "interpolate": (Interpolation, InterpolateSettings, {"sharpness": 1.0}),
    "modes": (VibrationModes, ModesSettings, {"count": 200}),
}
LONG = {"tolerance": 1e-8, "display": "VIEWPORT"}


def heated_box(cuts=40):
    obj = kit.bumpy_box(cuts=cuts)
    values = np.random.default_rng(0).random(len(obj.data.vertices))
    obj.data.attributes.new("heat", "FLOAT", "POINT").data.foreach_set("value", values.astype(np.float32))
    obj.data.vertices.foreach_set("select", np.arange(len(values)) % 50 == 0)
    return obj


def names(obj):
    return sorted(a.name for a in obj.data.attributes if not a.name.startswith("."))


def start(obj, tool, **changes):
    """A run that takes a while, begun and seen at work."""
    kind, settings, options = TOOLS[tool]
    run = kind([obj], defaults_of(settings, **(options | LONG | changes)))
    operator, context = begin(run)
    return run, operator, context


@pytest.mark.parametrize("tool", list(TOOLS))
def test_cancel_leaves_everything_as_it_was(tool):
    obj = heated_box()
    before = names(obj)
    run, operator, context = start(obj, tool)
    assert operator.modal(context, event("TIMER", "NOTHING")) == {"RUNNING_MODAL"}
    assert modal_kit.leave(operator, context) == {"CANCELLED"}
    assert not run.job.is_running
    assert names(obj) == before
    assert context.timers == 0
    assert operator.reports == [("INFO", "Canceled: everything is as it was")]


@pytest.mark.parametrize("tool", list(TOOLS))
def test_a_run_to_the_end_writes_and_reports(tool):
    obj = heated_box(cuts=4)
    _, operator, context = start(obj, tool, tolerance=1e-2, **({"count": 3} if tool == "modes" else {}))
    assert poll_to_the_end(operator, context) == {"FINISHED"}
    made = {"denoise": "heat_denoised", "interpolate": "heat_interpolated", "modes": "ridgeform_mode_2"}[tool]
    assert {made, SHOWN} <= set(names(obj))
    ((level, message),) = operator.reports
    assert level == "INFO"
    assert '"Box"' in message


def test_enter_takes_what_is_reached():
    obj = heated_box()
    run, operator, context = start(obj, "denoise")
    end = time.monotonic() + 60
    while run.job.current.progress.iteration == 0:
        assert time.monotonic() < end, "the solver does not begin"
        time.sleep(0.001)
    operator.modal(context, event("RET"))
    outcome = poll_to_the_end(operator, context)
    assert outcome == {"FINISHED"}
    assert "heat_denoised" in names(obj)
    assert run.summary[0]["status"] == "stopped"
    assert "stopped early" in operator.reports[0][1]


def test_status_bar_counts_iterations():
    progress = SimpleNamespace(stage="solving", iteration=3)
    task = SimpleNamespace(
        name="Box", progress=progress, counted="iteration", stage="", started=True, most=None
    )
    estimate = SimpleNamespace(elapsed=4.2, remaining=75.0)
    line = pacing.status_line(SimpleNamespace(current=task), estimate)
    assert line == "Box: solving, iteration 3, 4 s elapsed, about 1 min 15 s left"


def test_a_failed_run_is_an_error_and_writes_nothing():
    obj = heated_box(cuts=4)
    before = names(obj)
    _, operator, context = start(obj, "modes", count=10_000)
    assert poll_to_the_end(operator, context) == {"CANCELLED"}
    ((level, message),) = operator.reports
    assert level == "ERROR"
    assert "count" in message
    assert names(obj) == before
    assert bpy.context.mode == "OBJECT"
