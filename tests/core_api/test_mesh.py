"""`Mesh`, `MeshReport` and `boundary_loops`: what goes in comes out, and what is unusual is told."""

import numpy as np
import pytest
import ridgeform
from known_shapes import shapes


def test_a_mesh_gives_back_what_it_was_made_from():
    vertices, faces = shapes.icosphere(1)
    mesh = ridgeform.Mesh(vertices, faces)
    np.testing.assert_array_equal(mesh.vertices, vertices)
    np.testing.assert_array_equal(mesh.faces, faces)
    assert (mesh.n_vertices, mesh.n_faces) == (42, 80)
    assert repr(mesh) == "<ridgeform.Mesh: 42 vertices, 80 faces>"


def test_column_i_of_the_lengths_is_opposite_corner_i():
    mesh = ridgeform.Mesh([[0, 0, 0], [3, 0, 0], [0, 4, 0]], [[0, 1, 2]])
    np.testing.assert_array_equal(mesh.edge_lengths, [[5, 4, 3]])


def test_arrays_are_fresh_so_that_a_mesh_never_changes():
    vertices, faces = shapes.tetrahedron()
    mesh = ridgeform.Mesh(vertices, faces)
    for name in ("vertices", "faces", "edge_lengths"):
        array = getattr(mesh, name)
        before = array.copy()
        array[:] = 0
        np.testing.assert_array_equal(getattr(mesh, name), before)
    vertices[:] = 0
    assert np.abs(mesh.vertices).max() == 1


def test_a_mesh_of_lengths_has_no_positions():
    _, faces = shapes.tetrahedron()
    mesh = ridgeform.Mesh.from_edge_lengths(faces, np.ones((4, 3)), n_vertices=6)
    assert mesh.vertices is None
    assert mesh.n_vertices == 6
    assert ridgeform.Mesh.from_edge_lengths(faces, np.ones((4, 3))).n_vertices == 4
    np.testing.assert_array_equal(mesh.edge_lengths, np.ones((4, 3)))
    assert "edge lengths only" in repr(mesh)


@pytest.mark.parametrize(
    ("lengths", "message"),
    [
        ([[1, 1, 1], [1, 1, 3]], "face 1 violate the triangle inequality"),
        ([[1, 1, 1], [1, np.nan, 1]], "face 1 has an edge length"),
        ([[1, 1, -1], [1, 1, 1]], "face 0 has an edge length"),
        ([[1, 1, 1], [1, 1, 1.2]], "faces 0 and 1"),
    ],
)
def test_impossible_lengths_are_refused_by_face(lengths, message):
    with pytest.raises(ridgeform.MeshError, match=message):
        ridgeform.Mesh.from_edge_lengths([[0, 1, 2], [1, 0, 3]], lengths)


def test_lengths_need_one_row_a_face():
    with pytest.raises(ridgeform.RidgeformError, match="1"):
        ridgeform.Mesh.from_edge_lengths([[0, 1, 2], [1, 0, 3]], [[1, 1, 1]])


@pytest.mark.parametrize("face", [[0, 1, 4], [0, 1, -1], [0, 1, 2**40], [0, 1, 2**31]])
def test_faces_that_name_missing_vertices_are_refused(face):
    vertices, _ = shapes.tetrahedron()
    with pytest.raises(ridgeform.MeshError, match=f"face 1 names vertex {face[2]}.*only 4 vertices"):
        ridgeform.Mesh(vertices, [[0, 1, 2], face])


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_coordinates_must_be_finite(bad):
    vertices, faces = shapes.tetrahedron()
    vertices[2, 1] = bad
    with pytest.raises(ridgeform.MeshError, match="vertex 2"):
        ridgeform.Mesh(vertices, faces)


