"""`parts`: known limbs found again at every density, what each keyword does, and what is refused."""

from pathlib import Path

import numpy as np
import pytest
import ridgeform
from known_shapes import limbs, segment_shapes, shapes
from known_shapes.segment_shapes import adjusted_rand_index

SOURCES = Path(__file__).parents[2] / "blend_fixtures/sources"


def source(name):
    with np.load(SOURCES / f"{name}.npz") as data:
        return data["vertices"].astype(float), data["faces"].astype(np.int64)


def pieces_of(faces, labels):
    """How many connected pieces each part has."""
    first, second, _ = segment_shapes.face_pairs(faces)
    same = labels[first] == labels[second]
    pieces = segment_shapes.pieces(len(faces), first[same], second[same])
    return np.array([len(np.unique(pieces[labels == part])) for part in np.unique(labels)])


def areas_of(vertices, faces, labels):
    a, b, c = (vertices[faces[:, i]] for i in range(3))
    return np.bincount(labels, 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1))


def weights_around(faces, chosen, weight):
    """Weights (m, 3) of edges: that on the border of the chosen faces (m,), and 1."""
    weights = np.ones((len(faces), 3))
    first, second, edges = segment_shapes.face_pairs(faces)
    rim = {tuple(sorted(edge)) for edge in edges[chosen[first] != chosen[second]].tolist()}
    for f, face in enumerate(faces.tolist()):
        for i in range(3):
            if tuple(sorted((face[(i + 1) % 3], face[(i + 2) % 3]))) in rim:
                weights[f, i] = weight
    return weights


@pytest.fixture(scope="module")
def ball():
    return limbs.ball_with_limbs(4)


@pytest.fixture(scope="module")
def found(ball):
    return ridgeform.parts(ridgeform.Mesh(*ball[:2]))


@pytest.mark.parametrize("levels", [4, 5])
def test_the_limbs_of_a_ball_are_found_at_every_density_turned_and_under_noise(levels):
    vertices, faces, truth = limbs.ball_with_limbs(levels)
    plain = ridgeform.parts(ridgeform.Mesh(vertices, faces))
    assert plain.n_parts == 5
    assert adjusted_rand_index(plain.labels, truth) >= 0.9
    turned = ridgeform.parts(ridgeform.Mesh(vertices @ shapes.random_rotation(3).T, faces))
    assert adjusted_rand_index(turned.labels, plain.labels) >= 0.95
    noisy = shapes.add_noise(vertices, faces, 0.1, seed=2)
    noisy = ridgeform.parts(ridgeform.Mesh(noisy, faces), n_parts=5)
    assert adjusted_rand_index(noisy.labels, plain.labels) >= 0.95


def test_limbs_that_are_mirror_images_are_cut_alike(ball, found):
    vertices, faces, _ = ball
    areas = np.sort(areas_of(vertices, faces, found.labels))
    assert np.ptp(areas[:4]) <= 0.02 * areas[0]
    # What a limb is cut from grows thicker with the limbs that it has.
    assert found.costs[:4].max() <= 2 * found.costs[:4].min()


def test_divisions_are_nested_and_their_parts_connected_at_every_count(ball, found):
    _, faces, _ = ball
    fewest, most = found.range
    assert fewest == 1
    assert most >= 8
    assert found.labels_at(1).max() == 0
    finer = found.labels_at(most)
    for count in range(most - 1, 0, -1):
        labels = found.labels_at(count)
        assert np.array_equal(np.unique(labels), np.arange(count))
        assert len(np.unique(np.stack([finer, labels]), axis=1).T) == count + 1
        assert (pieces_of(faces, labels) == 1).all()
        finer = labels
    assert len(found.costs) == most - 1
    assert (found.costs > 0).all()
    assert np.array_equal(found.labels, found.labels_at(found.n_parts))


def test_a_thumb_on_a_limb_goes_before_the_limb():
    """Its cut is the cheapest: least border, and least area."""
    vertices, faces, truth = limbs.ball_with_limbs(4)
    plain = ridgeform.parts(ridgeform.Mesh(vertices, faces), n_parts=5)
    far = np.linalg.norm(vertices[faces].mean(axis=1), axis=1)
    tip = (truth == 0) & (far > far[truth == 0].max() - 0.15)
    weights = weights_around(faces, tip, 0.3)
    thumbed = ridgeform.parts(ridgeform.Mesh(vertices, faces), edge_weights=weights)
    assert adjusted_rand_index(thumbed.labels_at(5), plain.labels) >= 0.95


