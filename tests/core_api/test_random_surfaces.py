"""`facet` and `restore` on meshes that nobody modeled: thin, holed, noisy, and faulty ones."""

import numpy as np
import pytest
import ridgeform
from fuzz import answers
from fuzz.meshes import BASES, FAULTS, MeshPlan
from known_shapes import shapes

COUNTS = [1, 4, 12, 40]


def solid(seed):
    """A torus, voxels, a flat sphere with holes or without, a strip, or a cylinder; most under noise."""
    rng = np.random.default_rng(seed)
    makers = [
        lambda: shapes.torus(int(rng.integers(12, 30)), int(rng.integers(6, 12)), 1.0, rng.uniform(0.1, 0.6)),
        lambda: shapes.voxels(sorted({tuple(map(int, c)) for c in rng.integers(0, 3, (5, 3))}), 2),
        lambda: shapes.icosphere(2),
        lambda: shapes.icosphere(3),
        lambda: shapes.moebius_strip(int(rng.integers(12, 60)), float(rng.uniform(0.1, 0.8))),
        lambda: shapes.cylinder(int(rng.integers(6, 30)), int(rng.integers(2, 6))),
    ]
    kind = seed % len(makers)
    vertices, faces = makers[kind]()
    if kind in (2, 3):
        vertices = vertices * [1, 1, rng.uniform(0.05, 1)]
    if kind == 2:
        faces = faces[rng.random(len(faces)) > 0.1]
    return shapes.add_noise(vertices, faces, float(rng.choice([0, 0.05, 0.2]))), faces


def hostile(seed):
    rng = np.random.default_rng(seed)
    base, fault = (names[rng.integers(len(names))] for names in (BASES, FAULTS))
    return MeshPlan(base, int(rng.integers(1, 6)), fault, "one", 0, seed).make()


@pytest.mark.parametrize("make", [solid, hostile])
@pytest.mark.parametrize("seed", range(24))
def test_what_comes_out_is_sound_and_what_is_to_stay_does(make, seed):
    rng = np.random.default_rng(100 + seed)
    mesh = ridgeform.Mesh(*make(seed))
    some = {"faces": rng.random(mesh.n_faces) < 0.7} if seed % 3 == 0 else {}
    count = {"facets": COUNTS[seed % len(COUNTS)]} if seed % 5 else {}
    try:
        answers.facet(mesh, some | count, sane=True)
        answers.restore(mesh, some, sane=True)
    except ridgeform.RidgeformError as error:
        # A line or a point has no planes.
        assert "no face with positive area" in str(error)
        corners = mesh.vertices[mesh.faces]
        areas = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
        assert areas.max(initial=0) < 1e-12


@pytest.mark.parametrize("faces", [[[0, 1, 2]], [[0, 1, 2], [0, 2, 1]], [[0, 1, 2], [0, 1, 2], [1, 1, 2]]])
@pytest.mark.parametrize("tool", [ridgeform.stylize, ridgeform.segment, ridgeform.restore, ridgeform.facet])
def test_one_triangle_and_its_copies_have_a_size(tool, faces):
    vertices = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0)], float)
    found = tool(ridgeform.Mesh(vertices, np.array(faces)))
    assert found.status not in {"stopped", "diverged"}
