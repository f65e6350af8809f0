"""Giving diffusion curves other colors, the mesh drawn anew at once."""

import addon_kit as kit
import bpy
import numpy as np
import pytest
from bl_ext.user_default.ridgeform.diffusion import curves_io
from curve_kit import BLUE, RED, add_plane, corner_colors, find, halves, point_values, split_materials

GREEN = (0.1, 0.6, 0.2, 1.0)


def drawn():
    """A plane of two colors, and its curves, which are active."""
    obj = add_plane(halves)
    split_materials(obj)
    find()
    child = curves_io.curves_of(obj)
    bpy.ops.object.select_all(action="DESELECT")
    child.select_set(True)
    bpy.context.view_layer.objects.active = child
    return obj, child


def sides_of(obj):
    """The colors (f, 4, 4) of the corners of faces on the left and on the right."""
    right = np.array([face.center.x > 0.5 for face in obj.data.polygons])
    colors = corner_colors(obj).reshape(-1, 4, 4)
    return colors[~right], colors[right]


@pytest.mark.parametrize("mode", ["OBJECT", "EDIT"])
@pytest.mark.parametrize(
    ("sides", "left", "right"), [("LEFT", GREEN, BLUE), ("RIGHT", RED, GREEN), ("BOTH", GREEN, GREEN)]
)
def test_a_side_takes_the_color_and_the_mesh_is_drawn_anew(mode, sides, left, right):
    obj, child = drawn()
    if mode == "EDIT":
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.ops.curves.select_all(action="SELECT")
    assert bpy.ops.ridgeform.color_diffusion_curves(color=GREEN, sides=sides) == {"FINISHED"}
    bpy.ops.object.mode_set(mode="OBJECT")
    on_left, on_right = sides_of(obj)
    assert np.abs(on_left - left).max() < 1e-5
    assert np.abs(on_right - right).max() < 1e-5
    assert np.allclose(point_values(child, "left"), left)


def test_only_the_selected_points_take_it():
    _, child = drawn()
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.curves.select_all(action="DESELECT")
    with pytest.raises(RuntimeError, match="is selected"):
        bpy.ops.ridgeform.color_diffusion_curves(color=GREEN)
    bpy.ops.object.mode_set(mode="OBJECT")
    n = len(child.data.points)
    attribute = child.data.attributes[".selection"]
    assert attribute.domain == "POINT"
    attribute.data.foreach_set("value", np.arange(n) < 3)
    assert bpy.ops.ridgeform.color_diffusion_curves(color=GREEN) == {"FINISHED"}
    colors = point_values(child, "left")
    assert np.allclose(colors[:3], GREEN) and np.allclose(colors[3:], RED)


def test_with_the_mesh_active_it_is_the_same():
    obj, child = drawn()
    child.select_set(False)
    obj.select_set(True)
    bpy.context.view_layer.objects.active = obj
    assert bpy.ops.ridgeform.color_diffusion_curves(color=GREEN) == {"FINISHED"}
    assert np.abs(sides_of(obj)[0] - GREEN).max() < 1e-5


@pytest.mark.parametrize("mode", ["EDIT", "VERTEX_PAINT", "SCULPT"])
@pytest.mark.parametrize("tool", ["color_diffusion_curves", "redraw_diffusion_curves"])
def test_the_result_is_shown_in_every_mode_of_the_mesh(mode, tool):
    obj, child = drawn()
    child.select_set(False)
    obj.select_set(True)
    bpy.context.view_layer.objects.active = obj
    bpy.ops.object.mode_set(mode=mode)
    assert getattr(bpy.ops.ridgeform, tool)(show=True) == {"FINISHED"}
    assert obj.mode == mode


def test_what_cannot_be_redrawn_keeps_its_colors():
    obj, child = drawn()
    before = point_values(child, "left")
    obj.data.clear_geometry()
    with pytest.raises(RuntimeError, match="no faces"):
        bpy.ops.ridgeform.color_diffusion_curves(color=GREEN)
    assert np.array_equal(point_values(child, "left"), before)


def test_without_curves_the_tooltip_says_what_to_do():
    kit.bumpy_box()
    assert not bpy.ops.ridgeform.color_diffusion_curves.poll()
