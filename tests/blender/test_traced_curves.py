"""Diffusion curves that were moved, drawn or subdivided by hand, and meshes that changed under them."""

import bpy
import curve_kit
import numpy as np
import pytest
from bl_ext.user_default.ridgeform.diffusion import bezier, curves_io

GREEN = (0.1, 0.6, 0.2, 1.0)


@pytest.fixture
def plane():
    """A plane, red on the left and blue on the right, and the curve between."""
    obj = curve_kit.add_plane(curve_kit.halves)
    curve_kit.split_materials(obj)
    assert curve_kit.find() == {"FINISHED"}
    return obj, curves_io.curves_of(obj)


def redrawn(obj):
    """The colors of the quads (f, 4, 4) after redrawing."""
    assert bpy.ops.ridgeform.redraw_diffusion_curves() == {"FINISHED"}
    return curve_kit.corner_colors(obj).reshape(-1, 4, 4)


def centers(obj):
    return np.array([face.center for face in obj.data.polygons])


def add_line(child, places, **colors):
    """Add a curve of points at these places, as drawing by hand does, with colors if there are any."""
    begin = len(child.data.points)
    child.data.add_curves([len(places)])
    for i, place in enumerate(places):
        child.data.points[begin + i].position = place
        for side, color in colors.items():
            child.data.attributes[side].data[begin + i].color = color


def test_a_moved_curve_takes_its_colors_along(plane):
    obj, child = plane
    for point in child.data.points:
        # Off the mesh and between its vertices: a fifth of a cell.
        point.position = point.position[0] + 4.2 / curve_kit.CELLS, point.position[1], 0.01
    colors = redrawn(obj)
    left = centers(obj)[:, 0] < 0.5 + 4 / curve_kit.CELLS
    assert np.abs(colors[left] - curve_kit.RED).max() < 1e-5
    assert np.abs(colors[~left] - curve_kit.BLUE).max() < 1e-5


def test_where_the_curves_object_stands_does_not_count(plane):
    obj, child = plane
    before = curve_kit.corner_colors(obj)
    child.location = (3.0, 0.0, 0.0)
    assert np.abs(redrawn(obj).reshape(-1, 4) - before).max() < 1e-6


def test_a_curve_of_two_points_is_drawn_along_the_edges(plane):
    obj, child = plane
    y = 0.5 + 0.3 / curve_kit.CELLS
    add_line(child, [(0.0, y, 0.0), (0.4, y, 0.0)], left=GREEN, right=curve_kit.RED)
    colors = redrawn(obj)
    x, y, _ = centers(obj).T
    # Beside the new curve; colors flow around its open end.
    beside = (x < 0.25) & (np.abs(y - 0.5) < 1 / curve_kit.CELLS)
    assert np.abs(colors[beside & (y > 0.5)] - GREEN).max() < 0.2
    assert np.abs(colors[beside & (y < 0.5)] - curve_kit.RED).max() < 0.2
    assert np.abs(colors[x > 0.5] - curve_kit.BLUE).max() < 1e-5


def test_a_curve_drawn_without_colors_takes_those_of_the_paint():
    obj = curve_kit.add_plane(curve_kit.halves)
    curve_kit.find()
    child = curves_io.curves_of(obj)
    assert [curve.points_length for curve in child.data.curves] == [1]
    bpy.ops.object.select_all(action="DESELECT")
    bpy.context.view_layer.objects.active = child
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.curves.select_all(action="SELECT")
    bpy.ops.curves.delete()
    bpy.ops.object.mode_set(mode="OBJECT")
    assert not len(child.data.curves)
    add_line(child, [(0.49, 0.0, 0.0), (0.5, 0.5, 0.02), (0.51, 1.0, 0.0)])
    colors = redrawn(obj)
    x = centers(obj)[:, 0]
    assert np.abs(colors[x < 0.5] - curve_kit.RED).max() < 1e-5
    assert np.abs(colors[x > 0.5] - curve_kit.BLUE).max() < 1e-5
    # The curve itself stays as it was drawn.
    assert [curve.points_length for curve in child.data.curves] == [3]


def test_closed_curves_are_traced_all_around(plane):
    obj, child = plane
    add_line(
        child, [(0.7, 0.3, 0), (0.9, 0.3, 0), (0.9, 0.7, 0), (0.7, 0.7, 0)], left=GREEN, right=curve_kit.BLUE
    )
    cyclic = child.data.attributes["cyclic"].data
    cyclic[1].value = True
    colors = redrawn(obj)
    inside = (np.abs(centers(obj)[:, :2] - (0.8, 0.5)) < (0.05, 0.15)).all(axis=1)
    assert np.abs(colors[inside] - GREEN).max() < 1e-5
    outside = centers(obj)[:, 1] > 0.8
    assert np.abs(colors[outside & (centers(obj)[:, 0] > 0.5)] - curve_kit.BLUE).max() < 1e-5


def test_curves_fit_a_mesh_that_was_subdivided_since(plane):
    obj, child = plane
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.mesh.subdivide()
    bpy.ops.object.mode_set(mode="OBJECT")
    colors = redrawn(obj)
    left = centers(obj)[:, 0] < 0.5
    assert np.abs(colors[left] - curve_kit.RED).max() < 1e-5
    assert np.abs(colors[~left] - curve_kit.BLUE).max() < 1e-5
    assert len(curve_kit.point_values(child, "left")) == curve_kit.CELLS + 1


