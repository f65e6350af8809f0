"""What is made of a result: volume, ridge marks, fewer triangles."""

import addon_kit as kit
import bpy
import numpy as np
import pytest
from bl_ext.user_default.ridgeform.blender import mesh_io
from bl_ext.user_default.ridgeform.framework import job
from bl_ext.user_default.ridgeform.framework.ridges import dividing_angle, edge_angles
from bl_ext.user_default.ridgeform.framework.volume import is_closed, keep_volume, volume_and_centroid

CUBE = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)
CUBE_FACES = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
CUBE_TRIANGLES = np.array([[f[0], f[i], f[i + 1]] for f in CUBE_FACES for i in (1, 2)])


def notes():
    return job.last_summary()[0]["warnings"]


def volume_of(obj):
    return volume_and_centroid(kit.coordinates(obj), mesh_io.triangles(obj.data))[0]


def test_volume_and_centroid_of_a_box():
    box = CUBE * [1, 2, 3] + [100, 0, 0]
    volume, centroid = volume_and_centroid(box, CUBE_TRIANGLES)
    assert volume == pytest.approx(6, rel=1e-12)
    assert np.allclose(centroid, [100.5, 1, 1.5], rtol=1e-12)


def test_closed_means_two_agreeing_faces_at_every_edge():
    assert is_closed(CUBE_TRIANGLES, 8)
    assert not is_closed(CUBE_TRIANGLES[1:], 8)
    flipped = CUBE_TRIANGLES.copy()
    flipped[0] = flipped[0, ::-1]
    assert not is_closed(flipped, 8)
    assert not is_closed(np.concatenate([CUBE_TRIANGLES, CUBE_TRIANGLES]), 8)


def test_keep_volume_scales_about_the_centroid():
    small, reason = keep_volume(CUBE, 0.5 * CUBE, CUBE_TRIANGLES)
    assert reason is None
    assert np.allclose(small, CUBE - 0.25)
    _, reason = keep_volume(CUBE, 0.01 * CUBE, CUBE_TRIANGLES)
    assert "hardly any is left" in reason


def test_operator_keeps_the_volume():
    obj = kit.bumpy_box()
    before = volume_of(obj)
    bpy.ops.ridgeform.stylize(strength=0.8, keep_volume=True)
    assert volume_of(obj) == pytest.approx(before, rel=1e-5)
    assert notes() == []


def test_volume_is_left_with_a_reason():
    open_box = kit.add_object("Open", CUBE, CUBE_FACES[1:])
    bpy.ops.ridgeform.stylize(steps=1, keep_volume=True)
    assert any("the mesh is open" in note for note in notes())
    open_box.select_set(False)
    obj = kit.bumpy_box()
    open_box.select_set(False)
    before = kit.coordinates(obj)
    chosen = before[:, 0] > 0
    kit.select_only(obj, chosen)
    bpy.ops.ridgeform.stylize(steps=1, keep_volume=True)
    bpy.ops.object.mode_set(mode="OBJECT")
    assert any("only a part" in note for note in notes())
    assert kit.same_bits(kit.coordinates(obj)[~chosen], before[~chosen])


def ridges_of(vertices, faces, angle):
    obj = kit.add_object("Fold", vertices, faces)
    ends = mesh_io.edges(obj.data)
    angles = edge_angles(kit.coordinates(obj), mesh_io.face_corners(obj.data), len(ends))
    found = (angles >= 0) & (angles >= np.radians(angle))
    return {tuple(sorted(pair)) for pair in ends[found].tolist()}


def test_ridges_by_angle():
    roof = [
        [0, 0, 0],
        [1, 0, 0],
        [1, 1, 0],
        [0, 1, 0],
        [1, 2, np.tan(np.radians(30))],
        [0, 2, np.tan(np.radians(30))],
    ]
    faces = [[0, 1, 2, 3], [3, 2, 4, 5]]
    assert ridges_of(roof, faces, 29.9) == {(2, 3)}
    assert ridges_of(roof, faces, 30.1) == set()
    assert ridges_of(roof, [faces[0], faces[1][::-1]], 29.9) == {(2, 3)}
    assert ridges_of(roof, [faces[0], faces[1][::-1]], 30.1) == set()


def test_ridges_of_odd_edges():
    three = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [0, -1, -1]]
    assert ridges_of(three, [[0, 1, 2], [0, 1, 3], [0, 1, 4]], 0) == set()
    no_area = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [2, 0, 0]]
    assert ridges_of(no_area, [[0, 1, 2], [1, 0, 3]], 0) == set()


