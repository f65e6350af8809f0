"""`facet`: known polyhedra under noise, surfaces that stay closed, planes, masks, counts, refusals."""

from collections import Counter
from pathlib import Path

import numpy as np
import pytest
import ridgeform
from known_shapes import segment_shapes, shapes

SOURCES = Path(__file__).parents[2] / "blend_fixtures/sources"


def source(name):
    with np.load(SOURCES / f"{name}.npz") as data:
        return data["vertices"].astype(float), data["faces"].astype(np.int64)


def polygons(found):
    return np.split(found.polygon_vertices, found.polygon_starts[1:-1])


def directed_sides(rings):
    return Counter((a, b) for ring in rings for a, b in zip(ring, np.roll(ring, -1), strict=True))


def off_planes(found):
    """The largest distance of a corner from the plane of one of its facets."""
    planes = found.planes[found.face_facets]
    heights = (planes[:, None, :3] * found.vertices[found.faces]).sum(2) - planes[:, None, 3]
    return np.abs(heights).max()


def check_sound(found, size, *, is_closed=True):
    """Flat to 1e-6 of the size, simple polygons, every side once, none of them open, nothing crosses."""
    assert np.isfinite(found.vertices).all()
    assert off_planes(found) <= 1e-6 * size
    for rings in (polygons(found), list(found.faces)):
        sides = directed_sides([ring.tolist() for ring in rings])
        assert all(len(set(ring.tolist())) == len(ring) >= 3 for ring in rings)
        assert set(sides.values()) == {1}
        if is_closed:
            assert all((b, a) in sides for a, b in sides)
    assert found.n_crossings == 0
    np.testing.assert_allclose(np.linalg.norm(found.planes[:, :3], axis=1), 1)
    assert set(np.unique(found.face_facets)) == set(range(len(found.planes)))


def volume(vertices, faces):
    a, b, c = (vertices[faces[:, i]] for i in range(3))
    return np.einsum("ij,ij->", a, np.cross(b, c)) / 6


@pytest.mark.parametrize(
    ("name", "n", "n_corners"),
    [("cube", 6, 8), ("house", 7, 10), ("dodecahedron", 12, 20), ("l_shape", 8, 12)],
)
@pytest.mark.parametrize("noise", [0.0, 0.15])
def test_a_noisy_polyhedron_comes_back(name, n, n_corners, noise):
    part = getattr(segment_shapes, name)(1)
    noisy = part.turned(1).noisy(noise, 2)
    found = ridgeform.facet(ridgeform.Mesh(noisy.vertices, noisy.faces))
    exact = part.turned(1)
    size = np.ptp(exact.vertices, axis=0).max()
    check_sound(found, size)
    assert found.n_facets == n == len(polygons(found))
    edges = exact.vertices[exact.faces[:, 0]] - exact.vertices[exact.faces[:, 1]]
    sigma = noise * np.linalg.norm(edges, axis=1).mean()
    corners = np.linalg.norm(found.vertices[:, None] - exact.vertices[None], axis=2).min(1)
    assert corners.max() <= max(1.6 * sigma, 1e-6 * size), corners
    assert len(found.vertices) == n_corners
    assert segment_shapes.adjusted_rand_index(found.labels, exact.truth) >= 0.97


@pytest.mark.parametrize("name", ["cube", "house"])
def test_faces_that_noise_has_turned_over_do_not_turn_planes(name):
    exact = getattr(segment_shapes, name)(2)
    noisy = exact.noisy(0.3, 2)
    found = ridgeform.facet(ridgeform.Mesh(noisy.vertices, noisy.faces))
    edges = exact.vertices[exact.faces[:, 0]] - exact.vertices[exact.faces[:, 1]]
    sigma = 0.3 * np.linalg.norm(edges, axis=1).mean()
    corners = np.linalg.norm(found.vertices[:, None] - exact.vertices[None], axis=2).min(1)
    assert found.n_facets == exact.n_parts
    assert corners.max() <= sigma


@pytest.mark.parametrize("name", ["bust", "spot"])
@pytest.mark.parametrize("facets", [30, 200])
def test_what_is_closed_stays_closed_and_near(name, facets):
    vertices, faces = source(name)
    found = ridgeform.facet(ridgeform.Mesh(vertices, faces), facets=facets)
    size = np.linalg.norm(np.ptp(vertices, axis=0))
    check_sound(found, size)
    assert abs(found.n_facets - facets) <= 0.03 * facets + 1
    assert found.rms <= 0.4 / facets * size
    assert volume(found.vertices, found.faces) == pytest.approx(volume(vertices, faces), rel=0.1)
    assert found.labels.min() >= 0 and found.labels.max() < found.n_facets


