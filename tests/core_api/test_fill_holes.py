"""`fill_holes`: ridges go on, smooth surfaces stay smooth, and nothing outside the patches changes."""

import numpy as np
import pytest
import ridgeform
from known_shapes import fill_measures, holed_shapes, shapes


def without(vertices, faces, center, radius):
    """A mesh with a hole: the faces whose center lies within `radius` of `center` are gone."""
    away = np.linalg.norm(vertices[faces].mean(axis=1) - center, axis=1)
    return ridgeform.Mesh(vertices, faces[away > radius])


def turned_cube(n, center, radius, seed=0):
    """A cube of side 2 with a hole, turned at random, and the rotation."""
    vertices, faces = shapes.cube(n, 2.0)
    rotation = shapes.random_rotation(seed)
    return without(vertices @ rotation.T, faces, rotation @ np.asarray(center, float), radius), rotation


def distance_to(points, vertices, faces):
    """The distance of every point to a triangle mesh."""
    a, b, c = (vertices[faces[:, i]] for i in range(3))
    out = np.empty(len(points))
    for i, p in enumerate(points):
        best = np.full(len(faces), np.inf)
        for start, end in ((a, b), (b, c), (c, a)):
            along = end - start
            t = np.clip(((p - start) * along).sum(1) / np.maximum((along**2).sum(1), 1e-300), 0, 1)
            best = np.minimum(best, np.linalg.norm(start + t[:, None] * along - p, axis=1))
        normal = np.cross(b - a, c - a)
        square = np.maximum((normal**2).sum(1), 1e-300)
        to = p - a
        u = (np.cross(to, c - a) * normal).sum(1) / square
        v = (np.cross(b - a, to) * normal).sum(1) / square
        inside = (u >= 0) & (v >= 0) & (u + v <= 1)
        best = np.where(inside, np.minimum(best, np.abs((to * normal).sum(1)) / np.sqrt(square)), best)
        out[i] = best.min()
    return out


def patch_faces(filled):
    return filled.faces[filled.patch >= 0]


def check_invariants(mesh, filled):
    """The input first and bit by bit; closed where it was filled, consistent, no degenerate face."""
    n, m = mesh.n_vertices, mesh.n_faces
    assert np.array_equal(filled.vertices[:n], mesh.vertices)
    assert np.array_equal(filled.faces[:m], mesh.faces)
    assert (filled.patch[:m] == -1).all()
    assert (filled.patch[m:] >= 0).all()
    assert filled.vertices.dtype == np.float64
    assert filled.faces.dtype == filled.patch.dtype == np.int32
    result = ridgeform.Mesh(filled.vertices, filled.faces).report
    before = mesh.report
    assert len(result.nonmanifold_edges) == len(before.nonmanifold_edges)
    assert len(result.nonmanifold_vertices) <= len(before.nonmanifold_vertices)
    assert len(result.degenerate_faces) == len(before.degenerate_faces)
    assert len(result.duplicate_faces) == len(before.duplicate_faces)
    assert len(result.unreferenced_vertices) == len(before.unreferenced_vertices)
    refused = sum(hole.status == "refused" for hole in filled.holes)
    assert result.n_boundary_loops == before.n_boundary_loops - len(filled.holes) + refused


@pytest.mark.parametrize(("n", "radius", "seed"), [(12, 0.5, 0), (16, 0.4, 1), (16, 0.6, 2), (24, 0.5, 3)])
def test_a_cubes_edge_comes_back(n, radius, seed):
    mesh, rotation = turned_cube(n, [1, 1, 0.1], radius, seed)
    filled = ridgeform.fill_holes(mesh)
    check_invariants(mesh, filled)
    (hole,) = filled.holes
    assert hole.sharpness > 0
    t = 0.1 + 0.9 * radius * np.linspace(-1, 1, 101)
    ridge = np.column_stack([np.ones_like(t), np.ones_like(t), t]) @ rotation.T
    assert distance_to(ridge, filled.vertices, patch_faces(filled)).mean() <= 0.001
    ends = filled.vertices[filled.ridges] @ rotation
    assert np.abs(ends[..., :2] - 1).max() < 0.02


@pytest.mark.parametrize(("n", "radius", "seed"), [(12, 0.6, 4), (24, 0.3, 5)])
def test_a_cubes_corner_comes_back(n, radius, seed):
    mesh, rotation = turned_cube(n, [1, 1, 1], radius, seed)
    filled = ridgeform.fill_holes(mesh)
    check_invariants(mesh, filled)
    corner = distance_to(np.ones((1, 3)) @ rotation.T, filled.vertices, patch_faces(filled))
    assert corner[0] <= 0.001
    middles = filled.vertices[patch_faces(filled)].mean(axis=1) @ rotation
    assert shapes.distance_to_cube(middles).max() < 0.003


