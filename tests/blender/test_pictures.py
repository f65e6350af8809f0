"""Pictures show the mesh, framed and lit, on the background asked for, and leave the open file as it was."""

import bpy
import numpy as np
import pictures
import pytest
from known_shapes import shapes
from picture_geometry import Dots, Lines
from picture_scene import load_png, save_png, save_small_png

CUBE = shapes.cube(1)


def count_data():
    """Number of data blocks of every kind that a picture makes."""
    kinds = ("scenes", "objects", "meshes", "cameras", "curves", "materials", "images", "worlds")
    return [len(getattr(bpy.data, kind)) for kind in kinds]


def test_a_cube_seen_on_edge_fills_the_frame_and_shows_three_facets():
    pixels = pictures.render(*CUBE, view=(1, -1, 0.8), size=128, margin=0.1, background=None)
    drawn = np.argwhere(pixels[..., 3] > 128)
    assert drawn.min() == pytest.approx(0.1 * 128, abs=2)
    assert drawn.max() == pytest.approx(0.9 * 128, abs=2)
    spots = pixels[[35, 80, 80], [64, 40, 88], :3].astype(int)  # top, left and right side
    assert all(
        np.abs(a - b).max() > 15
        for a, b in ((spots[0], spots[1]), (spots[1], spots[2]), (spots[0], spots[2]))
    )


def test_the_background_is_the_one_asked_for():
    assert (pictures.render(*CUBE, size=32)[0, 0] == 255).all()
    assert pictures.render(*CUBE, size=32, background=(1.0, 0.5, 0.0))[0, 0].tolist() == [255, 128, 0, 255]
    assert pictures.render(*CUBE, size=32, background=None)[0, 0, 3] == 0


def test_ridges_are_drawn_dark_where_the_mesh_bends():
    vertices, faces = shapes.cube(4)
    look = {"view": (0, 0, 1), "up": (0, 1, 0), "size": 128}
    plain = pictures.render(vertices, faces, **look)[..., :3].max(axis=2)
    creases = pictures.render(vertices, faces, ridges=30.0, **look)[..., :3].max(axis=2)
    everything = pictures.render(vertices, faces, ridges=-1, **look)[..., :3].max(axis=2)
    assert [int((p < 60).sum() > 200) for p in (plain, creases, everything)] == [0, 1, 1]
    middle = slice(20, 108)
    assert (creases[middle, middle] > 60).all()
    assert (everything[middle, middle] < 60).any()


def test_lines_and_dots_are_drawn_over_the_surface_in_their_colors():
    vertices, faces = shapes.cube(4)
    marks = [
        Lines(np.array([[[-0.9, 0.5, 1.0], [0.9, 0.5, 1.0]]]), (0.0, 0.0, 1.0), 4.0),
        Dots(np.array([[0.0, -0.5, 1.0]]), (1.0, 0.0, 0.0), 12.0),
    ]
    look = {"view": (0, 0, 1), "up": (0, 1, 0), "size": 128, "margin": 0.0, "lit": False}
    pixels = pictures.render(vertices, faces, color=(1.0, 1.0, 1.0), marks=marks, **look)
    red, blue = (
        np.abs(pixels[..., :3].astype(int) - c).max(axis=-1) < 40 for c in ((255, 0, 0), (0, 0, 255))
    )
    assert red.sum() == pytest.approx(np.pi * 6**2, rel=0.3)  # without the soft rim
    assert np.argwhere(red).mean(axis=0) == pytest.approx((96, 64), abs=2)
    assert 2 * 0.9 * 128 <= blue.sum() <= 4 * 0.92 * 128  # 4 pixels wide, of which two may be soft rim
    assert np.argwhere(blue).mean(axis=0) == pytest.approx((32, 64), abs=2)
    assert (pixels[2, 2, :3] > 250).all()


def test_a_small_file_has_fewer_shades_and_the_same_picture(tmp_path):
    pixels = pictures.render(*CUBE, size=96)
    save_png(tmp_path / "whole.png", pixels)
    save_small_png(tmp_path / "small.png", pixels, 32)
    again = load_png(tmp_path / "small.png")
    assert again.shape == pixels.shape
    assert np.abs(again.astype(int) - pixels).max() <= 5
    assert (tmp_path / "small.png").stat().st_size < (tmp_path / "whole.png").stat().st_size


def test_the_same_frame_gives_the_same_scale():
    vertices, faces = CUBE
    look = {"size": 64, "frame": vertices, "background": None}
    whole, half = (pictures.render(s * vertices, faces, **look)[..., 3].sum(dtype=float) for s in (1.0, 0.5))
    assert half / whole == pytest.approx(0.25, abs=0.03)


def test_a_sheet_is_labeled_saved_and_leaves_no_data_behind(tmp_path):
    pictures.render(*CUBE, size=8)  # Blender keeps an image for the results of all renders, made by the first
    before = count_data()
    picture = pictures.render(*CUBE, size=(40, 30))
    page = pictures.sheet(
        tmp_path / "sheet.png", [[picture, None], [picture, picture]], columns=["one", "two"], rows=["a", "b"]
    )
    left, top = page.shape[1] - 80, page.shape[0] - 60
    assert left > 0
    assert top > 0
    assert (page[top : top + 30, left : left + 40] == picture).all()
    assert (page[top : top + 30, left + 40 :] == 255).all()
    assert page[:top, left:].min() < 100
    assert page[top:, :left].min() < 100
    assert (load_png(tmp_path / "sheet.png") == page).all()
    assert count_data() == before


def test_triangles_of_objects_are_in_world_space():
    mesh = bpy.data.meshes.new("square")
    mesh.from_pydata([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [], [(0, 1, 2, 3)])
    obj = bpy.data.objects.new("square", mesh)
    obj.location = (5, 0, 0)
    bpy.context.scene.collection.objects.link(obj)
    bpy.context.view_layer.update()
    vertices, faces = pictures.triangles([obj, obj])
    assert vertices.shape == (8, 3)
    assert sorted(set(faces.ravel().tolist())) == list(range(8))
    assert vertices[:, 0].min() == pytest.approx(5)
    bpy.data.meshes.remove(mesh)


def test_a_view_along_up_is_refused():
    with pytest.raises(ValueError, match="parallel to up"):
        pictures.render(*CUBE, view=(0, 0, 1))
