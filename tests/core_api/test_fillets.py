"""Fillets and bevels, each a segment of its own or with the larger side beside it."""

import numpy as np
import pytest
import ridgeform
from known_shapes import filleted_shapes as filleted
from known_shapes.segment_shapes import adjusted_rand_index

SIZE = (2.0, 1.6, 1.3)
SIDES, FACES = 6, 26
RADIUS = 0.3


def mesh_of(part):
    return ridgeform.Mesh(part.vertices, part.faces)


def segmented(part, option, **given):
    return ridgeform.segment(mesh_of(part), fillets=option, threads=1, **given)


def agreement_of_sides(part, labels, sides):
    """With the truth on the sides of a box."""
    chosen = np.isin(part.truth, sides)
    assert len(sides) == SIDES
    return adjusted_rand_index(labels[chosen], part.truth[chosen])


def sides_of(part):
    """The faces of a box that look along an axis."""
    corners = part.vertices[part.faces]
    sums = np.zeros((part.n_parts, 3))
    np.add.at(sums, part.truth, np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))
    return np.flatnonzero(np.abs(sums).max(axis=1) > 0.98 * np.linalg.norm(sums, axis=1))


TESSELLATED = {
    "fillets": lambda: filleted.filleted_box(SIZE, RADIUS, 8),
    "wide fillets": lambda: filleted.filleted_box(SIZE, 0.55, 12),
    "bevels": lambda: filleted.chamfered_box(SIZE, 0.2),
}


@pytest.mark.parametrize("name", TESSELLATED)
def test_a_tessellated_box_has_26_faces_apart_and_6_joined(name):
    straight = TESSELLATED[name]()
    part = straight.turned(3)
    apart, joined = segmented(part, "apart"), segmented(part, "joined")
    assert apart.n_segments == FACES
    assert adjusted_rand_index(apart.labels, part.truth) == 1.0
    assert joined.n_segments == SIDES
    assert agreement_of_sides(part, joined.labels, sides_of(straight)) == 1.0


@pytest.mark.parametrize("noise", [0.0, 0.1])
def test_a_remeshed_and_noisy_box_has_26_faces_apart_and_6_joined(noise):
    fine = filleted.filleted_box(SIZE, RADIUS, 40)
    part = filleted.remeshed(fine, filleted.zones_of_box(SIZE, RADIUS), 0.045, noise)
    apart, joined = segmented(part, "apart"), segmented(part, "joined")
    assert apart.n_segments == FACES
    assert adjusted_rand_index(apart.labels, part.truth) > 0.93
    assert joined.n_segments == SIDES
    assert agreement_of_sides(part, joined.labels, sides_of(part)) > 0.97


@pytest.mark.parametrize("noise", [0.0, 0.003, 0.1])
def test_a_remeshed_and_noisy_box_with_bevels_has_six_sides(noise):
    width = 0.2
    part = filleted.remeshed(
        filleted.chamfered_box(SIZE, width), filleted.zones_of_box(SIZE, width), 0.04, noise
    )
    joined = segmented(part, "joined")
    assert joined.n_segments == SIDES
    sides = sides_of(part)
    inner = np.isin(part.truth, sides)
    assert adjusted_rand_index(joined.labels[inner], part.truth[inner]) > 0.97


def test_both_are_in_one_hierarchy():
    part = filleted.filleted_box(SIZE, RADIUS, 8)
    apart, joined = segmented(part, "apart"), segmented(part, "joined")
    assert list(apart.range) == list(joined.range) == [1, FACES]
    assert np.array_equal(joined.labels_at(FACES), apart.labels)
    assert np.array_equal(apart.labels_at(SIDES), joined.labels)
    assert np.array_equal(segmented(part, "apart", n_segments=SIDES).labels, joined.labels)
    strengths = joined.strengths
    assert (strengths[: FACES - SIDES] == 0.0).all()
    assert (np.diff(strengths) >= 0.0).all()


