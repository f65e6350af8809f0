"""Sizes from the smallest to the largest numbers: the same answers, in other units, or a sentence.

A mesh and values between 1 and 2 are measured in units of 1. Times a power of two they are measured in
that, and what is computed is the same, bit by bit; only what is handed out is multiplied.
"""

import numpy as np
import pytest
import ridgeform
from known_shapes import shapes

VERTICES, FACES = shapes.icosphere(2)
VERTICES = shapes.add_noise(1.2 * VERTICES, FACES, 0.1)
FACES = FACES[6:]
VALUES = 1.5 * np.cos(3 * VERTICES)
PAINT = 1.0 * (VERTICES[:, 2] > 0.1)
EXPONENTS = [-1000, -300, 65, 300, 900]
ENERGIES = ["l1_hessian", "l2_hessian", "l2_curved_hessian", "l2_laplacian", "l1_hessian_stein2018"]


def mesh(exponent=0):
    """The sphere, 2^exponent times as large."""
    return ridgeform.Mesh(np.ldexp(VERTICES, exponent), FACES)


def same(found, expected, exponent=0):
    """Asserts that what was found is what was expected times 2^exponent, bit by bit."""
    np.testing.assert_array_equal(found, np.ldexp(expected, exponent))


of_any_size = pytest.mark.parametrize("exponent", EXPONENTS)


@of_any_size
def test_operators(exponent):
    same(mesh(exponent).edge_lengths, mesh().edge_lengths, exponent)
    same(ridgeform.hessian(mesh(exponent)).data, ridgeform.hessian(mesh()).data)
    same(ridgeform.cotangent_laplacian(mesh(exponent)).data, ridgeform.cotangent_laplacian(mesh()).data)
    delaunay = ridgeform.intrinsic_delaunay
    same(delaunay(mesh(exponent)).edge_lengths, delaunay(mesh()).edge_lengths, exponent)
    assert mesh(exponent).report.degenerate_faces.size == 0
    for function, power in (
        (ridgeform.voronoi_mass, 2),
        (lambda m: ridgeform.hessian_norm(m, VALUES), -2),
    ):
        if abs(power * exponent) < 1000:
            same(function(mesh(exponent)), function(mesh()), power * exponent)
    for kind in ENERGIES:
        power = -2 if kind.startswith("l2") else 0
        if abs(power * exponent) < 1000:
            energy = ridgeform.energy(mesh(exponent), VALUES, kind=kind)
            same(energy, ridgeform.energy(mesh(), VALUES, kind=kind), power * exponent)


def test_areas_are_numbers_with_all_their_digits_or_refused():
    for exponent in range(-560, -480, 7):
        try:
            found = ridgeform.voronoi_mass(mesh(exponent))
        except ridgeform.SolveError as refusal:
            assert exponent < -500
            assert "too small for a number" in str(refusal)
        else:
            same(np.ldexp(found, -2 * exponent), ridgeform.voronoi_mass(mesh()))


@of_any_size
def test_flows(exponent):
    for options in ({}, {"scale": "extent", "coupling": "separate"}, {"delaunay": True}):
        expected = ridgeform.stylize(mesh(), iterations=3, **options)
        progress = ridgeform.Progress()
        found = ridgeform.stylize(mesh(exponent), iterations=3, progress=progress, **options)
        same(found.vertices, expected.vertices, exponent)
        same(found.energy, expected.energy, exponent)
        same(found.gap, expected.gap)
        same(progress.snapshot(), expected.vertices, exponent)


@of_any_size
def test_filled_holes(exponent):
    expected, found = (ridgeform.fill_holes(mesh(e), sharpness=0.5) for e in (0, exponent))
    same(found.vertices, expected.vertices, exponent)
    same(found.faces, expected.faces)
    same(found.holes[0].energy, expected.holes[0].energy, exponent)
    length = {e: ridgeform.fill_holes(mesh(e), edge_length=np.ldexp(0.2, e)).faces for e in (0, exponent)}
    same(length[exponent], length[0])


@of_any_size
def test_remeshed(exponent):
    expected, found = (ridgeform.remesh(mesh(e), edge_length=np.ldexp(0.3, e)) for e in (0, exponent))
    same(found.vertices, expected.vertices, exponent)
    same(found.faces, expected.faces)
    assert found.edge_length == np.ldexp(0.3, exponent)


@of_any_size
def test_segments_and_curves(exponent):
    expected, found = (ridgeform.segment(mesh(e)) for e in (0, exponent))
    same(found.labels, expected.labels)
    same(found.values, expected.values, exponent)
    expected, found = (ridgeform.diffusion_curves(mesh(e), PAINT) for e in (0, exponent))
    same(found.colors, expected.colors)
    same(found.edges, expected.edges)
    smooth = {e: ridgeform.smooth_curves(mesh(e), expected.edges) for e in (0, exponent)}
    same(smooth[exponent], smooth[0], exponent)
    lines = {e: ridgeform.trace_curves(mesh(e), np.ldexp(VERTICES[[5, 90]], e)) for e in (0, exponent)}
    for found, expected in zip(lines[exponent], lines[0], strict=True):
        same(found, expected)


@of_any_size
def test_modes(exponent):
    for energy in ("l1_hessian", "l2_laplacian"):
        expected, found = (ridgeform.vibration_modes(mesh(e), 2, energy=energy) for e in (0, exponent))
        same(found, expected, -exponent)


