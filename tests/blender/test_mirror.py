"""Half a mesh under a Mirror modifier: the surface goes on across the plane, and the seam stays on it."""

import addon_kit as kit
import bpy
import numpy as np
import pytest
import ridgeform
from bl_ext.user_default.ridgeform.framework.job import last_summary
from mirror_kit import ball, cut, half_ball, mirror, open_edges, warnings


@pytest.mark.parametrize("axes", ["X", "Y", "Z", "XY", "XYZ"])
def test_a_part_of_a_ball_closes_to_a_ball(axes):
    obj, before = half_ball(axes)
    assert bpy.ops.ridgeform.stylize(steps=4) == {"FINISHED"}
    after = kit.coordinates(obj)
    for axis in axes:
        column = "XYZ".index(axis)
        seam = before[:, column] == 0.0
        assert seam.sum() > 4
        assert np.array_equal(after[seam, column].view(np.uint32), before[seam, column].view(np.uint32))
        assert (after[~seam, column] > 0.0).all()
    assert np.abs(after - before).max() > 0.005
    assert open_edges(obj) == 0


def triangulate(obj: bpy.types.Object) -> None:
    """Of quads the images would have the other diagonal."""
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.mesh.quads_convert_to_tris()
    bpy.ops.object.mode_set(mode="OBJECT")


def whole_of(obj: bpy.types.Object) -> tuple[bpy.types.Object, np.ndarray]:
    """An object of the mesh that modifiers make, selected alone, and which of its vertices are the mesh's."""
    before = kit.coordinates(obj)
    made = bpy.data.meshes.new_from_object(obj.evaluated_get(bpy.context.evaluated_depsgraph_get()))
    obj.select_set(False)
    whole = kit.link(bpy.data.objects.new("Whole", made))
    number = {tuple(place): row for row, place in enumerate(kit.coordinates(whole).tolist())}
    return whole, np.array([number[tuple(place)] for place in before.tolist()])


def test_half_a_ball_becomes_half_of_what_the_whole_becomes():
    obj, _ = half_ball()
    triangulate(obj)
    before = kit.coordinates(obj)
    whole, rows = whole_of(obj)
    bpy.ops.ridgeform.stylize(steps=4)
    wanted = kit.coordinates(whole)[rows]
    whole.select_set(False)
    obj.select_set(True)
    bpy.context.view_layer.objects.active = obj
    bpy.ops.ridgeform.stylize(steps=4)
    assert np.linalg.norm(wanted - before, axis=1).max() > 0.01
    assert np.linalg.norm(kit.coordinates(obj) - wanted, axis=1).max() < 1e-3


def test_without_the_modifier_the_seam_moves():
    obj, before = half_ball(show_viewport=False)
    bpy.ops.ridgeform.stylize(steps=4)
    seam = before[:, 0] == 0.0
    assert np.abs(kit.coordinates(obj)[seam, 0]).max() > 2e-4


