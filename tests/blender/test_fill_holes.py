"""The operator `ridgeform.fill_holes`: which holes it fills in which mode, and what it leaves alone."""

import addon_kit as kit
import bmesh
import bpy
import hole_kit
import numpy as np
import pytest
from bl_ext.user_default.ridgeform.blender import mesh_io
from bl_ext.user_default.ridgeform.blender.refusals import RefusedError
from bl_ext.user_default.ridgeform.framework import job
from bl_ext.user_default.ridgeform.framework.settings import defaults_of
from bl_ext.user_default.ridgeform.holes.settings import HoleSettings
from bl_ext.user_default.ridgeform.holes.tool import HoleFilling

FRONT, BACK = (1.0, 0.0, 1.0), (-1.0, 0.0, -1.0)


def refusal(obj, **changes):
    with pytest.raises(RefusedError) as refused:
        HoleFilling([obj], defaults_of(HoleSettings, **changes))
    return str(refused.value)


def boundary_edges(obj):
    mesh = obj.data
    used = np.empty(len(mesh.loops), np.int32)
    mesh.loops.foreach_get("edge_index", used)
    return int((np.bincount(used, minlength=len(mesh.edges)) == 1).sum())


@pytest.mark.parametrize("make", [hole_kit.sheet, hole_kit.box])
def test_operator_gives_what_the_wheel_gives(make):
    obj = make()
    n, n_faces = len(obj.data.vertices), len(obj.data.polygons)
    n_triangles = len(mesh_io.triangles(obj.data))
    expected = hole_kit.wheel_result(obj)
    assert bpy.ops.ridgeform.fill_holes() == {"FINISHED"}
    assert kit.same_bits(kit.coordinates(obj)[n:], expected.vertices[n:].astype(np.float32))
    new = [tuple(face.vertices) for face in obj.data.polygons[n_faces:]]
    assert new == [tuple(face) for face in expected.faces[n_triangles:].tolist()]
    assert not obj.data.validate()


def test_what_was_there_stays_to_the_bit():
    obj = hole_kit.box()
    before = hole_kit.state(obj)
    n, n_edges, n_faces = (len(kind) for kind in (obj.data.vertices, obj.data.edges, obj.data.polygons))
    bpy.ops.ridgeform.fill_holes()
    after = hole_kit.state(obj)
    assert after["faces"][:n_faces] == before["faces"]
    assert after["edges"][:n_edges] == before["edges"]
    assert after["positions"][: 12 * n] == before["positions"]
    assert {len(face) for face in after["faces"][:n_faces]} == {4}
    assert boundary_edges(obj) == 0


def test_the_edge_of_a_box_comes_back():
    obj = hole_kit.box(n=12, radius=0.5)
    n = len(obj.data.vertices)
    bpy.ops.ridgeform.fill_holes()
    new = kit.coordinates(obj)[n:]
    off = np.minimum(np.abs(new[:, 0] - 1), np.abs(new[:, 2] - 1))
    assert off.max() < 0.02
    (entry,) = job.last_summary()
    assert entry["ridge_edges"] > 0


def test_smooth_makes_no_ridges():
    obj = hole_kit.box(n=12, radius=0.5)
    n = len(obj.data.vertices)
    bpy.ops.ridgeform.fill_holes(shape="SMOOTH", marks={"SHARP"})
    (entry,) = job.last_summary()
    assert (entry["ridge_edges"], entry["steps"]) == (0, 0)
    new = kit.coordinates(obj)[n:]
    assert np.minimum(1 - new[:, 0], 1 - new[:, 2]).max() > 0.05
    assert not any(edge.use_edge_sharp for edge in obj.data.edges)


def test_several_holes_and_objects_and_the_report():
    boxes = [hole_kit.box(name=name, centers=(FRONT, BACK)) for name in "AB"]
    for obj in boxes:
        obj.select_set(True)
    bpy.ops.ridgeform.fill_holes()
    assert [boundary_edges(obj) for obj in boxes] == [0, 0]
    assert {entry["name"]: entry["holes"] for entry in job.last_summary()} == {"A": 2, "B": 2}
    for obj in boxes:
        patch = hole_kit.values(obj.data, "ridgeform_patch")[:, 0]
        assert set(patch) == {0, 1, 2}


def test_the_outer_border_of_a_sheet_is_left_open():
    obj = hole_kit.sheet()
    bpy.ops.ridgeform.fill_holes()
    assert boundary_edges(obj) == 48
    (entry,) = job.last_summary()
    assert entry["warnings"] == ["1 hole skipped (it is the outer border of an open sheet)"]


def test_a_sheet_without_holes_is_refused_unless_its_border_is_asked_for():
    obj = kit.add_object("Bowl", *bowl())
    assert "outer border of an open sheet" in refusal(obj)
    bpy.ops.ridgeform.fill_holes(outer=True)
    assert boundary_edges(obj) == 0


def bowl(n=8):
    at = np.linspace(-1, 1, n + 1)
    vertices = [(x, y, 0.3 * (x * x + y * y)) for x in at for y in at]
    corners = [x * (n + 1) + y for x in range(n) for y in range(n)]
    return vertices, [(a, a + n + 1, a + n + 2, a + 1) for a in corners]


def test_larger_holes_are_skipped_and_named():
    obj = hole_kit.sheet()
    assert "it has more than 15 edges" in refusal(obj, max_edges=15)
    assert bpy.ops.ridgeform.fill_holes(max_edges=16) == {"FINISHED"}


def test_a_closed_mesh_has_no_holes():
    assert refusal(kit.bumpy_box()) == '"Box" has no holes'
    assert bpy.ops.ridgeform.fill_holes() == {"CANCELLED"}
    (entry,) = job.last_summary()
    assert (entry["name"], entry["holes"], entry["faces_added"]) == ("Box", 0, 0)
    assert job.shown_summary() == []


