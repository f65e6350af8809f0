"""Facet and Finish: Facets: what meshes become, and what stays of them."""

import addon_kit as kit
import bpy
import numpy as np
import pytest
import ridgeform
from batch_kit import boxes, run
from bl_ext.user_default.ridgeform.blender import mesh_io
from bl_ext.user_default.ridgeform.framework import faceting, files, job
from facet_kit import ball, facet, is_closed, layered_box, off_planes, read_all


def test_a_subdivided_cube_becomes_six_quads():
    obj = kit.bumpy_box(noise=0.0)
    facet()
    mesh = obj.data
    assert sorted(len(face.vertices) for face in mesh.polygons) == [4] * 6
    assert len(mesh.vertices) == 8 and is_closed(mesh)
    np.testing.assert_allclose(np.abs(kit.coordinates(obj)), 1.0, atol=1e-6)
    assert all(edge.use_edge_sharp for edge in mesh.edges) and len(mesh.edges) == 12


@pytest.mark.parametrize("topology", ["POLYGONS", "TRIANGLES"])
@pytest.mark.parametrize("make", [ball, lambda: ball("ico"), kit.bumpy_box, kit.ngon_prism])
def test_facets_are_flat_and_closed_and_as_many_as_wanted(make, topology):
    obj = make()
    (entry,) = facet(mode="COUNT", facets=30, topology=topology)
    mesh = obj.data
    assert entry["facets"] == 30 and entry["faces"] == len(mesh.polygons)
    assert is_closed(mesh) and not mesh.validate()
    assert off_planes(mesh) < 1e-5
    sizes = {len(face.vertices) for face in mesh.polygons}
    assert sizes == {3} if topology == "TRIANGLES" else len(mesh.polygons) == 30


def test_the_mesh_is_what_the_package_gives():
    obj = kit.bumpy_box()
    before = ridgeform.Mesh(kit.coordinates(obj), mesh_io.triangles(obj.data))
    facet(mode="COUNT", facets=20)
    found = ridgeform.facet(before, facets=20)
    sizes = [len(face.vertices) for face in obj.data.polygons]
    assert sizes == np.diff(found.polygon_starts).tolist()
    corners = kit.coordinates(obj)[mesh_io.corner_vertices(obj.data)]
    np.testing.assert_array_equal(corners, found.vertices[found.polygon_vertices].astype(np.float32))


def test_planes_look_flat_at_once_and_only_if_wanted():
    obj = ball()
    facet(mode="COUNT", facets=40)
    mesh = obj.data
    assert not any(face.use_smooth for face in mesh.polygons)
    assert all(edge.use_edge_sharp for edge in mesh.edges) and not any(edge.use_seam for edge in mesh.edges)
    kit.empty_scene()
    obj = ball()
    facet(mode="COUNT", facets=40, marks=set(), mark_seams=True)
    assert all(face.use_smooth for face in obj.data.polygons)
    assert all(edge.use_seam for edge in obj.data.edges)
    assert not any(edge.use_edge_sharp for edge in obj.data.edges)


def test_in_triangles_only_borders_of_facets_are_marked():
    obj = kit.bumpy_box(noise=0.0)
    facet(topology="TRIANGLES")
    assert len(obj.data.polygons) == 12
    assert sum(edge.use_edge_sharp for edge in obj.data.edges) == 12


def half_ball():
    """Half a ball of quads under a Mirror modifier."""
    obj = ball()
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.mesh.bisect(plane_co=(0, 0, 0), plane_no=(1, 0, 0), clear_inner=True)
    bpy.ops.object.mode_set(mode="OBJECT")
    obj.modifiers.new("Mirror", "MIRROR")
    return obj


def test_a_mirrored_half_stays_on_its_plane_and_closes():
    obj = half_ball()
    mesh = obj.data
    facet(mode="COUNT", facets=25)
    ends = mesh_io.edges(mesh)[np.bincount(mesh_io.corner_edges(mesh)) == 1]
    assert len(ends) and (kit.coordinates(obj)[ends, 0] == 0.0).all()
    assert off_planes(mesh) < 1e-5
    assert is_closed(obj.evaluated_get(bpy.context.evaluated_depsgraph_get()).data)


