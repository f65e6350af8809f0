"""Diffusion curves in Blender: what is written, redrawing from edited curves, drawings, refusals."""

import re

import addon_kit as kit
import bpy
import numpy as np
import pytest
import ridgeform
from bl_ext.user_default.ridgeform.blender import mesh_io
from bl_ext.user_default.ridgeform.diffusion import curves_io, sources, svg
from bl_ext.user_default.ridgeform.framework import job
from curve_kit import (
    BLUE,
    CELLS,
    RED,
    add_plane,
    corner_colors,
    find,
    halves,
    point_values,
    split_materials,
    store_colors,
)


def test_the_curve_and_the_colors_are_those_of_the_wheel():
    obj = add_plane(lambda p: np.column_stack([p, p[:, 0] * p[:, 1], np.ones(len(p))]))
    split_materials(obj)
    assert find() == {"FINISHED"}
    triangles = mesh_io.triangles(obj.data)
    mesh = ridgeform.Mesh(kit.coordinates(obj).astype(np.float64), triangles)
    paint = np.empty(4 * mesh.n_vertices, np.float32)
    obj.data.attributes["paint"].data.foreach_get("color", paint)
    labels = np.array([obj.data.polygons[f].material_index for f in mesh_io.triangle_faces(obj.data)])
    tolerance = float(np.float32(0.01))
    expected = ridgeform.diffusion_curves(
        mesh, paint.reshape(-1, 4)[:, :3].astype(np.float64), labels=labels, color_error=tolerance
    )
    corners = np.zeros((len(obj.data.loops), 3), np.float32)
    corners[mesh_io.triangle_corners(obj.data)] = expected.corners
    assert kit.same_bits(np.ascontiguousarray(corner_colors(obj)[:, :3]), corners)
    child = curves_io.curves_of(obj)
    assert child.parent == obj
    assert child.users_collection == obj.users_collection
    assert [curve.points_length for curve in child.data.curves] == [CELLS + 1]
    (line,) = expected.polylines
    assert np.allclose([point.position for point in child.data.points], kit.coordinates(obj)[line])
    assert np.allclose(point_values(child, "left")[:-1, :3], expected.left[:, 0])
    assert np.allclose(point_values(child, "right")[-1, :3], expected.right[-1, 1])
    (entry,) = job.last_summary()
    assert entry["psnr"] == pytest.approx(expected.psnr)
    assert (entry["numbers_after"], entry["numbers_before"]) == (expected.n_numbers, 3 * mesh.n_vertices)
    assert entry["result"] == "paint_diffused"
    assert obj.data.color_attributes.active_color_name == "paint_diffused"


def test_a_second_run_replaces_the_first():
    obj = add_plane(halves)
    split_materials(obj)
    find()
    before = corner_colors(obj)
    find(rims=True)
    assert len(obj.children) == 1
    assert len(bpy.data.hair_curves) == 1
    assert len(curves_io.curves_of(obj).data.curves) == 3
    assert [a.name for a in obj.data.color_attributes] == ["paint", "paint_diffused"]
    assert np.abs(corner_colors(obj) - before).max() < 1e-5


def test_two_colors_come_back_exactly_and_jump_at_the_curve():
    obj = add_plane(halves)
    # The border runs through vertices of the blue side.
    split_materials(obj)
    find(color_error=0.0)
    (entry,) = job.last_summary()
    assert entry["psnr"] is None or entry["psnr"] > 100
    colors = corner_colors(obj).reshape(-1, 4, 4)
    right = np.array([face.center.x > 0.5 for face in obj.data.polygons])
    assert np.abs(colors[right] - BLUE).max() < 1e-5
    assert np.abs(colors[~right] - RED).max() < 1e-5


