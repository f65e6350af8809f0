"""Segmenting: the operator gives what the wheel gives, and writes it where it was asked to."""

import addon_kit as kit
import bpy
import numpy as np
import pytest
import ridgeform
from bl_ext.user_default.ridgeform.blender import attribute_io, mesh_io, selected_elements
from bl_ext.user_default.ridgeform.blender.stored_numbers import read_ints
from bl_ext.user_default.ridgeform.framework import job
from bl_ext.user_default.ridgeform.framework.settings import defaults_of
from bl_ext.user_default.ridgeform.segments import groups, layers, slots, tool
from bl_ext.user_default.ridgeform.segments.settings import SegmentSettings, segment_options
from known_shapes import shapes
from modal_kit import begin, event, poll_to_the_end

SIDES = 6


def cube(name="Cube", n=6, noise=0.05):
    """A cube of triangles with some noise, and the true side of each face."""
    vertices, faces = shapes.cube(n)
    middle = vertices[faces].mean(axis=1)
    axis = np.abs(middle).argmax(axis=1)
    truth = 2 * axis + (middle[np.arange(len(faces)), axis] > 0)
    noisy = shapes.add_noise(vertices, faces, noise, seed=4)
    return kit.add_object(name, noisy, faces.tolist()), truth


def ints(obj, name, domain="FACE"):
    return read_ints(obj.data, name, domain, -7)


def slot_of_faces(obj):
    index = np.empty(len(obj.data.polygons), np.int32)
    obj.data.polygons.foreach_get("material_index", index)
    return index


def flags(obj, name):
    values = np.zeros(len(obj.data.edges), bool)
    obj.data.edges.foreach_get(name, values)
    return values


def select_faces(obj, mask):
    """Enter Edit Mode with exactly these faces selected."""
    obj.data.vertices.foreach_set("select", np.zeros(len(obj.data.vertices), bool))
    selected_elements.write(obj.data, obj.data.edges, np.zeros(len(obj.data.edges), bool))
    obj.data.polygons.foreach_set("select", mask)
    bpy.context.scene.tool_settings.mesh_select_mode = (False, False, True)
    bpy.ops.object.mode_set(mode="EDIT")


def same_partition(a, b):
    """Whether two labelings divide faces in the same way."""
    pairs = np.unique(np.stack([a, b]), axis=1)
    return len(pairs[0]) == len(np.unique(a)) == len(np.unique(b))


def expected(obj, n_segments=None, **changes):
    """What the wheel says of an object of triangles, with the numbers as Blender stores them."""
    settings = defaults_of(SegmentSettings)
    for name, value in vars(settings).items():
        if isinstance(value, float):
            setattr(settings, name, float(np.float32(value)))
    mesh = ridgeform.Mesh(kit.coordinates(obj).astype(np.float64), mesh_io.triangles(obj.data))
    options = segment_options(settings) | changes
    return ridgeform.segment(mesh, n_segments=n_segments, **options)


def test_the_operator_gives_what_the_wheel_gives():
    obj, truth = cube()
    assert bpy.ops.ridgeform.segment() == {"FINISHED"}
    found = expected(obj)
    assert np.array_equal(ints(obj, layers.SEGMENT), found.labels)
    assert same_partition(ints(obj, layers.SEGMENT), truth)
    (entry,) = job.last_summary()
    assert entry["segments"] == SIDES
    assert entry["possible"] == list(found.range)


def test_each_segment_gets_a_slot_with_a_color_and_old_slots_stay():
    obj, truth = cube()
    old = bpy.data.materials.new("Old")
    obj.data.materials.append(old)
    bpy.ops.ridgeform.segment()
    assert obj.data.materials[0] == old
    assert len(obj.data.materials) == 1 + SIDES
    assert same_partition(slot_of_faces(obj), truth)
    assert slot_of_faces(obj).min() == 1
    colors = np.array([material.diffuse_color[:3] for material in obj.data.materials[1:]])
    apart = np.linalg.norm(colors[:, None] - colors, axis=2)[~np.eye(SIDES, dtype=bool)]
    assert apart.min() > 0.1