def test_a_mirror_object_says_where_the_plane_is():
    obj = ball()
    turn = np.array(bpy.context.object.matrix_world)
    angle = 0.4
    turn[:2, :2] = [[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]
    turn[:3, 3] = [2.0, -1.0, 0.5]
    before = cut(obj, "X", turn)
    center = bpy.data.objects.new("Center", None)
    bpy.context.collection.objects.link(center)
    center.matrix_world = turn.T.tolist()
    obj.location = 0.3, 0.0, 0.0
    center.location = 2.3, -1.0, 0.5
    mirror(obj, "X", mirror_object=center)
    bpy.context.view_layer.update()
    bpy.ops.ridgeform.stylize(steps=4)
    across = (kit.coordinates(obj).astype(np.float64) - turn[:3, 3]) @ turn[:3, 0]
    seam = np.abs((before.astype(np.float64) - turn[:3, 3]) @ turn[:3, 0]) < 1e-5
    assert seam.sum() > 10
    assert np.abs(across[seam]).max() < 1e-6
    assert np.abs(kit.coordinates(obj) - before).max() > 0.005
    assert open_edges(obj) == 0


def test_the_seam_may_be_off_the_plane_by_the_merge_distance():
    obj = ball()
    before = cut(obj, "X")
    seam = before[:, 0] == 0.0
    before[seam, 0] = np.linspace(-4e-4, 4e-4, seam.sum())
    kit.set_coordinates(obj, before)
    mirror(obj, "X", merge_threshold=1e-3)
    bpy.ops.ridgeform.stylize(steps=4)
    after = kit.coordinates(obj)
    assert np.array_equal(after[seam, 0], before[seam, 0])
    assert open_edges(obj) == 0


@pytest.mark.parametrize("merge", [True, False])
def test_two_modifiers_are_applied_in_turn(merge):
    obj = ball()
    before = cut(obj, "XY")
    mirror(obj, "X", use_mirror_merge=merge)
    mirror(obj, "Y", use_mirror_merge=merge)
    bpy.ops.ridgeform.stylize(steps=3)
    after = kit.coordinates(obj)
    for axis in (0, 1):
        seam = before[:, axis] == 0.0
        assert (after[seam, axis] == 0.0).all()
    if merge:
        assert open_edges(obj) == 0


@pytest.mark.parametrize("kind", ["whole", "apart"])
def test_a_mesh_whose_border_is_not_on_the_plane_is_taken_as_it_is(kind):
    results = []
    for modifier in (False, True):
        kit.empty_scene()
        obj = kit.bumpy_box(seed=3)
        if kind == "apart":
            kit.set_coordinates(obj, kit.coordinates(obj) + np.array([3.0, 0.0, 0.0]))
        if modifier:
            mirror(obj, "X")
        bpy.ops.ridgeform.stylize(steps=3)
        results.append(kit.coordinates(obj))
    assert kit.same_bits(*results)


def test_bisect_is_said_where_it_cuts():
    obj = kit.bumpy_box()
    mirror(obj, "X", use_bisect_axis=[True, False, False])
    bpy.ops.ridgeform.stylize(steps=1)
    assert "Bisect" in warnings()
    kit.empty_scene()
    obj, _ = half_ball(use_bisect_axis=[True, False, False])
    bpy.ops.ridgeform.stylize(steps=1)
    assert "Bisect" not in warnings()


def test_edit_mode_moves_the_selection_only():
    obj, before = half_ball()
    chosen = before[:, 2] > 0.2
    kit.select_only(obj, chosen)
    bpy.ops.ridgeform.stylize(steps=3)
    bpy.ops.object.mode_set(mode="OBJECT")
    after = kit.coordinates(obj)
    assert kit.same_bits(after[~chosen], before[~chosen])
    assert (after[before[:, 0] == 0.0, 0] == 0.0).all()
    assert np.abs(after - before).max() > 1e-3


def test_the_volume_is_that_of_the_whole():
    obj, _ = half_ball()
    bpy.ops.ridgeform.stylize(steps=4, keep_volume=True)
    assert "volume" not in warnings()
    assert open_edges(obj) == 0


def test_a_mask_and_a_shape_key_go_with_it():
    obj, before = half_ball()
    group = obj.vertex_groups.new(name="Mask")
    group.add(np.flatnonzero(before[:, 1] > 0).tolist(), 1.0, "REPLACE")
    bpy.ops.ridgeform.stylize(steps=3, strength_group="Mask", output="SHAPE_KEY")
    key = kit.key_coordinates(obj, "Stylized")
    assert kit.same_bits(key[before[:, 1] <= 0], before[before[:, 1] <= 0])
    assert (key[before[:, 0] == 0.0, 0] == 0.0).all() and np.abs(key - before).max() > 1e-3


def test_segments_go_on_across_the_plane():
    bpy.ops.mesh.primitive_cube_add()
    obj = bpy.context.object
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.subdivide(number_cuts=7)
    bpy.ops.object.mode_set(mode="OBJECT")
    cut(obj, "X")
    mirror(obj, "X")
    bpy.ops.ridgeform.segment()
    entry = last_summary()[0]
    assert entry["segments"] == 5 and entry["possible"][1] >= 5
    bpy.ops.ridgeform.segment(use_count=True, count=5)
    assert last_summary()[0]["segments"] == 5


def test_denoised_values_are_those_on_the_whole():
    obj, before = half_ball()
    triangulate(obj)
    noisy = (before[:, 0] + 0.1 * np.random.default_rng(0).normal(size=len(before))).astype(np.float32)
    obj.data.attributes.new("Heat", "FLOAT", "POINT").data.foreach_set("value", noisy)
    whole, rows = whole_of(obj)
    obj.select_set(True)
    results = {}
    bpy.ops.ridgeform.denoise_attribute(attribute="Heat", energy="l2_hessian", display="NONE")
    for item in (obj, whole):
        values = np.empty(len(item.data.vertices), np.float32)
        item.data.attributes["Heat_denoised"].data.foreach_get("value", values)
        results[item] = values
    assert np.abs(results[obj] - noisy).max() > 0.1
    assert np.abs(results[obj] - results[whole][rows]).max() < 1e-3


def test_images_of_a_triangle_turn_their_faces():
    mirroring = __import__("bl_ext.user_default.ridgeform.blender.mirroring", fromlist=["images_of"])
    places = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    flips = [np.diag([-1.0, 1.0, 1.0, 1.0]), np.diag([1.0, -1.0, 1.0, 1.0])]
    images = mirroring.images_of(
        places, np.array([[0, 1, 2]]), [mirroring.Mirror(flip, 1e-3) for flip in flips]
    )
    mesh = ridgeform.Mesh(images.places(places[images.source]), images.triangles)
    assert len(images.triangles) == 4 and mesh.n_vertices == 5
    assert mesh.report.n_boundary_loops == 1 and len(mesh.report.inconsistent_edges) == 0
    assert images.is_turned.tolist() == [False, True, True, False]
    held = images.held(np.ones((5, 3)))
    assert held[:3].tolist() == [[0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [0.0, 1.0, 1.0]]


def folded_sheet(bend: float, off: float = 0.0) -> bpy.types.Object:
    """Half a roof whose ridge lies on the plane x = 0, `off` from it, and falls by `bend` (radians)."""
    x, y = np.meshgrid(np.linspace(0.0, 1.0, 9), np.linspace(-1.0, 1.0, 17))
    points = np.stack([x.ravel(), y.ravel(), -np.tan(bend) * x.ravel()], axis=1)
    points[points[:, 0] == 0.0, 0] = off
    start = (np.arange(16)[:, None] * 9 + np.arange(8)).ravel()
    faces = np.stack([start, start + 1, start + 10, start + 9], axis=1)
    return kit.add_object("Roof", points, faces.tolist())


def sharp_edges(mesh: bpy.types.Mesh) -> np.ndarray:
    """The middles (s, 3) of the edges that are marked sharp."""
    places = np.array([vertex.co for vertex in mesh.vertices])
    return np.array([places[list(edge.vertices)].mean(axis=0) for edge in mesh.edges if edge.use_edge_sharp])


@pytest.mark.parametrize("finish", ["KEEP", "LOW_POLY", "FACETS"])
@pytest.mark.parametrize(("bend", "is_ridge"), [(0.5, True), (0.0, False)])
def test_a_ridge_on_the_plane_is_marked(finish, bend, is_ridge):
    obj = folded_sheet(bend)
    mirror(obj, "X")
    bpy.ops.ridgeform.stylize(finish=finish, reduce_ratio=0.5, steps=2)
    shown = obj.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    marked = sharp_edges(shown)
    on_plane = marked[np.abs(marked[:, 0]) < 1e-6] if len(marked) else marked
    assert (len(on_plane) > 0) == is_ridge


@pytest.mark.parametrize("use", ["merge distance", "mirror object", "two axes", "mask", "bevel"])
def test_a_ridge_on_the_plane_is_marked_whatever_the_mirror(use):
    obj = folded_sheet(0.4, 4e-4 if use == "merge distance" else 0.0)
    settings = {"merge_threshold": 1e-3} if use == "merge distance" else {}
    if use == "mirror object":
        settings["mirror_object"] = bpy.data.objects.new("Center", None)
        bpy.context.collection.objects.link(settings["mirror_object"])
        obj.location = settings["mirror_object"].location = 1.0, 2.0, 3.0
        bpy.context.view_layer.update()
    given = {"marks": {"BEVEL"}} if use == "bevel" else {}
    group = obj.vertex_groups.new(name="Mask")
    lower = np.flatnonzero(kit.coordinates(obj)[:, 1] < 0.0).tolist()
    group.add(lower, 1.0, "REPLACE")
    if use == "mask":
        given["strength_group"] = "Mask"
    mirror(obj, "XZ" if use == "two axes" else "X", **settings)
    bpy.ops.ridgeform.stylize(steps=1, **given)
    marked = np.array([edge.use_edge_sharp for edge in obj.data.edges])
    if use == "bevel":
        weights = np.empty(len(obj.data.edges), np.float32)
        obj.data.attributes["bevel_weight_edge"].data.foreach_get("value", weights)
        marked = weights == 1.0
    ends = np.array([edge.vertices for edge in obj.data.edges])
    places = kit.coordinates(obj)[ends]
    seam = (np.abs(places[:, :, 0]) < 1e-3).all(axis=1)
    wanted = seam & (places[:, :, 1] < 0.0).all(axis=1) if use == "mask" else seam
    assert seam.sum() == 16 and np.array_equal(marked[seam], wanted[seam])
