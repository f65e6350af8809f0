"""`facet`: the mesh's own triangles kept on the facets, and the volume kept."""

import numpy as np
import pytest
import ridgeform
from known_shapes import segment_shapes, shapes
from test_facet import check_sound, source, volume, wavy_sphere


def on_facets(found, faces):
    """The largest distance of a corner of a face from the plane of its facet."""
    planes = found.planes[found.labels]
    heights = (planes[:, None, :3] * found.kept_vertices[faces]).sum(2) - planes[:, None, 3]
    return np.abs(heights).max()


def kept_faces(found, faces):
    return faces.ravel()[found.kept_corners]


def turned(found, faces):
    """How many faces look to the other side than their facet."""
    a, b, c = (found.kept_vertices[faces[:, i]] for i in range(3))
    return int(((np.cross(b - a, c - a) * found.planes[found.labels, :3]).sum(1) < 0).sum())


def edges(faces):
    return {
        tuple(edge)
        for edge in np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]))
    }


@pytest.mark.parametrize("name", ["cube", "house", "dodecahedron", "l_shape"])
@pytest.mark.parametrize("noise", [0.0, 0.15])
def test_the_triangles_of_a_polyhedron_go_onto_its_planes(name, noise):
    part = getattr(segment_shapes, name)(1)
    noisy = part.noisy(noise, 2)
    mesh = ridgeform.Mesh(noisy.vertices, noisy.faces)
    found = ridgeform.facet(mesh, keep_triangles=True)
    assert found.n_facets == part.n_parts
    assert on_facets(found, kept_faces(found, noisy.faces)) < 1e-6
    assert found.n_folded == 0 == turned(found, kept_faces(found, noisy.faces))
    assert volume(found.kept_vertices, kept_faces(found, noisy.faces)) == pytest.approx(
        volume(found.vertices, found.faces)
    )
    if noise == 0.0:
        assert found.n_flipped == 0
        np.testing.assert_allclose(found.kept_vertices, noisy.vertices, atol=1e-6)


@pytest.mark.parametrize("name", ["bust", "spot"])
@pytest.mark.parametrize("facets", [30, 200])
def test_triangles_are_kept_on_as_many_facets_as_are_wanted(name, facets):
    vertices, faces = source(name)
    mesh, size = ridgeform.Mesh(vertices, faces), np.linalg.norm(np.ptp(vertices, axis=0))
    found = ridgeform.facet(mesh, facets=facets, keep_triangles=True)
    check_sound(found, size)
    own = kept_faces(found, faces)
    assert abs(found.n_facets - facets) <= 0.03 * facets + 1
    assert found.kept_vertices.shape == vertices.shape and own.shape == faces.shape
    assert on_facets(found, own) <= 1e-6 * size
    assert on_facets(found, faces) <= 1e-6 * size
    assert turned(found, own) <= found.n_folded <= 0.005 * len(faces)
    # A flip takes one edge away.
    assert found.n_flipped >= len(edges(faces) - edges(own))
    assert sorted(found.kept_corners.ravel()) != sorted(range(3 * len(faces))) or found.n_flipped == 0
    assert np.bincount(own.ravel(), minlength=len(vertices)).min() > 0
    assert volume(found.kept_vertices, own) == pytest.approx(volume(found.vertices, found.faces))
    again = found.at(facets=2 * facets)
    assert again.kept_vertices is not None and again.n_facets > found.n_facets


def test_without_being_asked_no_triangles_are_kept():
    vertices, faces = shapes.voxels([(0, 0, 0)], 2)
    found = ridgeform.facet(ridgeform.Mesh(vertices, faces))
    assert found.kept_vertices is None and found.kept_corners is None


def test_kept_vertices_outside_the_mask_keep_their_bits_and_those_without_a_face():
    vertices, faces = source("bust")
    vertices = np.vstack([vertices, [[9.0, 9.0, 9.0]]])
    selected = vertices[faces].mean(1)[:, 0] > np.median(vertices[:, 0])
    mesh = ridgeform.Mesh(vertices, faces)
    found = ridgeform.facet(mesh, facets=40, faces=selected, keep_triangles=True)
    held = np.ones(len(vertices), bool)
    held[faces[selected]] = False
    held[faces[~selected]] = True
    np.testing.assert_array_equal(found.kept_vertices[held], vertices[held])
    assert (found.kept_vertices != vertices).any()
    np.testing.assert_array_equal(kept_faces(found, faces)[~selected], faces[~selected])


