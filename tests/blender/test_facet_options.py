"""Facet with the mesh's own faces kept, in quads, and with the volume kept."""

import addon_kit as kit
import bpy
import numpy as np
import pytest
import ridgeform
from bl_ext.user_default.ridgeform.blender import mesh_io
from bl_ext.user_default.ridgeform.framework.volume import volume_and_centroid
from facet_kit import ball, facet, is_closed, layered_box, off_planes, read_all
from test_facets import half_ball


def volume(obj):
    return volume_and_centroid(kit.coordinates(obj), mesh_io.triangles(obj.data))[0]


def faces_of(mesh):
    return [tuple(face.vertices) for face in mesh.polygons]


def test_quads_are_made_where_facets_have_four_corners():
    obj = kit.bumpy_box(noise=0.0)
    facet(topology="QUADS")
    assert [len(face.vertices) for face in obj.data.polygons] == [4] * 6
    kit.empty_scene()
    obj = ball()
    (entry,) = facet(mode="COUNT", facets=40, topology="QUADS")
    sizes = np.array([len(face.vertices) for face in obj.data.polygons])
    assert set(sizes) == {3, 4} and is_closed(obj.data) and off_planes(obj.data) < 1e-5
    assert entry["facets"] == 40
    kit.empty_scene()
    other = ball()
    facet(mode="COUNT", facets=40)
    whole = np.array([len(face.vertices) for face in other.data.polygons])
    assert (sizes == 4).sum() == (whole == 4).sum() > 0
    assert (sizes == 3).sum() == (whole[whole != 4] - 2).sum()


@pytest.mark.parametrize("make", [ball, lambda: ball("ico"), kit.bumpy_box, layered_box])
def test_vertices_and_faces_are_kept_on_facets(make):
    obj = make()
    mesh = obj.data
    before, count = kit.coordinates(obj), len(mesh.polygons)
    (entry,) = facet(mode="COUNT", facets=30, topology="KEPT")
    assert entry["facets"] == 30 and entry["vertices"] == len(mesh.vertices) == len(before)
    assert len(mesh.polygons) >= count and is_closed(mesh)
    marked = np.array([edge.use_edge_sharp for edge in mesh.edges])
    ends = mesh_io.edges(mesh)
    assert marked.any() and not marked.all()
    # What is between marked edges is flat: faces on both sides of the others agree.
    normals = np.array([face.normal for face in mesh.polygons])
    sides = [[] for _ in ends]
    for face in mesh.polygons:
        for key in face.loop_indices:
            sides[mesh.loops[key].edge_index].append(face.index)
    flat = [abs(normals[a] @ normals[b]) for edge, (a, b) in enumerate(sides) if not marked[edge]]
    assert np.mean(np.array(flat) > 1 - 1e-4) > 0.97


def test_what_lies_on_the_mesh_is_kept_with_its_faces():
    obj = layered_box()
    mesh = obj.data
    before, faces = read_all(mesh), faces_of(mesh)
    weights = [[(item.group, item.weight) for item in vertex.groups] for vertex in mesh.vertices]
    facet(topology="KEPT")
    assert faces_of(mesh) == faces
    after = read_all(mesh)
    for name in ("UVMap", "Paint", "height", "side", "material_index"):
        assert after[name] == before[name], name
    assert [[(item.group, item.weight) for item in vertex.groups] for vertex in mesh.vertices] == weights


def test_kept_coordinates_are_what_the_package_gives():
    obj = ball("ico")
    before = ridgeform.Mesh(kit.coordinates(obj), mesh_io.triangles(obj.data))
    facet(mode="COUNT", facets=20, topology="KEPT", keep_volume=True)
    found = ridgeform.facet(before, facets=20, keep_triangles=True, keep_volume=True)
    np.testing.assert_array_equal(kit.coordinates(obj), found.kept_vertices.astype(np.float32))
    rows = before.faces.ravel()[found.kept_corners]
    # Blender begins a face with any of its corners.
    np.testing.assert_array_equal(np.sort(mesh_io.triangles(obj.data), axis=1), np.sort(rows, axis=1))


@pytest.mark.parametrize("has_keys", [False, True])
def test_the_result_can_be_a_shape_key(has_keys):
    obj = ball("ico")
    if has_keys:
        obj.shape_key_add(name="Basis")
        obj.shape_key_add(name="Other").data[3].co.x += 0.5
        obj.active_shape_key_index = 0
    before, faces = kit.coordinates(obj), faces_of(obj.data)
    facet(mode="COUNT", facets=20, topology="KEPT", shape_key=not has_keys)
    keys = obj.data.shape_keys.key_blocks
    assert [key.name for key in keys] == (["Basis", "Other", "Facets"] if has_keys else ["Basis", "Facets"])
    assert keys["Facets"].value == 1.0 and obj.active_shape_key_index == len(keys) - 1
    basis = mesh_io.key_coordinates(obj.data)["Basis"]
    np.testing.assert_array_equal(basis, before)
    assert np.abs(mesh_io.key_coordinates(obj.data)["Facets"] - before).max() > 0.01
    assert faces_of(obj.data) == faces
    assert not any(edge.use_edge_sharp for edge in obj.data.edges)


