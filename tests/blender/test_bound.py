"""The panel stays bound to the last result: changed settings start again from the original."""

import threading

import addon_kit as kit
import bpy
import modal_kit
import numpy as np
import pytest
from bl_ext.user_default.ridgeform import registry
from bl_ext.user_default.ridgeform.framework import bound, job, modal
from bl_ext.user_default.ridgeform.framework.settings import defaults_of, values_of
from bl_ext.user_default.ridgeform.stylize import recorded
from bl_ext.user_default.ridgeform.stylize.settings import StylizeSettings
from bl_ext.user_default.ridgeform.stylize.tool import Stylization
from mesh_changes import CHANGES
from modal_kit import open_box, state

TOOL = next(tool for tool in registry.TOOLS if tool.name == "stylize")


@pytest.fixture(autouse=True)
def nothing_kept():
    """No result is bound and no flow kept, before and after."""
    bound.release()
    recorded.forget()
    yield
    bound.release()
    assert modal._running == []


class Changing(bound.ChangingRun):
    """The operator that starts again, without a window."""

    __init__, report = modal_kit.FakeOperator.__init__, modal_kit.FakeOperator.report


def panel():
    return bpy.context.scene.ridgeform_stylize


def press(*objects, **settings):
    """The button: run in a window, and bind the panel."""
    for name, value in settings.items():
        setattr(panel(), name, value)
    run = Stylization(objects, values_of(StylizeSettings, panel()))
    run.keeps_original = bound.can_bind(TOOL, run)
    operator, context = modal_kit.begin(run)
    assert modal_kit.poll_to_the_end(operator, context) == {"FINISHED"}
    if run.keeps_original:
        bound.bind(TOOL, bpy.context.scene, run)
    return run


def looks():
    """What the timer does: a change counts when it is seen twice."""
    return bound.look() or bound.look()


def changed(**settings):
    """Change the panel, and start again; the operator and its context."""
    for name, value in settings.items():
        setattr(panel(), name, value)
    assert looks()
    operator, context = Changing(), modal_kit.FakeContext()
    run = operator._again()
    assert run is not None
    assert operator.begin_modal(context, run) == {"RUNNING_MODAL"}
    return operator, context


def change(**settings):
    """Change the panel, and let it run to its end."""
    operator, context = changed(**settings)
    outcome = modal_kit.poll_to_the_end(operator, context)
    assert context.timers == 0
    return outcome


def at_once(obj, **settings):
    """The state of a copy of an object that was stylized once, from the operator."""
    bound.release()
    recorded.forget()
    bpy.ops.object.select_all(action="DESELECT")
    obj.select_set(True)
    bpy.context.view_layer.objects.active = obj
    assert bpy.ops.ridgeform.stylize(**settings) == {"FINISHED"}
    return without_names(obj)


def without_names(obj):
    return {key: value for key, value in state(obj).items() if key != "name"}


def twin(obj):
    copy = obj.copy()
    copy.data = obj.data.copy()
    bpy.context.collection.objects.link(copy)
    return copy


CHANGED = (
    {"strength": 0.9},
    {"steps": 2},
    {"sharpness": 0.0, "marks": {"SHARP", "CREASE"}},
    {"finish": "LOW_POLY", "reduce_ratio": 0.5},
    {"finish": "FACETS", "use_facets": True, "facets": 20},
    {"output": "SHAPE_KEY"},
    {"output": "ATTRIBUTE"},
    {"keep_volume": True, "marks": set()},
)


@pytest.mark.parametrize("first", CHANGED, ids=str)
@pytest.mark.parametrize("second", CHANGED, ids=str)
def test_a_changed_setting_gives_what_a_run_from_the_original_gives(first, second):
    obj = open_box()
    other = twin(obj)
    press(obj, **first)
    if first != second:
        for name, value in vars(defaults_of(StylizeSettings)).items():
            setattr(panel(), name, value)
        assert change(**second) == {"FINISHED"}
    assert without_names(obj) == at_once(other, **second)
    assert not obj.data.validate()


