"""`restore`: known parts come back from noise, and what is held or not sure stays as it is."""

import json
from pathlib import Path

import numpy as np
import pytest
import ridgeform
from hypothesis import given, settings
from known_shapes import coarse_shapes, segment_shapes, shapes
from test_reliability import finite_or_refused, triangle_soups

SOURCES = Path(__file__).parents[2] / "blend_fixtures/sources"


def normals_of(vertices, faces):
    a, b, c = (vertices[faces[:, i]] for i in range(3))
    normals = np.cross(b - a, c - a)
    return normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)


def mean_angle(vertices, truth, faces):
    """Mean angle in degrees of the faces to the true ones."""
    cosines = (normals_of(vertices, faces) * normals_of(truth, faces)).sum(axis=1)
    return np.degrees(np.arccos(np.clip(cosines, -1, 1))).mean()


def kinds(result):
    return sorted(surface["kind"] for surface in result.surfaces)


@pytest.fixture(scope="module")
def noisy_cube():
    return shapes.noisy_cube(0)


@pytest.fixture(scope="module")
def found(noisy_cube):
    return ridgeform.restore(ridgeform.Mesh(*noisy_cube))


def test_a_noisy_cube_comes_back(noisy_cube, found):
    truth, faces = shapes.cube(16, 2.0)
    assert found.status == "restored"
    assert kinds(found) == ["plane"] * 6
    assert found.n_folded == found.n_held == 0
    # Six planes of 289 noisy vertices each are known to 0.0019; six at right angles to 0.0014.
    assert shapes.root_mean_square(shapes.distance_to_cube(found.vertices)) < 0.003
    assert mean_angle(found.vertices, truth, faces) < 0.25
    regular = ridgeform.restore(ridgeform.Mesh(*noisy_cube), regularize=3.0)
    assert shapes.root_mean_square(shapes.distance_to_cube(regular.vertices)) < 0.0025
    planes = np.array([surface["normal"] for surface in regular.surfaces])
    cosines = np.abs(planes @ planes.T)
    assert np.minimum(cosines, 1 - cosines).max() < 1e-12
    assert len(regular.relations) == 2


@pytest.mark.parametrize(
    ("name", "count"), [("cube", 6), ("gabled house", 7), ("dodecahedron", 12), ("L-shape", 8)]
)
def test_polyhedra_have_their_planes_and_corners(name, count):
    part = segment_shapes.SHAPES[name](1).turned(3)
    noise = 0.1 * shapes.mean_edge_length(part.vertices, part.faces)
    result = ridgeform.restore(ridgeform.Mesh(part.noisy(0.1, 5).vertices, part.faces))
    assert kinds(result) == ["plane"] * count
    corners = [
        v for v in range(len(part.vertices)) if len(set(part.truth[(part.faces == v).any(axis=1)])) >= 3
    ]
    away = np.linalg.norm(result.vertices[corners] - part.vertices[corners], axis=1)
    assert len(corners) >= 8
    # Three planes of N noisy vertices each are known in their corners to √(21 / N) of the noise: 0.27 to 0.4.
    assert away.max() < noise
    assert np.sqrt((away**2).mean()) < 0.5 * noise
    for k, surface in enumerate(result.surfaces):
        vertices = np.unique(part.faces[result.labels == k])
        heights = result.vertices[vertices] @ surface["normal"] - surface["offset"]
        assert np.abs(heights).max() < 1e-9


def test_cylinders_spheres_and_cones_are_named():
    part = segment_shapes.cylinder(0).turned(2)
    result = ridgeform.restore(ridgeform.Mesh(part.noisy(0.2, 1).vertices, part.faces))
    assert kinds(result) == ["cylinder", "plane", "plane"]
    curved = next(surface for surface in result.surfaces if surface["kind"] == "cylinder")
    assert curved["radius"] == pytest.approx(1.0, abs=0.01)
    assert abs(np.dot(curved["axis"], shapes.random_rotation(2)[:, 2])) == pytest.approx(1.0, abs=1e-4)
    assert not curved["inside"]
    assert mean_angle(result.vertices, part.vertices, part.faces) < 1.5
    vertices, faces = shapes.icosphere(4)
    noisy = shapes.add_noise(vertices, faces, 0.1, 4)
    ball = ridgeform.restore(ridgeform.Mesh(noisy, faces))
    assert kinds(ball) == ["sphere"]
    assert np.abs(np.linalg.norm(ball.vertices - ball.surfaces[0]["center"], axis=1) - 1.0).max() < 2e-3
    bore = ridgeform.restore(ridgeform.Mesh(noisy, faces[:, ::-1]))
    assert bore.surfaces[0]["inside"]