def test_a_second_run_uses_its_own_slots_again_and_leaves_no_material_behind():
    obj, truth = cube()
    obj.data.materials.append(bpy.data.materials.new("Old"))
    bpy.ops.ridgeform.segment()
    first = [material.name for material in obj.data.materials]
    obj.data.materials[1].diffuse_color = (0.1, 0.2, 0.3, 1)
    bpy.ops.ridgeform.segment()
    assert [material.name for material in obj.data.materials] == first
    assert np.allclose(obj.data.materials[1].diffuse_color[:3], (0.1, 0.2, 0.3))
    assert len(bpy.data.materials) == 1 + SIDES
    bpy.ops.ridgeform.segment(use_count=True, count=2)
    assert [material.name for material in obj.data.materials] == first[:3]
    assert {material.name for material in bpy.data.materials} == set(first[:3])
    assert sorted(np.unique(slot_of_faces(obj))) == [1, 2]
    bpy.ops.ridgeform.segment()
    assert same_partition(slot_of_faces(obj), truth)
    assert len(bpy.data.materials) == 1 + SIDES


def test_materials_shared_with_another_mesh_outlive_a_run_on_one():
    obj, truth = cube()
    bpy.ops.ridgeform.segment()
    other = bpy.data.objects.new("Copy", obj.data.copy())
    kit.link(other)
    obj.select_set(False)
    bpy.ops.ridgeform.segment(use_count=True, count=2)
    assert len(other.data.materials) == 2
    assert len(obj.data.materials) == SIDES
    assert None not in list(obj.data.materials)
    assert same_partition(slot_of_faces(obj), truth)


def test_fewer_segments_are_nested_and_come_from_what_is_known():
    obj, _ = cube()
    tool.forget()
    bpy.ops.ridgeform.segment()
    fine = ints(obj, layers.SEGMENT)
    found = expected(obj)
    for count in (4, 3, 1):
        bpy.ops.ridgeform.segment(use_count=True, count=count)
        coarse = ints(obj, layers.SEGMENT)
        assert np.array_equal(coarse, found.labels_at(count))
        assert len(np.unique(coarse)) == count
        assert len(np.unique(np.stack([fine, coarse]), axis=1)[0]) == SIDES
    assert len(tool._known) == 1
    kit.set_coordinates(obj, kit.coordinates(obj) * np.float32(1.5))
    bpy.ops.ridgeform.segment(use_count=True, count=3)
    assert len(tool._known) == 2
    bpy.ops.ridgeform.segment(length_weight=0.4)
    assert len(tool._known) == 3


def test_more_segments_than_there_are_is_said():
    obj, _ = cube()
    bpy.ops.ridgeform.segment(use_count=True, count=5000)
    (entry,) = job.last_summary()
    assert entry["segments"] < 5000
    assert entry["warnings"] == [
        f"5000 segments were asked for, {entry['possible'][0]} to {entry['possible'][1]} are possible"
    ]
    assert ints(obj, layers.SEGMENT).max() == entry["segments"] - 1


def test_seams_and_sharp_edges_lie_between_segments_and_follow_the_next_run():
    obj, truth = cube()
    mine = np.zeros(len(obj.data.edges), bool)
    mine[5] = True
    obj.data.edges.foreach_set("use_seam", mine)
    bpy.ops.ridgeform.segment(outputs={"SEAMS", "SHARP"})
    assert len(obj.data.materials) == 0
    borders = layers.border_edges(obj.data, truth.astype(np.int32))
    assert borders.sum() == 12 * 6
    assert np.array_equal(flags(obj, "use_seam"), borders | mine)
    assert np.array_equal(flags(obj, "use_edge_sharp"), borders)
    bpy.ops.ridgeform.segment(outputs={"SEAMS"}, use_count=True, count=1)
    assert np.array_equal(flags(obj, "use_seam"), mine)
    assert not flags(obj, "use_edge_sharp").any()
    assert layers.MARKED not in obj.data.attributes


