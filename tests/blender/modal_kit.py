"""The modal run without a window, and a mesh that every tool has something to do on."""

import time
from functools import partial
from types import SimpleNamespace

import addon_kit as kit
import bpy
import hole_kit
import numpy as np
from bl_ext.user_default.ridgeform.attributes.denoise import Denoising
from bl_ext.user_default.ridgeform.attributes.interpolate import Interpolation
from bl_ext.user_default.ridgeform.attributes.modes import VibrationModes
from bl_ext.user_default.ridgeform.attributes.settings import (
    DenoiseSettings,
    InterpolateSettings,
    ModesSettings,
)
from bl_ext.user_default.ridgeform.diffusion.settings import DiffusionSettings
from bl_ext.user_default.ridgeform.diffusion.tool import DiffusionCurves
from bl_ext.user_default.ridgeform.facets.settings import FacetSettings
from bl_ext.user_default.ridgeform.facets.tool import Faceting
from bl_ext.user_default.ridgeform.framework import modal
from bl_ext.user_default.ridgeform.framework.settings import defaults_of
from bl_ext.user_default.ridgeform.holes.settings import HoleSettings
from bl_ext.user_default.ridgeform.holes.tool import HoleFilling
from bl_ext.user_default.ridgeform.segments.settings import SegmentSettings
from bl_ext.user_default.ridgeform.segments.tool import Segmenting
from bl_ext.user_default.ridgeform.stylize.settings import StylizeSettings
from bl_ext.user_default.ridgeform.stylize.tool import Stylization

PATIENCE = 120.0
TOOLS = {
    "stylize": (Stylization, StylizeSettings, {"steps": 3}),
    "facet": (Faceting, FacetSettings, {"mode": "COUNT", "facets": 20}),
    "segment": (Segmenting, SegmentSettings, {}),
    "fill_holes": (HoleFilling, HoleSettings, {}),
    "denoise": (Denoising, DenoiseSettings, {"attribute": "heat"}),
    "interpolate": (Interpolation, InterpolateSettings, {"attribute": "heat", "known": "UNSELECTED"}),
    "modes": (VibrationModes, ModesSettings, {"count": 4}),
    "curves": (DiffusionCurves, DiffusionSettings, {"attribute": "paint"}),
}
"""What runs, the class of its settings, and those that are not left as they are."""


class FakeOperator(modal.ModalRun):
    """What Blender would make of the mixin, with its reports kept."""

    def __init__(self):
        """Begin without reports."""
        self.reports = []

    def report(self, level, message):
        """Keep a report."""
        self.reports.append((*level, message))


class FakeContext:
    """The parts of a context that a modal run uses, with what it showed and how many timers there are."""

    def __init__(self):
        """Begin with nothing shown."""
        self.window, self.area = None, None
        self.timers, self.cursor, self.status = 0, [], None
        self.window_manager = SimpleNamespace(
            event_timer_add=self._add,
            event_timer_remove=self._remove,
            modal_handler_add=lambda _operator: None,
            windows=(),
            progress_begin=lambda low, _high: self.cursor.append(low),
            progress_update=self.cursor.append,
            progress_end=lambda: self.cursor.append("end"),
        )
        self.workspace = SimpleNamespace(status_text_set=self._set_status)

    def _add(self, _seconds, window):
        self.timers += 1
        return "timer"

    def _remove(self, _timer):
        self.timers -= 1

    def _set_status(self, draw):
        self.status = draw


def event(kind, value="PRESS"):
    """What Blender hands to `modal`."""
    return SimpleNamespace(type=kind, value=value)


def begin(run):
    """Begin the modal run of a tool: the operator and its context."""
    operator, context = FakeOperator(), FakeContext()
    assert operator.begin_modal(context, run) == {"RUNNING_MODAL"}
    return operator, context


def poll_until(operator, context, seen):
    """Poll until something is seen, while the run goes on."""
    end = time.monotonic() + PATIENCE
    while not seen():
        assert time.monotonic() < end, "no preview"
        assert operator.modal(context, event("TIMER")) == {"RUNNING_MODAL"}
        time.sleep(0.002)


def poll_to_the_end(operator, context):
    """Poll until the operator ends, and say what it returned."""
    end = time.monotonic() + PATIENCE
    while (outcome := operator.modal(context, event("TIMER"))) == {"RUNNING_MODAL"}:
        assert time.monotonic() < end, "the run does not end"
        time.sleep(0.002)
    return outcome


def leave(operator, context, key="ESC"):
    """Cancel a run and wait until it has ended: what the operator returned then."""
    outcome = operator.modal(context, event(key)) - {"PASS_THROUGH"}
    return outcome if "CANCELLED" in outcome else poll_to_the_end(operator, context)


class Session:
    """A modal run of a tool."""

    def __init__(self, name, objects, held=False, **settings):
        """Begin it; `RefusedError` as the tool says. A held run does not end until it is told to."""
        tool, kind, given = TOOLS[name]
        self.run = tool(objects, defaults_of(kind, **(given | settings)))
        if held:
            for task in self.run.job.tasks:
                task.call = partial(self._then_wait, task.call)
        self.operator, self.context = begin(self.run)

    def _then_wait(self, call, progress):
        result = call(progress)
        self.run.job._stop.wait(PATIENCE)
        return result

    def release(self):
        """Let a held run end."""
        self.run.job._stop.set()

    def send(self, kind):
        """Hand over an event; a run that is canceled comes to its end."""
        if kind == "ESC":
            return leave(self.operator, self.context)
        return self.operator.modal(self.context, event(kind))

    def finish(self):
        """Poll until the operator ends, and say what it returned."""
        return poll_to_the_end(self.operator, self.context)

    def check_ended_but_timer(self):
        """Only what the next event takes away is left of the run."""
        assert modal._running == []
        assert not self.run.job.is_running

    def check_ended(self):
        """Nothing of the run is left."""
        self.check_ended_but_timer()
        assert self.context.timers == 0


def open_box(name="Box", cuts=3):
    """A box with noise and a hole, a painted number and a painted color, and a vertex group."""
    obj = kit.bumpy_box(name, cuts=cuts)
    mesh = obj.data
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="DESELECT")
    bpy.ops.object.mode_set(mode="OBJECT")
    mesh.polygons[0].select = True
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.delete(type="FACE")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.object.mode_set(mode="OBJECT")
    n = len(mesh.vertices)
    values = np.random.default_rng(0).random(n).astype(np.float32)
    mesh.attributes.new("heat", "FLOAT", "POINT").data.foreach_set("value", values)
    paint = np.ones((n, 4), np.float32)
    paint[:, :3] = kit.coordinates(obj)[:, :1] > 0
    mesh.color_attributes.new("paint", "FLOAT_COLOR", "POINT").data.foreach_set("color", paint.ravel())
    group = obj.vertex_groups.new(name="group")
    group.add(list(range(n // 2)), 0.5, "REPLACE")
    for index in range(n // 2):
        mesh.vertices[index].select = False
    return obj


def state(obj):
    """All of a mesh in Object Mode that a tool could change, to be compared."""
    materials = [material and material.name for material in obj.data.materials]
    return hole_kit.state(obj) | {"names": obj.vertex_groups.keys(), "materials": materials}
