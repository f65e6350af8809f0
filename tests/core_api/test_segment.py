"""`segment`: known parts found again, what each keyword does, and what is refused."""

from pathlib import Path

import numpy as np
import pytest
import ridgeform
from known_shapes import segment_shapes, shapes

SOURCES = Path(__file__).parents[2] / "blend_fixtures/sources"


def segmented(part, **keywords):
    return ridgeform.segment(ridgeform.Mesh(part.vertices, part.faces), **keywords)


def same_partition(first, second):
    return segment_shapes.adjusted_rand_index(np.asarray(first), np.asarray(second)) == pytest.approx(1.0)


@pytest.fixture(scope="module")
def house():
    """A gabled house with a little noise: seven parts."""
    return segment_shapes.house(0).noisy(0.1, 1).turned(3)


@pytest.fixture(scope="module")
def found(house):
    return segmented(house)


@pytest.mark.parametrize("name", segment_shapes.SHAPES)
def test_parts_of_exact_shapes_are_found(name):
    part = segment_shapes.SHAPES[name](0).turned(2)
    result = segmented(part)
    assert result.n_segments == part.n_parts
    assert segment_shapes.adjusted_rand_index(result.labels, part.truth) >= 0.98


@pytest.mark.parametrize("name", ["cube", "dodecahedron", "L-shape", "staircase", "gabled house"])
def test_parts_are_found_under_noise(name):
    part = segment_shapes.SHAPES[name](0).noisy(0.1, 2).turned(1)
    result = segmented(part)
    assert result.n_segments == part.n_parts
    assert segment_shapes.adjusted_rand_index(result.labels, part.truth) >= 0.98


@pytest.mark.parametrize(("name", "level", "seed"), [("gabled house", 2, 1), ("cylinder with caps", 0, 0)])
def test_heavy_noise_neither_hides_a_ridge_nor_makes_a_part(name, level, seed):
    part = segment_shapes.SHAPES[name](level).noisy(0.2, 10 + seed).turned(seed)
    result = segmented(part)
    assert result.n_segments == part.n_parts
    assert segment_shapes.adjusted_rand_index(result.labels, part.truth) >= 0.98


def test_a_character_has_the_more_segments_the_less_borders_cost_and_no_teeth():
    with np.load(SOURCES / "spot_low_resolution.npz") as data:
        vertices, faces = data["vertices"].astype(float), data["faces"].astype(np.int64)
    mesh = ridgeform.Mesh(vertices, faces)
    one, other, _ = segment_shapes.face_pairs(faces)
    counts = []
    for length_weight in (1.2, 0.8, 0.5, 0.3, 0.15):
        labels = ridgeform.segment(mesh, length_weight=length_weight).labels
        counts.append(labels.max() + 1)
        between = labels[one] != labels[other]
        edges_of_face = np.bincount(np.concatenate([one[between], other[between]]), minlength=len(faces))
        # A face with two of its edges on borders is a tooth, or lies at a bend.
        assert (edges_of_face > 1).sum() <= 0.12 * (edges_of_face > 0).sum()
    assert counts == sorted(counts)
    assert counts[0] > 1


def test_the_noisy_cube_has_six_sides():
    for seed in range(3):
        vertices, faces = shapes.noisy_cube(seed)
        result = ridgeform.segment(ridgeform.Mesh(vertices, faces))
        truth = segment_shapes.parts_by_angle(*shapes.cube(16, 2.0))
        assert result.n_segments == 6
        assert segment_shapes.adjusted_rand_index(result.labels, truth) >= 0.99
        # A sixteenth of a side is an edge, and noise of 0.15 of it was added.
        assert result.noise == pytest.approx(0.15 * 2 / 16, rel=0.15)


