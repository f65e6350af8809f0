"""Arrays across the border: every numeric dtype, memory order and container in, plain arrays out."""

import numpy as np
import pytest
import ridgeform
from known_shapes import shapes

VERTICES = np.array([[0, 0, 0], [4, 0, 0], [0, 4, 0], [0, 0, 4]])
FACES = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])


def unaligned(array):
    """The same numbers at an odd address."""
    buffer = np.zeros(array.nbytes + 1, np.uint8)
    view = buffer[1:].view(array.dtype).reshape(array.shape)
    view[:] = array
    assert not view.flags.aligned
    return view


LAYOUTS = {
    "c": np.ascontiguousarray,
    "fortran": np.asfortranarray,
    "strided": lambda a: np.repeat(a, 2, axis=0)[::2],
    "reversed": lambda a: np.ascontiguousarray(a[::-1])[::-1],
    "read-only": lambda a: np.frombuffer(a.tobytes(), a.dtype).reshape(a.shape),
    "unaligned": unaligned,
    "list": lambda a: a.tolist(),
    "tuple": lambda a: tuple(a.tolist()),
}


@pytest.mark.parametrize("layout", LAYOUTS)
def test_every_memory_layout(layout):
    mesh = ridgeform.Mesh(LAYOUTS[layout](VERTICES * 1.0), LAYOUTS[layout](FACES))
    np.testing.assert_array_equal(mesh.vertices, VERTICES)
    np.testing.assert_array_equal(mesh.faces, FACES)


@pytest.mark.parametrize(
    "dtype", ["f2", "f4", "f8", "g", ">f8", ">f4", "i1", "u1", "i4", "u4", "i8", "u8", ">i4", ">u8"]
)
def test_every_numeric_dtype(dtype):
    mesh = ridgeform.Mesh(VERTICES.astype(dtype), FACES.astype(dtype))
    np.testing.assert_array_equal(mesh.vertices, VERTICES)
    np.testing.assert_array_equal(mesh.faces, FACES)


@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize("shape", [(4,), (4, 1), (4, 3)])
def test_functions_come_back_in_the_shape_they_had(layout, shape):
    matrix = ridgeform.cotangent_laplacian(ridgeform.Mesh(VERTICES, FACES))
    values = np.random.default_rng(0).standard_normal(shape)
    product = matrix @ LAYOUTS[layout](values)
    assert product.shape == shape
    np.testing.assert_allclose(product, matrix.to_scipy().toarray() @ values, atol=1e-14)


def test_arrays_out_are_fresh_contiguous_float64_and_int32():
    mesh = ridgeform.Mesh(*shapes.open_cone())
    solution = ridgeform.denoise(mesh, mesh.vertices, fidelity=10)
    result = ridgeform.stylize(mesh, iterations=2)
    matrix = ridgeform.hessian(mesh)
    floats = [mesh.vertices, mesh.edge_lengths, ridgeform.voronoi_mass(mesh), matrix.data, solution.values]
    floats += [ridgeform.hessian_norm(mesh, mesh.vertices), result.vertices, result.energy, result.gap]
    integers = [
        mesh.faces,
        matrix.indptr,
        matrix.indices,
        *ridgeform.boundary_loops(mesh),
        result.solver_iterations,
    ]
    for arrays, dtype in ((floats, np.float64), (integers, np.int32)):
        for array in arrays:
            assert array.dtype == dtype
            assert array.flags.c_contiguous
            assert array.flags.writeable


