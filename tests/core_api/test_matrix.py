"""`SparseMatrix`: compressed rows, products, and the way to SciPy."""

import sys

import numpy as np
import pytest
import ridgeform
from known_shapes import shapes


@pytest.fixture
def matrix():
    """A Hessian that is not square."""
    return ridgeform.hessian(ridgeform.Mesh(*shapes.icosphere(1)))


def test_the_arrays_are_compressed_rows(matrix):
    rows, columns = matrix.shape
    assert (rows, columns) == (320, 42)
    assert matrix.indptr.shape == (rows + 1,)
    assert matrix.indptr[0] == 0
    assert matrix.indptr[-1] == matrix.nnz == len(matrix.indices) == len(matrix.data)
    for start, end in zip(matrix.indptr[:-1], matrix.indptr[1:], strict=True):
        assert (np.diff(matrix.indices[start:end]) > 0).all()
    assert 0 <= matrix.indices.min() <= matrix.indices.max() < columns
    assert repr(matrix) == f"<ridgeform.SparseMatrix: 320 x 42, {matrix.nnz} entries>"


def test_scipy_gets_the_same_matrix(matrix):
    scipy_matrix = matrix.to_scipy()
    assert scipy_matrix.shape == matrix.shape
    assert scipy_matrix.has_canonical_format
    np.testing.assert_array_equal(scipy_matrix.data, matrix.data)
    scipy_matrix.data[:] = 0
    assert np.abs(matrix.data).max() > 0


def test_products_are_those_of_the_dense_matrix(matrix):
    dense = matrix.to_scipy().toarray()
    rng = np.random.default_rng(1)
    for shape in [(42,), (42, 1), (42, 5)]:
        x = rng.standard_normal(shape)
        np.testing.assert_allclose(matrix @ x, dense @ x, atol=1e-12)
    with pytest.raises(
        ridgeform.ArgumentError, match="array: expected one row for each column of the matrix"
    ):
        matrix @ np.zeros(41)


def test_products_from_the_left_are_refused(matrix):
    with pytest.raises(TypeError):
        np.zeros(320) @ matrix


def test_scipy_is_optional(matrix, monkeypatch):
    monkeypatch.setitem(sys.modules, "scipy", None)
    monkeypatch.setitem(sys.modules, "scipy.sparse", None)
    with pytest.raises(ImportError, match="to_scipy needs SciPy"):
        matrix.to_scipy()
    assert (matrix @ np.ones(42)).shape == (320,)