def test_more_facets_are_nearer_and_come_from_the_first_call():
    vertices, faces = source("bust")
    first = ridgeform.facet(ridgeform.Mesh(vertices, faces), facets=40)
    finer = first.at(facets=160)
    assert finer.rms < 0.5 * first.rms
    again = ridgeform.facet(ridgeform.Mesh(vertices, faces), facets=160)
    np.testing.assert_array_equal(finer.vertices, again.vertices)
    np.testing.assert_array_equal(finer.polygon_vertices, again.polygon_vertices)
    near = first.at(error=0.004)
    assert near.rms <= 0.004 * 1.1
    assert near.n_facets > first.n_facets or first.rms <= 0.004


def barn(n):
    """A box of side 2 cut into (n, n) squares a side, with a roof of three planes: the ridge is a strip, one
    square wide, that is 0.3 % of the size (root mean square) from the two planes beside it."""
    vertices, faces = shapes.cube(n)
    top = vertices[:, 2] > 0.99
    vertices[top, 2] += 0.8 * (1 - np.abs(vertices[top, 0]))
    return vertices.astype(np.float32), faces


def test_a_mesh_of_planes_keeps_them_all_and_is_not_cut_up():
    vertices, faces = barn(7)
    mesh = ridgeform.Mesh(vertices, faces)
    for asked in (None, 8, 60):
        found = ridgeform.facet(mesh, facets=asked)
        assert found.n_facets == len(polygons(found)) == 8
        assert found.largest < 1e-6
        check_sound(found, 4)
    assert ridgeform.facet(mesh, facets=7).n_facets == 7


def test_the_result_turns_and_grows_with_the_mesh_and_is_the_same_on_any_threads():
    part = segment_shapes.house(2).noisy(0.1, 5)
    plain = ridgeform.facet(ridgeform.Mesh(part.vertices, part.faces), facets=7, threads=1)
    rotation = shapes.random_rotation(4)
    moved = 1e3 * part.vertices @ rotation.T + [5.0, -3.0, 1e3]
    found = ridgeform.facet(ridgeform.Mesh(moved, part.faces), facets=7, threads=2)
    np.testing.assert_array_equal(found.labels, plain.labels)
    np.testing.assert_allclose(
        found.vertices, 1e3 * plain.vertices @ rotation.T + [5.0, -3.0, 1e3], atol=2e-2
    )
    same = ridgeform.facet(ridgeform.Mesh(part.vertices, part.faces), facets=7, threads=2)
    np.testing.assert_array_equal(same.vertices, plain.vertices)


def test_faces_outside_the_mask_keep_their_bits():
    vertices, faces = source("bust")
    selected = vertices[faces].mean(1)[:, 0] > np.median(vertices[:, 0])
    found = ridgeform.facet(ridgeform.Mesh(vertices, faces), facets=40, faces=selected)
    assert found.labels[~selected].min() >= found.n_facets
    kept = {tuple(sorted(map(tuple, vertices[face]))) for face in faces[~selected]}
    made = {tuple(sorted(map(tuple, found.vertices[face]))) for face in found.faces}
    assert kept <= made
    assert off_planes(found) <= 1e-6 * np.linalg.norm(np.ptp(vertices, axis=0))


def test_an_open_sheet_keeps_its_outline():
    vertices, faces = shapes.grid(12, 9)
    found = ridgeform.facet(ridgeform.Mesh(vertices, faces))
    check_sound(found, 1.0, is_closed=False)
    assert found.n_facets == 1
    assert len(found.vertices) == 4
    area = (
        0.5
        * np.linalg.norm(
            np.cross(
                *(found.vertices[found.faces[:, i]] - found.vertices[found.faces[:, 0]] for i in (1, 2))
            ),
            axis=1,
        ).sum()
    )
    expected = np.prod(np.ptp(vertices, axis=0)[:2])
    assert area == pytest.approx(expected)


def test_a_facet_with_a_hole_becomes_polygons_without():
    vertices, faces = shapes.voxels([(x, y, 0) for x in range(3) for y in range(3) if (x, y) != (1, 1)], 2)
    found = ridgeform.facet(ridgeform.Mesh(vertices, faces))
    check_sound(found, 3.0)
    assert found.n_facets == 10
    assert len(found.vertices) == 16
    assert np.bincount(found.polygon_facets).tolist().count(2) == 2


