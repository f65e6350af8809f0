"""What lies on a mesh goes on in the patches that fill its holes: values, UVs, weights, keys, marks."""

import addon_kit as kit
import bpy
import hole_kit
import numpy as np
import pytest

MAP = np.array([[1.3, 0.2], [-0.4, 0.8], [0.3, 0.5]])
"""A linear map of the coordinates to UVs."""
LINEAR = 2e-6
"""How far a linear function may be off: float32 and the solver."""


def filled(obj, **settings):
    assert bpy.ops.ridgeform.fill_holes(**settings) == {"FINISHED"}
    assert not obj.data.validate()
    return kit.coordinates(obj), hole_kit.corner_vertices(obj.data)


def face_middles(obj):
    at = kit.coordinates(obj)
    return np.array([at[list(face.vertices)].mean(axis=0) for face in obj.data.polygons])


def test_a_linear_uv_map_goes_on_linearly():
    obj = hole_kit.sheet()
    at, corner = kit.coordinates(obj), hole_kit.corner_vertices(obj.data)
    hole_kit.set_values(obj.data, "UV", "FLOAT2", "CORNER", (at[corner] @ MAP).astype(np.float32))
    old = hole_kit.values(obj.data, "UV")
    at, corner = filled(obj)
    uv = hole_kit.values(obj.data, "UV")
    assert kit.same_bits(uv[: len(old)], old)
    assert np.abs(uv - at[corner] @ MAP).max() < LINEAR


def test_each_uv_island_goes_on_by_itself():
    obj = hole_kit.sheet()
    mesh = obj.data
    at, corner = kit.coordinates(obj), hole_kit.corner_vertices(mesh)
    right = np.repeat(face_middles(obj)[:, 0] > 0.5, 4)
    islands = [at[corner] @ MAP, at[corner] @ MAP[[1, 0, 2]] + 3.0]
    hole_kit.set_values(
        mesh, "UV", "FLOAT2", "CORNER", np.where(right[:, None], islands[1], islands[0]).astype(np.float32)
    )
    seam = [all(abs(at[v, 0] - 0.5) < 1e-6 for v in edge.vertices) for edge in mesh.edges]
    mesh.edges.foreach_set("use_seam", seam)
    at, corner = filled(obj)
    uv = hole_kit.values(mesh, "UV").reshape(-1, 2)[4 * 128 :].reshape(-1, 3, 2)
    at = at[corner[4 * 128 :].reshape(-1, 3)]
    errors = [np.abs(uv - island).max(axis=(1, 2)) for island in (at @ MAP, at @ MAP[[1, 0, 2]] + 3.0)]
    assert np.minimum(*errors).max() < LINEAR
    shares = [(error < LINEAR).mean() for error in errors]
    assert min(shares) > 0.35
    # The seam goes on through the patch, where the two islands meet.
    seams = [edge for edge in mesh.edges if edge.use_seam]
    assert len(seams) > sum(seam)
    ends = kit.coordinates(obj)[[edge.vertices[:] for edge in seams]]
    assert np.abs(ends[..., 0] - 0.5).max() < 0.2


def test_a_seam_along_an_edge_of_a_box_follows_the_ridge():
    obj = hole_kit.box(n=12, radius=0.5)
    mesh = obj.data
    at, corner = kit.coordinates(obj), hole_kit.corner_vertices(mesh)
    top = np.repeat(face_middles(obj)[:, 2] > 0.99, 4)
    uv = np.where(top[:, None], at[corner][:, :2], at[corner][:, 1:] + 5.0).astype(np.float32)
    hole_kit.set_values(mesh, "UV", "FLOAT2", "CORNER", uv)
    n = len(corner)
    at, corner = filled(obj)
    uv = hole_kit.values(mesh, "UV")[n:].reshape(-1, 3, 2)
    at = at[corner[n:].reshape(-1, 3)]
    is_top = at[..., 2].mean(axis=1) > 1 - 1e-2
    is_side = at[..., 0].mean(axis=1) > 1 - 1e-2
    assert (is_top | is_side).all()
    assert np.abs(uv[is_top] - at[is_top][..., :2]).max() < 0.02
    assert np.abs(uv[~is_top] - at[~is_top][..., 1:] - 5.0).max() < 0.02


@pytest.mark.parametrize(
    ("data_type", "domain", "columns"),
    [
        ("FLOAT", "POINT", 1), ("FLOAT2", "POINT", 2), ("FLOAT_VECTOR", "POINT", 3),
        ("FLOAT_COLOR", "POINT", 4),
        ("FLOAT", "CORNER", 1), ("FLOAT_VECTOR", "CORNER", 3), ("FLOAT_COLOR", "CORNER", 4),
    ],
)  # fmt: skip
def test_linear_values_go_on_linearly(data_type, domain, columns):
    obj = hole_kit.sheet()
    at, corner = kit.coordinates(obj), hole_kit.corner_vertices(obj.data)
    turn = np.random.default_rng(0).random((3, columns)) / 3

    def wanted(at, corner):
        return (at @ turn + 0.1)[corner if domain == "CORNER" else slice(None)]

    hole_kit.set_values(obj.data, "it", data_type, domain, wanted(at, corner).astype(np.float32))
    at, corner = filled(obj)
    assert np.abs(hole_kit.values(obj.data, "it") - wanted(at, corner)).max() < LINEAR


