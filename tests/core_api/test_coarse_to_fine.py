"""By levels, `stylize` and `segment` say the same as without, at any density."""

import dataclasses
import threading
import time

import numpy as np
import pytest
import ridgeform
from known_shapes import shapes, stepped_shapes
from known_shapes.segment_shapes import SHAPES, adjusted_rand_index

HALF = {"movement": 0.007, "flat_share": 0.5, "fidelity": 10**6.55, "scale": "area", "sharpness": 0.75}
"""The settings of the add-on at half strength."""


def moved(mesh, result):
    """Root mean square movement in parts of the size."""
    size = np.ptp(mesh.vertices, axis=0).max()
    return shapes.root_mean_square(np.linalg.norm(result.vertices - mesh.vertices, axis=1)) / size


def noisy_torus(segments, rings):
    """A torus with noise of a fiftieth of an edge."""
    vertices, faces = shapes.torus(segments, rings)
    return ridgeform.Mesh(shapes.add_noise(vertices, faces, 0.02), faces)


@pytest.fixture(scope="module")
def torus():
    """A dense torus, and what becomes of it."""
    mesh = noisy_torus(170, 112)
    return mesh, ridgeform.stylize(mesh, **HALF)


def test_most_steps_are_done_on_a_coarser_mesh_and_the_last_on_the_mesh_itself(torus):
    mesh, result = torus
    assert result.status in {"reached", "settled"}
    assert (result.level_vertices[-2:] == mesh.n_vertices).all()
    assert (result.level_vertices[:-2] <= 9000).all()
    steps = len(result.level_vertices)
    assert (steps, result.iterations) == (len(result.gap), steps - 2)
    assert len(result.energy) == steps + 1
    assert len(result.solver_iterations) == steps
    assert (result.gap <= 1e-3).all()


def test_a_dense_shape_becomes_what_a_coarse_one_becomes(torus):
    mesh, dense = torus
    small = noisy_torus(112, 75)
    coarse = ridgeform.stylize(small, **HALF)
    assert len(coarse.level_vertices) == coarse.iterations
    assert moved(mesh, dense) == pytest.approx(moved(small, coarse), rel=0.25)
    assert dense.flat_share[1] == pytest.approx(coarse.flat_share[1], abs=0.12)


def test_it_is_as_flat_as_all_steps_on_the_mesh_itself_make_it(torus):
    mesh, result = torus
    alone = ridgeform.stylize(mesh, coarse_to_fine=False, **HALF)
    assert (alone.level_vertices == mesh.n_vertices).all()
    assert result.energy[-1] <= 1.07 * alone.energy[-1]
    assert result.energy[0] == alone.energy[0]


def test_steps_on_the_mesh_itself_are_as_short_for_its_edges_as_the_first_on_the_coarsest(torus):
    mesh, result = torus
    finer = mesh.n_vertices / result.level_vertices[0]
    np.testing.assert_allclose(result.fidelities[-2:], result.fidelities[0] * finer**1.5, rtol=1e-12)


def test_one_step_on_the_mesh_itself_is_enough_where_nothing_is_to_be_cleared_away():
    mesh = ridgeform.Mesh(*shapes.torus(170, 112))
    result = ridgeform.stylize(mesh, **HALF)
    alone = ridgeform.stylize(mesh, coarse_to_fine=False, **HALF)
    assert (result.level_vertices == mesh.n_vertices).sum() == 1
    assert result.flat_share[1] >= alone.flat_share[1] - 0.02
    assert result.energy[-1] <= 1.05 * alone.energy[-1]


@pytest.mark.parametrize("noise", [0.1, 0.2])
def test_a_noisy_cube_is_restored_as_well(noise):
    vertices, faces = shapes.cube(60)
    mesh = ridgeform.Mesh(shapes.add_noise(vertices, faces, noise), faces)
    off = {
        levels: shapes.root_mean_square(
            shapes.distance_to_cube(ridgeform.stylize(mesh, coarse_to_fine=levels, **HALF).vertices)
        )
        for levels in (None, False)
    }
    assert off[None] <= 1.1 * off[False]


def test_equal_steps_are_those_of_the_paper_unless_levels_are_asked_for(torus):
    mesh, _ = torus
    plain = ridgeform.stylize(mesh, iterations=1, tolerance=1e-2)
    assert plain.level_vertices.tolist() == [mesh.n_vertices]
    levels = ridgeform.stylize(mesh, iterations=2, tolerance=1e-2, coarse_to_fine=True)
    assert levels.status == "finished"
    assert levels.iterations == 2
    assert levels.level_vertices[-1] == mesh.n_vertices


def test_small_meshes_have_no_levels():
    mesh = noisy_torus(32, 16)
    with_levels = ridgeform.stylize(mesh, coarse_to_fine=True, **HALF)
    without = ridgeform.stylize(mesh, coarse_to_fine=False, **HALF)
    np.testing.assert_array_equal(with_levels.vertices, without.vertices)


def test_held_vertices_keep_their_bits_and_weights_hold_on_every_level(torus):
    mesh, _ = torus
    held = mesh.vertices[:, 0] > 0
    strength = np.clip(mesh.vertices[:, 1] + 1.4, 0.0, 1.0) * 0.5
    result = ridgeform.stylize(
        mesh, fixed=held, strength=strength, ridge_weights=np.full(mesh.n_faces, 2.0), **HALF
    )
    np.testing.assert_array_equal(result.vertices[held], mesh.vertices[held])
    still = strength <= 0
    np.testing.assert_array_equal(result.vertices[still], mesh.vertices[still])
    assert np.linalg.norm(result.vertices - mesh.vertices, axis=1)[~held].max() > 1e-3
    assert len(result.level_vertices) > result.iterations