def test_face_sets_groups_and_indicator():
    obj, truth = cube()
    mine = obj.vertex_groups.new(name="Mine")
    bpy.ops.ridgeform.segment(outputs={"FACE_SETS", "VERTEX_GROUPS", "INDICATOR"})
    sets = ints(obj, layers.FACE_SET)
    assert same_partition(sets, truth)
    assert sets.min() == 1
    assert len(obj.vertex_groups) == 1 + SIDES
    group = obj.vertex_groups[groups.GROUP + "0"]
    inside = np.unique([v for face in obj.data.polygons if sets[face.index] == 1 for v in face.vertices])
    weights = mesh_io.group_weights(obj, group.name)
    assert np.array_equal(np.flatnonzero(weights == 1), inside)
    indicator = np.empty(len(truth), np.float32)
    obj.data.attributes[layers.INDICATOR].data.foreach_get("value", indicator)
    assert kit.same_bits(indicator, expected(obj).indicator.astype(np.float32))
    bpy.ops.ridgeform.segment(outputs={"VERTEX_GROUPS"}, use_count=True, count=2)
    names = [group.name for group in obj.vertex_groups]
    assert names == [mine.name, groups.GROUP + "0", groups.GROUP + "1"]


def test_the_sharpened_surface_is_a_shape_key():
    obj, _ = cube()
    bpy.ops.ridgeform.segment(outputs={"SHARPENED"})
    assert kit.same_bits(kit.key_coordinates(obj, tool.KEY_NAME), expected(obj).values.astype(np.float32))


def test_separate_objects_take_their_faces_and_slots_along():
    obj, truth = cube()
    obj.data.uv_layers.new(name="Map")
    outcome = bpy.ops.ridgeform.segment(outputs={"MATERIALS", "OBJECTS"})
    assert outcome == {"FINISHED"}
    objects = list(bpy.context.selected_objects)
    assert len(objects) == SIDES
    assert sum(len(part.data.polygons) for part in objects) == len(truth)
    for part in objects:
        assert len(part.data.polygons) == len(truth) // SIDES
        assert len(part.data.materials) == 1
        assert (slot_of_faces(part) == 0).all()
        assert "Map" in part.data.uv_layers
        assert np.ptp(kit.coordinates(part), axis=0).min() < 0.2
    assert bpy.context.view_layer.objects.active == obj
    assert len(bpy.data.materials) == SIDES


def test_edit_mode_segments_the_selected_faces_only():
    obj, truth = cube()
    bpy.ops.ridgeform.segment(use_count=True, count=1)
    before = slot_of_faces(obj)
    top = np.isin(truth, (4, 5, 0))
    select_faces(obj, top)
    assert bpy.ops.ridgeform.segment(outputs={"MATERIALS", "SEAMS", "FACE_SETS"}) == {"FINISHED"}
    assert obj.mode == "EDIT"
    bpy.ops.object.mode_set(mode="OBJECT")
    labels = ints(obj, layers.SEGMENT)
    assert (labels[~top] == 0).all()
    assert sorted(np.unique(labels[top])) == [1, 2, 3]
    assert same_partition(labels[top], truth[top])
    assert (slot_of_faces(obj)[~top] == before[~top]).all()
    assert same_partition(slot_of_faces(obj), np.where(top, truth, -1))
    assert same_partition(ints(obj, layers.FACE_SET), np.where(top, truth, -1))
    inside = layers.border_edges(obj.data, np.where(top, truth, -1).astype(np.int32))
    assert np.array_equal(flags(obj, "use_seam"), inside)
    select_faces(obj, top)
    bpy.ops.ridgeform.segment()
    bpy.ops.object.mode_set(mode="OBJECT")
    assert np.array_equal(ints(obj, layers.SEGMENT), labels)
    assert len(bpy.data.materials) == 4


