"""Turned faces, split seams, and a far origin: results are those of the mesh without them."""

import numpy as np
import pytest
import ridgeform
from known_shapes import shapes

FAR = np.array([512345.678, 5572094.155, 312.5])


def open_cube(n=8, noise=0.0, seed=0, place=(1, 1, 1)):
    """A cube of side 2 with a hole, at a corner if no other place is named."""
    vertices, faces = shapes.cube(n, 2.0)
    if noise:
        vertices = shapes.add_noise(vertices, faces, noise, seed)
    away = np.linalg.norm(vertices[faces].mean(axis=1) - place, axis=1)
    return vertices, faces[away > 0.7]


def soup(vertices, faces, rounding=0.0, seed=1):
    """Every triangle with vertices of its own, each coordinate off by up to `rounding`."""
    corners = vertices[faces].reshape(-1, 3)
    off = rounding * np.random.default_rng(seed).uniform(-1, 1, corners.shape)
    return corners + off, np.arange(len(corners)).reshape(-1, 3)


def turned(faces, share, seed=2):
    """The faces, a share of them turned over by a rotation and a swap of their corners."""
    flip = np.random.default_rng(seed).random(len(faces)) < share
    faces = faces.copy()
    faces[flip] = faces[flip][:, [0, 2, 1]]
    return faces, flip


@pytest.mark.parametrize("share", [0.02, 0.1, 0.3])
def test_orient_finds_the_turned_faces_and_keeps_all_others(share):
    for vertices, faces in (shapes.cube(6), shapes.torus(20, 10), shapes.grid(9, 5)):
        mixed, flip = turned(faces, share)
        oriented, flipped = ridgeform.orient(mixed)
        assert np.array_equal(flipped, flip)
        assert np.array_equal(oriented, faces)
        assert oriented.dtype == np.int32
        assert flipped.dtype == bool
        assert len(ridgeform.Mesh(vertices, oriented).report.inconsistent_edges) == 0


def test_orient_leaves_an_agreeing_mesh_alone_and_a_moebius_strip_in_one_piece():
    _, faces = shapes.icosphere(2)
    assert np.array_equal(ridgeform.orient(faces[:, ::-1])[0], faces[:, ::-1])
    vertices, faces = shapes.moebius_strip()
    oriented, _ = ridgeform.orient(faces)
    assert len(ridgeform.Mesh(vertices, oriented).report.inconsistent_edges) > 0
    assert ridgeform.orient(np.empty((0, 3), int))[0].shape == (0, 3)


@pytest.mark.parametrize("rounding", [0, 1e-7, 2e-6])
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_weld_makes_one_mesh_of_a_soup(rounding, dtype):
    vertices, faces = open_cube(noise=0.1)
    apart, own = soup(vertices, faces, rounding)
    welded, joined, index = ridgeform.weld(apart.astype(dtype), own)
    assert len(welded) == len(np.unique(faces))
    assert np.array_equal(joined, index[own])
    first = [np.flatnonzero(index == k)[0] for k in range(len(welded))]
    assert np.array_equal(welded, apart.astype(dtype)[first])
    assert ridgeform.Mesh(welded, joined).report.n_boundary_loops == 1


def band_with_a_seam():
    """A strip of triangles, one of whose vertices is 0.00001 of its size from a border vertex."""
    vertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0], [1 + 3e-6, 0, 0], [2, 0, 0], [2, 1, 0]]
    return np.array(vertices, float), np.array([[0, 1, 2], [1, 3, 2], [4, 5, 6], [4, 6, 3]])


@pytest.mark.parametrize("exponent", [-1000, -536, 0, 536, 1000])
def test_weld_and_the_report_have_no_unit(exponent):
    vertices, faces = band_with_a_seam()
    vertices = np.ldexp(vertices, exponent)
    assert len(ridgeform.weld(vertices, faces)[0]) == 6
    assert len(ridgeform.weld(vertices, faces, tolerance=np.ldexp(1e-7, exponent))[0]) == 7
    assert len(ridgeform.Mesh(vertices, faces).report.t_junctions) == 0


def test_weld_takes_a_tolerance_and_joins_borders_only():
    vertices, faces = shapes.cube(4)
    apart, own = soup(vertices, faces, 1e-3)
    assert len(ridgeform.weld(apart, own)[0]) == len(apart)
    assert len(ridgeform.weld(apart, own, tolerance=3e-3)[0]) == len(vertices)
    twice = np.concatenate([vertices, vertices]), np.concatenate([faces, faces + len(vertices)])
    assert len(ridgeform.weld(*twice)[0]) == 2 * len(vertices)
    with pytest.raises(ridgeform.ArgumentError, match="tolerance"):
        ridgeform.weld(vertices, faces, tolerance=-1)
    with pytest.raises(ridgeform.MeshError):
        ridgeform.weld(vertices, faces + 1)