@pytest.mark.parametrize("mode", ["OBJECT", "EDIT"])
def test_redrawing_from_an_edited_curve(mode):
    obj = add_plane(halves)
    split_materials(obj)
    find()
    child = curves_io.curves_of(obj)
    green = (0.1, 0.6, 0.2, 1.0)
    n = len(child.data.points)
    child.data.attributes["left"].data.foreach_set("color", np.tile(np.float32(green), n))
    bpy.ops.object.select_all(action="DESELECT")
    child.select_set(True)
    bpy.context.view_layer.objects.active = child
    bpy.ops.object.mode_set(mode=mode)
    assert bpy.ops.ridgeform.redraw_diffusion_curves() == {"FINISHED"}
    bpy.ops.object.mode_set(mode="OBJECT")
    right = np.array([face.center.x > 0.5 for face in obj.data.polygons])
    colors = corner_colors(obj).reshape(-1, 4, 4)
    # The smaller material index lies on the left.
    assert np.abs(colors[~right] - green).max() < 1e-5
    assert np.abs(colors[right] - BLUE).max() < 1e-5


def test_setting_colors_with_blenders_own_operator():
    obj = add_plane(halves)
    split_materials(obj)
    find()
    child = curves_io.curves_of(obj)
    bpy.context.view_layer.objects.active = child
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.curves.select_all(action="SELECT")
    assert child.data.attributes.active.name == "left"
    bpy.ops.curves.attribute_set(value_color=(1.0, 1.0, 0.0, 1.0))
    bpy.ops.object.mode_set(mode="OBJECT")
    assert np.allclose(point_values(child, "left"), (1.0, 1.0, 0.0, 1.0))
    bpy.ops.ridgeform.redraw_diffusion_curves()
    assert np.allclose(corner_colors(obj)[0], (1.0, 1.0, 0.0, 1.0), atol=1e-5)


@pytest.mark.parametrize("count", [0, 2])
def test_regions_are_found_by_their_colors_and_keep_faces_whole(count):
    obj = add_plane(lambda p: np.where(np.hypot(*(p - 0.5).T)[:, None] < 0.3, RED, BLUE), cells=24)
    assert find(regions="COLORS", count=count) == {"FINISHED"}
    (entry,) = job.last_summary()
    assert entry["regions"] == 2
    assert entry["psnr"] is None or entry["psnr"] > 60
    corners = corner_colors(obj).reshape(-1, 4, 4)
    assert np.abs(corners - corners[:, :1]).max() < 0.01
    assert len(curves_io.curves_of(obj).data.curves) == 1


def test_one_region_has_a_color_point_and_loose_pieces_too():
    obj = add_plane(lambda p: np.tile(np.float32(RED), (len(p), 1)))
    find()
    child = curves_io.curves_of(obj)
    assert [curve.points_length for curve in child.data.curves] == [1]
    assert np.abs(corner_colors(obj) - RED).max() < 1e-6
    child.data.attributes["left"].data.foreach_set("color", BLUE)
    bpy.ops.ridgeform.redraw_diffusion_curves()
    assert np.abs(corner_colors(obj) - BLUE).max() < 1e-6


def test_colors_of_an_image_through_the_uv_map():
    obj = add_plane()
    split_materials(obj)
    layer = obj.data.uv_layers.new()
    for loop in obj.data.loops:
        layer.uv[loop.index].vector = obj.data.vertices[loop.vertex_index].co.xy
    image = bpy.data.images.new("Map", 64, 64, float_buffer=True)
    pixels = np.ones((64, 64, 4), np.float32)
    pixels[:, :32], pixels[:, 32:] = RED, BLUE
    image.pixels.foreach_set(pixels.ravel())
    material = obj.data.materials[0]
    material.use_nodes = True
    node = material.node_tree.nodes.new("ShaderNodeTexImage")
    node.image = image
    assert find(source="IMAGE") == {"FINISHED"}
    colors = corner_colors(obj, "Map_diffused").reshape(-1, 4, 4)
    inner = np.array([0.1 < face.center.x < 0.4 for face in obj.data.polygons])
    assert np.abs(colors[inner] - RED).max() < 0.02