@pytest.mark.parametrize("noise", [0.1, 0.2])
@pytest.mark.parametrize(
    ("solid", "place", "radius"),
    [
        (holed_shapes.cube, (1, 0, 1), 0.3),
        (holed_shapes.cube, (1, 0, 1), 0.6),
        (holed_shapes.cube, (1, 1, 1), 0.6),
        (holed_shapes.roof, (0, 0, 1.5), 0.3),
    ],
)
def test_ridges_come_back_under_noise(solid, place, radius, noise):
    """Noise bends edges as much as ridges do: without the segments around the hole seven of these
    eight kinds have holes that stay chamfers, up to two edges off."""
    for seed in range(3):
        holed = holed_shapes.cut(solid(24), [(np.asarray(place, float), radius)], seed)
        bumps = np.random.default_rng(seed).normal(0, noise * holed.edge, holed.vertices.shape)
        filled = ridgeform.fill_holes(ridgeform.Mesh(holed.vertices + bumps, holed.faces))
        off = fill_measures.point_distances(holed.ridge[::7], filled.vertices, filled.faces).mean()
        assert off < 2 * noise * holed.edge


@pytest.mark.parametrize("coarse", [shapes.octahedron(0), shapes.icosphere(0)], ids=["four", "five"])
def test_a_corner_of_many_planes_comes_back(coarse):
    """The first try finds one in ten of these not, a later one from a patch that is further does."""
    solid = holed_shapes.polyhedron(coarse, shapes.subdivide(*coarse, 4))
    for seed in range(8):
        irregular = holed_shapes.irregular(solid, seed)
        holed = holed_shapes.cut(irregular, [(coarse[0][4], 0.35)], seed=seed)
        filled = ridgeform.fill_holes(ridgeform.Mesh(holed.vertices, holed.faces))
        new = filled.faces[filled.patch >= 0]
        assert fill_measures.point_distances(holed.ridge, filled.vertices, new).max() < 1e-9


def test_a_cylinders_rim_bends_on():
    vertices, faces = shapes.cylinder(72, 20, 10)
    mesh = without(vertices, faces, np.array([0.6, 0.8, 1.0]), 0.4)
    filled = ridgeform.fill_holes(mesh)
    check_invariants(mesh, filled)
    new = filled.vertices[mesh.n_vertices :]
    on_side = np.abs(np.hypot(new[:, 0], new[:, 1]) - 1)
    assert np.minimum(on_side, np.abs(new[:, 2] - 1)).max() < 0.01
    ends = filled.vertices[filled.ridges]
    assert np.abs(np.hypot(ends[..., 0], ends[..., 1]) - 1).max() < 0.01
    assert np.abs(ends[..., 2] - 1).max() < 0.01


def test_a_sphere_stays_smooth():
    vertices, faces = shapes.icosphere(4)
    mesh = without(vertices, faces, np.array([0.3, 0.5, 0.81]), 0.45)
    filled = ridgeform.fill_holes(mesh)
    check_invariants(mesh, filled)
    assert filled.holes[0].sharpness == 0
    assert len(filled.ridges) == 0
    assert filled.status == "converged"
    assert np.abs(np.linalg.norm(filled.vertices[mesh.n_vertices :], axis=1) - 1).max() < 0.05


def test_a_flat_hole_stays_flat():
    vertices, faces = shapes.flat_lattice(20, 20)
    mesh = without(vertices, faces, vertices.mean(axis=0), 4.0)
    filled = ridgeform.fill_holes(mesh)
    check_invariants(mesh, filled)
    assert len(filled.holes) == 1
    assert np.abs(filled.vertices[:, 2]).max() < 1e-9


def test_the_outer_border_is_filled_only_when_asked_for():
    vertices, faces = shapes.flat_lattice(12, 12)
    mesh = without(vertices, faces, vertices.mean(axis=0), 3.0)
    loops = ridgeform.boundary_loops(mesh)
    assert len(loops) == 2
    inner = int(np.argmin([len(loop) for loop in loops]))
    assert len(ridgeform.fill_holes(mesh).holes) == 1
    assert len(ridgeform.fill_holes(mesh, max_edges=3).holes) == 0
    by_index = ridgeform.fill_holes(mesh, loops=[inner])
    by_vertices = ridgeform.fill_holes(mesh, loops=[loops[inner][::-1]])
    assert set(by_index.holes[0].boundary) == set(loops[inner])
    np.testing.assert_allclose(
        np.sort(by_index.vertices, axis=0), np.sort(by_vertices.vertices, axis=0), atol=1e-6
    )