@pytest.mark.parametrize("rounding", [0, 1e-7])
def test_tools_see_a_soup_as_the_mesh_that_it_was(rounding):
    vertices, faces = open_cube(noise=0.05)
    apart, own = soup(vertices, faces, rounding)
    whole, mesh = ridgeform.Mesh(vertices, faces), ridgeform.Mesh(apart, own)
    expected, filled = ridgeform.fill_holes(whole), ridgeform.fill_holes(mesh)
    assert [len(hole.boundary) for hole in filled.holes] == [len(hole.boundary) for hole in expected.holes]
    assert len(filled.new_faces) == pytest.approx(len(expected.new_faces), rel=0.1)
    # The patch meets the mesh in vertices of the mesh.
    closed = ridgeform.Mesh(*ridgeform.weld(filled.vertices, filled.faces)[:2])
    assert closed.report.n_boundary_loops == 0
    assert np.array_equal(filled.vertices[: len(apart)], apart)
    assert len(ridgeform.find_holes(mesh)) == 1
    segments = ridgeform.segment(mesh)
    assert segments.n_segments == ridgeform.segment(whole).n_segments
    assert len(segments.labels) == len(own)
    moved = ridgeform.stylize(mesh, iterations=3).vertices
    welded, _, index = ridgeform.weld(apart, own)
    assert all(len(np.unique(moved[index == k], axis=0)) == 1 for k in range(len(welded)))
    assert np.abs(moved - ridgeform.stylize(whole, iterations=3).vertices[faces.ravel()]).max() < 1e-4


def test_tools_see_turned_faces_as_their_neighbors_do():
    vertices, faces = open_cube(10, noise=0.05)
    mixed, _ = turned(faces, 0.1)
    whole, mesh = ridgeform.Mesh(vertices, faces), ridgeform.Mesh(vertices, mixed)
    assert np.array_equal(ridgeform.segment(mesh).labels, ridgeform.segment(whole).labels)
    assert np.array_equal(ridgeform.stylize(mesh).vertices, ridgeform.stylize(whole).vertices)
    expected, filled = ridgeform.fill_holes(whole), ridgeform.fill_holes(mesh)
    assert np.array_equal(filled.faces[: len(mixed)], mixed)
    assert np.allclose(filled.new_vertices, expected.new_vertices)
    values = vertices[:, 0] + 0.1 * np.random.default_rng(3).normal(size=len(vertices))
    assert np.allclose(
        ridgeform.denoise(mesh, values, fidelity=100.0).values,
        ridgeform.denoise(whole, values, fidelity=100.0).values,
        atol=1e-6,
    )
    edge_weights = np.random.default_rng(4).uniform(0.5, 1, (len(faces), 3))
    swapped = np.where((mixed != faces).any(axis=1)[:, None], edge_weights[:, [0, 2, 1]], edge_weights)
    assert np.array_equal(
        ridgeform.segment(mesh, edge_weights=swapped).labels,
        ridgeform.segment(whole, edge_weights=edge_weights).labels,
    )


@pytest.mark.parametrize("factor", [1, 2, 20])
def test_results_do_not_depend_on_where_the_origin_is(factor):
    vertices, faces = open_cube(10, noise=0.05, place=(1, 0.1, 0.2))
    here, there = ridgeform.Mesh(vertices, faces), ridgeform.Mesh(vertices + factor * FAR, faces)
    close = {"rtol": 0, "atol": 1e-5}
    moved = ridgeform.stylize(there).vertices - factor * FAR
    assert np.allclose(moved, ridgeform.stylize(here).vertices, **close)
    expected, filled = ridgeform.fill_holes(here), ridgeform.fill_holes(there)
    assert np.array_equal(filled.new_faces, expected.new_faces)
    assert np.allclose(filled.new_vertices - factor * FAR, expected.new_vertices, **close)
    first, second = ridgeform.segment(here), ridgeform.segment(there)
    assert np.array_equal(first.labels, second.labels)
    assert second.noise == pytest.approx(first.noise, rel=1e-4)
    assert np.allclose(second.values - factor * FAR, first.values, **close)


def test_what_does_not_move_keeps_its_bits_far_away():
    vertices, faces = open_cube(6, noise=0.1)
    far = vertices + 9.3 * FAR
    fixed = np.arange(len(far)) % 3 == 0
    moved = ridgeform.stylize(ridgeform.Mesh(far, faces), fixed=fixed, iterations=3).vertices
    assert np.array_equal(moved[fixed], far[fixed])
    assert not np.array_equal(moved[~fixed], far[~fixed])