def test_the_drawing_shows_moved_curves(plane, tmp_path):
    _, child = plane
    for point in child.data.points:
        point.position = point.position[0] + 4 / curve_kit.CELLS, point.position[1], 0.0
    path = tmp_path / "curves.svg"
    assert bpy.ops.ridgeform.export_diffusion_svg(filepath=str(path), fill=False) == {"FINISHED"}
    line = path.read_text().split('class="curve" d="M')[1].split('"')[0]
    places = [float(pair.split()[0]) for pair in line.split("L")]
    assert np.allclose(places, 8 + 1000 * (0.5 + 4 / curve_kit.CELLS), atol=0.1)


def test_a_curve_between_loose_parts_is_refused(plane):
    obj, child = plane
    other = curve_kit.add_plane()
    other.location = (3.0, 0.0, 0.0)
    bpy.ops.object.select_all(action="DESELECT")
    for part in (other, obj):
        part.select_set(True)
    bpy.context.view_layer.objects.active = obj
    bpy.ops.object.join()
    add_line(child, [(0.9, 0.5, 0.0), (3.1, 0.5, 0.0)], left=curve_kit.RED, right=curve_kit.RED)
    with pytest.raises(RuntimeError, match="no edges join"):
        bpy.ops.ridgeform.redraw_diffusion_curves()


def test_curves_are_drawn_smoothly_and_redraw_what_was_found(tmp_path):
    # A slanted border, and a round one, on a lattice whose edges have teeth there.
    obj = curve_kit.add_plane(
        lambda places: np.where(places[:, :1] + 0.6 * places[:, 1:] < 0.8, curve_kit.RED, curve_kit.BLUE)
    )
    slanted = [face.center.x + 0.6 * face.center.y > 0.8 for face in obj.data.polygons]
    curve_kit.split_materials(obj, np.array(slanted))
    curve_kit.find()
    child = curves_io.curves_of(obj)
    found = curve_kit.corner_colors(obj)
    places = curve_kit.point_values(child, "position", "vector", 3)
    offsets = curve_kit.point_values(child, "offset", "vector", 3)
    length = [np.linalg.norm(np.diff(line, axis=0), axis=1).sum() for line in (places, places - offsets)]
    assert length[0] < 0.9 * length[1]
    assert np.abs(offsets).max() < 0.7 / curve_kit.CELLS
    assert np.abs(offsets[[0, -1]]).max() == 0.0
    assert np.abs(redrawn(obj).reshape(-1, 4) - found).max() < 1e-6
    path = tmp_path / "curves.svg"
    assert bpy.ops.ridgeform.export_diffusion_svg(filepath=str(path), fill=False) == {"FINISHED"}
    line = path.read_text().split('class="curve" d="M')[1].split('"')[0]
    drawn = np.array([[float(x) for x in pair.split()] for pair in line.split("L")])
    assert np.abs((drawn[:, 0] - 8) / 1000 - places[:, 0]).max() < 1e-4
    assert np.abs(1 - (drawn[:, 1] - 8) / 1000 - places[:, 1]).max() < 1e-4


def test_curves_without_offsets_lie_where_they_are(plane):
    obj, child = plane
    before = curve_kit.corner_colors(obj)
    child.data.attributes.remove(child.data.attributes["offset"])
    assert np.abs(redrawn(obj).reshape(-1, 4) - before).max() < 1e-6


@pytest.mark.skipif(bpy.app.version < (5, 0), reason="this Blender cannot set the type of a curve")
def test_bezier_curves_are_followed_between_their_points(plane):
    obj, child = plane
    # A bow over a chord: its two points alone would be the chord.
    add_line(child, [(0.6, 0.2, 0.0), (0.9, 0.2, 0.0)], left=GREEN, right=curve_kit.BLUE)
    child.data.set_types(type="BEZIER", indices=[1])
    for side, places in (("left", [(0.6, 0.2, 0), (0.9, 0.9, 0)]), ("right", [(0.6, 0.9, 0), (0.9, 0.2, 0)])):
        name = f"handle_{side}"
        handles = child.data.attributes.get(name) or child.data.attributes.new(name, "FLOAT_VECTOR", "POINT")
        for i, place in zip((-2, -1), places, strict=True):
            handles.data[len(handles.data) + i].vector = place
    drawn = curves_io.read_curves(child)
    bow = bezier.straightened(child.data, drawn)
    assert bow.sizes.tolist() == [curve_kit.CELLS + 1, bezier.PIECES + 1]
    assert np.abs(bow.places[curve_kit.CELLS + 1 + bezier.PIECES // 2] - (0.75, 0.725, 0.0)).max() < 1e-6
    assert np.abs(bow.places[[curve_kit.CELLS + 1, -1]] - drawn.places[-2:]).max() < 1e-6
    assert np.abs(bow.left[curve_kit.CELLS + 1 :] - GREEN).max() < 1e-6
    assert (bow.places[: curve_kit.CELLS + 1] == drawn.places[: curve_kit.CELLS + 1]).all()
    colors = redrawn(obj)
    above = (np.abs(centers(obj)[:, :2] - (0.75, 0.78)) < (0.04, 0.04)).all(axis=1)
    assert np.abs(colors[above] - GREEN).max() < 0.25
