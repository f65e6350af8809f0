"""The comparison energies: against dense NumPy, known values, and through `denoise` and `interpolate`."""

import numpy as np
import pytest
import ridgeform
from fuzz.calls import ENERGIES as KINDS
from known_shapes import shapes

QUADRATIC = [kind for kind in KINDS if kind.startswith("l2")]


def hat_gradients(corners):
    """Gradients (3,3) in space of the hat functions of a triangle, a row a corner; and its area."""
    normal = np.cross(corners[1] - corners[0], corners[2] - corners[0])
    opposite = np.roll(corners, -2, axis=0) - np.roll(corners, -1, axis=0)
    return np.cross(normal, opposite) / (normal @ normal), np.linalg.norm(normal) / 2


def boundary_vertices(faces):
    """The vertices of edges with one face."""
    edges = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
    distinct, counts = np.unique(edges, axis=0, return_counts=True)
    return np.unique(distinct[counts == 1])


def space_hessian(vertices, faces):
    """The integrals (n,3,3,n) of the gradients' products: Stein et al. 2018b, times the mass."""
    n = len(vertices)
    hessian = np.zeros((n, 3, 3, n))
    for face in faces:
        gradients, area = hat_gradients(vertices[face])
        for a in range(3):
            for b in range(3):
                hessian[face[a], :, :, face[b]] += area * np.outer(gradients[a], gradients[b])
    hessian[boundary_vertices(faces)] = 0
    return hessian


def edge_operator(vertices, faces):
    """He and Schaefer's area-based operator D, a row an inner edge, by the formula with dot products."""
    rows = []
    where = {}
    for face in faces:
        for i in range(3):
            where[face[i], face[(i + 1) % 3]] = face[(i + 2) % 3]
    for (i1, i3), i2 in where.items():
        if i1 < i3 and (i3, i1) in where:
            i4 = where[i3, i1]
            p1, p2, p3, p4 = vertices[[i1, i2, i3, i4]]
            first = np.linalg.norm(np.cross(p2 - p1, p3 - p1))
            second = np.linalg.norm(np.cross(p3 - p1, p4 - p1))
            total, squared = first + second, (p3 - p1) @ (p3 - p1)
            row = np.zeros(len(vertices))
            row[i1] = first * (p4 - p3) @ (p3 - p1) + second * (p1 - p3) @ (p3 - p2)
            row[i3] = first * (p3 - p1) @ (p1 - p4) + second * (p2 - p1) @ (p1 - p3)
            row[[i1, i3]] /= squared * total
            row[i2], row[i4] = second / total, first / total
            rows.append(row)
    return np.array(rows)


def dense_energy(kind, vertices, faces, mass, u):
    """The energy of u, from matrices that share nothing with the package but the mass."""
    if kind == "l1_edge_laplacian":
        return np.abs(edge_operator(vertices, faces) @ u).sum()
    hessian = space_hessian(vertices, faces) @ u
    if kind == "l1_hessian_stein2018":
        return np.abs(hessian).sum()
    if kind == "l2_hessian":
        return (hessian**2).sum(axis=(1, 2)) @ (1 / mass) / 2
    laplacian = np.zeros(len(u))
    for face in faces:
        gradients, area = hat_gradients(vertices[face])
        laplacian[face] += area * gradients @ gradients.T @ u[face]
    return (laplacian**2) @ (1 / mass) / 2


def flat_curved_energy(vertices, faces, u):
    """The Crouzeix-Raviart energy of a flat mesh, with edge vectors in one frame for all."""
    fields, areas = {}, {}
    for face in faces:
        gradients, area = hat_gradients(vertices[face])
        for i in range(3):
            edge = frozenset((int(face[(i + 1) % 3]), int(face[(i + 2) % 3])))
            fields[edge] = fields.get(edge, 0) + area * u[face] @ gradients
            areas[edge] = areas.get(edge, 0) + area
    energy = 0.0
    for face in faces:
        gradients, area = hat_gradients(vertices[face])
        edges = [frozenset((int(face[(i + 1) % 3]), int(face[(i + 2) % 3]))) for i in range(3)]
        slope = sum(-2 * np.outer(fields[e] / areas[e], g) for e, g in zip(edges, gradients, strict=True))
        energy += area * (slope**2).sum() / 2
    return energy