def test_the_result_is_complete_and_consistent(house, found):
    m = len(house.faces)
    assert found.labels.shape == found.indicator.shape == (m,)
    assert found.values.shape == house.vertices.shape
    assert np.array_equal(np.unique(found.labels), np.arange(found.n_segments))
    _, first = np.unique(found.labels, return_index=True)
    assert (np.diff(first) > 0).all()
    assert ((found.indicator > 0) & (found.indicator <= 1)).all()
    one, other, edges = segment_shapes.face_pairs(house.faces)
    between = found.labels[one] != found.labels[other]
    expected = {tuple(edge) for edge in edges[between].tolist()}
    assert {tuple(sorted(edge)) for edge in found.boundary_edges.tolist()} == expected
    assert found.indicator[np.concatenate([one[between], other[between]])].mean() < 0.5
    assert found.status == "solved"
    assert repr(found).startswith("<ridgeform.Segmentation: 7 segments of 1 to ")


def test_the_surface_comes_back_sharpened(house, found):
    truth = segment_shapes.house(0).turned(3).vertices
    before = shapes.root_mean_square(house.vertices - truth)
    assert shapes.root_mean_square(found.values - truth) < 0.95 * before


def test_rotations_sizes_and_the_order_of_faces_change_nothing(house, found):
    turned = house.turned(9)
    assert same_partition(segmented(turned).labels, found.labels)
    large = ridgeform.segment(ridgeform.Mesh(1e3 * house.vertices + 5.0, house.faces))
    assert same_partition(large.labels, found.labels)
    order = np.random.default_rng(0).permutation(len(house.faces))
    shuffled = ridgeform.segment(ridgeform.Mesh(house.vertices, house.faces[order]))
    assert segment_shapes.adjusted_rand_index(shuffled.labels, found.labels[order]) > 0.98


def test_the_same_bits_on_any_number_of_threads(house):
    first = segmented(house, threads=1)
    second = segmented(house, threads=2)
    np.testing.assert_array_equal(first.labels, second.labels)
    np.testing.assert_array_equal(first.indicator, second.indicator)
    np.testing.assert_array_equal(first.labels_at(3), second.labels_at(3))


def test_the_hierarchy_is_nested(found):
    fewest, most = found.range
    assert fewest == 1
    assert fewest <= found.n_segments <= most
    assert found.strengths.shape == (most - fewest,)
    assert (np.diff(found.strengths) >= 0).all()
    np.testing.assert_array_equal(found.labels_at(found.n_segments), found.labels)
    finer = found.labels_at(most)
    for n in range(most, 0, -1):
        labels = found.labels_at(n)
        assert len(np.unique(labels)) == n
        # Every finer segment lies in one coarser segment.
        pairs = np.unique(np.stack([finer, labels]), axis=1)
        assert len(np.unique(pairs[0])) == pairs.shape[1]
        finer = labels
    np.testing.assert_array_equal(found.labels_at(10_000), found.labels_at(most))


def test_a_number_of_segments_can_be_asked_for(house):
    result = segmented(house, n_segments=4)
    assert result.n_segments == 4
    assert len(np.unique(result.labels)) == 4


def test_a_larger_length_weight_gives_fewer_segments():
    part = segment_shapes.house(0)
    # The roof meets walls and itself at 45 and 90 degrees.
    counts = [segmented(part, length_weight=weight).n_segments for weight in (0.3, 1.8, 4.0)]
    assert counts[0] == 7
    assert 7 > counts[1] >= counts[2] == 1


def test_the_method_of_the_paper_finds_the_sides_of_a_cube():
    part = segment_shapes.cube(1)
    result = segmented(part, method="paper", epsilon_end=0.02, cut_threshold=0.6)
    assert result.n_segments == 6
    assert segment_shapes.adjusted_rand_index(result.labels, part.truth) > 0.8


def test_values_are_segmented_by_their_slopes_and_steps():
    vertices, faces = shapes.grid(24, 24)
    mesh = ridgeform.Mesh(vertices, faces)
    x = vertices[:, 0] / 24
    centers = vertices[faces].mean(axis=1)[:, 0] / 24
    ridge = ridgeform.segment(mesh, values=np.abs(x - 0.5))
    assert ridge.n_segments == 2
    assert segment_shapes.adjusted_rand_index(ridge.labels, (centers > 0.5).astype(int)) == 1.0
    rng = np.random.default_rng(0)
    colors = np.array([[0.9, 0.2, 0.1], [0.1, 0.4, 0.8]])[(x > 0.51).astype(int)]
    painted = ridgeform.segment(mesh, values=colors + 0.01 * rng.standard_normal(colors.shape))
    assert painted.n_segments == 2
    assert painted.values.shape == colors.shape
    assert segment_shapes.adjusted_rand_index(painted.labels, (centers > 0.5).astype(int)) > 0.9
    assert ridgeform.segment(mesh, values=2 * x + 1).n_segments == 1