def test_several_objects_and_linked_ones():
    one, two = kit.bumpy_box("One"), kit.ngon_prism("Two")
    one.select_set(True)
    entries = facet(mode="COUNT", facets=10)
    assert {entry["name"]: entry["facets"] for entry in entries} == {"One": 10, "Two": 10}
    assert is_closed(one.data) and is_closed(two.data)


def test_shape_keys_are_refused_and_stay():
    obj = kit.bumpy_box()
    obj.shape_key_add(name="Basis")
    before = read_all(obj.data)
    with pytest.raises(RuntimeError, match="has shape keys"):
        bpy.ops.ridgeform.facet()
    assert read_all(obj.data) == before


@pytest.mark.parametrize("what", ["nan", "empty mask", "no group", "flat"])
def test_bad_input_costs_nothing(what):
    obj = kit.bumpy_box()
    settings = {}
    if what == "nan":
        obj.data.vertices[5].co.x = np.nan
    elif what == "flat":
        kit.set_coordinates(obj, np.zeros((len(obj.data.vertices), 3)))
    else:
        if what == "empty mask":
            obj.vertex_groups.new(name="Mask")
        settings["strength_group"] = "Mask"
    before = [repr(row) for row in read_all(obj.data).items()]
    with pytest.raises(RuntimeError, match=r"Error: "):
        bpy.ops.ridgeform.facet(**settings)
    assert [repr(row) for row in read_all(obj.data).items()] == before


def test_undo_brings_everything_back_in_one_step():
    obj = layered_box()
    bpy.ops.ed.undo_push(message="Before")
    before, name = read_all(obj.data), obj.name
    facet(mode="COUNT", facets=8)
    bpy.ops.ed.undo_push(message="Facet")
    assert len(obj.data.polygons) < 20
    bpy.ops.ed.undo()
    assert read_all(bpy.data.objects[name].data) == before


def test_painted_ridges_attract_borders():
    (x, y) = np.meshgrid(np.linspace(-1, 1, 33), np.linspace(-1, 1, 33), indexing="ij")
    points = np.stack([x.ravel(), y.ravel(), (0.15 * x**2).ravel()], axis=1)
    a = (33 * np.arange(32)[:, None] + np.arange(32)).ravel()
    faces = np.stack([a, a + 33, a + 34, a + 1], axis=1)
    seen = []
    for settings in ({}, {"ridge_group": "Line"}):
        kit.empty_scene()
        obj = kit.add_object("Sheet", points, faces.tolist())
        group = obj.vertex_groups.new(name="Line")
        group.add(np.flatnonzero(np.abs(points[:, 0] - 0.375) < 1e-9).tolist(), 1.0, "REPLACE")
        facet(mode="COUNT", facets=2, **settings)
        edge = next(edge for edge in obj.data.edges if edge.use_edge_sharp)
        seen.append(abs(np.mean([obj.data.vertices[v].co.x for v in edge.vertices]) - 0.375))
    assert seen[1] < seen[0]


def test_finish_facets_makes_facets_of_the_flow():
    obj = ball("ico")
    given = {"steps": 5, "finish": "FACETS"}
    assert bpy.ops.ridgeform.stylize(facets=40, use_facets=True, **given) == {"FINISHED"}
    (entry,) = job.last_summary()
    assert entry["facets"] == 40 and len(obj.data.polygons) == 40
    assert is_closed(obj.data) and off_planes(obj.data) < 1e-5
    assert all(edge.use_edge_sharp for edge in obj.data.edges)