def test_the_sides_of_a_seam_stay_together(torus):
    mesh, _ = torus
    # The faces of one half get vertices of their own along the cut.
    half = mesh.vertices[mesh.faces].mean(axis=1)[:, 0] > 0
    split, inverse = np.unique(mesh.faces[half], return_inverse=True)
    faces = mesh.faces.copy()
    faces[half] = inverse.reshape(-1, 3) + mesh.n_vertices
    vertices = np.vstack([mesh.vertices, mesh.vertices[split]])
    result = ridgeform.stylize(ridgeform.Mesh(vertices, faces), **HALF)
    shared = np.isin(split, mesh.faces[~half])
    copies = result.vertices[mesh.n_vertices :][shared]
    np.testing.assert_array_equal(copies, result.vertices[split[shared]])


def kept_at_first_sight(mesh, **settings):
    """What is shown first, with the number of its step, and the result when the flow is then kept."""
    progress, found = ridgeform.Progress(), []
    run = threading.Thread(
        target=lambda: found.append(ridgeform.stylize(mesh, progress=progress, **settings, **HALF))
    )
    run.start()
    while progress.snapshot() is None and run.is_alive():
        time.sleep(0.01)
    shown = progress.numbered_snapshot()
    progress.finish()
    run.join()
    return shown, found[0]


def test_a_coarse_step_is_shown_on_the_mesh_and_can_be_kept(torus):
    mesh, _ = torus
    (number, shown), result = kept_at_first_sight(mesh, tolerance=1e-9)
    assert number == 1
    assert shown.shape == mesh.vertices.shape
    assert result.status == "stopped"
    assert result.vertices.shape == mesh.vertices.shape
    assert (result.level_vertices < mesh.n_vertices).all()
    assert 0 < moved(mesh, result) < 0.1


def test_what_is_shown_first_on_a_large_mesh_is_all_of_the_coarsest_flow():
    """To draw it takes longer than those steps."""
    mesh = noisy_torus(340, 224)
    (number, shown), result = kept_at_first_sight(mesh)
    assert number == (result.level_vertices == result.level_vertices[0]).sum() > 2
    assert shown.shape == mesh.vertices.shape
    assert result.status == "stopped"
    assert (result.level_vertices < mesh.n_vertices).all()


def dense(name, noise):
    """A shape with known parts, 25,000 vertices and more."""
    return finer(SHAPES[name](2)).noisy(noise, 10).turned(0)


def finer(part):
    """Four faces for each."""
    vertices, faces = shapes.subdivide(part.vertices, part.faces)
    return dataclasses.replace(part, vertices=vertices, faces=faces, truth=np.tile(part.truth, 4))


def segment(part, **given):
    """The segments of a shape, and how well they agree with its parts."""
    result = ridgeform.segment(ridgeform.Mesh(part.vertices, part.faces), **given)
    return result, adjusted_rand_index(result.labels, part.truth)


@pytest.mark.parametrize(
    ("name", "noise"), [("cube", 0.1), ("dodecahedron", 0.2), ("L-shape", 0.0), ("fan part", 0.1)]
)
def test_segments_of_a_dense_shape_are_its_parts(name, noise):
    part = dense(name, noise)
    result, agreement = segment(part)
    assert (result.n_segments, agreement >= 0.99) == (part.n_parts, True)
    assert result.labels.shape == result.indicator.shape == (len(part.faces),)
    assert result.values.shape == part.vertices.shape
    fewer = result.labels_at(part.n_parts - 1)
    assert all(len(np.unique(fewer[result.labels == k])) == 1 for k in range(part.n_parts))


def test_a_box_with_rounded_edges_has_six_sides_at_any_density():
    for n in (37, 73):
        result = ridgeform.segment(ridgeform.Mesh(*shapes.rounded_box(n, 0.15)), fillets="joined")
        assert result.n_segments == 6
        areas = np.bincount(result.labels_at(6)) / len(result.labels)
        assert areas.min() > 0.08, areas
        np.testing.assert_array_equal(result.labels_at(6), result.labels)


def test_windows_one_edge_deep_are_found_on_a_coarser_mesh():
    part = stepped_shapes.house(64, 1).noisy(0.05, 3).turned(1)
    result, agreement = segment(part)
    assert (result.n_segments, agreement >= 0.98) == (part.n_parts, True)


def test_a_pole_of_slivers_under_noise_leaves_the_rest_of_the_shape_its_vertices():
    part = finer(finer(SHAPES["cylinder with caps"](1))).noisy(0.1, 10)
    result, agreement = segment(part)
    assert (result.n_segments, agreement >= 0.99) == (3, True)


def test_counts_least_faces_and_weights_hold_on_every_level():
    part = dense("cube", 0.1)
    assert segment(part, n_segments=4)[0].n_segments == 4
    sizes = np.bincount(segment(part, min_faces=7000)[0].labels)
    assert sizes.min() >= 7000
    free = np.where(part.vertices[part.faces].mean(axis=1)[:, 0] > 0, 1.0, 1e4)
    assert segment(part, face_weights=free)[0].n_segments < 6


def test_segments_without_levels_are_found_on_the_mesh_itself():
    part = dense("cube", 0.1)
    own, agreement = segment(part, coarse_to_fine=False)
    assert agreement == 1.0
    weighted = segment(part, edge_weights=np.ones((len(part.faces), 3)))[0]
    np.testing.assert_array_equal(weighted.indicator, own.indicator)