def test_the_result_is_complete_and_consistent(ball, found):
    _, faces, _ = ball
    assert found.labels.shape == (len(faces),)
    one, other, edges = segment_shapes.face_pairs(faces)
    between = found.labels[one] != found.labels[other]
    expected = {tuple(sorted(edge)) for edge in edges[between].tolist()}
    assert {tuple(sorted(edge)) for edge in found.boundary_edges.tolist()} == expected
    assert found.status == "solved"
    assert repr(found) == f"<ridgeform.Parts: 5 parts of 1 to {found.range[1]}, solved>"


def test_a_larger_coarseness_gives_fewer_parts_and_a_count_is_kept(ball):
    mesh = ridgeform.Mesh(*ball[:2])
    counts = [ridgeform.parts(mesh, coarseness=c).n_parts for c in (30.0, 1.5, 0.1)]
    assert counts[0] == 1
    assert counts[1] == 5
    assert counts[2] > 5
    assert ridgeform.parts(mesh, n_parts=3).n_parts == 3


def test_a_character_has_a_head_and_legs_where_asked_for_few_parts():
    vertices, faces = source("spot_low_resolution")
    found = ridgeform.parts(ridgeform.Mesh(vertices, faces))
    assert 3 <= found.n_parts <= 20
    assert (pieces_of(faces, found.labels_at(8)) == 1).all()


def test_a_scanned_bust_has_few_parts():
    vertices, faces = source("bust")
    found = ridgeform.parts(ridgeform.Mesh(vertices, faces))
    assert 2 <= found.n_parts <= 8
    assert (pieces_of(faces, found.labels) == 1).all()


def test_the_same_bits_on_any_number_of_threads(ball):
    mesh = ridgeform.Mesh(*ball[:2])
    first, second = (ridgeform.parts(mesh, threads=n) for n in (1, 2))
    np.testing.assert_array_equal(first.labels, second.labels)
    np.testing.assert_array_equal(first.costs, second.costs)


def test_sizes_and_places_change_nothing(ball, found):
    vertices, faces, _ = ball
    large = ridgeform.parts(ridgeform.Mesh(1e3 * vertices + 7.0, faces))
    assert adjusted_rand_index(large.labels, found.labels) >= 0.99


def test_pieces_are_parts_or_belong_to_what_is_near(ball):
    vertices, faces, _ = ball
    n = len(vertices)
    small, small_faces = shapes.icosphere(1)
    speck = 0.001 * small + vertices[0]
    pair = ridgeform.Mesh(
        np.concatenate([vertices, vertices + np.array([6.0, 0.0, 0.0]), speck]),
        np.concatenate([faces, faces + n, small_faces + 2 * n]),
    )
    two = ridgeform.parts(pair, n_parts=2).labels
    m = len(faces)
    assert len(np.unique(two[:m])) == len(np.unique(two[m : 2 * m])) == 1
    assert two[0] != two[m]
    nearest = np.flatnonzero((faces == 0).any(axis=1))[0]
    assert (two[2 * m :] == two[nearest]).all()


def test_no_part_is_a_speck_at_any_count():
    """Less than a disk as wide as the scale on which hollows are measured is none."""
    vertices, faces = source("bust")
    noisy = shapes.add_noise(vertices, faces, 0.2, seed=1)
    found = ridgeform.parts(ridgeform.Mesh(noisy, faces))
    for count in (4, 8, 16, found.range[1]):
        areas = areas_of(noisy, faces, found.labels_at(min(count, found.range[1])))
        assert areas.min() >= 1.25e-3 * areas.sum()


def test_beyond_what_is_found_large_parts_are_divided_before_strips_come_off():
    """A rod in pieces: none is a strip along it."""
    vertices, faces = shapes.cylinder(32, 64)
    found = ridgeform.parts(ridgeform.Mesh(vertices * [1, 1, 8], faces))
    assert found.n_parts == 1
    areas = areas_of(vertices * [1, 1, 8], faces, found.labels_at(2))
    assert areas.min() >= 0.1 * areas.sum()