def test_steps_are_scrubbed_from_what_was_computed(monkeypatch):
    obj = kit.bumpy_box(cuts=8)
    run = press(obj, strength=0.9)
    flow = run.parts[0].flow
    assert flow.result.iterations > 3
    calls = []
    real = recorded.ridgeform.stylize

    def counts(mesh, **options):
        calls.append(options["iterations"])
        return real(mesh, **options)

    for steps in range(1, flow.result.iterations):
        # In so short a run not every step is seen.
        flow.steps[steps] = real(
            recorded.ridgeform.Mesh(flow.vertices, flow.triangles), iterations=steps, **flow.options
        ).vertices
    monkeypatch.setattr(recorded.ridgeform, "stylize", counts)
    for steps in (2, 1, flow.result.iterations, 3):
        assert change(steps=steps) == {"FINISHED"}
        (entry,) = job.last_summary()
        assert (entry["steps"], entry["facets"] > 0) == (steps, True)
    assert set(calls) == {0}


def test_the_steps_that_are_seen_are_those_of_the_flow():
    obj = kit.bumpy_box(cuts=20)
    flow = press(obj, strength=1.0, sharpness=1.0).parts[0].flow
    assert flow.steps
    for steps, vertices in flow.steps.items():
        mesh = recorded.ridgeform.Mesh(flow.vertices, flow.triangles)
        assert np.array_equal(
            vertices, recorded.ridgeform.stylize(mesh, iterations=steps, **flow.options).vertices
        )


@pytest.mark.parametrize("finish", ["KEEP", "FACETS", "LOW_POLY"])
def test_esc_goes_back_to_the_last_result_and_its_settings(finish):
    obj = open_box()
    press(obj, finish=finish, reduce_ratio=0.5)
    before = state(obj)
    operator, context = changed(strength=0.9, finish="KEEP")
    assert modal_kit.leave(operator, context) == {"CANCELLED"}
    assert operator.reports[-1] == ("INFO", "Canceled: back to the last result")
    assert state(obj) == before
    assert (panel().strength, panel().finish) == (0.5, finish)
    assert bound.current() is not None
    assert not looks()
    assert change(strength=0.7) == {"FINISHED"}


def test_a_setting_that_changes_while_it_runs_starts_once_more():
    obj, other = open_box(), open_box("Other")
    press(obj)
    operator, context = changed(strength=0.9)
    panel().strength = 0.3
    assert modal_kit.poll_to_the_end(operator, context) == {"FINISHED"}
    # The run may have ended before the change was seen twice.
    if looks():
        assert change() == {"FINISHED"}
    assert bound.current().values.strength == pytest.approx(0.3)
    got = without_names(obj)
    assert got == at_once(other, strength=0.3)


def test_other_events_stay_with_blender_meanwhile():
    press(open_box())
    operator, context = changed(strength=0.9)
    assert operator.modal(context, modal_kit.event("LEFTMOUSE")) == {"PASS_THROUGH"}
    assert modal_kit.leave(operator, context) == {"CANCELLED"}


@pytest.mark.parametrize(("key", "passes"), [("ESC", True), ("RIGHTMOUSE", False)])
def test_esc_reaches_a_slider_that_is_still_dragged(key, passes):
    press(open_box())
    operator, context = changed(strength=0.9)
    outcome = operator.modal(context, modal_kit.event(key))
    assert ("PASS_THROUGH" in outcome) == passes
    while "CANCELLED" not in outcome:
        outcome = operator.modal(context, modal_kit.event("TIMER"))
    # What Blender sets then is the value before the drag: nothing starts again.
    panel().strength = 0.5
    assert not looks() and bound.current() is not None


