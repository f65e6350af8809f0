"""Any filling of any holes leaves a sound mesh: random holes in ten meshes.

`benchmarks/holes.py --stress` runs 500 of them.
"""

import numpy as np
import pytest
import ridgeform
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