def test_hollows_say_little_where_they_are_everywhere():
    """Bumps all over a ball make no parts of it, and of its limbs neither."""
    vertices, faces, truth = limbs.ball_with_limbs(5)
    waves = 1 + 0.03 * np.prod(np.sin(12 * vertices), axis=1)
    rough = ridgeform.parts(ridgeform.Mesh(vertices * waves[:, None], faces))
    assert rough.n_parts == 5
    assert adjusted_rand_index(rough.labels, truth) >= 0.9
    sphere, triangles = shapes.icosphere(5)
    bumps = 1 + 0.1 * np.prod(np.sin(12 * sphere), axis=1)
    assert ridgeform.parts(ridgeform.Mesh(sphere * bumps[:, None], triangles)).n_parts == 1


def test_closed_pieces_that_pass_through_each_other_are_a_part_each():
    """The inside of one does not make the other thin."""
    small, small_faces = shapes.icosphere(3)
    head = 0.6 * small + np.array([0.0, 0.0, 1.3])
    arms = [0.35 * small + np.array([x, 0.0, 0.3]) for x in (1.1, -1.1)]
    balls = [small, head, *arms]
    n, m = len(small), len(small_faces)
    faces = np.concatenate([small_faces + i * n for i in range(len(balls))])
    found = ridgeform.parts(ridgeform.Mesh(np.concatenate(balls), faces))
    assert found.n_parts == len(balls)
    assert np.array_equal(found.labels, np.repeat(np.arange(len(balls)), m))


@pytest.mark.parametrize("rounding", [0.0, 1e-7, 1e-6])
def test_loose_triangles_of_one_surface_are_divided_as_that_surface(ball, found, rounding):
    vertices, faces, _ = ball
    loose = np.arange(3 * len(faces)).reshape(-1, 3)
    corners = vertices[faces].reshape(-1, 3)
    corners = corners + rounding * np.random.default_rng(1).uniform(-1, 1, corners.shape)
    result = ridgeform.parts(ridgeform.Mesh(corners, loose))
    assert adjusted_rand_index(result.labels, found.labels) >= 0.99


def test_faces_that_run_the_other_way_change_nothing(ball, found):
    vertices, faces, _ = ball
    mixed = faces.copy()
    mixed[::3] = mixed[::3, ::-1]
    result = ridgeform.parts(ridgeform.Mesh(vertices, mixed))
    assert adjusted_rand_index(result.labels, found.labels) >= 0.99


def test_real_files_get_parts(ball):
    vertices, faces, truth = ball
    rng = np.random.default_rng(0)
    kept = ~((truth == 0) & (np.linalg.norm(vertices[faces].mean(axis=1), axis=1) > 2.3))
    opened = faces[kept]
    doubled = np.concatenate([faces, faces[::50]])
    degenerate = np.concatenate([faces, np.stack([faces[:40, 0], faces[:40, 0], faces[:40, 1]], axis=1)])
    fin = np.concatenate([faces, np.stack([faces[:30, 0], faces[:30, 1], rng.integers(0, 900, 30)], axis=1)])
    soup = rng.integers(0, len(vertices), (300, 3))
    # Fins that bridge limbs hide their hollows: there are parts, but others.
    finned = ridgeform.parts(ridgeform.Mesh(vertices, fin), n_parts=5)
    assert 2 <= finned.n_parts <= 5
    for given in (opened, doubled, degenerate):
        result = ridgeform.parts(ridgeform.Mesh(vertices, given), n_parts=5)
        sound = np.arange(min(len(given), len(faces)))
        known = truth if len(given) >= len(faces) else truth[kept]
        assert adjusted_rand_index(result.labels[sound], known) >= 0.9
        assert np.array_equal(np.unique(result.labels), np.arange(5))
    result = ridgeform.parts(ridgeform.Mesh(vertices, soup))
    assert np.array_equal(np.unique(result.labels), np.arange(result.n_parts))
    for tiny in (shapes.tetrahedron(), shapes.three_faces_on_an_edge(), shapes.moebius_strip()):
        assert ridgeform.parts(ridgeform.Mesh(*tiny)).n_parts >= 1


def test_flat_and_round_shapes_are_one_part():
    for shape in (shapes.icosphere(3), shapes.grid(20, 20)):
        assert ridgeform.parts(ridgeform.Mesh(*shape)).n_parts == 1