@pytest.mark.parametrize("kind", ["l2_hessian", "l2_laplacian", "l1_hessian_stein2018", "l1_edge_laplacian"])
@pytest.mark.parametrize("shape", [shapes.torus(9, 7), shapes.open_cone(), shapes.random_delaunay(30)])
def test_energies_equal_the_dense_ones(kind, shape):
    vertices, faces = shape
    vertices = shapes.add_noise(vertices, faces, 0.1, seed=3)
    mesh = ridgeform.Mesh(vertices, faces)
    u = np.random.default_rng(1).standard_normal(len(vertices))
    expected = dense_energy(kind, vertices, faces, ridgeform.voronoi_mass(mesh), u)
    assert ridgeform.energy(mesh, u, kind=kind) == pytest.approx(expected, rel=1e-10)


def test_the_curved_energy_of_a_flat_mesh_is_the_planar_one():
    vertices, faces = shapes.random_delaunay(50)
    u = np.random.default_rng(4).standard_normal(len(vertices))
    turned = vertices @ shapes.random_rotation(2).T
    expected = flat_curved_energy(vertices, faces, u)
    energy = ridgeform.energy(ridgeform.Mesh(turned, faces), u, kind="l2_curved_hessian")
    assert energy == pytest.approx(expected, rel=1e-9)


def test_the_l2_laplacian_interpolates_as_the_dense_system():
    vertices, faces = shapes.torus(12, 8)
    vertices = shapes.add_noise(vertices, faces, 0.1, seed=5)
    mesh = ridgeform.Mesh(vertices, faces)
    laplacian = np.zeros((len(vertices),) * 2)
    for face in faces:
        gradients, area = hat_gradients(vertices[face])
        laplacian[np.ix_(face, face)] += area * gradients @ gradients.T
    system = laplacian @ np.diag(1 / ridgeform.voronoi_mass(mesh)) @ laplacian
    known = np.arange(0, len(vertices), 7)
    free = np.setdiff1d(np.arange(len(vertices)), known)
    values = vertices[known][:, [0, 2]] ** 2
    expected = np.linalg.solve(system[np.ix_(free, free)], -system[np.ix_(free, known)] @ values)
    solution = ridgeform.interpolate(mesh, known, values, energy="l2_laplacian")
    np.testing.assert_allclose(solution.values[free], expected, atol=1e-9)
    np.testing.assert_array_equal(solution.values[known], values)
    assert (solution.status, solution.solver) == ("solved", "cholesky")
    assert solution.gap < 1e-9
    assert solution.objective == pytest.approx(
        ridgeform.energy(mesh, solution.values, kind="l2_laplacian"), rel=1e-9
    )


@pytest.mark.parametrize("kind", KINDS)
def test_every_energy_denoises_and_its_optimum_beats_its_neighbors(kind):
    vertices, faces = shapes.icosphere(2)
    mesh = ridgeform.Mesh(vertices, faces)
    rng = np.random.default_rng(7)
    data = np.abs(vertices[:, 0]) + 0.1 * rng.standard_normal(len(vertices))
    weights = rng.uniform(0.5, 2, len(faces))
    mass = ridgeform.voronoi_mass(mesh)
    solution = ridgeform.denoise(
        mesh, data, fidelity=20.0, energy=kind, fixed=[3, 8], face_weights=weights, tolerance=1e-6
    )

    def objective(u):
        energy = ridgeform.energy(mesh, u, kind=kind, face_weights=weights)
        return energy + 20.0 * mass @ (u - data) ** 2

    assert solution.status == "solved"
    assert solution.objective == pytest.approx(objective(solution.values), rel=1e-9)
    np.testing.assert_array_equal(solution.values[[3, 8]], data[[3, 8]])
    for size in (1e-4, 1e-2):
        other = solution.values + size * rng.standard_normal(len(data))
        other[[3, 8]] = data[[3, 8]]
        assert objective(other) > solution.objective * (1 - solution.gap)


@pytest.mark.parametrize("kind", ["l1_hessian_stein2018", "l1_edge_laplacian"])
def test_the_solvers_meet_in_their_certificates(kind):
    vertices, faces = shapes.random_delaunay(120)
    mesh = ridgeform.Mesh(vertices, faces)
    known = np.arange(0, len(vertices), 6)
    values = np.abs(vertices[known, 0] - 0.5)
    fast, exact = (
        ridgeform.interpolate(mesh, known, values, energy=kind, solver=solver, tolerance=tolerance)
        for solver, tolerance in (("fast", 1e-4), ("clarabel", 1e-7))
    )
    assert fast.status == "solved"
    assert exact.objective * (1 - 1e-6) <= fast.objective <= exact.objective * (1 + 1.1e-4)


