"""`facet`: symmetric meshes give symmetric facets where that is asked for."""

import numpy as np
import pytest
import ridgeform
from known_shapes import segment_shapes, shapes
from test_facet import check_sound, directed_sides, polygons


def bumpy(n=8, seed=0):
    """A ball with bumps, symmetric across x = 0, whose edges do not run along that plane."""
    vertices, faces = shapes.voxels([(0, 0, 0)], n)
    vertices = vertices - vertices.mean(0)
    vertices /= np.linalg.norm(vertices, axis=1, keepdims=True)
    waves = np.random.default_rng(seed).normal(size=(3, 3))
    even = np.stack([vertices[:, 0] ** 2, vertices[:, 1], vertices[:, 2]], axis=1)
    heights = 1 + 0.1 * np.sin(3 * even @ waves).sum(1)
    return vertices * heights[:, None], faces


def rings(found, at=0.0, axis=0):
    """The polygons as sets of places, and their images."""
    places = np.round(found.vertices, 9) + 0.0
    own = {frozenset(map(tuple, places[ring])) for ring in polygons(found)}
    moved = places.copy()
    moved[:, axis] = np.round(2 * at - found.vertices[:, axis], 9) + 0.0
    return own, {frozenset(map(tuple, moved[ring])) for ring in polygons(found)}


@pytest.mark.parametrize("n", [8, 9])
@pytest.mark.parametrize("facets", [20, 61, None])
@pytest.mark.parametrize("seed", range(2))
def test_facets_of_a_symmetric_mesh_are_symmetric(n, facets, seed):
    vertices, faces = bumpy(n, seed)
    mesh = ridgeform.Mesh(vertices, faces)
    found = ridgeform.facet(mesh, facets=facets, symmetric="x")
    check_sound(found, np.linalg.norm(np.ptp(vertices, axis=0)))
    own, mirrored = rings(found)
    assert own == mirrored
    plain = ridgeform.facet(mesh, facets=found.n_facets)
    assert found.rms <= 1.5 * plain.rms
    if facets is not None:
        assert abs(found.n_facets - facets) <= 2
    assert found.labels.min() >= 0 and found.labels.max() < found.n_facets
    # Both sides of a face and its image have facets that are images of each other.
    normals = found.planes[found.labels, :3]
    a, b, c = (vertices[faces[:, i]] for i in range(3))
    assert ((np.cross(b - a, c - a) * normals).sum(1) > 0).mean() > 0.97


@pytest.mark.parametrize("seed", range(3))
def test_lines_along_the_mirror_leave_no_face_on_its_own_image(seed):
    vertices, faces = bumpy(16, seed)
    on = np.abs(vertices[:, 0]) < 1e-12
    vertices[on, 1:] += np.random.default_rng(seed).normal(0, 0.06, (on.sum(), 2))
    found = ridgeform.facet(ridgeform.Mesh(vertices, faces), facets=60, symmetric="x")
    report = ridgeform.Mesh(found.vertices, found.faces).report
    assert not len(report.nonmanifold_edges) and not len(report.duplicate_faces)
    assert len(np.unique(found.faces)) == len(found.vertices)
    assert report.n_boundary_loops == 0


@pytest.mark.parametrize("name", ["cube", "l_shape", "house"])
@pytest.mark.parametrize("n", [1, 2])
def test_planes_across_the_mirror_stay_whole(name, n):
    part = getattr(segment_shapes, name)(n)
    found = ridgeform.facet(ridgeform.Mesh(part.vertices, part.faces), symmetric="auto")
    check_sound(found, 4.0)
    assert found.n_facets == part.n_parts == len(polygons(found))
    assert segment_shapes.adjusted_rand_index(found.labels, part.truth) == 1


def test_a_cube_asked_for_six_is_a_cube_and_other_numbers_are_quick():
    vertices, faces = shapes.voxels([(0, 0, 0)], 5)
    found = ridgeform.facet(ridgeform.Mesh(vertices + 3.0, faces), facets=6, symmetric="y")
    assert (found.n_facets, found.largest < 1e-9) == (6, True)
    assert {len(ring) for ring in polygons(found)} == {4}
    bumps, faces = bumpy()
    first = ridgeform.facet(ridgeform.Mesh(bumps, faces), facets=30, symmetric="x")
    again = first.at(facets=60)
    other = ridgeform.facet(ridgeform.Mesh(bumps, faces), facets=60, symmetric="x")
    np.testing.assert_array_equal(again.vertices, other.vertices)


def test_an_open_mesh_and_one_with_an_odd_count_are_cut_at_the_plane():
    vertices, faces = shapes.grid(7, 4)
    found = ridgeform.facet(ridgeform.Mesh(vertices, faces), symmetric="x")
    check_sound(found, 1.0, is_closed=False)
    assert found.n_facets == 1 and len(found.polygon_vertices) == 4
    assert max(directed_sides([ring.tolist() for ring in polygons(found)]).values()) == 1


@pytest.mark.parametrize("word", ["x", "auto"])
def test_what_is_not_symmetric_is_refused(word):
    vertices, faces = bumpy()
    rng = np.random.default_rng(0)
    with pytest.raises(ridgeform.ArgumentError, match="symmetric: needs a mesh that is symmetric across"):
        mesh = ridgeform.Mesh(vertices + 0.05 * rng.normal(size=vertices.shape), faces)
        ridgeform.facet(mesh, symmetric=word)


@pytest.mark.parametrize("other", [{"faces": [0]}, {"keep_volume": True}, {"keep_triangles": True}])
def test_what_does_not_go_with_it_is_said(other):
    mesh = ridgeform.Mesh(*bumpy())
    with pytest.raises(ridgeform.ArgumentError, match=f"symmetric: does not go with {next(iter(other))}"):
        ridgeform.facet(mesh, symmetric="x", **other)
    with pytest.raises(ridgeform.ArgumentError, match='"w" is not known'):
        ridgeform.facet(mesh, symmetric="w")