def test_painted_edges_attract_the_borders():
    vertices, faces = shapes.voxels([(0, 0, 0)], 8)
    center = vertices[faces].mean(1)
    top = center[:, 2] > center[:, 2].max() - 1e-9
    left = top & (center[:, 0] < 0.5 * (vertices[:, 0].min() + vertices[:, 0].max()))
    first, second, edges = segment_shapes.face_pairs(faces)
    crossing = {
        tuple(sorted(edge))
        for edge in edges[(left[first] != left[second]) & top[first] & top[second]].tolist()
    }
    weights = np.ones((len(faces), 3))
    for f, face in enumerate(faces.tolist()):
        for i in range(3):
            if tuple(sorted((face[(i + 1) % 3], face[(i + 2) % 3]))) in crossing:
                weights[f, i] = 0.0
    rng = np.random.default_rng(3)
    noisy = vertices + 1e-3 * rng.normal(size=vertices.shape)
    found = ridgeform.facet(ridgeform.Mesh(noisy, faces), facets=7, edge_weights=weights)
    assert len(np.unique(found.labels[top])) == 2
    assert segment_shapes.adjusted_rand_index(found.labels[top], left[top].astype(int)) == 1


def n_passing(vertices, faces):
    """How many edges pass through the inside of a triangle that they do not touch."""

    def volumes(a, b, c, d):
        return np.einsum("...i,...i->...", np.cross(b - a, c - a), d - a)

    corners = vertices[faces]
    least = 1e-12 * np.ptp(vertices, axis=0).max() ** 3
    passing = 0
    for p, q in {tuple(sorted((face[i], face[i - 1]))) for face in faces.tolist() for i in range(3)}:
        apart = ~((faces == p) | (faces == q)).any(1)
        (a, b, c), p_at, q_at = corners[apart].transpose(1, 0, 2), vertices[p], vertices[q]
        ends = volumes(a, b, c, p_at) * volumes(a, b, c, q_at)
        around = np.stack([volumes(p_at, q_at, x, y) for x, y in ((a, b), (b, c), (c, a))])
        inside = (around > least).all(0) | (around < -least).all(0)
        passing += int((inside & (ends < -(least**2))).sum())
    return passing


def area(vertices, faces):
    a, b, c = vertices[faces].transpose(1, 0, 2)
    return 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1).sum()


def thin_shapes():
    rng = np.random.default_rng(7)
    for name, n, m, tube in (("fine torus", 64, 24, 0.33), ("coarse torus", 36, 8, 0.2)):
        around, across = (np.arange(k) * 2 * np.pi / k for k in (n, m))
        u, v = (angle.ravel() for angle in np.meshgrid(around, across, indexing="ij"))
        out = 1 + tube * np.cos(v)
        i, j = np.divmod(np.arange(n * m), m)
        a, b, c, d = ((i + x) % n * m + (j + y) % m for x, y in ((0, 0), (1, 0), (1, 1), (0, 1)))
        faces = np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])
        yield name, np.stack([out * np.cos(u), out * np.sin(u), tube * np.sin(v)], 1), faces
    sphere, faces = shapes.voxels([(0, 0, 0)], 8)
    sphere = sphere - sphere.mean(0)
    sphere /= np.linalg.norm(sphere, axis=1, keepdims=True)
    waves = 1 + 0.2 * np.sin(4 * sphere @ rng.normal(size=3))
    yield "thin and open", waves[:, None] * sphere * [1, 0.8, 0.15], faces[rng.random(len(faces)) > 0.03]


@pytest.mark.parametrize(
    ("name", "vertices", "faces"), [pytest.param(*case, id=case[0]) for case in thin_shapes()]
)
@pytest.mark.parametrize("facets", [None, 12, 100])
def test_no_facet_passes_through_another(name, vertices, faces, facets):
    assert n_passing(vertices, faces) == 0
    found = ridgeform.facet(ridgeform.Mesh(vertices, faces), facets=facets)
    if "torus" in name:
        check_sound(found, 3.0)
        if facets != 12:
            assert area(found.vertices, found.faces) <= 1.2 * area(vertices, faces)
    assert off_planes(found) <= 3e-6
    assert found.n_crossings == 0
    assert n_passing(found.vertices, found.faces) == 0
    assert found.n_facets < len(faces) / 2


def wavy_sphere(seed, *, thickness, share_of_holes=0.0):
    """A thin sphere with waves, without some of its faces."""
    rng = np.random.default_rng(seed)
    vertices, faces = shapes.voxels([(0, 0, 0)], 8)
    vertices = vertices - vertices.mean(0)
    vertices /= np.linalg.norm(vertices, axis=1, keepdims=True)
    vertices *= (1 + 0.2 * np.sin(4 * vertices @ rng.normal(size=3)))[:, None]
    return vertices * [1, 0.8, thickness], faces[rng.random(len(faces)) >= share_of_holes]


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("facets", [12, 30])
def test_thin_shapes_come_in_the_number_that_is_asked_for(seed, facets):
    vertices, faces = wavy_sphere(seed, thickness=0.1)
    found = ridgeform.facet(ridgeform.Mesh(vertices, faces), facets=facets)
    check_sound(found, 2.0)
    assert found.n_facets == facets == len(found.planes)
    assert n_passing(found.vertices, found.faces) == 0