def test_finish_facets_is_the_flow_and_then_facets():
    one, two = kit.bumpy_box("One", cuts=6), None
    given = {"steps": 4, "strength": 0.4}
    bpy.ops.ridgeform.stylize(finish="FACETS", use_facets=True, facets=30, **given)
    made = kit.coordinates(one)
    kit.empty_scene()
    two = kit.bumpy_box("Two", cuts=6)
    bpy.ops.ridgeform.stylize(marks=set(), **given)
    facet(mode="COUNT", facets=30)
    np.testing.assert_array_equal(made, kit.coordinates(two))


def test_finish_facets_says_why_not():
    obj = kit.bumpy_box()
    n = len(obj.data.polygons)
    bpy.ops.ridgeform.stylize(steps=1, finish="FACETS", output="SHAPE_KEY")
    (entry,) = job.last_summary()
    assert any("facets were not made, because" in note for note in entry["warnings"])
    assert len(obj.data.polygons) == n


def test_files_go_in_and_come_out_as_facets(tmp_path, capfd):
    paths = [*boxes(tmp_path / "in", 2, ".obj"), tmp_path / "in" / "broken.obj"]
    paths[-1].write_text("nothing")
    code, records = run(capfd, "facet", *paths, "-o", tmp_path / "out", "--facets", "12")
    assert code == 1 and records["broken.obj"]["error"] is not None
    for path in paths[:2]:
        (entry,) = records[path.name]["meshes"]
        assert entry["tool"] == "facet" and entry["facets"] == entry["faces"] == 12
        assert 0.0 < entry["rms"] < 0.1 and entry["error"] is None
        kit.empty_scene()
        files.read_file(tmp_path / "out" / path.name)
        (obj,) = bpy.data.objects
        assert len(obj.data.polygons) == 12 and is_closed(obj.data)


def test_stylize_has_facets_on_the_command_line(tmp_path, capfd):
    paths = boxes(tmp_path / "in", 1, ".obj")
    code, records = run(capfd, "stylize", *paths, "-o", tmp_path / "out", "--steps", "2", "--facets", "10")
    assert code == 0
    assert records["box0.obj"]["meshes"][0]["facets"] == records["box0.obj"]["faces"] == 10


def test_other_numbers_start_from_what_was_found():
    faceting.forget()
    made = {}
    for count in (10, 20, 10):
        kit.empty_scene()
        obj = kit.bumpy_box()
        facet(mode="COUNT", facets=count)
        again = kit.coordinates(obj).tobytes()
        assert made.setdefault(count, again) == again
        assert len(faceting._known) == 1
    kit.empty_scene()
    obj = kit.bumpy_box()
    faceting.forget()
    facet(mode="COUNT", facets=20)
    assert kit.coordinates(obj).tobytes() == made[20]


def test_an_error_takes_as_many_facets_as_it_needs():
    counts = []
    for error in (2.0, 0.5, 0.1):
        kit.empty_scene()
        ball("ico")
        (entry,) = facet(mode="ERROR", error=error)
        assert entry["rms"] <= 0.01 * error
        counts.append(entry["facets"])
    assert counts == sorted(set(counts))


def test_split_seams_of_a_file_stay_closed(tmp_path):
    path = tmp_path / "ball.ply"
    ball("ico")
    bpy.ops.object.shade_flat()
    files.write_file(path)
    kit.empty_scene()
    files.read_file(path)
    (obj,) = bpy.data.objects
    bpy.context.view_layer.objects.active = obj
    obj.select_set(True)
    facet(mode="COUNT", facets=20)
    assert is_closed(obj.data) and len(obj.data.polygons) == 20


def test_a_mirrored_half_gets_facets_after_the_flow():
    obj = half_ball()
    bpy.ops.ridgeform.stylize(steps=3, finish="FACETS", use_facets=True, facets=25)
    ends = mesh_io.edges(obj.data)[np.bincount(mesh_io.corner_edges(obj.data)) == 1]
    assert len(ends) and (kit.coordinates(obj)[ends, 0] == 0.0).all()
    assert is_closed(obj.evaluated_get(bpy.context.evaluated_depsgraph_get()).data)