def cheap_where(near):
    """Keywords that make borders cheap on some faces: as weights of faces, and of their edges."""
    weights = np.where(near, 0.2, 1.0)
    return {"face_weights": weights}, {"edge_weights": np.repeat(weights[:, None], 3, axis=1)}


def test_weights_attract_borders():
    vertices, faces = shapes.grid(24, 24)
    bent = vertices / 24
    # A bend of 17 degrees is no border, unless it is cheap there.
    bent[:, 2] = 0.3 * np.maximum(bent[:, 0] - 0.5, 0)
    mesh = ridgeform.Mesh(bent, faces)
    assert ridgeform.segment(mesh).n_segments == 1
    for weights in cheap_where(np.abs(bent[faces].mean(axis=1)[:, 0] - 0.5) < 0.1):
        assert ridgeform.segment(mesh, **weights).n_segments == 2


def test_only_the_faces_asked_for_take_part():
    part = segment_shapes.cube(0)
    mask = part.truth < 3
    result = segmented(part, faces=mask)
    assert (result.labels[~mask] == -1).all()
    assert result.n_segments == 3
    assert same_partition(result.labels[mask], part.truth[mask])
    assert (result.indicator[~mask] == 1).all()
    assert (result.labels_at(2)[~mask] == -1).all()
    away = np.setdiff1d(np.arange(len(part.vertices)), part.faces[mask])
    np.testing.assert_array_equal(result.values[away], part.vertices[away])
    np.testing.assert_array_equal(segmented(part, faces=np.flatnonzero(mask)).labels, result.labels)


def test_separate_parts_are_separate_segments():
    vertices, faces = shapes.cube(6)
    points = np.concatenate([vertices, vertices + 5])
    both = ridgeform.Mesh(points, np.concatenate([faces, faces + len(vertices)]))
    result = ridgeform.segment(both)
    assert result.n_segments == 12
    assert result.range[0] == 2


@pytest.mark.parametrize(
    ("keywords", "name"),
    [
        ({"length_weight": 0.0}, "length_weight"),
        ({"fidelity": -1.0}, "fidelity"),
        ({"epsilon_start": 0.01, "epsilon_end": 0.1}, "epsilon_end"),
        ({"cut_threshold": 1.5}, "cut_threshold"),
        ({"n_segments": 0}, "n_segments"),
        ({"method": "magic"}, "method"),
        ({"scale": "miles"}, "scale"),
        ({"faces": np.zeros(768, bool)}, "faces"),
        ({"face_weights": np.ones(5)}, "face_weights"),
        ({"edge_weights": -np.ones((768, 3))}, "edge_weights"),
        ({"values": np.ones((386, 20))}, "values"),
        ({"values": np.ones(5)}, "values"),
        ({"min_faces": -1}, "min_faces"),
    ],
)
def test_bad_arguments_are_refused_by_name(keywords, name):
    with pytest.raises(ridgeform.ArgumentError, match=name):
        segmented(segment_shapes.cube(0), **keywords)


def test_a_mesh_without_positions_or_area_is_refused():
    lengths = ridgeform.Mesh.from_edge_lengths([[0, 1, 2]], [[1.0, 1.0, 1.0]])
    with pytest.raises(ridgeform.MeshError, match="positions"):
        ridgeform.segment(lengths)
    with pytest.raises(ridgeform.MeshError, match="area"):
        ridgeform.segment(ridgeform.Mesh(np.zeros((3, 3)), [[0, 1, 2]]))