def test_other_faces_are_refused_on_shape_keys_with_a_way_out():
    obj = kit.bumpy_box()
    obj.shape_key_add(name="Basis")
    with pytest.raises(RuntimeError, match="choose the topology Kept"):
        bpy.ops.ridgeform.facet()


def test_a_mirrored_half_keeps_its_seam_on_the_plane():
    obj = half_ball()
    border = kit.coordinates(obj)[:, 0] == 0.0
    facet(mode="COUNT", facets=25, topology="KEPT")
    assert border.any() and (kit.coordinates(obj)[border, 0] == 0.0).all()
    assert is_closed(obj.evaluated_get(bpy.context.evaluated_depsgraph_get()).data)


def test_only_selected_faces_change():
    obj = layered_box()
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="DESELECT")
    bpy.ops.object.mode_set(mode="OBJECT")
    for face in obj.data.polygons:
        face.select = face.center.x > 0
    held = np.unique([v for face in obj.data.polygons if not face.select for v in face.vertices])
    bpy.ops.object.mode_set(mode="EDIT")
    before = kit.coordinates(obj)
    facet(mode="COUNT", facets=8, topology="KEPT")
    assert obj.mode == "EDIT"
    bpy.ops.object.mode_set(mode="OBJECT")
    after = kit.coordinates(obj)
    np.testing.assert_array_equal(after[held], before[held])
    assert (after != before).any()


@pytest.mark.parametrize("shape_key", [False, True])
def test_undo_brings_everything_back_in_one_step(shape_key):
    obj = layered_box()
    bpy.ops.ed.undo_push(message="Before")
    before, name = read_all(obj.data), obj.name
    facet(mode="COUNT", facets=8, topology="KEPT", shape_key=shape_key)
    bpy.ops.ed.undo_push(message="Facet")
    bpy.ops.ed.undo()
    assert read_all(bpy.data.objects[name].data) == before
    assert bpy.data.objects[name].data.shape_keys is None


@pytest.mark.parametrize("topology", ["POLYGONS", "KEPT"])
def test_the_volume_is_kept(topology):
    obj = ball("ico")
    before = volume(obj)
    facet(mode="COUNT", facets=20, topology=topology, keep_volume=True)
    assert volume(obj) == pytest.approx(before, rel=1e-5)


def test_a_volume_is_refused_on_an_open_mesh():
    half_ball()
    with pytest.raises(RuntimeError, match="encloses no volume to keep"):
        bpy.ops.ridgeform.facet(keep_volume=True)


def is_symmetric(obj):
    """Whether the mesh is its own image across X, to what it stores."""
    places = np.round(kit.coordinates(obj).astype(float), 6) + 0.0
    faces = {frozenset(map(tuple, places[list(face)])) for face in faces_of(obj.data)}
    return faces == {frozenset((-x + 0.0, y, z) for x, y, z in face) for face in faces}


@pytest.mark.parametrize("topology", ["POLYGONS", "QUADS"])
@pytest.mark.parametrize("symmetric", ["X", "AUTO"])
def test_a_monkey_gets_symmetric_facets(topology, symmetric):
    bpy.ops.mesh.primitive_monkey_add()
    obj = bpy.context.object
    (entry,) = facet(mode="COUNT", facets=60, symmetric=symmetric, topology=topology)
    assert abs(entry["facets"] - 60) <= 2
    assert off_planes(obj.data) < 1e-5 and not obj.data.validate()
    if topology == "POLYGONS":
        assert is_symmetric(obj)


def test_symmetric_facets_are_refused_where_they_cannot_be():
    obj = kit.bumpy_box()
    before = read_all(obj.data)
    with pytest.raises(RuntimeError, match="needs a mesh that is symmetric"):
        bpy.ops.ridgeform.facet(symmetric="AUTO")
    with pytest.raises(RuntimeError, match="choose one of both"):
        bpy.ops.ridgeform.facet(symmetric="X", keep_volume=True)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="DESELECT")
    bpy.ops.object.mode_set(mode="OBJECT")
    obj.data.polygons[0].select = True
    bpy.ops.object.mode_set(mode="EDIT")
    with pytest.raises(RuntimeError, match="Facets of a part"):
        bpy.ops.ridgeform.facet(symmetric="X")
    bpy.ops.object.mode_set(mode="OBJECT")
    assert {name: before[name] for name in ("position", "UVMap")} == {
        name: read_all(obj.data)[name] for name in ("position", "UVMap")
    }
