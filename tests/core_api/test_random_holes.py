"""Any filling of any holes leaves a sound mesh: random holes in ten meshes.

`benchmarks/holes.py --stress` runs 500 of them.
"""

import contextlib

import numpy as np
import pytest
import ridgeform
from fuzz import answers
from fuzz.meshes import MeshPlan
from known_shapes import random_holes

SEEDS = range(20)
"""Two for each mesh."""


@pytest.mark.parametrize("seed", SEEDS)
def test_filled_random_holes_leave_a_sound_mesh(seed):
    _, vertices, faces = random_holes.random_holes(seed)
    filled = ridgeform.fill_holes(ridgeform.Mesh(vertices, faces))
    assert (filled.patch >= 0).any()
    after = (filled.vertices, filled.faces.astype(np.int64))
    assert random_holes.faults((vertices, faces), after, filled.patch) == []


@pytest.mark.parametrize(
    ("base", "fault", "size"),
    [
        ("soup", "none", "one"),
        ("soup", "holes", "one"),
        ("moebius", "bow tie", "mixed"),
        ("grid", "bow tie", "mixed"),
        ("sphere", "holes", "mixed"),
        ("moebius", "holes", "one"),
    ],
)
def test_no_edge_gets_more_faces_than_it_can_have(base, fault, size):
    # Rims that touch themselves, and seams whose sides are many vertices in one place.
    n_patches = 0
    for seed in range(60):
        mesh = ridgeform.Mesh(*MeshPlan(base, 1 + seed % 5, fault, size, 0, seed).make())
        given = {"outer": seed % 2 == 1, "iterations": 3}
        with contextlib.suppress(ridgeform.SolveError):
            answers.fill_holes(mesh, given, sane=True)
            n_patches += len(ridgeform.fill_holes(mesh, **given).new_faces) > 0
    assert n_patches >= 10
