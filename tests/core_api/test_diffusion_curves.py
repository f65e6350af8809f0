"""Diffusion curves through the wheel: arrays, a reference for (27), edited curves, refusals."""

import numpy as np
import pytest
import ridgeform
from known_shapes import shapes


def lattice(n=12):
    """Equilateral triangles: Delaunay, and without obtuse angles at the rim."""
    x, y = np.meshgrid(np.arange(n + 1.0), np.arange(n + 1.0))
    vertices = np.column_stack([(x - 0.5 * y).ravel(), (y * 0.75**0.5).ravel(), 0 * x.ravel()])
    corner = (np.arange(n)[None, :] + (n + 1) * np.arange(n)[:, None]).ravel()
    right, up, across = corner + 1, corner + n + 1, corner + n + 2
    return vertices, np.vstack(
        [np.column_stack([corner, right, across]), np.column_stack([corner, across, up])]
    )


def halves(vertices, faces, axis=1):
    centers = vertices[faces].mean(axis=1)[:, axis]
    return (centers > centers.mean()).astype(np.int32)


def wavy(vertices):
    size = np.abs(vertices).max()
    return 0.5 + 0.4 * np.sin(2 * vertices / size)


def test_shapes_and_kinds_of_the_results():
    vertices, faces = lattice()
    mesh, labels, colors = ridgeform.Mesh(vertices, faces), halves(vertices, faces), wavy(vertices)
    found = ridgeform.diffusion_curves(mesh, colors, labels=labels)
    k = len(found.edges)
    assert found.left.shape == found.right.shape == (k, 2, 3)
    assert found.colors.shape == colors.shape
    assert found.corners.shape == (len(faces), 3, 3)
    assert found.starts.tolist() == [0, k]
    assert found.edges.dtype == found.labels.dtype == found.sides.dtype == np.int32
    assert (found.labels == labels).all()
    (line,) = found.polylines
    assert (line[:-1] == found.edges[:, 0]).all()
    assert line[-1] == found.edges[-1, 1]
    assert found.psnr == pytest.approx(-10 * np.log10(found.error))
    mass = ridgeform.voronoi_mass(mesh)
    error = (mass @ (found.colors - colors) ** 2).mean() / mass.sum()
    assert found.error == pytest.approx(error)
    assert found.n_numbers == 8 * (k + 1)
    assert found.n_numbers_before == colors.size
    assert "1 curves" in repr(found)
    single = ridgeform.diffusion_curves(mesh, colors[:, 0], labels=labels)
    assert single.left.shape == (k, 2)
    assert single.corners.shape == (len(faces), 3)
    assert single.colors.shape == (len(vertices),)
    assert np.abs(single.colors - found.colors[:, 0]).max() < 0.1


def test_the_colors_of_a_curve_minimize_27_on_each_side():
    linalg = pytest.importorskip("scipy.sparse.linalg")
    sparse = pytest.importorskip("scipy.sparse")
    vertices, faces = lattice()
    labels, colors = halves(vertices, faces), wavy(vertices)
    mesh = ridgeform.Mesh(vertices, faces)
    fidelity = 300.0
    found = ridgeform.diffusion_curves(mesh, colors, labels=labels, fidelity=fidelity, refine=False)
    area = ridgeform.voronoi_mass(mesh).sum()
    border = np.unique(found.edges)
    # A vertex on the border is on one side, or a blend: there it counts, elsewhere it is free.
    for label, side in ((0, found.left), (1, found.right)):
        own = faces[labels == label]
        used, local = np.unique(own, return_inverse=True)
        part = ridgeform.Mesh(vertices[used], local.reshape(-1, 3))
        weights = fidelity / area * ridgeform.voronoi_mass(part)
        here = (found.sides[used] >= 0) & (labels[found.sides[used]] == label)
        weights[np.isin(used, border) & ~here] = 0.0
        system = ridgeform.cotangent_laplacian(part).to_scipy() + sparse.diags(weights)
        expected = linalg.spsolve(system.tocsc(), weights[:, None] * colors[used])
        place = np.searchsorted(used, found.edges)
        np.testing.assert_allclose(side, expected[place], atol=1e-6)