def test_fills_scale_with_the_mesh():
    mesh, _ = turned_cube(12, [1, 1, 0.1], 0.5)
    # A power of two: no rounding, so that even ties are decided alike.
    scaled = ridgeform.Mesh(1024 * mesh.vertices, mesh.faces)
    plain, other = (ridgeform.fill_holes(m) for m in (mesh, scaled))
    np.testing.assert_array_equal(plain.faces, other.faces)
    np.testing.assert_allclose(other.vertices, 1024 * plain.vertices, rtol=0, atol=1e-9)


def passes_through(vertices, faces):
    """How many edges of faces pass through the inside of other faces."""
    count = 0
    for tail, head in np.concatenate([faces[:, [i, (i + 1) % 3]] for i in range(3)]):
        other = faces[~((faces == tail) | (faces == head)).any(axis=1)]
        start, way = vertices[tail], vertices[head] - vertices[tail]
        a, b, c = (vertices[other[:, i]] for i in range(3))
        across = np.cross(way, c - a)
        det = ((b - a) * across).sum(axis=1)
        det[np.abs(det) < 1e-12] = np.nan
        u = ((start - a) * across).sum(axis=1) / det
        along = np.cross(start - a, b - a)
        v, t = (along @ way) / det, ((c - a) * along).sum(axis=1) / det
        count += ((u > 1e-9) & (v > 1e-9) & (u + v < 1 - 1e-9) & (t > 1e-9) & (t < 1 - 1e-9)).sum()
    return count


@pytest.mark.parametrize("sharpness", [0.5, 0.6, 0.8, 1.0])
def test_no_sharp_lid_passes_through_itself(sharpness):
    vertices, faces = shapes.cube(3, 2.0)
    open_box = faces[vertices[faces].mean(axis=1)[:, 2] > -1 + 1e-9]
    mesh = ridgeform.Mesh(vertices, open_box)
    filled = ridgeform.fill_holes(mesh, shape="sharp", sharpness=sharpness)
    assert (filled.patch >= 0).any()
    assert passes_through(filled.vertices, filled.faces) == 0


@pytest.mark.parametrize(("shape", "lengths"), [("smooth", (0.1, 0.03, 0.01, 0.005)), ("auto", (0.03, 0.01))])
def test_shorter_edges_give_more_faces_up_to_the_most_there_are(shape, lengths):
    mesh, _ = turned_cube(8, [1, 0, 1], 0.5)
    counts, edges = [], []
    for length in lengths:
        filled = ridgeform.fill_holes(mesh, edge_length=length, shape=shape)
        check_invariants(mesh, filled)
        new = patch_faces(filled)
        counts.append(len(new))
        sides = filled.vertices[new] - filled.vertices[np.roll(new, 1, axis=1)]
        edges.append(np.median(np.linalg.norm(sides, axis=2)))
    assert np.all(np.diff(counts) > 0)
    assert counts[-1] > 10_000
    assert counts[-1] < 60_000
    # The shortest of "smooth" would take more faces than a patch may have.
    assert np.all(np.array(edges[:2]) < 1.3 * np.array(lengths[:2]))


def test_the_same_input_gives_the_same_bits():
    mesh, _ = turned_cube(12, [1, 1, 0.1], 0.5)
    first, second = (ridgeform.fill_holes(mesh, threads=k) for k in (1, 2))
    assert np.array_equal(first.vertices, second.vertices)
    assert np.array_equal(first.faces, second.faces)


def test_several_holes_at_once():
    vertices, faces = shapes.cube(16, 2.0)
    centers = vertices[faces].mean(axis=1)
    spots = np.array([[1, 1, 0.1], [-1, 0.2, 0.1], [-1, -1, -1]])
    away = np.linalg.norm(centers[:, None] - spots, axis=2).min(axis=1)
    mesh = ridgeform.Mesh(vertices, faces[away > 0.35])
    filled = ridgeform.fill_holes(mesh)
    check_invariants(mesh, filled)
    assert len(filled.holes) == 3
    assert sorted({*filled.patch}) == [-1, 0, 1, 2]


