"""Isolines and bands for pictures are exact on every triangle."""

import numpy as np
import picture_isolines
import pytest
from known_shapes import shapes

LEVELS = np.linspace(-0.8, 0.8, 9)


def areas_and_normals(vertices, faces):
    a, b, c = (vertices[faces[:, i]] for i in range(3))
    normals = np.cross(b - a, c - a)
    doubled = np.linalg.norm(normals, axis=1)
    return 0.5 * doubled, normals / doubled[:, None]


@pytest.fixture
def ball():
    vertices, faces = shapes.icosphere(2)
    return vertices, faces, vertices @ [0.3, -0.5, 0.81]


def test_isolines_of_an_affine_function_lie_in_its_planes(ball):
    vertices, faces, values = ball
    segments = picture_isolines.isolines(vertices, faces, values, LEVELS)
    heights = segments @ [0.3, -0.5, 0.81]
    nearest = LEVELS[np.abs(heights[..., None] - LEVELS).argmin(axis=-1)]
    assert np.abs(heights - nearest).max() < 1e-14
    assert set(nearest.ravel()) == set(LEVELS)


def test_isolines_on_a_closed_surface_close(ball):
    vertices, faces, values = ball
    segments = picture_isolines.isolines(vertices, faces, values, LEVELS)
    _, count = np.unique(segments.reshape(-1, 3).round(9), axis=0, return_counts=True)
    assert (count == 2).all()


def test_bands_cover_the_surface_once_and_face_as_it_does(ball):
    vertices, faces, values = ball
    pieces, piece_faces, band, face = picture_isolines.bands(vertices, faces, values, LEVELS)
    area, normals = areas_and_normals(vertices, faces)
    piece_area, piece_normals = areas_and_normals(pieces, piece_faces)
    assert np.bincount(face, piece_area, minlength=len(faces)) == pytest.approx(area, rel=1e-8)
    large = piece_area > 1e-6 * area[face]
    assert (piece_normals * normals[face])[large].sum(axis=1).min() > 0.999
    middle = pieces[piece_faces].mean(axis=1) @ [0.3, -0.5, 0.81]
    assert (np.searchsorted(LEVELS, middle) == band).all()


def test_levels_at_corners_and_constant_triangles():
    vertices, faces = shapes.grid(2, 2)
    steps = vertices[:, 0]
    assert len(picture_isolines.isolines(vertices, faces, np.ones(len(vertices)), [1.0])) == 0
    pieces, piece_faces, band, _ = picture_isolines.bands(vertices, faces, steps, [1.0])
    area, _ = areas_and_normals(pieces, piece_faces)
    assert np.bincount(band, area) == pytest.approx([2.0, 2.0])
    pieces, piece_faces, band, _ = picture_isolines.bands(vertices, faces, np.full(len(vertices), 0.5), [1.0])
    assert set(band) == {0}
    assert areas_and_normals(pieces, piece_faces)[0].sum() == pytest.approx(4.0)