def test_faces_on_a_mesh_that_is_turned_over_in_parts_and_split_keep_their_corners():
    vertices, faces = shapes.voxels([(0, 0, 0)], 6)
    faces = np.where(np.arange(len(faces))[:, None] % 3 == 0, faces[:, ::-1], faces)
    rng = np.random.default_rng(3)
    noisy = vertices + 0.02 * rng.normal(size=vertices.shape)
    for corners, rows in (
        (noisy, faces),
        (noisy[faces].reshape(-1, 3), np.arange(faces.size).reshape(-1, 3)),
    ):
        found = ridgeform.facet(ridgeform.Mesh(corners, rows), keep_triangles=True)
        own = kept_faces(found, rows)
        assert found.n_facets == 6
        assert on_facets(found, own) < 1e-6
        is_own = (found.kept_corners == np.arange(rows.size).reshape(-1, 3)).all(1)
        np.testing.assert_array_equal(own[is_own], rows[is_own])
        assert found.n_flipped > 0 or is_own.all()


@pytest.mark.parametrize("name", ["bust", "spot"])
@pytest.mark.parametrize("facets", [12, 100])
def test_the_volume_is_kept(name, facets):
    vertices, faces = source(name)
    mesh, size = ridgeform.Mesh(vertices, faces), np.linalg.norm(np.ptp(vertices, axis=0))
    plain = ridgeform.facet(mesh, facets=facets)
    found = ridgeform.facet(mesh, facets=facets, keep_volume=True, keep_triangles=True)
    check_sound(found, size)
    wanted = volume(vertices, faces)
    assert volume(found.vertices, found.faces) == pytest.approx(wanted, rel=1e-9)
    assert volume(found.kept_vertices, kept_faces(found, faces)) == pytest.approx(wanted, rel=1e-6)
    assert abs(volume(plain.vertices, plain.faces) / wanted - 1) > 1e-4
    assert found.rms <= 1.3 * plain.rms


def test_the_volume_is_kept_beside_faces_that_stay():
    vertices, faces = source("bust")
    selected = vertices[faces].mean(1)[:, 0] > np.median(vertices[:, 0])
    found = ridgeform.facet(ridgeform.Mesh(vertices, faces), facets=40, faces=selected, keep_volume=True)
    assert volume(found.vertices, found.faces) == pytest.approx(volume(vertices, faces), rel=1e-5)
    kept = {tuple(sorted(map(tuple, vertices[face]))) for face in faces[~selected]}
    made = {tuple(sorted(map(tuple, found.vertices[face]))) for face in found.faces}
    assert kept <= made


def test_only_what_is_closed_has_a_volume_to_keep():
    vertices, faces = shapes.grid(4, 4)
    with pytest.raises(ridgeform.ArgumentError, match="keep_volume: needs a mesh that is closed"):
        ridgeform.facet(ridgeform.Mesh(vertices, faces), keep_volume=True)
    flat = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0.0]])
    with pytest.raises(ridgeform.ArgumentError, match="keep_volume: needs a mesh that encloses"):
        ridgeform.facet(ridgeform.Mesh(flat, [[0, 1, 2], [0, 2, 1]]), keep_volume=True)


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("facets", [None, 12, 40])
def test_thin_shapes_with_holes_keep_their_triangles(seed, facets):
    vertices, faces = wavy_sphere(seed, thickness=0.1 + 0.2 * (seed % 2), share_of_holes=0.03 * seed)
    found = ridgeform.facet(ridgeform.Mesh(vertices, faces), facets=facets, keep_triangles=True)
    assert np.isfinite(found.kept_vertices).all()
    assert found.n_crossings == 0
    assert on_facets(found, kept_faces(found, faces)) <= 2e-6


@pytest.mark.parametrize("name", ["bust", "spot"])
@pytest.mark.parametrize("axis", range(3))
def test_facets_meet_what_a_mask_holds_without_a_crack_or_a_fold(name, axis):
    vertices, faces = source(name)
    selected = vertices[faces].mean(1)[:, axis] > np.median(vertices[:, axis])
    found = ridgeform.facet(ridgeform.Mesh(vertices, faces), facets=60, faces=selected)
    assert found.n_crossings == 0
    places, rows = np.asarray(found.vertices), np.asarray(found.faces)
    beside = {}
    for row, (a, b, c) in enumerate(rows.tolist()):
        for side in ((a, b), (b, c), (c, a)):
            assert side not in beside
            beside[side] = row
    assert all((b, a) in beside for a, b in beside)
    stay = {tuple(place) for place in vertices[np.unique(faces[~selected])].tolist()}
    is_there = np.array([tuple(place) in stay for place in places.tolist()])
    assert {tuple(place) for place in places[is_there].tolist()} == stay
    a, b, c = (places[rows[:, i]] for i in range(3))
    normals = np.cross(b - a, c - a)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    is_still, is_held = is_there[rows].all(1), np.asarray(found.face_facets) >= found.n_facets

    def bends(one, other):
        pairs = [(row, beside[b, a]) for (a, b), row in beside.items() if one[row] and other[beside[b, a]]]
        first, second = np.array(pairs).T
        return (normals[first] * normals[second]).sum(1)

    # What stays against the rim of triangles that touch it, and that against the facets.
    assert bends(is_still, ~is_still).min() > 0.0
    assert (bends(is_held, ~is_held) < -0.5).mean() <= 0.01