def test_an_exact_part_stays_as_it_is():
    part = segment_shapes.house(0)
    result = ridgeform.restore(ridgeform.Mesh(part.vertices, part.faces))
    assert kinds(result) == ["plane"] * 7
    assert np.abs(result.vertices - part.vertices).max() < 1e-5


@pytest.mark.parametrize("single", [False, True])
@pytest.mark.parametrize("n", [16, 24, 32, 64])
def test_a_cylinder_of_two_rims_is_no_sphere_and_stays_as_it_is(n, single):
    vertices, faces = two_rims(n)
    if single:
        vertices = vertices.astype(np.float32).astype(float)
    result = ridgeform.restore(ridgeform.Mesh(vertices, faces))
    assert kinds(result)[0] == "cylinder"
    assert set(kinds(result)[1:]) <= {"plane", "free"}
    assert len(set(result.labels[: 2 * n])) == 1
    assert len(set(result.labels[2 * n : 3 * n - 2])) == len(set(result.labels[3 * n - 2 :])) == 1
    assert result.n_folded == 0
    # Slivers of the fans that caps are made of are not relaxed.
    assert np.abs(result.vertices - vertices).max() < 1e-6


@pytest.mark.parametrize("height", [0.7, 2.0])
def test_a_cone_without_vertices_between_is_no_plane(height):
    rim = two_rims(32)[0][:32]
    vertices = np.concatenate([rim, [[0, 0, height - 1.0], [0, 0, -1.0]]])
    i, j = np.arange(32), (np.arange(32) + 1) % 32
    faces = np.concatenate([np.stack([i, j, 0 * i + 32], 1), np.stack([j, i, 0 * i + 33], 1)])
    result = ridgeform.restore(ridgeform.Mesh(vertices, faces))
    assert kinds(result) == ["cone", "plane"]
    assert np.abs(result.vertices - vertices).max() < 1e-6


def two_rims(n):
    """A cylinder of n sides without vertices between its rims; a fan of triangles is each cap."""
    angle = 2 * np.pi * np.arange(n) / n
    rim = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    vertices = np.concatenate([np.insert(rim, 2, height, axis=1) for height in (-1.0, 1.0)])
    i, j = np.arange(n), (np.arange(n) + 1) % n
    k = np.arange(1, n - 1)
    sides = [np.stack([i, j, n + j], axis=1), np.stack([i, n + j, n + i], axis=1)]
    caps = [np.stack([0 * k, k + 1, k], axis=1), np.stack([0 * k + n, n + k, n + k + 1], axis=1)]
    return vertices, np.concatenate(sides + caps)


def test_a_character_is_not_sure_and_stays_bit_by_bit():
    with np.load(SOURCES / "spot_low_resolution.npz") as data:
        vertices, faces = data["vertices"].astype(float), data["faces"].astype(np.int64)
    result = ridgeform.restore(ridgeform.Mesh(vertices, faces))
    assert result.status == "unsure", result.surfaces
    assert {surface["kind"] for surface in result.surfaces} == {"free"}
    np.testing.assert_array_equal(result.vertices, vertices)


@pytest.mark.parametrize(("n", "noise"), [(25, 0.1), (37, 0.2)])
def test_narrow_fillets_are_not_pulled_into_sharp_edges(n, noise):
    radius = 0.1
    truth, faces = shapes.rounded_box(n, radius)
    edge = shapes.mean_edge_length(truth, faces)
    core = np.abs(truth).max(axis=0) - radius
    vertices = truth + np.random.default_rng(3).normal(scale=noise * edge, size=truth.shape)
    result = ridgeform.restore(ridgeform.Mesh(vertices, faces))
    away = np.abs(result.vertices) - core
    off = np.linalg.norm(np.maximum(away, 0.0), axis=1) + np.minimum(away.max(axis=1), 0.0) - radius
    # With every vertex on the surface of its label, it was 1.35 and 0.67 times the noise; now 0.4 and 0.25.
    assert shapes.root_mean_square(off) < 0.5 * noise * edge
    assert {"free", "plane"} <= set(kinds(result))