@pytest.mark.parametrize("count", [2, 5])
def test_regions_are_found_by_their_colors(count):
    vertices, faces = lattice(30)
    place = (vertices[:, 0] - vertices[:, 0].min()) / np.ptp(vertices[:, 0])
    region = np.minimum((count * place).astype(int), count - 1)
    palette = np.random.default_rng(5).random((count, 3))
    mesh = ridgeform.Mesh(vertices, faces)
    found = ridgeform.diffusion_curves(mesh, palette[region])
    assert found.labels.max() + 1 == count
    # Borders follow the paint exactly, also where they meet the slanted rim at a single vertex.
    assert found.psnr > 100
    assert count - 1 <= len(found.polylines) <= count + 1
    groups = np.arange(len(faces)) % (len(faces) // 2)
    squares = ridgeform.diffusion_curves(mesh, palette[region], face_groups=groups)
    assert (squares.labels[: len(groups) // 2] == squares.labels[len(groups) // 2 :]).all()
    assert squares.psnr > 100
    fewer = ridgeform.diffusion_curves(mesh, palette[region], n_regions=count - 1)
    assert fewer.labels.max() + 1 == count - 1


def test_redrawing_edited_curves():
    vertices, faces = shapes.icosphere(3)
    labels = halves(vertices, faces, axis=2)
    mesh = ridgeform.Mesh(vertices, faces)
    colors = np.where(vertices[:, 2:] > 0, [0.8, 0.2, 0.1], [0.1, 0.2, 0.8])
    found = ridgeform.diffusion_curves(mesh, colors, labels=labels)
    same = ridgeform.redraw(mesh, found.edges, found.left, found.right, sides=found.sides)
    assert (same.colors == found.colors).all()
    assert (same.corners == found.corners).all()
    edited = ridgeform.redraw(
        mesh, found.edges, np.full_like(found.left, 0.5), found.right, sides=found.sides
    )
    lower = labels == 0
    assert np.abs(edited.corners[lower] - 0.5).max() < 1e-12
    assert np.abs(edited.corners[~lower] - found.corners[~lower]).max() < 1e-12
    assert "642 vertices" in repr(edited)


def test_a_piece_without_a_curve_has_a_point():
    vertices, faces = lattice(4)
    mesh = ridgeform.Mesh(vertices, faces)
    found = ridgeform.diffusion_curves(mesh, np.full((25, 4), 0.25), labels=np.zeros(len(faces), int))
    assert found.edges.shape == (0, 2)
    assert found.points.tolist() == [0]
    assert found.point_colors.shape == (1, 4)
    assert found.polylines == []
    drawn = ridgeform.redraw(
        mesh, found.edges, found.left, found.right, points=found.points, point_colors=found.point_colors
    )
    assert np.abs(drawn.colors - 0.25).max() < 1e-12


def test_refusals(cancelled):
    vertices, faces = lattice(3)
    mesh = ridgeform.Mesh(vertices, faces)
    colors, labels = np.zeros((16, 3)), np.zeros(len(faces), int)
    cases = (
        ({"colors": np.zeros((15, 3))}, "colors: expected one row for each vertex"),
        ({"labels": labels[1:]}, "labels: expected one entry for each face"),
        ({"labels": labels + 0.5}, "labels: expected whole numbers"),
        ({"fidelity": -1.0}, "fidelity: is -1; it must be positive"),
        ({"color_error": np.nan}, "color_error"),
        ({"labels": None, "face_groups": [0]}, "face_groups: expected one entry for each face"),
        ({"labels": None, "fidelity": 0}, "fidelity: is 0; it must be positive"),
    )
    for changed, message in cases:
        given = {"colors": colors, "labels": labels, **changed}
        with pytest.raises(ridgeform.ArgumentError, match=message):
            ridgeform.diffusion_curves(mesh, given.pop("colors"), **given)
    cases = (
        (([[0, 16]], np.zeros((1, 2)), np.zeros((1, 2))), "edges: row 0: vertex 16 does not exist"),
        (([[0, 15]], np.zeros((1, 2)), np.zeros((1, 2))), "no edge of the mesh joins vertices 0 and 15"),
        (([[0, 1]], np.zeros((1, 3)), np.zeros((1, 2))), r"left: expected shape \(1, 2, c\)"),
        (([[0, 1]], np.zeros((1, 2, 3)), np.zeros((1, 2))), "right: needs the shape of left"),
    )
    for arguments, message in cases:
        with pytest.raises(ridgeform.ArgumentError, match=message):
            ridgeform.redraw(mesh, *arguments)
    with pytest.raises(ridgeform.ArgumentError, match="sides: -2 is no face"):
        ridgeform.redraw(mesh, [[0, 1]], np.zeros((1, 2)), np.zeros((1, 2)), sides=np.full(16, -2))
    with pytest.raises(ridgeform.Cancelled):
        ridgeform.diffusion_curves(mesh, colors, labels=labels, progress=cancelled)
