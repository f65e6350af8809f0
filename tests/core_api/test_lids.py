"""Planar rims that the surface meets steeply all round are closed flat: any density, noise, and fringe."""

import numpy as np
import pytest
import ridgeform
from known_shapes import shapes


def box(n, size=(2.0, 2.0, 2.0)):
    """A box of n squares a side around the origin."""
    vertices, faces = shapes.cube(n, 2.0)
    return vertices * (np.asarray(size) / 2), faces


def normals(vertices, faces):
    """Unit normals; zero where a face has no area."""
    a, b, c = (vertices[faces[:, i]] for i in range(3))
    cross = np.cross(b - a, c - a)
    return cross / np.maximum(np.linalg.norm(cross, axis=1, keepdims=True), 1e-300)


def open_box(n, size=(2.0, 2.0, 2.0)):
    """A box without its top."""
    vertices, faces = box(n, size)
    return vertices, faces[normals(vertices, faces)[:, 2] < 0.9]


def fringed(n, depth, seed=0):
    """An open box whose upper rows lost faces at random."""
    vertices, faces = open_box(n)
    centers = vertices[faces].mean(axis=1)
    top = (centers[:, 2] > 1 - depth * 2 / n) & (np.abs(normals(vertices, faces)[:, 2]) < 0.1)
    lost = top & (np.random.default_rng(seed).random(len(faces)) < 0.4)
    return vertices, faces[~lost]


def worst_bend(vertices, faces, patch):
    """The largest angle in degrees between the normals of neighbors, of which one is of the patch."""
    pairs = {}
    for f, face in enumerate(faces.tolist()):
        for a, b in zip(face, face[1:] + face[:1], strict=True):
            pairs.setdefault((min(a, b), max(a, b)), []).append(f)
    n = normals(vertices, faces)
    both = [p for p in pairs.values() if len(p) == 2 and (patch[p[0]] >= 0 or patch[p[1]] >= 0)]
    first, second = np.array(both).T
    return np.degrees(np.arccos(np.clip((n[first] * n[second]).sum(axis=1), -1, 1))).max()


def volume(vertices, faces):
    """The volume that a closed mesh encloses."""
    a, b, c = (vertices[faces[:, i]] for i in range(3))
    return (a * np.cross(b, c)).sum() / 6


@pytest.mark.parametrize("n", [1, 2, 3, 4, 8, 16, 25])
@pytest.mark.parametrize("size", [(2, 2, 2), (2, 2, 0.4), (1, 3, 2)])
def test_a_box_gets_its_side_back(n, size):
    vertices, faces = open_box(n, size)
    rotation = shapes.random_rotation(n)
    filled = ridgeform.fill_holes(ridgeform.Mesh(vertices @ rotation.T, faces))
    assert [hole.shape for hole in filled.holes] == ["flat"]
    back = filled.vertices @ rotation
    assert np.abs(back[np.unique(filled.new_faces)][:, 2] - size[2] / 2).max() < 1e-12
    assert volume(back, filled.faces) == pytest.approx(np.prod(size), rel=1e-12)
    assert normals(back, filled.new_faces)[:, 2].min() > 1 - 1e-9
    assert ridgeform.Mesh(back, filled.faces).report.n_boundary_loops == 0


@pytest.mark.parametrize("sharpness", ["auto", 0.0, 0.5, 1.0])
def test_a_lid_does_not_depend_on_the_sharpness(sharpness):
    filled = ridgeform.fill_holes(ridgeform.Mesh(*open_box(12)), sharpness=sharpness)
    assert np.abs(filled.new_vertices[:, 2] - 1).max() < 1e-12


@pytest.mark.parametrize("segments", [6, 16, 48])
def test_both_ends_of_a_tube_are_closed_flat(segments):
    vertices, faces = shapes.cylinder(segments, 10, 3)
    tube = faces[np.abs(normals(vertices, faces)[:, 2]) < 0.5]
    filled = ridgeform.fill_holes(ridgeform.Mesh(vertices, tube))
    assert [hole.shape for hole in filled.holes] == ["flat", "flat"]
    assert np.abs(np.abs(filled.new_vertices[:, 2]) - 1).max() < 1e-12


@pytest.mark.parametrize("noise", [0.05, 0.15, 0.3])
@pytest.mark.parametrize("seed", range(3))
def test_the_lid_of_a_noisy_box_lies_in_the_mean_plane(noise, seed):
    n = 16
    vertices, faces = shapes.cube(n, 2.0)
    noisy = shapes.add_noise(vertices, faces, noise, seed, edge=2 / n)
    kept = faces[normals(vertices, faces)[:, 2] < 0.9]
    filled = ridgeform.fill_holes(ridgeform.Mesh(noisy, kept))
    (hole,) = filled.holes
    assert hole.shape == "flat"
    # Closing deep notches first lifts the mean of what is left of the rim a little.
    assert np.abs(filled.new_vertices[:, 2] - 1).max() < 0.2 * 2 / n
    assert normals(filled.vertices, filled.new_faces)[:, 2].min() > 0