@pytest.mark.parametrize(
    ("vertices", "faces", "message"),
    [
        (VERTICES[:, :2], FACES, r"vertices: expected an array of shape \(k, 3\), got shape \(4, 2\)"),
        (VERTICES.ravel(), FACES, r"vertices: .*got shape \(12,\)"),
        (VERTICES, FACES[:, :2], r"faces: .*got shape \(4, 2\)"),
        (VERTICES, 7, "faces: .*got a single number"),
        (VERTICES, [[0, 1, 1.5]], "faces: expected whole numbers, got 1.5"),
        (VERTICES, [[0, 1, np.nan]], "faces: expected whole numbers, got NaN"),
        (VERTICES, FACES.astype(bool), "faces: expected whole numbers, got booleans"),
        (VERTICES, "faces", "faces: expected an array of real numbers, got dtype <U5"),
        (None, FACES, "vertices: expected an array of real numbers, got dtype object"),
        (VERTICES * 1j, FACES, "vertices: expected an array of real numbers, got dtype complex128"),
        ([[0, 0, 0], [1, 1]], FACES, "vertices: expected an array of real numbers"),
    ],
)
def test_what_is_not_a_mesh_is_refused_in_a_sentence(vertices, faces, message):
    with pytest.raises(ridgeform.ArgumentError, match=message):
        ridgeform.Mesh(vertices, faces)


@pytest.mark.parametrize(
    ("values", "message"),
    [
        (
            np.zeros(3),
            r"values: expected one row for each vertex, shape \(4,\) or \(4, k\), got shape \(3,\)",
        ),
        (np.zeros((3, 4)), r"values: .*got shape \(3, 4\)"),
        (np.zeros((4, 0)), r"values: .*got shape \(4, 0\)"),
        (np.zeros((4, 2, 2)), r"values: .*got shape \(4, 2, 2\)"),
        (1.0, "values: .*got a single number"),
        ([0, 1, np.nan, 0], "values: row 2 holds NaN"),
        ([[0, 1], [1, 1], [0, 0], [0, np.inf]], "values: row 3 holds inf"),
        ([None] * 4, "values: .*dtype object"),
    ],
)
def test_values_are_checked_by_every_function(values, message):
    mesh = ridgeform.Mesh(VERTICES, FACES)
    for call in (
        lambda: ridgeform.hessian_norm(mesh, values),
        lambda: ridgeform.energy(mesh, values),
        lambda: ridgeform.denoise(mesh, values, fidelity=1.0),
    ):
        with pytest.raises(ridgeform.ArgumentError, match=message):
            call()


def test_masks_may_be_booleans_or_indices():
    mesh = ridgeform.Mesh(*shapes.icosphere(1))
    noisy = shapes.add_noise(*shapes.icosphere(1), 0.2)[:, 2]
    as_indices = ridgeform.denoise(mesh, noisy, fidelity=1.0, fixed=[3, 5, 3])
    mask = np.zeros(mesh.n_vertices, bool)
    mask[[3, 5]] = True
    as_mask = ridgeform.denoise(mesh, noisy, fidelity=1.0, fixed=mask)
    np.testing.assert_array_equal(as_indices.values, as_mask.values)
    assert as_mask.values[3] == noisy[3]
    none = ridgeform.denoise(mesh, noisy, fidelity=1.0, fixed=[])
    np.testing.assert_array_equal(none.values, ridgeform.denoise(mesh, noisy, fidelity=1.0).values)


@pytest.mark.parametrize(
    ("fixed", "message"),
    [
        ([4], "fixed: index 4 is out of range: there are 4 entries"),
        ([-1], "fixed: index -1 is out of range"),
        ([True, False], r"fixed: expected one entry for each vertex, shape \(4,\), got shape \(2,\)"),
        ([[0], [1]], r"fixed: expected vertex indices of shape \(k,\), got shape \(2, 1\)"),
        ([0.5], "fixed: expected whole numbers"),
    ],
)
def test_bad_masks_are_refused(fixed, message):
    mesh = ridgeform.Mesh(VERTICES, FACES)
    with pytest.raises(ridgeform.ArgumentError, match=message):
        ridgeform.denoise(mesh, VERTICES, fidelity=1.0, fixed=fixed)
    with pytest.raises(ridgeform.ArgumentError, match=message):
        ridgeform.stylize(mesh, fixed=fixed)


@pytest.mark.parametrize("dtype", [np.int32, np.int64])
def test_a_negative_vertex_is_named(dtype):
    with pytest.raises(ridgeform.MeshError, match=r"face 1 names vertex -7"):
        ridgeform.Mesh(np.eye(3), np.array([[0, 1, 2], [0, 1, -7]], dtype))