@pytest.mark.parametrize("noise", [0.1, 0.2])
def test_surfaces_that_no_crease_parts_are_sought_in_a_free_piece(noise):
    radius = 0.4
    truth, faces = shapes.rounded_box(37, radius)
    scale = noise * shapes.mean_edge_length(truth, faces)
    result = ridgeform.restore(ridgeform.Mesh(shapes.add_noise(truth, faces, noise, 3), faces))
    # Sides, edges, corners. The whole box is one segment, and was left as it is.
    counts = [kinds(result).count(kind) for kind in ("plane", "cylinder", "sphere")]
    assert counts == [6, 12, 8]
    away = np.maximum(np.abs(result.vertices) - (np.abs(truth).max(axis=0) - radius), 0.0)
    # It is 0.11 and 0.14.
    assert shapes.root_mean_square(np.linalg.norm(away, axis=1) - radius) < 0.2 * scale
    edges = [surface for surface in result.surfaces if surface["kind"] in ("cylinder", "sphere")]
    assert [surface["radius"] for surface in edges] == pytest.approx([radius] * 20, rel=0.05)


def test_surfaces_are_json_and_count_the_faces(noisy_cube, found):
    again = json.loads(json.dumps(found.surfaces))
    assert again == found.surfaces
    counts = np.bincount(found.labels, minlength=len(found.surfaces))
    assert [surface["faces"] for surface in found.surfaces] == counts.tolist()
    assert all(surface["rms"] < 1.5 * found.noise for surface in found.surfaces)
    assert 0.8 < found.noise / (0.15 * 2 / 16) < 1.2


def test_rigid_motions_scales_and_the_order_of_vertices_change_nothing(noisy_cube, found):
    vertices, faces = noisy_cube
    turn = shapes.random_rotation(7)
    moved = ridgeform.restore(ridgeform.Mesh(3.0 * vertices @ turn.T + [5.0, -2.0, 1.0], faces))
    expected = 3.0 * found.vertices @ turn.T + [5.0, -2.0, 1.0]
    assert np.abs(moved.vertices - expected).max() < 2e-3
    order = np.random.default_rng(0).permutation(len(vertices))
    place = np.argsort(order)
    shuffled = ridgeform.restore(ridgeform.Mesh(vertices[order], place[faces]))
    # Folds are taken out vertex by vertex, in their order.
    away = np.linalg.norm(shuffled.vertices[place] - found.vertices, axis=1)
    assert (away < 1e-6).mean() > 0.95
    assert shapes.root_mean_square(shapes.distance_to_cube(shuffled.vertices[place])) < 0.003
    first, second = (ridgeform.restore(ridgeform.Mesh(vertices, faces), threads=n) for n in (1, 2))
    np.testing.assert_array_equal(first.vertices, second.vertices)


def test_what_is_held_stays_bit_by_bit(noisy_cube):
    vertices, faces = noisy_cube
    fixed = vertices[:, 0] > 0.3
    result = ridgeform.restore(ridgeform.Mesh(vertices, faces), fixed=fixed)
    np.testing.assert_array_equal(result.vertices[fixed], vertices[fixed])
    assert (result.vertices[~fixed] != vertices[~fixed]).any(axis=1).mean() > 0.99
    chosen = vertices[faces].mean(axis=1)[:, 2] > 0.0
    result = ridgeform.restore(ridgeform.Mesh(vertices, faces), faces=chosen)
    assert (result.labels[~chosen] == -1).all()
    held = np.unique(faces[~chosen])
    np.testing.assert_array_equal(result.vertices[held], vertices[held])
    assert (result.vertices != vertices).any()


def test_no_vertex_moves_farther_than_allowed(noisy_cube):
    vertices, faces = noisy_cube
    result = ridgeform.restore(ridgeform.Mesh(vertices, faces), max_move=0.01)
    assert np.linalg.norm(result.vertices - vertices, axis=1).max() <= 0.01 * (1 + 1e-9)
    assert result.n_held > 100