@pytest.mark.parametrize("change_by_hand", CHANGES, ids=lambda change: change.__name__)
@pytest.mark.parametrize("finish", ["KEEP", "FACETS", "LOW_POLY"])
def test_a_mesh_changed_by_hand_ends_it(change_by_hand, finish):
    obj = open_box()
    press(obj, finish=finish, reduce_ratio=0.5)
    change_by_hand(obj)
    before = state(obj) if obj.mode == "OBJECT" else None
    panel().strength = 0.9
    if looks():
        operator = Changing()
        assert operator._again() is None
        assert "was changed meanwhile" in operator.reports[-1][1]
    assert bound.current() is None
    if before is not None:
        assert state(obj) == before


def test_a_deleted_object_ends_it():
    obj = open_box()
    press(obj)
    bpy.data.objects.remove(obj)
    assert not looks()
    assert bound.current() is None


@pytest.mark.parametrize("what", ["undo", "file", "apply", "scene"])
def test_what_ends_it(what):
    bpy.context.preferences.edit.use_global_undo = True
    obj = open_box()
    bpy.ops.ed.undo_push(message="made")
    before = state(obj)
    press(obj)
    bpy.ops.ed.undo_push(message="stylized")
    if what == "undo":
        bpy.ops.ed.undo()
        assert state(bpy.data.objects["Box"]) == before
    elif what == "file":
        kit.empty_scene()
    elif what == "scene":
        bpy.context.scene.name = "Another"
        assert not looks()
    else:
        assert bpy.ops.ridgeform.apply_result() == {"FINISHED"}
    assert bound.current() is None
    assert recorded._kept == []


def test_undo_while_it_starts_again_takes_the_last_result_back():
    bpy.context.preferences.edit.use_global_undo = True
    obj = open_box()
    bpy.ops.ed.undo_push(message="made")
    before = state(obj)
    press(obj, finish="LOW_POLY", reduce_ratio=0.5)
    bpy.ops.ed.undo_push(message="stylized")
    after = state(obj)
    operator, context = changed(strength=0.9)
    bpy.ops.ed.undo()
    assert operator.modal(context, modal_kit.event("TIMER")) == {"CANCELLED"}
    assert state(bpy.data.objects["Box"]) == before
    bpy.ops.ed.redo()
    assert state(bpy.data.objects["Box"]) == after


def test_settings_that_no_mesh_can_be_worked_on_with_bring_the_last_result_back():
    obj = open_box()
    press(obj)
    before = state(obj)
    panel().strength_group = "none of this name"
    assert looks()
    operator = Changing()
    assert operator._settled({"CANCELLED"} if operator._again() is None else {}) == {"CANCELLED"}
    assert 'has no vertex group "none of this name"' in operator.reports[-1][1]
    assert state(obj) == before
    assert panel().strength_group == ""
    assert not looks()


def test_saving_while_it_runs_saves_no_half_of_a_result(tmp_path):
    obj = open_box()
    before = state(obj)
    session = modal_kit.Session("stylize", [obj], held=True)
    before_preview = kit.coordinates(obj)
    modal_kit.poll_until(
        session.operator, session.context, lambda: not np.array_equal(kit.coordinates(obj), before_preview)
    )
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "saved.blend"), copy=True)
    assert state(obj) == before
    session.release()
    assert session.finish() == {"FINISHED"}


def test_a_job_that_is_slow_to_stop_does_not_hold_a_change_up():
    obj, other = open_box(), open_box("Other")
    press(obj)
    gate = threading.Event()
    panel().strength = 0.9
    assert looks()
    operator, context = Changing(), modal_kit.FakeContext()
    run = operator._again()
    for task in run.job.tasks:
        task.call = lambda _progress: gate.wait(modal_kit.PATIENCE)
    assert operator.begin_modal(context, run) == {"RUNNING_MODAL"}
    panel().strength = 0.3
    for _ in range(4):
        assert operator.modal(context, modal_kit.event("TIMER")) == {"RUNNING_MODAL"}
    assert operator._run is run
    gate.set()
    assert modal_kit.poll_to_the_end(operator, context) == {"FINISHED"}
    assert bound.current().values.strength == pytest.approx(0.3)
    got = without_names(obj)
    assert got == at_once(other, strength=0.3)