def test_without_a_selected_face_the_button_says_so():
    obj, _ = cube()
    kit.select_only(obj, np.zeros(len(obj.data.vertices), bool))
    assert not bpy.ops.ridgeform.segment.poll()
    bpy.ops.object.mode_set(mode="OBJECT")
    one = np.arange(len(obj.data.vertices)) == 0
    kit.select_only(obj, one)
    with pytest.raises(RuntimeError, match="No face"):
        bpy.ops.ridgeform.segment()
    bpy.ops.object.mode_set(mode="OBJECT")
    assert layers.SEGMENT not in obj.data.attributes


def test_faces_of_any_size_are_segmented():
    obj = kit.bumpy_box(cuts=6, noise=0.01)
    x = kit.coordinates(obj)
    kit.select_only(obj, (np.abs(x) < 0.5).sum(axis=1) == 2)
    bpy.ops.mesh.select_mode(type="FACE")
    bpy.ops.mesh.dissolve_faces()
    bpy.ops.object.mode_set(mode="OBJECT")
    sizes = sorted(len(face.vertices) for face in obj.data.polygons)
    assert sizes == [4] * SIDES * (49 - 9) + [12] * SIDES
    bpy.ops.ridgeform.segment()
    labels = ints(obj, layers.SEGMENT)
    middle = np.array([face.center for face in obj.data.polygons])
    axis = np.abs(middle).argmax(axis=1)
    assert same_partition(labels, 2 * axis + (middle[np.arange(len(middle)), axis] > 0))


def test_a_face_has_the_segment_of_most_of_its_area():
    part = tool.SegmentPart(
        None,
        None,
        0,
        weld=None,
        faces=np.array([0, 0, 0, 1, 1, 3]),
        areas=np.array([3.0, 1.0, 1.0, 1.0, 2.0, 1.0]),
        taking=np.array([True, True, True, False]),
        source=None,
    )
    # The first face is mostly of segment 5, the second of 2; the third has no triangle, the fourth no part.
    labels = part.face_labels(np.array([5, 2, 2, 5, 2, 0]))
    assert labels.tolist() == [1, 0, -1, -1]
    assert part.face_labels(np.full(6, -1)).tolist() == [-1, -1, -1, -1]
    means = part.face_means(np.array([1.0, 0.0, 0.0, 0.0, 0.3, 0.5]))
    assert np.allclose(means[[0, 1, 3]], [0.6, 0.2, 0.5])


@pytest.mark.parametrize("data_type", ["FLOAT", "FLOAT_VECTOR", "FLOAT_COLOR"])
def test_segments_of_an_attribute(data_type):
    vertices, faces = shapes.grid(16, 16)
    obj = kit.add_object("Sheet", vertices, faces.tolist())
    step = (vertices[:, 0] > 8).astype(float)
    columns = {"FLOAT": [step], "FLOAT_VECTOR": [step, 2 * step, 0 * step]}.get(
        data_type, [step, 1 - step, step, np.ones_like(step)]
    )
    prop = {"FLOAT": "value", "FLOAT_VECTOR": "vector", "FLOAT_COLOR": "color"}[data_type]
    attribute = obj.data.attributes.new("paint", data_type, "POINT")
    attribute.data.foreach_set(prop, np.stack(columns, axis=1).astype(np.float32).ravel())
    outcome = bpy.ops.ridgeform.segment(
        source="ATTRIBUTE", attribute="paint", outputs={"MATERIALS", "SHARPENED"}
    )
    assert outcome == {"FINISHED"}
    labels = ints(obj, layers.SEGMENT)
    left = vertices[faces].mean(axis=1)[:, 0]
    assert len(np.unique(labels[left < 8])) == len(np.unique(labels[left > 9])) == 1
    assert labels[left < 8][0] != labels[left > 9][0]
    made = attribute_io.read_values(obj, "paint_sharpened").values
    assert np.abs(made - np.stack(columns, axis=1)).max() < 0.2
    (entry,) = job.last_summary()
    assert entry["attribute"] == "paint"