def test_faces_without_area_are_not_said_to_be_folded():
    part = coarse_shapes.clamped_prism(4)
    found = ridgeform.restore(ridgeform.Mesh(*shapes.subdivide(part.vertices, part.faces, 3)))
    assert kinds(found) == 6 * ["plane"]
    assert found.n_folded == 0


def test_free_pieces_are_denoised_or_stay():
    x, y = np.meshgrid(np.linspace(-1, 1, 40), np.linspace(-1, 1, 40))
    grid, faces = shapes.grid(39, 39)
    xy = grid[:, :2] / 19.5 - 1.0
    hill = 0.4 * np.sin(3 * xy[:, 0]) * np.cos(2.5 * xy[:, 1]) * (xy[:, 0] > 0) * xy[:, 0]
    truth = np.column_stack([xy, hill])
    noisy = truth + np.random.default_rng(3).normal(scale=0.006, size=truth.shape)
    result = ridgeform.restore(ridgeform.Mesh(noisy, faces))
    assert x.shape == y.shape
    assert result.status in ("restored", "unsure")
    kept = ridgeform.restore(ridgeform.Mesh(noisy, faces), free=False)
    free = [k for k, surface in enumerate(kept.surfaces) if surface["kind"] == "free"]
    inside = ~np.isin(np.arange(len(noisy)), faces[~np.isin(kept.labels, free)])
    np.testing.assert_array_equal(kept.vertices[inside], noisy[inside])


@given(mesh=triangle_soups())
@settings(max_examples=60)
def test_any_mesh(mesh):
    arrays = finite_or_refused(lambda: [ridgeform.restore(mesh).vertices])
    if arrays:
        assert arrays[0].shape == mesh.vertices.shape


@pytest.mark.parametrize("seed", range(6))
def test_random_meshes_keep_their_faces_and_give_numbers(seed):
    rng = np.random.default_rng(seed)
    vertices, faces = shapes.torus(12, 8) if seed % 2 else shapes.house(2)
    vertices = vertices + rng.normal(scale=0.05, size=vertices.shape)
    faces = faces[rng.random(len(faces)) > 0.1]
    faces[::9] = faces[::9, ::-1]
    result = ridgeform.restore(ridgeform.Mesh(1e3 * vertices, faces), regularize=5.0)
    assert np.isfinite(result.vertices).all()
    assert result.labels.shape == (len(faces),)
    unused = np.setdiff1d(np.arange(len(vertices)), faces)
    np.testing.assert_array_equal(result.vertices[unused], 1e3 * vertices[unused])


@pytest.mark.parametrize(
    ("keywords", "words"),
    [
        ({"max_move": 0.0}, "max_move: is 0; it must be a positive length"),
        ({"noise": float("nan")}, "noise"),
        ({"noise": 1e3}, "noise"),
        ({"regularize": 45.0}, "regularize: is 45; it must be between 0 and 30"),
        ({"fixed": np.zeros(3, bool)}, "fixed"),
        ({"faces": np.zeros(12, bool)}, "faces"),
    ],
)
def test_what_is_refused(keywords, words):
    with pytest.raises(ridgeform.ArgumentError, match=words):
        ridgeform.restore(ridgeform.Mesh(*shapes.cube(1)), **keywords)


def test_a_mesh_without_positions_or_area_is_refused():
    vertices, faces = shapes.cube(2)
    lengths = ridgeform.Mesh(vertices, faces).edge_lengths
    with pytest.raises(ridgeform.MeshError, match="positions"):
        ridgeform.restore(ridgeform.Mesh.from_edge_lengths(faces, lengths))
    with pytest.raises(ridgeform.MeshError, match="area"):
        ridgeform.restore(ridgeform.Mesh(np.zeros((3, 3)), [[0, 1, 2]]))


def test_it_hears_wishes_to_stop(noisy_cube, cancelled):
    with pytest.raises(ridgeform.Cancelled):
        ridgeform.restore(ridgeform.Mesh(*noisy_cube), progress=cancelled)
    finishing = ridgeform.Progress()
    finishing.finish()
    result = ridgeform.restore(ridgeform.Mesh(*noisy_cube), progress=finishing)
    assert result.status in ("stopped", "unsure")
    assert np.isfinite(result.vertices).all()