@pytest.mark.parametrize("domain", ["POINT", "CORNER"])
def test_byte_colors_go_on_and_the_old_ones_stay(domain):
    obj = hole_kit.sheet()
    mesh = obj.data
    at, corner = kit.coordinates(obj), hole_kit.corner_vertices(mesh)
    where = corner if domain == "CORNER" else slice(None)
    colors = np.c_[at, np.ones(len(at))][where].astype(np.float32)
    hole_kit.set_values(mesh, "color", "BYTE_COLOR", domain, colors)
    old = hole_kit.values(mesh, "color")
    at, corner = filled(obj)
    new = hole_kit.values(mesh, "color")
    assert kit.same_bits(new[: len(old)], old)
    where = corner if domain == "CORNER" else slice(None)
    assert np.abs(new[:, :2] - at[where][:, :2]).max() < 0.02


def test_weights_and_shape_keys_go_on():
    obj = hole_kit.sheet()
    at = kit.coordinates(obj)
    group = obj.vertex_groups.new(name="bone")
    for vertex, weight in enumerate(at[:, 0].tolist()):
        group.add([vertex], weight, "REPLACE")
    obj.vertex_groups.new(name="far").add([0], 1.0, "REPLACE")
    kit.add_key(obj, "Basis", 0 * at)
    kit.add_key(obj, "Bent", np.c_[0 * at[:, :2], 0.5 * at[:, 1]])
    obj.data.shape_keys.key_blocks["Bent"].value = 0.5
    old = {name: kit.key_coordinates(obj, name) for name in ("Basis", "Bent")}
    at, _ = filled(obj)
    for name, before in old.items():
        assert kit.same_bits(kit.key_coordinates(obj, name)[: len(before)], before)
    assert kit.same_bits(kit.key_coordinates(obj, "Basis"), at)
    bent = kit.key_coordinates(obj, "Bent") - at
    assert np.abs(bent - np.c_[0 * at[:, :2], 0.5 * at[:, 1]]).max() < LINEAR
    weights = [{g.group: g.weight for g in vertex.groups} for vertex in obj.data.vertices]
    assert np.abs([weight.get(0, 0.0) for weight in weights] - at[:, 0]).max() < LINEAR
    assert [index for index, weight in enumerate(weights) if 1 in weight] == [0]
    assert obj.data.shape_keys.key_blocks["Bent"].value == 0.5


def test_whole_numbers_and_truths_come_from_the_nearest():
    obj = hole_kit.sheet()
    mesh = obj.data
    at = kit.coordinates(obj)
    hole_kit.set_values(mesh, "side", "INT", "POINT", np.where(at[:, :1] > 0.5, 7, 3).astype(np.int32))
    right = at[hole_kit.corner_vertices(mesh)][:, :1] > 0.5
    hole_kit.set_values(mesh, "is_right", "BOOLEAN", "CORNER", right)
    mesh.attributes.new("name", "STRING", "POINT").data[5].value = b"five"
    at, corner = filled(obj)
    far = np.abs(at[:, 0] - 0.5) > 0.1
    assert np.array_equal(hole_kit.values(mesh, "side")[far, 0], np.where(at[far, 0] > 0.5, 7, 3))
    assert np.array_equal(hole_kit.values(mesh, "is_right")[far[corner], 0], at[corner][far[corner], 0] > 0.5)
    assert mesh.attributes["name"].data[5].value == b"five"


def test_values_that_are_no_numbers_come_from_the_nearest():
    obj = hole_kit.sheet()
    at = kit.coordinates(obj)
    broken = np.where(at[:, :1] > 0.5, np.nan, 1.0).astype(np.float32)
    hole_kit.set_values(obj.data, "broken", "FLOAT", "POINT", broken)
    assert bpy.ops.ridgeform.fill_holes() == {"FINISHED"}
    # Blender's validation, which other tests call, would replace them.
    at = kit.coordinates(obj)
    values = hole_kit.values(obj.data, "broken")[:, 0]
    far = np.abs(at[:, 0] - 0.5) > 0.1
    assert np.array_equal(np.isnan(values[far]), at[far, 0] > 0.5)


def test_a_map_of_single_faces_is_no_seam():
    obj = hole_kit.sheet()
    corners = np.array([(0, 0), (1, 0), (1, 1), (0, 1)], np.float32)
    hole_kit.set_values(obj.data, "UV", "FLOAT2", "CORNER", np.tile(corners, (len(obj.data.polygons), 1)))
    filled(obj)
    uv = hole_kit.values(obj.data, "UV")
    assert np.isfinite(uv).all()
    assert uv.min() > -0.5
    assert uv.max() < 1.5


