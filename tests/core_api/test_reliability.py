"""Any mesh gives a finite result or a clear error: random triangles, repeated points, any size."""

import numpy as np
import pytest
import ridgeform
from hypothesis import given, settings, strategies as st
from known_shapes import shapes


@st.composite
def triangle_soups(draw):
    """A mesh that nobody modeled: faces at random, corners repeated, points on a coarse grid, any size."""
    n = draw(st.integers(1, 10))
    numbers = st.integers(-3, 3).map(float) | st.floats(-3, 3, width=32)
    scale = 10.0 ** draw(st.integers(-12, 12))
    points = draw(st.lists(st.tuples(numbers, numbers, numbers), min_size=n, max_size=n))
    index = st.integers(0, n - 1)
    faces = draw(st.lists(st.tuples(index, index, index), max_size=16))
    return ridgeform.Mesh(scale * np.array(points), np.array(faces, int).reshape(-1, 3))


def finite_or_refused(call):
    """The arrays of a call, all finite, or None where it was refused by one of the named errors."""
    try:
        arrays = call()
    except (ridgeform.MeshError, ridgeform.ArgumentError, ridgeform.SolveError) as error:
        assert len(str(error).split()) > 3
        return None
    for array in arrays:
        assert np.isfinite(array).all()
    return arrays


@given(mesh=triangle_soups(), dual=st.sampled_from(["barycentric", "circumcentric"]))
@settings(max_examples=150)
def test_operators(mesh, dual):
    finite_or_refused(lambda: [ridgeform.hessian(mesh, dual=dual).data])
    finite_or_refused(lambda: [ridgeform.hessian_norm(mesh, mesh.vertices, dual=dual)])
    assert np.isfinite(ridgeform.voronoi_mass(mesh)).all()
    assert np.isfinite(ridgeform.cotangent_laplacian(mesh).data).all()
    assert ridgeform.intrinsic_delaunay(mesh).n_faces == mesh.n_faces
    report = mesh.report
    assert report.n_boundary_loops == len(ridgeform.boundary_loops(mesh))
    assert report.n_components <= max(mesh.n_faces, 1)
    unnamed = np.setdiff1d(np.arange(mesh.n_vertices), mesh.faces)
    np.testing.assert_array_equal(report.unreferenced_vertices, unnamed)


@given(
    mesh=triangle_soups(),
    fidelity=st.sampled_from([1e-8, 1.0, 1e8]),
    scale=st.sampled_from(["max_edge", "bounding_box", "area"]),
    coupling=st.sampled_from(["joint", "separate"]),
    sharpness=st.sampled_from([0.0, 0.5, 1.0]),
    delaunay=st.booleans(),
)
@settings(max_examples=150)
def test_flows(mesh, **options):
    def run():
        result = ridgeform.stylize(mesh, iterations=5, **options)
        assert result.vertices.shape == mesh.vertices.shape
        return result.vertices, result.energy, result.gap

    finite_or_refused(run)


@given(
    mesh=triangle_soups(),
    fidelity=st.sampled_from([1e-8, 1.0, 1e8]),
    solver=st.sampled_from(["fast", "clarabel"]),
)
@settings(max_examples=100)
def test_denoising_and_interpolation(mesh, fidelity, solver):
    values = np.cos(np.arange(mesh.n_vertices))

    def denoise():
        solution = ridgeform.denoise(mesh, values, fidelity=fidelity, solver=solver)
        return [solution.values, [solution.objective, solution.gap]]

    def interpolate():
        solution = ridgeform.interpolate(mesh, [0], values[:1], solver=solver)
        return [solution.values, [solution.objective, solution.gap]]

    finite_or_refused(denoise)
    finite_or_refused(interpolate)


@pytest.mark.parametrize("fidelity", [1e-6, 1.0, 30.0, 1e3])
@pytest.mark.parametrize("scale", ["max_edge", "bounding_box"])
def test_two_hundred_of_the_strongest_steps(fidelity, scale):
    for vertices, faces in (
        shapes.cube(4),
        shapes.icosphere(2),
        shapes.torus(16, 10),
        shapes.moebius_strip(),
    ):
        noisy = ridgeform.Mesh(shapes.add_noise(vertices, faces, 0.3), faces)
        result = ridgeform.stylize(noisy, iterations=200, fidelity=fidelity, scale=scale)
        assert np.isfinite(result.vertices).all()
        assert np.isfinite(result.energy).all()
        assert result.status in ("finished", "converged", "collapsed")