@pytest.mark.parametrize("mode", ["OBJECT", "EDIT"])
def test_marks_are_added_to_those_that_exist(mode):
    obj = kit.add_object("Cube", CUBE, CUBE_FACES)
    mesh = obj.data
    mesh.attributes.new("crease_edge", "FLOAT", "EDGE").data.foreach_set(
        "value", np.full(12, 0.25, np.float32)
    )
    chosen = CUBE[:, 2] == 1 if mode == "EDIT" else np.ones(8, bool)
    if mode == "EDIT":
        kit.select_only(obj, chosen)
    bpy.ops.ridgeform.stylize(steps=1, strength=0.0, marks={"SHARP", "CREASE", "BEVEL"}, use_mark_angle=True)
    bpy.ops.object.mode_set(mode="OBJECT")
    ridges = chosen[mesh_io.edges(mesh)].all(axis=1)
    values = {}
    for name, dtype in (("sharp_edge", bool), ("crease_edge", np.float32), ("bevel_weight_edge", np.float32)):
        values[name] = np.empty(12, dtype)
        mesh.attributes[name].data.foreach_get("value", values[name])
    assert np.array_equal(values["sharp_edge"], ridges)
    assert np.array_equal(values["crease_edge"], np.where(ridges, 1, 0.25).astype(np.float32))
    assert np.array_equal(values["bevel_weight_edge"], ridges.astype(np.float32))


def test_the_dividing_angle_lies_between_facets_and_ridges():
    angles = np.radians([0.1, 0.5, 0.0, 0.3, 40.0, 30.0, 50.0, -60.0])
    lengths = np.array([1.0, 1.0, 2.0, 1.0, 1.0, 1.0, 0.5, 9.0])
    angle = dividing_angle(angles, lengths)
    assert np.radians(0.5) < angle < np.radians(30.0)
    # The angles of an icosphere are all alike but for rounding: nothing parts them.
    assert dividing_angle(np.full(5, 0.3), np.ones(5)) == np.inf
    assert dividing_angle(np.array([-1.0]), np.ones(1)) == np.inf


@pytest.mark.parametrize("smooth", [False, True])
def test_facets_are_seen_at_the_defaults_and_one_undo_takes_all_back(smooth):
    obj = kit.bumpy_box()
    obj.data.polygons.foreach_set("use_smooth", [smooth] * len(obj.data.polygons))
    bpy.ops.ed.undo_push(message="before")
    assert bpy.ops.ridgeform.stylize() == {"FINISHED"}
    marked = np.empty(len(obj.data.edges), bool)
    obj.data.attributes["sharp_edge"].data.foreach_get("value", marked)
    assert 0 < marked.sum() < len(marked)
    entry = job.last_summary()[0]
    assert entry["facets"] > 5
    assert 0 < entry["moved"] < 0.1
    assert entry["gap"] <= 1e-3
    assert [face.use_smooth for face in obj.data.polygons] == [smooth] * len(obj.data.polygons)


@pytest.mark.parametrize("mode", ["OBJECT", "EDIT"])
def test_marks_follow_the_result(mode):
    obj = kit.bumpy_box()
    if mode == "EDIT":
        kit.select_only(obj, np.ones(len(obj.data.vertices), bool))
    bpy.ops.ridgeform.stylize(steps=6, marks={"SHARP"}, use_mark_angle=True, mark_angle=np.radians(15))
    bpy.ops.object.mode_set(mode="OBJECT")
    ends = mesh_io.edges(obj.data)
    expected = edge_angles(kit.coordinates(obj), mesh_io.face_corners(obj.data), len(ends)) >= np.radians(15)
    marked = np.empty(len(ends), bool)
    obj.data.attributes["sharp_edge"].data.foreach_get("value", marked)
    assert np.array_equal(marked, expected)
    assert 0 < marked.sum() < len(ends)