@pytest.mark.parametrize(("seed", "thickness", "share"), [(1, 0.1, 0.03), (3, 0.3, 0.1), (4, 0.1, 0.1)])
def test_no_edge_is_used_twice_where_holes_are_many(seed, thickness, share):
    vertices, faces = wavy_sphere(seed, thickness=thickness, share_of_holes=share)
    found = ridgeform.facet(ridgeform.Mesh(vertices, faces), facets=12)
    for rings in (polygons(found), list(found.faces)):
        assert set(directed_sides([ring.tolist() for ring in rings]).values()) == {1}
    assert found.n_crossings == 0


def test_what_passes_through_on_the_mesh_may_do_so():
    vertices, faces = shapes.voxels([(0, 0, 0)], 4)
    both = np.vstack([vertices, vertices + np.array([0.52, 0.41, 0.33])])
    found = ridgeform.facet(ridgeform.Mesh(both, np.vstack([faces, faces + len(vertices)])))
    assert (found.n_facets, found.n_crossings) == (12, 0)
    assert n_passing(found.vertices, found.faces) > 0


def hostile():
    sphere = shapes.voxels([(0, 0, 0)], 4)
    yield (
        "bow tie",
        np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0.0]]),
        [[0, 1, 2], [0, 3, 4]],
    )
    yield (
        "fin",
        np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1.0]]),
        [[0, 1, 2], [1, 0, 3], [0, 1, 4]],
    )
    yield "one face twice", np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0.0]]), [[0, 1, 2], [0, 1, 2]]
    yield "pillow", np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0.0]]), [[0, 1, 2], [0, 2, 1]]
    yield (
        "sliver",
        np.array([[0, 0, 0], [1, 0, 0], [2, 0, 0], [0, 1, 0.0]]),
        [[0, 1, 2], [0, 2, 3], [1, 1, 3]],
    )
    yield (
        "turned",
        sphere[0],
        np.where(np.arange(len(sphere[1]))[:, None] % 3 == 0, sphere[1][:, ::-1], sphere[1]),
    )
    yield "loose", np.vstack([sphere[0], [[9, 9, 9.0]]]), sphere[1]
    soup = sphere[0][sphere[1]].reshape(-1, 3)
    yield "soup", soup, np.arange(len(soup)).reshape(-1, 3)


@pytest.mark.parametrize(
    ("name", "vertices", "faces"), [pytest.param(*case, id=case[0]) for case in hostile()]
)
@pytest.mark.parametrize("facets", [None, 1, 5])
def test_any_mesh_gives_a_finite_answer(name, vertices, faces, facets):
    found = ridgeform.facet(ridgeform.Mesh(vertices, faces), facets=facets)
    assert np.isfinite(found.vertices).all()
    assert found.faces.max() < len(found.vertices)
    assert len(found.labels) == len(faces)
    if name in {"soup", "turned", "loose"} and facets is None:
        assert found.n_facets == 6


def test_faces_that_lie_on_each_other_and_corners_named_twice_give_an_answer():
    vertices = np.random.default_rng(0).normal(size=(4, 3))
    faces = [[1, 3, 2], [0, 3, 2], [3, 0, 0], [3, 0, 2], [0, 1, 1], [1, 1, 0]]
    for facets in (None, 1, 2, 10):
        found = ridgeform.facet(ridgeform.Mesh(vertices, faces), facets=facets)
        assert np.isfinite(found.vertices).all()
        # One keeps no face's distance small; where no number is asked for, every face has its own.
        assert found.n_facets == (3 if facets is None else 1)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"facets": 0}, "facets"),
        ({"error": 0.0}, "error"),
        ({"error": np.nan}, "error"),
        ({"edge_weights": np.ones((2, 3))}, "edge_weights"),
        ({"faces": [99]}, "faces"),
        ({"threads": 0}, "threads"),
    ],
)
def test_wrong_arguments_are_named(arguments, message):
    vertices, faces = shapes.voxels([(0, 0, 0)], 1)
    with pytest.raises(ridgeform.ArgumentError, match=message):
        ridgeform.facet(ridgeform.Mesh(vertices, faces), **arguments)


def test_a_mesh_without_positions_is_refused():
    mesh = ridgeform.Mesh.from_edge_lengths(np.array([[0, 1, 2]]), np.ones((1, 3)))
    with pytest.raises(ridgeform.MeshError):
        ridgeform.facet(mesh)


def test_a_call_can_be_canceled():
    vertices, faces = source("bust")
    progress = ridgeform.Progress()
    progress.cancel()
    with pytest.raises(ridgeform.Cancelled):
        ridgeform.facet(ridgeform.Mesh(vertices, faces), progress=progress)
