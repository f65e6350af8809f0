"""Which boundary loops are holes."""

import numpy as np
import pytest
import ridgeform


def grid(n, without=()):
    """A flat grid of n by n squares, each two triangles, but for some squares."""
    vertices = np.array([(x, y, 0.0) for x in range(n + 1) for y in range(n + 1)])
    squares = [(x, y) for x in range(n) for y in range(n) if (x, y) not in without]
    corners = [(x * (n + 1) + y, (x + 1) * (n + 1) + y) for x, y in squares]
    return vertices, np.array([face for a, b in corners for face in ((a, b, b + 1), (a, b + 1, a + 1))])


def test_a_sheet_has_an_outer_border_and_holes():
    mesh = ridgeform.Mesh(*grid(6, without={(1, 1), (3, 3), (3, 4)}))
    holes = ridgeform.find_holes(mesh)
    loops = ridgeform.boundary_loops(mesh)
    assert [list(hole.vertices) for hole in holes] == [list(loop) for loop in loops]
    assert sorted(len(hole.vertices) for hole in holes if not hole.is_outer_border) == [4, 6]
    assert [len(hole.vertices) for hole in holes if hole.is_outer_border] == [24]
    assert all(hole.refusal is None for hole in holes)


def test_a_box_without_lid_has_one_hole():
    vertices = np.array([(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)], float)
    quads = [(0, 2, 3, 1), (0, 1, 5, 4), (1, 3, 7, 5), (3, 2, 6, 7), (2, 0, 4, 6)]
    faces = [face for a, b, c, d in quads for face in ((a, b, c), (a, c, d))]
    (hole,) = ridgeform.find_holes(ridgeform.Mesh(vertices, np.array(faces)))
    assert sorted(hole.vertices) == [4, 5, 6, 7]
    assert not hole.is_outer_border


def test_what_cannot_be_filled_says_why():
    (hole,) = ridgeform.find_holes(ridgeform.Mesh(np.eye(3), [[0, 1, 2]]))
    assert "single triangle" in hole.refusal
    assert "not fillable" in repr(hole)


def test_lengths_alone_are_refused():
    mesh = ridgeform.Mesh.from_edge_lengths([[0, 1, 2]], [[1.0, 1.0, 1.0]])
    with pytest.raises(ridgeform.MeshError):
        ridgeform.find_holes(mesh)


def test_there_is_no_surface_before_a_call_made_one():
    assert ridgeform.Progress().snapshot_surface() is None


def vertical(n, x):
    """A wall of n by n squares below the plane z = 0, at x, along y."""
    vertices, faces = grid(n)
    return np.column_stack([np.full(len(vertices), float(x)), vertices[:, 0], -vertices[:, 1]]), faces


def joined(*parts):
    """One mesh of several whose vertices in one place are one."""
    offsets = np.cumsum([0] + [len(vertices) for vertices, _ in parts[:-1]])
    vertices = np.concatenate([vertices for vertices, _ in parts])
    faces = np.concatenate([faces + offset for (_, faces), offset in zip(parts, offsets, strict=True)])
    unique, index = np.unique(vertices, axis=0, return_inverse=True)
    return ridgeform.Mesh(unique, index.ravel()[faces])


TOUCHING = {
    "a checkerboard": {(x, y) for x in range(2, 7) for y in range(2, 7) if (x + y) % 2},
    "two": {(3, 3), (4, 4)},
    "a diagonal of four": {(k, k) for k in range(2, 6)},
    "the other diagonal": {(k, 8 - k) for k in range(2, 7)},
    "two pairs": {(1, 1), (2, 2), (6, 5), (7, 4)},
    "one at three corners": {(4, 4), (3, 3), (5, 5), (3, 5)},
}


@pytest.mark.parametrize("bent", [0.0, 0.03])
@pytest.mark.parametrize("cells", TOUCHING.values(), ids=TOUCHING)
def test_holes_that_touch_at_corners_are_filled_one_by_one(cells, bent):
    vertices, faces = grid(9, without=cells)
    vertices[:, 2] = bent * ((vertices[:, 0] - 4) ** 2 + (vertices[:, 1] - 5) ** 2)
    mesh = ridgeform.Mesh(vertices, faces)
    holes = [hole for hole in ridgeform.find_holes(mesh) if not hole.is_outer_border]
    assert [len(hole.vertices) for hole in holes] == [4] * len(cells)
    filled = ridgeform.fill_holes(mesh)
    assert ridgeform.Mesh(filled.vertices, filled.faces).report.n_boundary_loops == 1
    assert len(ridgeform.Mesh(filled.vertices, filled.faces).report.nonmanifold_edges) == 0
    corners = filled.vertices[filled.new_faces]
    areas = 0.5 * np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])[:, 2]
    assert areas.min() > 0
    assert areas.sum() == pytest.approx(len(cells))