def test_reduce_carries_everything_over():
    obj = kit.bumpy_box(cuts=16)
    mesh = obj.data
    for name in ("left", "right"):
        mesh.materials.append(bpy.data.materials.new(name))
    centers = np.array([face.center[:] for face in mesh.polygons])
    mesh.polygons.foreach_set("material_index", (centers[:, 0] > 0).astype(np.int32))
    before = kit.coordinates(obj)
    heat = mesh.attributes.new("heat", "FLOAT", "POINT")
    heat.data.foreach_set("value", before[:, 2].copy())
    tint = mesh.color_attributes.new("tint", "FLOAT_COLOR", "CORNER")
    corner_vertices = mesh_io.face_corners(mesh)[1]
    colors = np.c_[(before[corner_vertices] + 1) / 2, np.ones(len(corner_vertices))].astype(np.float32)
    tint.data.foreach_set("color", colors.ravel())
    bone = obj.vertex_groups.new(name="bone")
    for vertex in np.flatnonzero(before[:, 1] > 0).tolist():
        bone.add([vertex], 0.75, "REPLACE")
    obj.vertex_groups.new(name="none")
    n_triangles = len(mesh_io.triangles(mesh))
    assert bpy.ops.ridgeform.stylize(steps=2, strength=0.0, finish="LOW_POLY", reduce_ratio=0.2) == {
        "FINISHED"
    }

    assert len(mesh.polygons) == pytest.approx(0.2 * n_triangles, rel=0.02)
    assert all(len(face.vertices) == 3 for face in mesh.polygons)
    assert not mesh.validate(verbose=True)
    after, spacing = kit.coordinates(obj), 2 / 17
    assert [material.name for material in mesh.materials] == ["left", "right"]
    centers = np.array([face.center[:] for face in mesh.polygons])
    clear = np.abs(centers[:, 0]) > spacing
    index = np.array([face.material_index for face in mesh.polygons])
    assert np.array_equal(index[clear], (centers[clear, 0] > 0).astype(int))
    values = np.empty(len(after), np.float32)
    mesh.attributes["heat"].data.foreach_get("value", values)
    assert np.abs(values - after[:, 2]).max() < spacing
    corner_vertices = mesh_io.face_corners(mesh)[1]
    values = np.empty(4 * len(corner_vertices), np.float32)
    mesh.color_attributes["tint"].data.foreach_get("color", values)
    assert np.abs(values.reshape(-1, 4)[:, :3] - (after[corner_vertices] + 1) / 2).max() < spacing
    assert [group.name for group in obj.vertex_groups] == ["bone", "none"]
    weights = mesh_io.group_weights(obj, "bone")
    assert np.allclose(weights[after[:, 1] > spacing], 0.75)
    assert not weights[after[:, 1] < -spacing].any()
    assert "quads and n-gons became triangles" in " ".join(notes())


def test_scripts_may_still_say_reduce():
    obj = kit.bumpy_box(cuts=8)
    n_triangles = len(mesh_io.triangles(obj.data))
    bpy.ops.ridgeform.stylize(steps=1, reduce=True, reduce_ratio=0.5)
    assert len(obj.data.polygons) == n_triangles // 2
    bpy.ops.ridgeform.stylize(steps=1, reduce=False)
    assert len(obj.data.polygons) == n_triangles // 2