def test_edit_mode_fills_the_picked_hole_and_selects_the_patch():
    obj = hole_kit.box(centers=(FRONT, BACK))
    n_faces = len(obj.data.polygons)
    hole = hole_kit.around_holes(obj)[1].vertices.tolist()
    hole_kit.pick(obj, hole[:2])
    assert bpy.ops.ridgeform.fill_holes() == {"FINISHED"}
    assert obj.mode == "EDIT"
    bpy.ops.object.mode_set(mode="OBJECT")
    new = set().union(*(face.vertices for face in obj.data.polygons[n_faces:]))
    assert set(hole) <= new
    assert job.last_summary()[0]["holes"] == 1
    assert boundary_edges(obj) > 0
    assert [face.select for face in obj.data.polygons] == [
        index >= n_faces for index in range(len(obj.data.polygons))
    ]
    assert {v.index for v in obj.data.vertices if v.select} == new


def test_several_objects_in_edit_mode():
    boxes = [hole_kit.box(name=name, centers=(FRONT, BACK)) for name in "AB"]
    picked = [hole_kit.around_holes(obj)[0].vertices.tolist()[:2] for obj in boxes]
    for obj in boxes:
        obj.select_set(True)
    hole_kit.pick(boxes[0], picked[0])
    bpy.ops.object.mode_set(mode="OBJECT")
    hole_kit.pick(boxes[1], picked[1])
    assert bpy.ops.ridgeform.fill_holes() == {"FINISHED"}
    bpy.ops.object.mode_set(mode="OBJECT")
    assert {entry["name"]: entry["holes"] for entry in job.last_summary()} == {"A": 1, "B": 1}


def test_edit_mode_without_an_edge_of_a_hole_is_refused():
    obj = hole_kit.box()
    rim = set(hole_kit.around_holes(obj)[0].vertices.tolist())
    edge = next(tuple(edge.vertices) for edge in obj.data.edges if not rim & set(edge.vertices))
    hole_kit.pick(obj, edge)
    with pytest.raises(RuntimeError, match="No edge around a hole"):
        bpy.ops.ridgeform.fill_holes()
    bpy.ops.object.mode_set(mode="OBJECT")


@pytest.mark.parametrize("both", [False, True])
def test_an_outer_border_picked_alone_is_filled(both):
    obj = hole_kit.sheet()
    inner, outer = (hole.vertices.tolist() for hole in hole_kit.around_holes(obj))
    hole_kit.pick(obj, outer[:2], *([inner[:2]] if both else []))
    bpy.ops.ridgeform.fill_holes()
    bpy.ops.object.mode_set(mode="OBJECT")
    assert boundary_edges(obj) == (48 if both else 16)


def test_ridges_are_marked_on_request():
    obj = hole_kit.box()
    bpy.ops.ridgeform.fill_holes(marks={"SHARP", "CREASE"})
    marked = hole_kit.values(obj.data, "sharp_edge")[:, 0]
    ends = kit.coordinates(obj)[mesh_io.edges(obj.data)[marked]]
    assert marked.any()
    assert np.abs(ends[..., [0, 2]] - 1).max() < 0.02
    assert np.array_equal(hole_kit.values(obj.data, "crease_edge")[:, 0] == 1, marked)


def test_a_second_run_counts_patches_on():
    obj = hole_kit.box(centers=(FRONT, BACK))
    first = hole_kit.around_holes(obj)[0].vertices.tolist()
    hole_kit.pick(obj, first[:2])
    bpy.ops.ridgeform.fill_holes()
    bpy.ops.object.mode_set(mode="OBJECT")
    bpy.ops.ridgeform.fill_holes()
    assert set(hole_kit.values(obj.data, "ridgeform_patch")[:, 0]) == {0, 1, 2}


def test_split_seams_are_no_holes():
    obj = hole_kit.box()
    mesh = obj.data
    rim = len(hole_kit.around_holes(obj)[0].vertices)
    middle = np.abs(kit.coordinates(obj)[:, 1]) < 1e-6
    split_along = [edge.index for edge in mesh.edges if middle[list(edge.vertices)].all()]
    split(obj, split_along)
    assert len(mesh.vertices) > len(set(map(tuple, kit.coordinates(obj).tolist())))
    before = kit.coordinates(obj)
    assert bpy.ops.ridgeform.fill_holes() == {"FINISHED"}
    (entry,) = job.last_summary()
    assert entry["holes"] == 1
    assert kit.same_bits(kit.coordinates(obj)[: len(before)], before)
    patch = hole_kit.values(mesh, "ridgeform_patch")[:, 0]
    # Every edge around the hole has its patch: it borders on the very vertices of the mesh's faces.
    used = {}
    for face in mesh.polygons:
        for edge in face.edge_keys:
            used.setdefault(edge, []).append(patch[face.index])
    assert sum(sorted(faces) == [0, 1] for faces in used.values()) == rim


def split(obj, edges):
    """Split a mesh along edges."""
    with kit.edited(obj) as mesh:
        bmesh.ops.split_edges(mesh, edges=[mesh.edges[index] for index in edges])


def test_linked_meshes_are_refused(tmp_path):
    obj = hole_kit.box()
    path = tmp_path / "box.blend"
    bpy.data.libraries.write(str(path), {obj.data})
    kit.empty_scene()
    with bpy.data.libraries.load(str(path), link=True) as (source, target):
        target.meshes = source.meshes
    kit.link(bpy.data.objects.new("Linked", target.meshes[0]))
    assert not bpy.ops.ridgeform.fill_holes.poll()