@pytest.mark.parametrize("kind", [kind for kind in KINDS if kind != "l1_hessian"])
@pytest.mark.parametrize(("keyword", "value"), [("sharpness", 0.5), ("dual", "circumcentric")])
def test_what_only_our_energy_knows_is_refused_elsewhere(kind, keyword, value):
    mesh = ridgeform.Mesh(*shapes.icosphere(1))
    with pytest.raises(ridgeform.ArgumentError, match=f"^{keyword}: .*{kind}"):
        ridgeform.denoise(mesh, mesh.vertices, fidelity=1.0, energy=kind, **{keyword: value})


def test_quadratic_energies_refuse_conic_solvers_and_energies_in_space_refuse_lengths():
    mesh = ridgeform.Mesh(*shapes.icosphere(1))
    lengths = ridgeform.Mesh.from_edge_lengths(mesh.faces, mesh.edge_lengths)
    for kind in QUADRATIC:
        with pytest.raises(ridgeform.ArgumentError, match=f"^solver: .*{kind}"):
            ridgeform.interpolate(mesh, [0], [1.0], energy=kind, solver="clarabel")
    for kind in ("l2_hessian", "l1_hessian_stein2018"):
        with pytest.raises(ridgeform.MeshError, match="positions"):
            ridgeform.energy(lengths, mesh.vertices, kind=kind)


def test_circumcentric_dual_edges_without_length():
    vertices, faces = shapes.grid(5, 5)
    mesh = ridgeform.Mesh(vertices, faces)
    with pytest.raises(ridgeform.MeshError, match=r"faces 0 and \d+ .*circumcentric_or_barycentric"):
        ridgeform.denoise(mesh, vertices[:, 0], fidelity=1.0, dual="circumcentric")
    mixed = ridgeform.hessian(mesh, dual="circumcentric_or_barycentric")
    assert np.isfinite(mixed.data).all()
    ridge = np.abs(vertices[:, 0] - vertices[:, 0].mean())
    solution = ridgeform.denoise(mesh, ridge, fidelity=1.0, dual="circumcentric_or_barycentric")
    assert solution.status == "solved"


@pytest.mark.parametrize("kind", KINDS)
def test_delaunay_flips_before_solving(kind):
    vertices, faces = shapes.grid(10, 10)
    sheared = vertices @ np.array([[0.15, 0, 0], [0.9, 1, 0], [0, 0, 1]])
    mesh = ridgeform.Mesh(sheared, faces)
    flipped = ridgeform.intrinsic_delaunay(mesh)
    known, values = [0, 12, 57, 80], np.array([0.0, 1.0, 0.5, 2.0])
    if kind in ("l2_hessian", "l1_hessian_stein2018"):
        with pytest.raises(ridgeform.ArgumentError, match=f"^delaunay: .*{kind}"):
            ridgeform.interpolate(mesh, known, values, energy=kind, delaunay=True)
        return
    found = ridgeform.interpolate(mesh, known, values, energy=kind, delaunay=True)
    expected = ridgeform.interpolate(flipped, known, values, energy=kind)
    np.testing.assert_array_equal(found.values, expected.values)
    data = np.abs(sheared[:, 1] - sheared[:, 1].mean())
    weights = np.full(len(faces), 2.0)
    found = ridgeform.denoise(mesh, data, fidelity=2.0, energy=kind, delaunay=True, face_weights=weights)
    expected = ridgeform.denoise(flipped, data, fidelity=2.0, energy=kind, face_weights=weights)
    np.testing.assert_array_equal(found.values, expected.values)


def test_delaunay_mends_the_ridge_that_slivers_spoil():
    # Paper, fig. 11: an affine function from a few values, on slivers and on the same plane flipped.
    vertices, faces = shapes.random_delaunay(150, seed=4)
    squeezed = vertices * np.array([1.0, 0.02, 1.0])
    values = np.abs(squeezed[:, 0] - 0.4)
    known = np.arange(0, len(values), 4)
    errors = []
    for delaunay in (False, True):
        mesh = ridgeform.Mesh(squeezed, faces)
        solution = ridgeform.interpolate(mesh, known, values[known], delaunay=delaunay)
        errors.append(np.abs(solution.values - values).mean())
    assert errors[1] < errors[0]