def test_several_rims_of_one_mesh_and_a_rim_on_a_limb():
    vertices, faces = shapes.icosphere(4)
    vertices = vertices * [1, 1, 3]
    centers = vertices[faces].mean(axis=1)
    limb = ridgeform.Mesh(vertices, faces[np.abs(centers[:, 2]) < 1.0])
    filled = ridgeform.fill_holes(limb)
    assert [hole.shape for hole in filled.holes] == ["flat", "flat"]
    boxes = [open_box(k) for k in (3, 8)]
    both = np.concatenate([boxes[0][0], boxes[1][0] + [5, 0, 0]])
    joined = np.concatenate([boxes[0][1], boxes[1][1] + len(boxes[0][0])])
    filled = ridgeform.fill_holes(ridgeform.Mesh(both, joined))
    assert volume(filled.vertices, filled.faces) == pytest.approx(16, rel=1e-12)


@pytest.mark.parametrize("shape", ["auto", "flat", "smooth", "sharp"])
@pytest.mark.parametrize("depth", [1, 2])
@pytest.mark.parametrize("seed", range(1))
def test_no_patch_in_a_fringed_rim_folds_or_faces_inwards(shape, depth, seed):
    vertices, faces = fringed(12, depth, seed)
    mesh = ridgeform.Mesh(vertices, faces)
    holes = ridgeform.find_holes(mesh)
    rim = max(range(len(holes)), key=lambda i: len(holes[i].vertices))
    filled = ridgeform.fill_holes(mesh, loops=[rim], shape=shape, iterations=12)
    assert len(filled.new_faces)
    assert normals(filled.vertices, filled.new_faces)[:, 2].min() > -0.5
    assert worst_bend(filled.vertices, filled.faces, filled.patch) < 160
    assert np.array_equal(filled.vertices[: len(vertices)], vertices)


@pytest.mark.parametrize("depth", [1, 2])
@pytest.mark.parametrize("n", [8, 12, 20])
@pytest.mark.parametrize("seed", range(3))
def test_a_fringed_rim_is_closed_flat(n, depth, seed):
    vertices, faces = fringed(n, depth, seed)
    mesh = ridgeform.Mesh(vertices, faces)
    holes = ridgeform.find_holes(mesh)
    rim = max(range(len(holes)), key=lambda i: len(holes[i].vertices))
    filled = ridgeform.fill_holes(mesh, loops=[rim])
    assert [hole.shape for hole in filled.holes] == ["flat"]
    assert np.abs(filled.new_vertices[:, 2] - 1).max() < 0.5 * 2 / n
    assert normals(filled.vertices, filled.new_faces)[:, 2].min() > -1e-9


def test_holes_that_are_no_lids_stay_what_they_are():
    vertices, faces = box(16)
    centers = vertices[faces].mean(axis=1)
    ring = ridgeform.Mesh(
        vertices, faces[(centers[:, 2] < 0.999) | (np.abs(centers[:, :2]).max(axis=1) > 0.87)]
    )
    assert [hole.shape for hole in ridgeform.fill_holes(ring).holes] == ["smooth"]
    edge = ridgeform.Mesh(vertices, faces[np.linalg.norm(centers - [1, 0, 1], axis=1) > 0.5])
    assert [hole.shape for hole in ridgeform.fill_holes(edge).holes] == ["sharp"]
    vertices, faces = shapes.icosphere(4)
    cap = ridgeform.Mesh(vertices, faces[vertices[faces].mean(axis=1)[:, 2] < 0.8])
    assert [hole.shape for hole in ridgeform.fill_holes(cap).holes] == ["smooth"]


def test_flat_closes_any_rim_in_its_mean_plane():
    vertices, faces = shapes.icosphere(4)
    cap = ridgeform.Mesh(vertices, faces[vertices[faces].mean(axis=1)[:, 2] < 0.8])
    filled = ridgeform.fill_holes(cap, shape="flat")
    assert [hole.shape for hole in filled.holes] == ["flat"]
    assert np.ptp(filled.new_vertices[:, 2]) < 0.02
    with pytest.raises(ridgeform.ArgumentError, match="shape"):
        ridgeform.fill_holes(cap, shape="round")