@pytest.mark.parametrize("width", [3, 5])
def test_a_ring_pinched_at_a_vertex_is_one_hole(width):
    low, high = 2, 3 + width
    ring = {(x, y) for x in range(low, high + 1) for y in range(low, high + 1)}
    ring -= {(x, y) for x in range(low + 1, high) for y in range(low + 1, high)} | {(low, low)}
    mesh = ridgeform.Mesh(*grid(high + 4, without=ring))
    (hole,) = [hole for hole in ridgeform.find_holes(mesh) if not hole.is_outer_border]
    assert hole.refusal is None
    assert len(hole.vertices) == len(np.unique(hole.vertices)) + 1
    filled = ridgeform.fill_holes(mesh)
    whole = ridgeform.Mesh(filled.vertices, filled.faces)
    assert whole.report.n_boundary_loops == 1
    assert len(whole.report.nonmanifold_vertices) == 0
    corners = filled.vertices[filled.new_faces]
    areas = 0.5 * np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])[:, 2]
    assert areas.min() > 0
    assert areas.sum() == pytest.approx(len(ring))


UP_TO_A_WALL = [
    {(4, 2), (4, 3)},
    {(3, 2), (4, 2)},
    {(3, 5)},
    {(4, 4), (5, 4), (4, 5), (5, 5)},
    {(2, 3), (3, 3), (4, 3), (5, 3)},
    {(3, 1), (4, 6)},
]
"""Cells that were removed beside or across a wall at 4."""


@pytest.mark.parametrize("removed", UP_TO_A_WALL)
def test_a_hole_that_runs_up_to_an_inner_wall_is_named(removed):
    mesh = joined(grid(8, without=removed), vertical(8, 4))
    refused = [hole.refusal for hole in ridgeform.find_holes(mesh) if hole.refusal]
    assert any("non-manifold" in reason for reason in refused)
    assert len(ridgeform.fill_holes(mesh).new_faces) == 0


@pytest.mark.parametrize("removed", UP_TO_A_WALL)
def test_holes_away_from_the_wall_are_filled_all_the_same(removed):
    mesh = joined(grid(8, without=removed | {(1, 6), (6, 1)}), vertical(8, 4))
    made = ridgeform.fill_holes(mesh)
    middle = made.vertices[made.new_faces].mean(axis=1)
    assert sorted({(int(x), int(y)) for x, y, _ in middle}) == [(1, 6), (6, 1)]


@pytest.mark.parametrize(("n", "m"), [(1, 2), (6, 7), (3, 5), (2, 4), (8, 1), (5, 4)])
def test_sides_that_meet_in_t_junctions_are_no_hole(n, m):
    left, right = grid(n), grid(m)
    left = left[0] / n, left[1]
    right = right[0] / m + [1, 0, 0], right[1]
    mesh = joined(left, right)
    # Where some vertices are shared, there is a slit between each two.
    slits = [hole for hole in ridgeform.find_holes(mesh) if not hole.is_outer_border]
    assert len(slits) == np.gcd(n, m)
    assert all("T-junctions" in slit.refusal for slit in slits)
    assert len(ridgeform.fill_holes(mesh).new_faces) == 0
    assert len(mesh.report.t_junctions) > 0


def test_the_outer_border_is_told_by_the_faces_along_it():
    # A tile with houses: walls and roofs have more area than the ground.
    n = 24
    vertices, faces = grid(
        n, without={(x, y) for x in range(n) for y in range(n) if x % 4 in (1, 2) and y % 4 in (1, 2)}
    )
    parts = [(vertices, faces)]
    for x in range(1, n, 4):
        for y in range(1, n, 4):
            ring = np.array(
                [
                    (x, y),
                    (x + 1, y),
                    (x + 2, y),
                    (x + 2, y + 1),
                    (x + 2, y + 2),
                    (x + 1, y + 2),
                    (x, y + 2),
                    (x, y + 1),
                ]
            )
            walls = np.array([(a, b, z) for z in (0.0, 8.0) for a, b in ring])
            sides = [(k, (k + 1) % 8, k + 8) for k in range(8)] + [
                ((k + 1) % 8, (k + 1) % 8 + 8, k + 8) for k in range(8)
            ]
            roof = [(8 + k, 8 + (k + 1) % 8, 16) for k in range(8)]
            parts.append((np.concatenate([walls, [[x + 1, y + 1, 8.0]]]), np.array(sides + roof)))
    mesh = joined(*parts)
    assert [hole.is_outer_border for hole in ridgeform.find_holes(mesh)] == [True]
    hills, faces = grid(30, without={(9, 9), (9, 10), (20, 5)})
    rng = np.random.default_rng(0)
    for height, noise in [(3.0, 0.0), (2.0, 0.3), (6.0, 0.1)]:
        z = height * np.sin(hills[:, 0] / 3) * np.cos(hills[:, 1] / 4)
        scan = np.column_stack([hills[:, :2], z]) + noise * rng.normal(size=hills.shape)
        found = ridgeform.find_holes(ridgeform.Mesh(scan, faces))
        assert [len(hole.vertices) for hole in found if hole.is_outer_border] == [120]
        assert len(found) == 3


def test_a_tray_is_a_hole_and_a_bowl_is_a_sheet():
    vertices = np.array([(x, y, 0.2 * z) for z in (0, 1) for y in (0, 1) for x in (0, 1)], float)
    quads = [(0, 2, 3, 1), (0, 1, 5, 4), (1, 3, 7, 5), (3, 2, 6, 7), (2, 0, 4, 6)]
    faces = [face for a, b, c, d in quads for face in ((a, b, c), (a, c, d))]
    (hole,) = ridgeform.find_holes(ridgeform.Mesh(vertices, np.array(faces)))
    assert not hole.is_outer_border