def test_a_clean_mesh_reports_nothing():
    report = ridgeform.Mesh(*shapes.torus()).report
    assert (report.n_components, report.n_boundary_loops) == (1, 0)
    assert report.nonmanifold_edges.shape == (0, 2)
    lists = ("duplicate_faces", "doubled_faces", "t_junctions", "nonmanifold_vertices", "degenerate_faces")
    for name in (*lists, "unreferenced_vertices"):
        array = getattr(report, name)
        assert array.shape == (0,)
        assert array.dtype == np.int32


def test_the_report_names_what_is_unusual():
    assert ridgeform.Mesh(*shapes.bow_tie()).report.nonmanifold_vertices.tolist() == [0]
    assert ridgeform.Mesh(*shapes.three_faces_on_an_edge()).report.nonmanifold_edges.tolist() == [[0, 1]]
    twisted = ridgeform.Mesh(*shapes.moebius_strip()).report
    assert twisted.nonmanifold_edges.shape == (1, 2)
    np.testing.assert_array_equal(twisted.inconsistent_edges, twisted.nonmanifold_edges)
    vertices, faces = shapes.tetrahedron()
    worse = ridgeform.Mesh([*vertices, [9, 9, 9]], [*faces, [1, 2, 0], [0, 0, 1]]).report
    assert worse.unreferenced_vertices.tolist() == [4]
    assert worse.duplicate_faces.tolist() == [4]
    assert worse.degenerate_faces.tolist() == [5]
    assert "1 duplicate" in repr(worse)


def test_the_report_names_second_lids_and_t_junctions():
    corners = np.array([[x, y, z] for z in (0, 1) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))], float)
    quads = np.array([[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]])
    box = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    assert ridgeform.Mesh(corners, box).report.doubled_faces.tolist() == []
    # A second lid, cut along the other diagonal.
    twice = ridgeform.Mesh(corners, np.vstack([box, [[4, 5, 7], [5, 6, 7]]])).report
    assert twice.doubled_faces.tolist() == [1, 7, 12, 13]
    assert twice.duplicate_faces.tolist() == []
    # One square beside two, whose common corner is in the middle of its edge; and the same as a soup.
    points = np.array([[0, 0], [2, 0], [2, 2], [0, 2], [2, 1], [3, 0], [3, 1], [3, 2]], float)
    vertices = np.column_stack([points, np.zeros(8)])
    faces = np.array([[0, 1, 2], [0, 2, 3], [1, 5, 6], [1, 6, 4], [4, 6, 7], [4, 7, 2]])
    assert ridgeform.Mesh(vertices, faces).report.t_junctions.tolist() == [4]
    soup = ridgeform.Mesh(vertices[faces].reshape(-1, 3), np.arange(18).reshape(-1, 3)).report
    np.testing.assert_array_equal(vertices[faces].reshape(-1, 3)[soup.t_junctions], vertices[[4]])


def test_components_are_counted():
    vertices, faces = shapes.cube(2)
    two = ridgeform.Mesh(
        np.concatenate([vertices, vertices + 5]), np.concatenate([faces, faces + len(vertices)])
    )
    assert two.report.n_components == 2


def test_boundary_loops_run_along_the_boundary():
    mesh = ridgeform.Mesh(*shapes.open_cone(8))
    (loop,) = ridgeform.boundary_loops(mesh)
    assert loop.dtype == np.int32
    start = loop.tolist().index(1)
    assert np.roll(loop, -start).tolist() == list(range(1, 9))
    assert ridgeform.boundary_loops(ridgeform.Mesh(*shapes.cube(2))) == []
    assert mesh.report.n_boundary_loops == 1


def test_an_empty_mesh_is_a_mesh():
    mesh = ridgeform.Mesh(np.zeros((0, 3)), np.zeros((0, 3), int))
    assert (mesh.n_vertices, mesh.n_faces) == (0, 0)
    assert ridgeform.voronoi_mass(mesh).shape == (0,)
    assert ridgeform.hessian(mesh).shape == (0, 0)
    assert ridgeform.boundary_loops(mesh) == []
    with pytest.raises(ridgeform.RidgeformError):
        ridgeform.stylize(mesh)
