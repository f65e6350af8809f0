"""The modal run of Fill Holes: the preview touches no mesh, Esc leaves every bit, Enter keeps."""

import addon_kit as kit
import bpy
import hole_kit
import modal_kit
import numpy as np
import pytest
from bl_ext.user_default.ridgeform.framework import job, modal
from bl_ext.user_default.ridgeform.framework.settings import defaults_of
from bl_ext.user_default.ridgeform.holes.settings import HoleSettings
from bl_ext.user_default.ridgeform.holes.tool import HoleFilling
from modal_kit import begin, event, poll_to_the_end, poll_until


@pytest.fixture(autouse=True)
def none_left():
    """No run is left over."""
    yield
    assert modal._running == []


def start(obj, previewed=True):
    run = HoleFilling([obj], defaults_of(HoleSettings, iterations=200, edge_length=0.02))
    operator, context = begin(run)
    if previewed:
        poll_until(operator, context, lambda: run._overlay.n_triangles > 0)
    return run, operator, context


def test_cancel_leaves_every_bit_and_takes_the_preview_away():
    obj = hole_kit.box()
    before = hole_kit.state(obj)
    run, operator, context = start(obj)
    assert hole_kit.state(obj) == before
    assert modal_kit.leave(operator, context) == {"CANCELLED"}
    assert hole_kit.state(obj) == before
    assert run._overlay.n_triangles == 0
    assert not run.job.is_running


def test_the_preview_keeps_patches_that_are_done():
    obj = hole_kit.box(centers=((1.0, 0.0, 1.0), (-1.0, 0.0, -1.0)))
    run = HoleFilling([obj], defaults_of(HoleSettings))
    (part,) = run.parts
    rim, other = np.eye(3), np.eye(3) + 5.0
    faces = np.array([[0, 1, 2], [1, 2, 3]])
    for patch in (rim, other):
        for height in (0.1, 0.2):
            part.see((np.vstack([patch, [height, height, height]]), faces))
    assert [surface[0][3, 0] for surface in part.shown] == [0.2, 0.2]
    assert run._overlay.show([(obj.matrix_world, *surface) for surface in part.shown])
    assert run._overlay.n_triangles == 4
    run.restore()


def test_cancel_in_edit_mode():
    obj = hole_kit.box()
    hole = hole_kit.around_holes(obj)[0].vertices.tolist()
    hole_kit.pick(obj, hole[:2])
    bpy.ops.object.mode_set(mode="OBJECT")
    before = hole_kit.state(obj)
    bpy.ops.object.mode_set(mode="EDIT")
    _, operator, context = start(obj)
    assert obj.mode == "EDIT"
    assert modal_kit.leave(operator, context) == {"CANCELLED"}
    bpy.ops.object.mode_set(mode="OBJECT")
    assert hole_kit.state(obj) == before


def test_opening_a_file_takes_the_preview_away():
    run, operator, context = start(hole_kit.box())
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    assert not run.job.is_running
    assert run._overlay.n_triangles == 0
    operator.cancel(context)


def test_enter_keeps_what_is_there():
    # While the first hole is seen, the others are still open, however late Enter comes.
    obj = hole_kit.box(n=16, radius=0.4, centers=[(x, 0.0, z) for x in (-1, 1) for z in (-1, 1)])
    n_faces = len(obj.data.polygons)
    run, operator, context = start(obj)
    assert operator.modal(context, event("RET")) == {"RUNNING_MODAL"}
    assert poll_to_the_end(operator, context) == {"FINISHED"}
    (entry,) = job.last_summary()
    assert entry["status"] == "stopped"
    assert len(obj.data.polygons) == n_faces + entry["faces_added"]
    assert run._overlay.n_triangles == 0
    assert not obj.data.validate()


def test_the_end_of_the_run_is_what_execute_gives():
    obj = hole_kit.box()
    settings = {"iterations": 200, "edge_length": 0.05}
    run = HoleFilling([obj], defaults_of(HoleSettings, **settings))
    operator, context = begin(run)
    assert poll_to_the_end(operator, context) == {"FINISHED"}
    kit.empty_scene()
    # The run above is over; the object of the same shape takes its place.
    other = hole_kit.box()
    other_before = len(other.data.polygons)
    bpy.ops.ridgeform.fill_holes(**settings)
    assert len(other.data.polygons) == other_before + job.last_summary()[0]["faces_added"]
