"""When stylize is disabled or refuses, with which reason, and that it leaves the mesh alone then."""

import addon_kit as kit
import bpy
import numpy as np
import pytest
from bl_ext.user_default.ridgeform.blender import selection


def reason():
    """The reason shown in the tooltip; the button itself must agree with it."""
    found = selection.reason_disabled(bpy.context)
    assert bpy.ops.ridgeform.stylize.poll() == (found is None)
    return found


def test_ready_with_a_mesh():
    kit.bumpy_box()
    assert reason() is None
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    assert reason() is None


def test_nothing_selected():
    assert reason() == "Select a mesh object"


def test_only_other_objects_selected():
    kit.link(bpy.data.objects.new("Lamp", bpy.data.lights.new("Lamp", "POINT")))
    assert reason() == "Select a mesh object"


def test_other_mode():
    bpy.ops.object.armature_add()
    bpy.ops.object.mode_set(mode="POSE")
    assert reason() == "Switch to Object Mode, or to Edit Mode, Sculpt Mode, or a paint mode of a mesh"


def test_empty_mesh_and_mesh_without_faces():
    kit.add_object("Empty", np.empty((0, 3)), [])
    assert reason() == '"Empty" has no faces'
    bpy.ops.object.select_all(action="DESELECT")
    kit.add_object("Points", np.eye(3), [])
    assert reason() == '"Points" has no faces'


def test_nothing_selected_in_edit_mode():
    obj = kit.bumpy_box()
    kit.select_only(obj, np.zeros(len(obj.data.vertices), bool))
    assert reason() == 'Nothing is selected in "Box": select the part to work on'


def test_multiresolution():
    kit.bumpy_box().modifiers.new("Multires", "MULTIRES")
    assert reason() == '"Box" has a Multiresolution modifier: apply it first'


def test_locked_shape_key():
    obj = kit.bumpy_box()
    obj.shape_key_add(name="Basis")
    key = obj.shape_key_add(name="Smile")
    obj.active_shape_key_index = 1
    assert reason() is None
    key.lock_shape = True
    assert reason() == 'The active shape key of "Box" is locked: unlock it first'


@pytest.fixture
def library(tmp_path):
    """A file with one box in it."""
    kit.bumpy_box("Far")
    path = tmp_path / "library.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    kit.empty_scene()
    return str(path)


def test_linked_data(library):
    with bpy.data.libraries.load(library, link=True) as (_, into):
        into.objects = ["Far"]
    kit.link(into.objects[0])
    assert reason() == '"Far" is linked from another file: make its mesh local first'


def test_overridden_data(library):
    with bpy.data.libraries.load(library, link=True) as (_, into):
        into.objects = ["Far"]
    obj = kit.link(into.objects[0].override_create(remap_local_usages=True))
    assert "is linked from another file" in reason()
    obj.data.override_create(remap_local_usages=True)
    assert reason() == '"Far" has overridden mesh data: make its mesh local first'


def test_usable_objects_run_and_the_others_are_named():
    kit.add_object("Points", np.eye(3), [])
    kit.bumpy_box().select_set(True)
    bpy.data.objects["Points"].select_set(True)
    chosen = selection.usable(selection.mesh_objects(bpy.context))
    assert [obj.name for obj in chosen.objects] == ["Box"]
    assert chosen.skipped == ['"Points" has no faces']
    assert bpy.ops.ridgeform.stylize(steps=1) == {"FINISHED"}


def refused(**settings):
    """The message with which stylize refuses; the mesh must not have changed by a bit."""
    obj = bpy.context.object
    before = kit.coordinates(obj)
    with pytest.raises(RuntimeError) as refusal:
        bpy.ops.ridgeform.stylize(steps=1, **settings)
    assert kit.same_bits(kit.coordinates(obj), before)
    return str(refusal.value)


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_non_finite_coordinates_name_the_vertex(bad):
    obj = kit.bumpy_box()
    values = kit.coordinates(obj)
    values[17, 1] = bad
    kit.set_coordinates(obj, values)
    assert 'Vertex 17 of "Box" has a coordinate that is not a finite number (1 in all)' in refused()


def test_unknown_group_and_empty_mask():
    obj = kit.bumpy_box()
    assert 'has no vertex group "nose"' in refused(strength_group="nose")
    assert 'has no vertex group "nose"' in refused(ridge_group="nose")
    obj.vertex_groups.new(name="none")
    assert "No vertex" in refused(strength_group="none")


@pytest.mark.parametrize(("vertices", "faces"), kit.BAD_MESHES.values(), ids=kit.BAD_MESHES)
def test_bad_meshes_end_finite_or_refused(vertices, faces):
    obj = kit.add_object("Bad", vertices, faces)
    before = kit.coordinates(obj)
    try:
        bpy.ops.ridgeform.stylize(steps=3)
    except RuntimeError as refusal:
        assert str(refusal).startswith("Error: ")
        assert kit.same_bits(kit.coordinates(obj), before)
    else:
        assert np.isfinite(kit.coordinates(obj)).all()