def test_a_seam_that_ends_in_the_hole_is_led_to_its_middle():
    obj = hole_kit.sheet(hole=(5, 7))
    mesh = obj.data
    at, corner = kit.coordinates(obj), hole_kit.corner_vertices(mesh)
    middle = face_middles(obj)[:, :2] - 0.5
    # An angle around the middle of the hole: it jumps where it has gone around.
    offset = at[corner][:, :2] - 0.5
    angle = np.arctan2(offset[:, 1], offset[:, 0])
    below = np.repeat((middle[:, 1] < 0) & (middle[:, 0] < 0), 4)
    angle = np.where(below & (angle > 3.0), angle - 2 * np.pi, angle)
    hole_kit.set_values(mesh, "angle", "FLOAT", "CORNER", angle.astype(np.float32)[:, None])
    n = len(corner)
    at, corner = filled(obj)
    values = hole_kit.values(mesh, "angle")[n:].reshape(-1, 3)
    # Across the cut the angle is continued on both sides: no triangle reaches around.
    assert np.ptp(values, axis=1).max() < 5.0
    assert values.min() < -2.0
    assert values.max() > 2.0


def test_faces_take_material_and_flags_of_those_beside_them():
    obj = hole_kit.box(n=12, radius=0.5)
    mesh = obj.data
    top = face_middles(obj)[:, 2] > 0.99
    for name in "ab":
        mesh.materials.append(bpy.data.materials.new(name))
    mesh.polygons.foreach_set("material_index", top.astype(np.int32))
    mesh.polygons.foreach_set("use_smooth", top)
    hole_kit.set_values(mesh, "region", "INT", "FACE", np.where(top, 9, 4).astype(np.int32))
    n = len(mesh.polygons)
    filled(obj)
    top = face_middles(obj)[n:, 2] > 1 - 1e-2
    new = mesh.polygons[n:]
    assert [face.material_index == 1 for face in new] == top.tolist()
    assert [face.use_smooth for face in new] == top.tolist()
    assert np.array_equal(hole_kit.values(mesh, "region")[n:, 0], np.where(top, 9, 4))


def test_one_material_is_that_of_most_of_the_border():
    obj = hole_kit.box(n=12, radius=0.5, centers=((1.0, 0.0, 0.8),))
    mesh = obj.data
    for name in "ab":
        mesh.materials.append(bpy.data.materials.new(name))
    mesh.polygons.foreach_set("material_index", (face_middles(obj)[:, 2] > 0.99).astype(np.int32))
    n = len(mesh.polygons)
    filled(obj, material="MAJORITY")
    assert {face.material_index for face in mesh.polygons[n:]} == {0}


def test_new_faces_are_smooth_where_all_around_is_smooth():
    obj = hole_kit.sheet()
    obj.data.polygons.foreach_set("use_smooth", np.ones(len(obj.data.polygons), bool))
    filled(obj)
    assert all(face.use_smooth for face in obj.data.polygons)


def test_marks_go_on_along_the_ridge():
    obj = hole_kit.box(n=12, radius=0.5)
    mesh = obj.data
    at = kit.coordinates(obj)
    ridge = [all(min(at[v, 0], at[v, 2]) > 1 - 1e-6 for v in edge.vertices) for edge in mesh.edges]
    mesh.edges.foreach_set("use_edge_sharp", ridge)
    crease = mesh.attributes.new("crease_edge", "FLOAT", "EDGE")
    crease.data.foreach_set("value", 0.75 * np.array(ridge))
    n = len(mesh.edges)
    filled(obj)
    sharp = [edge.index for edge in mesh.edges if edge.use_edge_sharp]
    assert sum(index >= n for index in sharp) > 3
    ends = kit.coordinates(obj)[[mesh.edges[index].vertices[:] for index in sharp]]
    assert np.abs(ends[..., [0, 2]] - 1).max() < 0.02
    new = hole_kit.values(mesh, "crease_edge")[n:, 0]
    assert set(np.unique(new)) == {0.0, 0.75}


def test_custom_normals_keep_their_direction():
    obj = hole_kit.sheet()
    mesh = obj.data
    mesh.polygons.foreach_set("use_smooth", np.ones(len(mesh.polygons), bool))
    wanted = kit.coordinates(obj)[hole_kit.corner_vertices(mesh)] * (0.4, 0.2, 0.0) + (0.0, 0.0, 1.0)
    wanted /= np.linalg.norm(wanted, axis=1, keepdims=True)
    mesh.normals_split_custom_set(wanted.tolist())
    n = len(mesh.loops)
    at, corner = filled(obj)
    assert mesh.has_custom_normals
    normals = np.array([normal.vector for normal in mesh.corner_normals])
    assert np.abs(normals[:n] - wanted).max() < 2e-3
    going_on = at[corner] * (0.4, 0.2, 0.0) + (0.0, 0.0, 1.0)
    going_on /= np.linalg.norm(going_on, axis=1, keepdims=True)
    assert np.abs(normals[n:] - going_on[n:]).max() < 0.02
    assert not any(edge.use_edge_sharp for edge in mesh.edges)