@pytest.mark.parametrize("noise", [None, 0.0, 0.1])
def test_the_rounded_rim_of_a_cylinder_belongs_to_its_side(noise):
    shape = (1.0, 2.0, 0.25)
    part = filleted.filleted_cylinder(*shape).turned(2)
    if noise is not None:
        fine = filleted.filleted_cylinder(*shape, around=240, steps=30)
        part = filleted.remeshed(fine, filleted.zones_of_cylinder(*shape), 0.05, noise)
    apart, joined = segmented(part, "apart"), segmented(part, "joined")
    assert apart.n_segments == 4
    assert adjusted_rand_index(apart.labels, part.truth) > (1.0 - 1e-9 if noise is None else 0.97)
    assert joined.n_segments == 3
    wanted = np.where(part.truth == 2, 1, part.truth)
    assert adjusted_rand_index(joined.labels, wanted) > (1.0 - 1e-9 if noise is None else 0.98)


def prism(corners):
    """A prism three high over a polygon."""
    n = len(corners)
    bottom = np.column_stack([corners, np.zeros(n)])
    vertices = np.concatenate([bottom, bottom + np.array([0.0, 0.0, 3.0])])
    k = np.arange(n)
    following = (k + 1) % n
    faces = [np.column_stack([k, following, following + n]), np.column_stack([k, following + n, k + n])]
    fan = np.column_stack([np.zeros(n - 2, int), k[1:-1], k[2:]])
    return ridgeform.Mesh(vertices, np.concatenate([*faces, fan[:, ::-1], fan + n]))


def regular(n):
    angles = 2.0 * np.pi * np.arange(n) / n
    return np.column_stack([np.cos(angles), np.sin(angles)])


NOT_BEVELED = {
    "hexagon": (regular(6), 8),
    "dozen": (regular(12), 14),
    "plate": (np.array([[0.0, 0.0], [4.0, 0.0], [4.0, 0.2], [0.0, 0.2]]), 6),
    "stairs": (np.array([[0.0, 0.0], [3.0, 0.0], [3.0, 1.0], [1.5, 1.0], [1.5, 1.2], [0.0, 1.2]]), 8),
    "ramp": (np.array([[0.0, 0.0], [5.0, 0.0], [5.0, 0.8], [2.0, 2.6], [0.0, 2.6]]), 7),
    "gable": (np.array([[0.0, 0.0], [3.0, 0.0], [3.0, 2.0], [1.5, 3.0], [0.0, 2.0]]), 7),
}


@pytest.mark.parametrize("name", NOT_BEVELED)
def test_what_is_no_bevel_stays_a_side(name):
    corners, count = NOT_BEVELED[name]
    found = ridgeform.segment(prism(corners), fillets="joined")
    assert found.n_segments == count


def test_only_the_faces_asked_for_take_part():
    part = filleted.filleted_box(SIZE, RADIUS, 8)
    n = len(part.faces)
    vertices = np.concatenate([part.vertices, part.vertices + np.array([5.0, 0.0, 0.0])])
    both = ridgeform.Mesh(vertices, np.concatenate([part.faces, part.faces + len(part.vertices)]))
    found = ridgeform.segment(both, fillets="joined", faces=np.arange(2 * n) < n)
    assert (found.labels[n:] == -1).all()
    assert np.array_equal(found.labels[:n], segmented(part, "joined").labels)
    assert ridgeform.segment(both, fillets="joined").n_segments == 2 * SIDES


def test_the_same_bits_on_any_number_of_threads():
    fine = filleted.filleted_box(SIZE, RADIUS, 40)
    part = filleted.remeshed(fine, filleted.zones_of_box(SIZE, RADIUS), 0.08, 0.1)
    one, two = (ridgeform.segment(mesh_of(part), fillets="joined", threads=n) for n in (1, 2))
    assert np.array_equal(one.labels, two.labels)


@pytest.mark.parametrize(
    "given",
    [
        {"fillets": "some"},
        {"fillets": "apart", "method": "paper"},
        {"fillets": "joined", "fidelity": 100.0},
        {"fillets": "joined", "values": np.arange(24.0)},
    ],
)
def test_where_there_are_no_fillets_the_option_is_refused(given):
    with pytest.raises(ridgeform.ArgumentError, match="fillets"):
        ridgeform.segment(mesh_of(filleted.chamfered_box(SIZE, 0.2)), **given)


def test_unless_asked_segments_are_as_before():
    part = filleted.filleted_box(SIZE, RADIUS, 8)
    plain = ridgeform.segment(mesh_of(part))
    asked = segmented(part, "automatic")
    assert np.array_equal(plain.labels, asked.labels)
    assert plain.range == asked.range