def test_reduce_keeps_uv_charts_apart():
    obj = kit.bumpy_box(cuts=12)
    mesh = obj.data
    starts, vertices, _ = mesh_io.face_corners(mesh)
    assert np.array_equal(np.diff(starts), np.full(len(starts) - 1, 4))
    side = np.array([2 * int(np.argmax(np.abs(face.normal))) for face in mesh.polygons])
    chart = np.repeat(side, 4)
    uv = np.empty((len(vertices), 2), np.float32)
    positions = kit.coordinates(obj)[vertices]
    for axis in (0, 2, 4):
        rows = chart == axis
        uv[rows] = 10 * axis + np.delete(positions[rows], axis // 2, axis=1)
    mesh.uv_layers["UVMap"].data.foreach_set("uv", uv.ravel())
    bpy.ops.ridgeform.stylize(steps=1, strength=0.0, finish="LOW_POLY", reduce_ratio=0.3)
    values = np.empty(2 * len(mesh.loops), np.float32)
    mesh.uv_layers["UVMap"].data.foreach_get("uv", values)
    faces = values.reshape(-1, 3, 2)
    assert np.ptp(faces, axis=1).max() < 3, "a triangle stretches from one chart to another"
    assert mesh.uv_layers.active.name == "UVMap"


def test_reduce_keeps_seams():
    obj = kit.bumpy_box(cuts=16, noise=0.005)
    mesh = obj.data
    ends, points = mesh_io.edges(mesh), kit.coordinates(obj)
    outer = np.abs(points) > 0.95
    seam = (outer[ends[:, 0]] & outer[ends[:, 1]]).sum(axis=1) >= 2
    mesh.edges.foreach_set("use_seam", seam)
    bpy.ops.ridgeform.stylize(steps=1, strength=0.0, finish="LOW_POLY", reduce_ratio=0.3)
    kept = np.empty(len(mesh.edges), bool)
    mesh.edges.foreach_get("use_seam", kept)
    middles = kit.coordinates(obj)[mesh_io.edges(mesh)].mean(axis=1)
    assert 20 < kept.sum() < seam.sum()
    assert ((np.abs(middles[kept]) > 0.9).sum(axis=1) >= 2).all()


def test_reduce_does_not_open_split_seams():
    """Every face of a box by itself, as glTF stores it, comes out as one closed surface."""
    whole = kit.bumpy_box(cuts=8)
    points = kit.coordinates(whole)
    corners = mesh_io.face_corners(whole.data)[1]
    obj = kit.add_object("Split", points[corners], np.arange(len(corners)).reshape(-1, 4))
    whole.select_set(False)
    bpy.ops.ridgeform.stylize(steps=1, strength=0.0, finish="LOW_POLY", reduce_ratio=0.5)
    assert is_closed(mesh_io.triangles(obj.data), len(obj.data.vertices))


def test_reduce_is_left_with_a_reason():
    few = kit.add_object("Cube", CUBE, CUBE_FACES)
    bpy.ops.ridgeform.stylize(steps=1, strength=0.0, finish="LOW_POLY", reduce_ratio=1.0)
    assert "its 12 triangles were not reduced, because there are few enough" in notes()
    few.select_set(False)
    obj = kit.bumpy_box()
    faces = len(obj.data.polygons)
    kit.select_only(obj, np.ones(len(obj.data.vertices), bool))
    bpy.ops.ridgeform.stylize(steps=1, finish="LOW_POLY")
    bpy.ops.object.mode_set(mode="OBJECT")
    assert any("only in Object Mode" in note for note in notes())
    obj.shape_key_add(name="Basis")
    bpy.ops.ridgeform.stylize(steps=1, finish="LOW_POLY")
    assert any("has shape keys" in note for note in notes())
    assert len(obj.data.polygons) == faces


def sharp_and_angles(obj):
    ends = mesh_io.edges(obj.data)
    angles = edge_angles(kit.coordinates(obj), mesh_io.face_corners(obj.data), len(ends))
    sharp = np.zeros(len(ends), bool)
    attribute = obj.data.attributes.get("sharp_edge")
    if attribute is not None:
        attribute.data.foreach_get("value", sharp)
    return ends, sharp, angles


@pytest.mark.parametrize("smooth", [True, False])
@pytest.mark.parametrize("kind", ["sphere", "torus", "box"])
def test_every_facet_of_a_reduced_mesh_is_seen(kind, smooth):
    if kind == "box":
        obj = kit.bumpy_box()
    else:
        add = {"sphere": bpy.ops.mesh.primitive_uv_sphere_add, "torus": bpy.ops.mesh.primitive_torus_add}
        add[kind]()
        obj = bpy.context.object
    obj.data.polygons.foreach_set("use_smooth", [smooth] * len(obj.data.polygons))
    bpy.ops.ridgeform.stylize(steps=2, finish="LOW_POLY", reduce_ratio=0.4)
    _, sharp, angles = sharp_and_angles(obj)
    assert sharp[angles >= np.radians(2.0)].all()
    assert not sharp[(angles >= 0) & (angles < np.radians(2.0))].any()


def test_what_a_mask_holds_stays_smooth_where_the_rest_is_reduced():
    bpy.ops.mesh.primitive_uv_sphere_add()
    obj = bpy.context.object
    obj.data.polygons.foreach_set("use_smooth", [True] * len(obj.data.polygons))
    group = obj.vertex_groups.new(name="mask")
    group.add(np.flatnonzero(kit.coordinates(obj)[:, 2] > 0).tolist(), 1.0, "REPLACE")
    before = kit.coordinates(obj)
    bpy.ops.ridgeform.stylize(steps=2, finish="LOW_POLY", reduce_ratio=0.6, strength_group="mask")
    ends, sharp, angles = sharp_and_angles(obj)
    places = {point.tobytes() for point in before[before[:, 2] <= 0]}
    held = np.array([point.tobytes() in places for point in kit.coordinates(obj)])
    assert held.sum() == len(places)
    inside = ~held[ends].any(axis=1)
    assert np.array_equal(sharp, inside & (angles >= np.radians(2.0)))


@pytest.mark.parametrize("finish", ["KEEP", "LOW_POLY"])
def test_a_ridge_angle_that_is_set_counts_for_each_finish(finish):
    obj = kit.bumpy_box()
    bpy.ops.ridgeform.stylize(steps=2, finish=finish, reduce_ratio=0.5, mark_angle=np.radians(40.0))
    _, sharp, angles = sharp_and_angles(obj)
    assert np.array_equal(sharp, angles >= np.float32(np.radians(40.0)))