@pytest.mark.parametrize("exponent", EXPONENTS)
@pytest.mark.parametrize("energy", ENERGIES)
def test_values_of_any_size(energy, exponent):
    def interpolated(e):
        values = np.ldexp(VALUES[::20], e)
        return ridgeform.interpolate(mesh(), range(0, len(VERTICES), 20), values, energy=energy)

    power = 2 if energy.startswith("l2") else 1
    if abs(power * exponent) < 1000:
        expected, found = interpolated(0), interpolated(exponent)
        same(found.values, expected.values, exponent)
        same(found.objective, expected.objective, power * exponent)
        same(found.gap, expected.gap)


@pytest.mark.parametrize("exponent", [-400, 65, 400])
def test_values_and_meshes_of_any_size_are_denoised(exponent):
    """The fidelity weighs squares over areas: in the same proportion, the answer is the same."""
    for energy, by_values, by_size in (("l1_hessian", -1, -2), ("l2_laplacian", 0, -4)):
        expected = ridgeform.denoise(mesh(), VALUES, fidelity=8.0, energy=energy)
        fidelity = np.ldexp(8.0, by_values * exponent)
        found = ridgeform.denoise(mesh(), np.ldexp(VALUES, exponent), fidelity=fidelity, energy=energy)
        same(found.values, expected.values, exponent)
        if abs(by_size * exponent) < 1000:
            fidelity = np.ldexp(8.0, by_size * exponent)
            found = ridgeform.denoise(mesh(exponent), VALUES, fidelity=fidelity, energy=energy)
            same(found.values, expected.values)


def test_colors_of_any_size():
    curves = ridgeform.diffusion_curves(mesh(), PAINT)
    for exponent in (-400, 400):
        found = ridgeform.diffusion_curves(mesh(), np.ldexp(PAINT, exponent))
        same(found.left, curves.left, exponent)
        same(found.error, curves.error, 2 * exponent)
        redrawn = ridgeform.redraw(mesh(), found.edges, found.left, found.right, sides=found.sides)
        np.testing.assert_allclose(np.ldexp(redrawn.colors, -exponent), curves.colors, atol=1e-9)


def test_answers_past_the_largest_number_are_refused_in_words():
    with pytest.raises(ridgeform.SolveError, match="an area would be too large"):
        ridgeform.voronoi_mass(mesh(900))
    with pytest.raises(ridgeform.SolveError, match="the energy would be too large"):
        ridgeform.energy(mesh(), np.ldexp(VALUES, 900), kind="l2_laplacian")
    with pytest.raises(ridgeform.MeshError, match="edge too long for a number; scale the mesh down"):
        ridgeform.Mesh(np.sign(VERTICES) * 1.7e308, FACES)
    with pytest.raises(ridgeform.ArgumentError, match=r"fidelity: .* weighs nothing"):
        ridgeform.denoise(mesh(-900), VALUES, fidelity=1.0)


def test_vertices_without_faces_keep_every_bit():
    loose = np.array([[1e300, -1e-300, 5e-324]])
    vertices = np.concatenate([np.ldexp(VERTICES, -800), loose])
    small = ridgeform.Mesh(vertices, FACES)
    same(ridgeform.stylize(small, iterations=2).vertices[-1], loose[0])
    same(ridgeform.fill_holes(small).vertices[: len(vertices)], vertices)


def test_values_that_stay_keep_every_bit():
    values = np.array([1e-308, -3.3e-310, 2.5e30])
    found = ridgeform.interpolate(mesh(), [0, 50, 90], values)
    same(found.values[[0, 50, 90]], values)


def test_sizes_that_differ_within_a_mesh_claim_no_more_than_is_so():
    """The objective is the energy of the values handed out, however uneven the triangles are."""
    for seed in range(12):
        rng = np.random.default_rng(seed)
        sizes = 10.0 ** rng.uniform(-30, 30, (len(VERTICES), 1))
        uneven = ridgeform.Mesh(VERTICES * sizes, FACES)
        try:
            found = ridgeform.interpolate(uneven, [0, 50], [1.0, 3.0], energy="l1_hessian")
        except ridgeform.RidgeformError as refused:
            assert len(str(refused).split()) > 5
            continue
        energy = ridgeform.energy(uneven, found.values)
        np.testing.assert_allclose(found.objective, energy, rtol=1e-9)
        assert 0 <= found.gap < np.inf
        assert found.status != "solved" or found.gap <= 1e-3


def test_a_flow_that_leaves_its_surroundings_says_so():
    """Found by fuzzing: vertices at 1e66 as the last sound step of a mesh of size 1e30."""
    for seed in range(12):
        rng = np.random.default_rng(seed)
        uneven = ridgeform.Mesh(VERTICES * 10.0 ** rng.uniform(-30, 30, (len(VERTICES), 1)), FACES)
        try:
            found = ridgeform.stylize(uneven, iterations=3, fidelity=1e-3)
        except ridgeform.RidgeformError as refused:
            assert len(str(refused).split()) > 5
            continue
        size = np.ptp(uneven.vertices, axis=0).max()
        assert np.abs(found.vertices - uneven.vertices).max() <= 11 * size
        assert (found.gap >= 0).all() and np.isfinite(found.energy).all()