@pytest.mark.parametrize(
    ("bend", "radius", "place"), [(138, 0.4, 0), (142, 0.3, 0.05), (146, 0.5, 0), (150, 0.4, 0)]
)
def test_ridges_of_wedges_come_back(bend, radius, place):
    half = np.radians(bend) / 2
    flat, faces = shapes.grid(24, 24)
    across, along = (flat[:, :2] / 12 - 1).T
    vertices = np.column_stack([across * np.cos(half), along, -np.abs(across) * np.sin(half)])
    away = np.linalg.norm(vertices[faces].mean(axis=1) - [0, place, 0], axis=1)
    mesh = ridgeform.Mesh(vertices, faces[away > radius])
    loop = min(ridgeform.boundary_loops(mesh), key=len)
    filled = ridgeform.fill_holes(mesh, loops=[loop])
    assert filled.holes[0].shape == "sharp"
    sides = np.array([[np.sin(half), 0, np.cos(half)], [-np.sin(half), 0, np.cos(half)]])
    assert np.abs(filled.new_vertices @ sides.T).min(axis=1).max() < 1e-6


def test_progress_shows_the_patch_and_can_stop_it(cancelled):
    mesh, _ = turned_cube(12, [1, 1, 0.1], 0.5)
    progress = ridgeform.Progress()
    progress.finish()
    filled = ridgeform.fill_holes(mesh, progress=progress)
    assert filled.status == "stopped"
    check_invariants(mesh, filled)
    vertices, faces = progress.snapshot_surface()
    assert len(faces) == len(patch_faces(filled))
    assert faces.max() == len(vertices) - 1
    with pytest.raises(ridgeform.Cancelled):
        ridgeform.fill_holes(mesh, progress=cancelled)


@pytest.mark.parametrize(
    ("keywords", "word"),
    [
        ({"fidelity": 0.0}, "fidelity"),
        ({"sharpness": 2.0}, "sharpness"),
        ({"sharpness": "much"}, "sharpness"),
        ({"edge_length": -1.0}, "edge_length"),
        ({"loops": [7]}, "loops"),
        ({"loops": 3}, "loops"),
        ({"loops": [[0, 1, 10**6]]}, "loops"),
        ({"iterations": -1}, "iterations"),
        ({"scale": "big"}, "scale"),
    ],
)
def test_wrong_arguments_are_named(keywords, word):
    mesh, _ = turned_cube(12, [1, 1, 0.1], 0.5)
    with pytest.raises(ridgeform.ArgumentError, match=word):
        ridgeform.fill_holes(mesh, **keywords)


def test_vertices_that_are_no_loop_are_refused():
    mesh, _ = turned_cube(12, [1, 1, 0.1], 0.5)
    with pytest.raises(ridgeform.MeshError, match="boundary"):
        ridgeform.fill_holes(mesh, loops=[[0, 1, 2]])


def test_the_whole_is_the_mesh_and_what_is_new():
    mesh, _ = turned_cube(8, [1, 1, 0.1], 0.5, 7)
    filled = ridgeform.fill_holes(mesh)
    assert filled.vertices is filled.vertices
    np.testing.assert_array_equal(filled.vertices, np.concatenate([mesh.vertices, filled.new_vertices]))
    np.testing.assert_array_equal(filled.faces, np.concatenate([mesh.faces, filled.new_faces]))
    assert (filled.patch[: mesh.n_faces] == -1).all()
    np.testing.assert_array_equal(filled.patch[mesh.n_faces :], filled.new_patch)
    assert (filled.new_patch == 0).all()
    assert filled.vertices.dtype == np.float64
    assert filled.faces.dtype == filled.patch.dtype == np.int32


def test_a_wide_hole_across_an_edge_has_no_folds():
    """Ninety edges wide: the patch reached its planes with three folds in them, and was given up."""
    vertices, faces = shapes.cube(100, 100 / 12)
    side = vertices.max()
    filled = ridgeform.fill_holes(without(vertices, faces, [side, 0.1, side], 2.0))
    new = np.asarray(filled.new_vertices)
    assert np.minimum(side - new[:, 0], side - new[:, 2]).max() < 1e-9


def test_a_hole_named_twice_is_filled_by_neither():
    vertices, faces = shapes.icosphere(2)
    mesh = ridgeform.Mesh(vertices, faces[1:])
    (rim,) = ridgeform.boundary_loops(mesh)
    for loops in ([0, 0], [0, rim], [rim, np.roll(rim, 1)[::-1]]):
        with pytest.raises(ridgeform.ArgumentError, match="loops: entries 0 and 1 are the same hole"):
            ridgeform.fill_holes(mesh, loops=loops)
