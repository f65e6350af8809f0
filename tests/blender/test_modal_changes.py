"""The mesh of a run changes by another hand: the run ends, the mesh stays as that hand left it."""

import time

import addon_kit as kit
import bpy
import modal_kit
import pytest
from bl_ext.user_default.ridgeform.framework import modal
from mesh_changes import CHANGES, HARMLESS
from modal_kit import Session, open_box, state


@pytest.fixture(autouse=True)
def none_left():
    """No run is left over."""
    yield
    assert modal._running == []


@pytest.mark.parametrize("change", CHANGES, ids=lambda change: change.__name__)
@pytest.mark.parametrize("tool", modal_kit.TOOLS)
def test_a_changed_mesh_stays_as_it_is(tool, change):
    obj = open_box()
    session = Session(tool, [obj])
    change(obj)
    before = state(obj) if obj.mode == "OBJECT" else None
    assert session.finish() == {"CANCELLED"}
    session.check_ended()
    level, message = session.operator.reports[-1]
    assert level == "ERROR"
    assert message.startswith('Stopped: "Box" was changed meanwhile, ')
    assert message.endswith(": it stays as it is now")
    if before is None:
        bpy.ops.object.mode_set(mode="OBJECT")
    else:
        assert state(obj) == before
    assert not obj.data.validate()


@pytest.mark.parametrize("change", CHANGES, ids=lambda change: change.__name__)
@pytest.mark.parametrize("key", ["ESC", "TIMER"])
def test_after_a_preview_too(change, key):
    obj, other = open_box(), open_box("Other")
    start = state(other)
    session = Session("stylize", [obj, other], held=True)
    wait_for_preview(session, obj)
    change(obj)
    if key == "TIMER":
        session.release()
    before = state(obj) if obj.mode == "OBJECT" else None
    outcome = session.finish() if key == "TIMER" else session.send(key)
    assert outcome == {"CANCELLED"}
    session.check_ended()
    level, message = session.operator.reports[-1]
    assert level == ("ERROR" if key == "TIMER" else "WARNING")
    assert '"Box" was changed meanwhile' in message
    if before is not None:
        assert state(obj) == before
        assert state(other) == start


def wait_for_preview(session, obj):
    before = kit.coordinates(obj)
    end = time.monotonic() + modal_kit.PATIENCE
    while (kit.coordinates(obj) == before).all():
        assert time.monotonic() < end, "no preview"
        assert session.send("TIMER") == {"RUNNING_MODAL"}
        time.sleep(0.002)


def edit_another(_obj):
    other = kit.bumpy_box("Another", cuts=1)
    bpy.context.view_layer.objects.active = other
    bpy.ops.object.mode_set(mode="EDIT")


@pytest.mark.parametrize("change", [*HARMLESS, edit_another], ids=lambda change: change.__name__)
@pytest.mark.parametrize("tool", modal_kit.TOOLS)
def test_what_does_not_concern_the_mesh_does_not_stop_the_run(tool, change):
    obj = open_box()
    session = Session(tool, [obj])
    change(obj)
    assert session.finish() == {"FINISHED"}, session.operator.reports
    session.check_ended()
    if change is edit_another:
        bpy.ops.object.mode_set(mode="OBJECT")
    assert not obj.data.validate()


@pytest.mark.parametrize("tool", modal_kit.TOOLS)
def test_a_deleted_object(tool):
    obj = open_box()
    session = Session(tool, [obj])
    bpy.data.objects.remove(obj)
    assert session.finish() == {"CANCELLED"}
    session.check_ended()
    assert session.operator.reports[-1] == (
        "ERROR",
        'Stopped: "Box" was changed meanwhile, it was deleted: it stays as it is now',
    )


@pytest.mark.parametrize("tool", modal_kit.TOOLS)
@pytest.mark.parametrize("what", ["undo", "file"])
def test_undo_and_another_file_end_the_run(tool, what):
    bpy.context.preferences.edit.use_global_undo = True
    obj = open_box()
    bpy.ops.ed.undo_push(message="made")
    before = state(obj)
    bpy.ops.mesh.primitive_cube_add()
    bpy.ops.ed.undo_push(message="cube")
    session = Session(tool, [bpy.data.objects["Box"]])
    if what == "undo":
        bpy.ops.ed.undo()
        assert state(bpy.data.objects["Box"]) == before
    else:
        kit.empty_scene()
    session.check_ended_but_timer()
    assert session.send("TIMER") == {"CANCELLED"}
    session.check_ended()


def test_a_fault_of_the_program_ends_the_run_and_gives_the_mesh_back(capfd):
    obj = open_box()
    before = state(obj)
    session = Session("stylize", [obj], held=True)
    wait_for_preview(session, obj)
    session.run.show = lambda: 1 / 0
    assert session.send("TIMER") == {"CANCELLED"}
    session.check_ended()
    assert session.operator.reports[-1] == ("ERROR", "Stopped: ZeroDivisionError: division by zero")
    assert "Traceback" in capfd.readouterr().err
    assert state(obj) == before


@pytest.mark.parametrize("fault", ["write", "headline"])
def test_a_fault_while_the_result_is_written_leaves_an_undo_step(fault, capfd):
    session = Session("stylize", [open_box()])
    setattr(session.run, fault, lambda *_: 1 / 0)
    # Blender makes an undo step of what has finished only.
    assert session.finish() == {"FINISHED"}
    session.check_ended()
    assert session.operator.reports[-1] == (
        "ERROR",
        "Stopped while writing the result, undo takes it back: ZeroDivisionError: division by zero",
    )
    assert "Traceback" in capfd.readouterr().err


def test_values_that_change_while_a_mesh_is_reduced_are_not_lost():
    obj = open_box()
    session = Session("stylize", [obj], held=True, finish="LOW_POLY", reduce_ratio=0.5)
    obj.data.attributes["heat"].data[3].value = 7.0
    before = state(obj)
    session.release()
    assert session.finish() == {"CANCELLED"}
    assert "its attributes are others" in session.operator.reports[-1][1]
    assert state(obj) == before


def test_a_run_that_cannot_even_start():
    obj = open_box()
    before = state(obj)
    session = Session("stylize", [obj])
    session.send("ESC")
    run = modal_kit.Stylization([obj], modal_kit.defaults_of(modal_kit.StylizeSettings))
    session.context.window_manager.modal_handler_add = lambda _operator: 1 / 0
    operator = modal_kit.FakeOperator()
    assert operator.begin_modal(session.context, run) == {"CANCELLED"}
    session.check_ended()
    assert not run.job.is_running
    assert state(obj) == before
