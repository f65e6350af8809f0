"""`facet` where a mesh has thousands of one thing in one place."""

import time

import numpy as np
import pytest
import ridgeform
from known_shapes import shapes


@pytest.mark.parametrize("crowd", ["book", "copies", "place"])
def test_thousands_in_one_place_take_a_time_in_proportion(crowd):
    # Each took minutes: all pairs of a corner with its facets were unknowns of one dense system, and all
    # triangles on each other were looked at for each of them.
    count = 3000
    if crowd == "book":
        angles = 2 * np.pi * np.arange(count) / count
        tips = np.column_stack([np.cos(angles), np.sin(angles), 0.5 + 0 * angles])
        vertices = np.vstack([[[0, 0, 0], [0, 0, 1]], tips])
        faces = np.column_stack([np.zeros(count), np.ones(count), 2 + np.arange(count)])
    else:
        vertices, faces = shapes.grid(60, 60)
        if crowd == "copies":
            faces = np.vstack([faces[:200], np.repeat(faces[50:51], count, axis=0)])
        else:
            vertices[:count] = vertices[0]
    mesh = ridgeform.Mesh(vertices, faces.astype(np.int64))
    before = time.process_time()
    found = ridgeform.facet(mesh, threads=1)
    assert time.process_time() - before < 20.0
    assert np.isfinite(found.vertices).all()
    planes = found.planes[found.face_facets]
    heights = (planes[:, None, :3] * found.vertices[found.faces]).sum(2) - planes[:, None, 3]
    assert np.abs(heights).max() <= 1e-6 * np.ptp(vertices, axis=0).max()


def test_planes_nearer_than_promised_are_not_fitted_any_nearer():
    # Each of some sixty rounds came nearer by a thousandth of two ten-millionths of the diagonal.
    sides = 1000
    angles = 2 * np.pi * np.arange(sides) / sides
    ring = np.column_stack([np.cos(angles), np.sin(angles), 0 * angles])
    vertices = np.vstack([ring, ring + np.array([0, 0, 1]), [[0, 0, 0], [0, 0, 1]]])
    here, after = np.arange(sides), (np.arange(sides) + 1) % sides
    bottom, top = np.full(sides, 2 * sides), np.full(sides, 2 * sides + 1)
    parts = [
        [here, after, sides + after],
        [here, sides + after, sides + here],
        [bottom, after, here],
        [top, sides + here, sides + after],
    ]
    faces = np.concatenate([np.column_stack(part) for part in parts])
    progress = ridgeform.Progress()
    found = ridgeform.facet(ridgeform.Mesh(vertices, faces), facets=sides, progress=progress)
    assert progress.stage == "fitting planes"
    assert progress.iteration <= 100
    assert found.rms <= 1e-6 * np.linalg.norm([2, 2, 1])
    assert found.n_crossings == 0


def test_among_hundreds_of_holes_faults_do_not_spread_by_repairs():
    # Repairs crossed the neighbors, and what crossed was divided: it took 4 s and left 320 facets.
    side = 70
    vertices, faces = shapes.grid(side, side)
    vertices += np.random.default_rng(0).normal(scale=0.05, size=vertices.shape)
    row, column = np.divmod(np.arange(side * side), side)
    is_kept = np.tile((row % 3 != 1) | (column % 3 != 1), 2)
    found = ridgeform.facet(ridgeform.Mesh(vertices, faces[is_kept]), facets=200)
    assert found.n_crossings == 0
    assert found.n_facets <= 300