def test_an_attribute_that_never_changes_is_refused():
    obj, _ = cube()
    obj.data.attributes.new("even", "FLOAT", "POINT")
    with pytest.raises(RuntimeError, match="same value everywhere"):
        bpy.ops.ridgeform.segment(source="ATTRIBUTE", attribute="even")
    with pytest.raises(RuntimeError, match='no attribute or vertex group "odd"'):
        bpy.ops.ridgeform.segment(source="ATTRIBUTE", attribute="odd")


def test_split_seams_are_one_surface():
    obj, truth = cube()
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.mesh.edge_split(type="EDGE")
    bpy.ops.object.mode_set(mode="OBJECT")
    assert len(obj.data.vertices) == 3 * len(truth)
    bpy.ops.ridgeform.segment(outputs={"FACE_SETS"})
    assert len(np.unique(ints(obj, layers.SEGMENT))) == SIDES


def test_escape_leaves_everything_and_enter_keeps_what_is_reached():
    obj, _ = cube(n=40)
    run = tool.Segmenting([obj], defaults_of(SegmentSettings, length_weight=0.45))
    operator, context = begin(run)
    if operator.modal(context, event("ESC")) != {"CANCELLED"}:
        # The job has not heard it yet, as on a machine with much else to do.
        assert poll_to_the_end(operator, context) == {"CANCELLED"}
    assert layers.SEGMENT not in obj.data.attributes
    assert len(bpy.data.materials) == 0
    run = tool.Segmenting([obj], defaults_of(SegmentSettings, length_weight=0.45))
    operator, context = begin(run)
    operator.modal(context, event("RET"))
    assert poll_to_the_end(operator, context) == {"FINISHED"}
    assert run.summary[0]["status"] == "stopped"
    assert "stopped early" in operator.reports[-1][1]
    assert layers.SEGMENT in obj.data.attributes
    known = len(tool._known)
    finished = tool.Segmenting([obj], defaults_of(SegmentSettings, length_weight=0.45, epsilon_end=0.1))
    finished.job.run()
    assert len(tool._known) == min(known + 1, tool._known.MOST)


def test_undo_takes_slots_attribute_and_seams_back():
    obj, _ = cube()
    bpy.context.preferences.edit.use_global_undo = True
    bpy.ops.ed.undo_push(message="before")
    bpy.ops.ridgeform.segment("EXEC_DEFAULT", True, outputs={"MATERIALS", "SEAMS"})
    assert len(bpy.data.materials) == SIDES
    bpy.ops.ed.undo()
    obj = bpy.data.objects["Cube"]
    assert layers.SEGMENT not in obj.data.attributes
    assert len(obj.data.materials) == 0
    assert len([material for material in bpy.data.materials if slots.MARK in material]) == 0
    assert not flags(obj, "use_seam").any()
    bpy.ops.ed.redo()
    obj = bpy.data.objects["Cube"]
    assert len(obj.data.materials) == SIDES
    assert flags(obj, "use_seam").sum() == 12 * 6


def test_the_cube_that_a_new_scene_has_gets_six_materials():
    bpy.ops.mesh.primitive_cube_add(rotation=(0.3, 0.5, 0.9))
    obj = bpy.context.active_object
    assert bpy.ops.ridgeform.segment() == {"FINISHED"}
    assert len(obj.material_slots) == SIDES
    assert sorted(slot_of_faces(obj)) == list(range(SIDES))
    bpy.ops.mesh.primitive_cylinder_add(vertices=32)
    assert bpy.ops.ridgeform.segment() == {"FINISHED"}
    assert len(bpy.context.active_object.material_slots) == 3