def test_sampling_is_bilinear_and_repeats():
    pixels = np.zeros((2, 4, 4), np.float32)
    pixels[0, 1], pixels[1, 1] = 1.0, 3.0
    uv = np.array([[0.375, 0.25], [0.375, 0.5], [0.25, 0.25], [1.375, -0.75]])
    assert np.allclose(sources.sampled(pixels, uv)[:, 0], [1.0, 2.0, 0.5, 1.0])


def test_seams_of_split_vertices_are_closed():
    obj = add_plane(halves)
    split_materials(obj)
    find()
    whole = corner_colors(obj)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.mesh.edge_split()
    bpy.ops.object.mode_set(mode="OBJECT")
    assert len(obj.data.vertices) == 4 * CELLS**2
    find(attribute="paint")
    assert np.abs(corner_colors(obj) - whole).max() < 1e-5


def test_svg_of_a_flat_mesh(tmp_path):
    obj = add_plane(halves)
    split_materials(obj)
    find()
    path = tmp_path / "curves.svg"
    assert bpy.ops.ridgeform.export_diffusion_svg(filepath=str(path), fill=True) == {"FINISHED"}
    text = path.read_text()
    assert text.count('<g id="curve') == 1
    red, blue = (svg._hex(np.array([color]))[0] for color in (RED, BLUE))
    left = re.search(r'class="left" points="([^"]+)" fill="([^"]+)"', text)
    right = re.search(r'class="right" points="([^"]+)" fill="([^"]+)"', text)
    assert (left[2], right[2]) == (red, blue)
    middle = [np.mean([float(pair.split(",")[0]) for pair in side[1].split()]) for side in (left, right)]
    assert middle[0] < 508 < middle[1]
    assert text.count("<polygon points=") == len(obj.data.polygons)


def test_refusals(tmp_path):
    bpy.context.preferences.edit.use_global_undo = False
    obj = add_plane()
    with pytest.raises(RuntimeError, match="has no color attribute"):
        find()
    with pytest.raises(RuntimeError, match="has no material with nodes"):
        find(source="IMAGE")
    store_colors(obj, halves(np.zeros((len(obj.data.vertices), 2))))
    with pytest.raises(RuntimeError, match='has no integer attribute "zone"'):
        find(regions="ATTRIBUTE", region_attribute="zone")
    assert not bpy.ops.ridgeform.redraw_diffusion_curves.poll()
    find()
    child = curves_io.curves_of(obj)
    child.data.attributes.remove(child.data.attributes["left"])
    obj.data.attributes.remove(obj.data.attributes["paint"])
    with pytest.raises(RuntimeError, match='has no colors, and "paint"'):
        bpy.ops.ridgeform.redraw_diffusion_curves()
    ball = kit.bumpy_box()
    store_colors(ball, np.tile(np.float32(RED), (len(ball.data.vertices), 1)))
    bpy.ops.object.select_all(action="DESELECT")
    ball.select_set(True)
    bpy.context.view_layer.objects.active = ball
    find()
    with pytest.raises(RuntimeError, match="is not flat"):
        bpy.ops.ridgeform.export_diffusion_svg(filepath=str(tmp_path / "ball.svg"))
    assert not list(tmp_path.iterdir())


def test_undo_takes_everything_back():
    bpy.context.preferences.edit.use_global_undo = True
    obj = add_plane(halves)
    split_materials(obj)
    bpy.ops.ed.undo_push(message="before")
    bpy.ops.ridgeform.diffusion_curves("EXEC_DEFAULT", True, regions="MATERIALS")
    bpy.ops.ed.undo()
    obj = bpy.data.objects["Plane"]
    assert not obj.children
    assert "paint_diffused" not in obj.data.attributes
    assert len(bpy.data.hair_curves) == 0
    bpy.ops.ed.redo()
    assert len(curves_io.curves_of(bpy.data.objects["Plane"]).data.curves) == 1