def test_odd_meshes_give_labels():
    for vertices, faces in (
        shapes.bow_tie(),
        shapes.moebius_strip(),
        shapes.three_faces_on_an_edge(),
        shapes.grid(1, 1),
    ):
        result = ridgeform.segment(ridgeform.Mesh(vertices, faces))
        assert (result.labels >= 0).all()
        assert np.isfinite(result.values).all()


def strips(n, m, bend=0.0):
    """Two strips of `n` and `m` squares along a line, with common vertices only where both have one."""
    parts = []
    for count, shift in ((n, 0.0), (m, 1.0)):
        vertices, faces = shapes.grid(count, count)
        vertices = vertices / count + [shift, 0.0, 0.0]
        vertices[:, 2] = bend * np.maximum(vertices[:, 0] - 1.0, 0.0)
        parts.append((vertices, faces))
    (a, of_a), (b, of_b) = parts
    points, index = np.unique(np.round(np.vstack([a, b]), 9), axis=0, return_inverse=True)
    return points, index.ravel()[np.vstack([of_a, of_b + len(a)])]


@pytest.mark.parametrize(("n", "m"), [(1, 2), (2, 3), (6, 7), (9, 12)])
@pytest.mark.parametrize("turned", [False, True])
def test_t_junctions_cut_no_face_and_hide_no_ridge(n, m, turned):
    for bend, count in ((0.0, 1), (1.0, 2)):
        vertices, faces = strips(n, m, bend)
        if turned:
            faces[: 2 * n * n] = faces[: 2 * n * n, ::-1]
        mesh = ridgeform.Mesh(vertices @ shapes.random_rotation(3).T, faces)
        assert len(mesh.report.t_junctions) > 0
        result = ridgeform.segment(mesh)
        sides = (np.arange(len(faces)) >= 2 * n * n).astype(int) if count == 2 else np.zeros(len(faces), int)
        assert result.n_segments == count
        assert same_partition(result.labels, sides) or count == 1
        assert result.labels.shape == result.indicator.shape == (len(faces),)
        np.testing.assert_array_equal(result.labels_at(count), result.labels)
        # No edge has a face of either side.
        assert len(result.boundary_edges) == 0 or count == 2


@pytest.mark.parametrize("noise", [0.0, 0.05])
def test_a_second_lid_is_of_the_segment_of_the_first(noise):
    part = segment_shapes.cube(0).noisy(noise, 1)
    lid = np.flatnonzero(part.truth == 2)
    # Turned over as well: which way a copy faces does not matter.
    copies = part.faces[lid][::-1]
    copies[::2] = copies[::2, ::-1]
    mesh = ridgeform.Mesh(part.vertices, np.vstack([part.faces, copies]))
    assert len(mesh.report.duplicate_faces) == len(lid)
    result = ridgeform.segment(mesh)
    assert result.n_segments == 6
    assert same_partition(result.labels[: len(part.faces)], part.truth)
    np.testing.assert_array_equal(result.labels[len(part.faces) :], result.labels[lid[::-1]])
    assert len(np.unique(result.labels_at(3))) == 3
    np.testing.assert_array_equal(result.labels_at(6), result.labels)
    # Without the first ones the copies are the lid.
    faces = np.ones(len(mesh.faces), bool)
    faces[lid] = False
    alone = ridgeform.segment(mesh, faces=faces).labels
    assert (alone[lid] == -1).all()
    assert (alone[len(part.faces) :] >= 0).all()


def test_weights_and_a_choice_of_faces_reach_the_parts_of_split_faces():
    vertices, faces = strips(6, 7, bend=0.3)
    mesh = ridgeform.Mesh(vertices, faces)
    assert ridgeform.segment(mesh).n_segments == 1
    for weights in cheap_where(np.abs(vertices[faces].mean(axis=1)[:, 0] - 1.0) < 0.2):
        assert ridgeform.segment(mesh, **weights).n_segments == 2
    some = np.arange(len(faces)) < 72
    labels = ridgeform.segment(mesh, faces=some).labels
    assert (labels[some] == 0).all()
    assert (labels[~some] == -1).all()