@pytest.mark.parametrize("times", [2, 8, 20])
def test_what_is_long_is_one_part_as_well(times):
    """Nothing says where to cut it, however short the way around is."""
    sphere, faces = shapes.icosphere(4)
    rod = sphere + np.array([0.0, 0.0, 1.0]) * times * np.sign(sphere[:, 2:])
    cylinder, sides = shapes.cylinder(32, 8 * times)
    for shape in ((sphere * [1, 1, times], faces), (rod, faces), (cylinder * [1, 1, times], sides)):
        assert ridgeform.parts(ridgeform.Mesh(*shape)).n_parts == 1


def test_paint_attracts_cuts_and_keeps_them_away(ball):
    vertices, faces, truth = ball
    mesh = ridgeform.Mesh(vertices, faces)
    far = np.linalg.norm(vertices[faces].mean(axis=1), axis=1)
    ring = (truth == 0) & (np.abs(far - 1.7) < 0.5)
    there = ridgeform.parts(mesh, n_parts=2, face_weights=np.where(ring, 1e-3, 1.0)).labels
    at = ridgeform.parts(mesh, n_parts=2).labels
    assert len(np.unique(there[ring])) == 2
    assert len(np.unique(at[ring])) == 1
    base = np.where((truth == limbs.BODY) | (truth == 0), 50.0, 1.0)
    away = ridgeform.parts(mesh, n_parts=4, face_weights=base).labels
    # Three limbs come off; the one in paint stays with the body.
    assert len(np.unique(away[(truth == 0) | (truth == limbs.BODY)])) == 1


def test_edges_that_are_borders_already_are_cut_along(ball):
    vertices, faces, truth = ball
    far = np.linalg.norm(vertices[faces].mean(axis=1), axis=1)
    tip = (truth == 1) & (far > 1.7)
    weights = weights_around(faces, tip, 0.0)
    labels = ridgeform.parts(ridgeform.Mesh(vertices, faces), n_parts=2, edge_weights=weights).labels
    assert adjusted_rand_index(labels, tip.astype(int)) >= 0.99


def test_only_the_faces_named_take_part(ball):
    vertices, faces, truth = ball
    mask = truth != 2
    found = ridgeform.parts(ridgeform.Mesh(vertices, faces), faces=mask)
    assert ((found.labels == -1) == ~mask).all()
    assert adjusted_rand_index(found.labels[mask], truth[mask]) >= 0.95


@pytest.mark.parametrize(
    ("keywords", "culprit"),
    [
        ({"n_parts": 0}, "n_parts"),
        ({"coarseness": 0.0}, "coarseness"),
        ({"coarseness": np.nan}, "coarseness"),
        ({"face_weights": [1.0]}, "face_weights"),
        ({"edge_weights": [[1.0, 1.0, 1.0]]}, "edge_weights"),
        ({"faces": np.zeros(5120, bool)}, "faces"),
        ({"threads": 0}, "threads"),
    ],
)
def test_what_cannot_be_is_refused_by_name(ball, keywords, culprit):
    with pytest.raises(ridgeform.ArgumentError, match=culprit):
        ridgeform.parts(ridgeform.Mesh(*ball[:2]), **keywords)


def test_a_mesh_without_positions_or_area_is_refused():
    vertices, faces = shapes.tetrahedron()
    lengths = ridgeform.Mesh(vertices, faces).edge_lengths
    with pytest.raises(ridgeform.MeshError):
        ridgeform.parts(ridgeform.Mesh.from_edge_lengths(faces, lengths))
    with pytest.raises(ridgeform.MeshError):
        ridgeform.parts(ridgeform.Mesh(np.zeros((3, 3)), [[0, 1, 2]]))


def test_a_call_can_be_cancelled_and_finished_early(ball, cancelled):
    mesh = ridgeform.Mesh(*ball[:2])
    finishing = ridgeform.Progress()
    with pytest.raises(ridgeform.Cancelled):
        ridgeform.parts(mesh, progress=cancelled)
    finishing.finish()
    result = ridgeform.parts(mesh, progress=finishing)
    assert result.status == "stopped"
    assert result.labels.shape == (mesh.n_faces,)
