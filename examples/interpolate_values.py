"""Spread a few known values over a whole surface, piecewise linear with sharp creases.

    python interpolate_values.py mesh.npz

The file holds `vertices` (n,3) and `faces` (m,3). The known values are heights at 60 vertices.
"""

import sys

import numpy as np
import ridgeform

data = np.load(sys.argv[1])
mesh = ridgeform.Mesh(data["vertices"], data["faces"])
truth = np.abs(mesh.vertices[:, 2] - mesh.vertices[:, 2].mean())

known = np.random.default_rng(0).choice(mesh.n_vertices, 60, replace=False)
found = ridgeform.interpolate(mesh, known, truth[known])

assert (found.values[known] == truth[known]).all()  # known values are kept exactly
error = np.sqrt(np.mean((found.values - truth) ** 2)) / truth.std()
print(
    f"{len(known)} of {mesh.n_vertices} values known; error {100 * error:.1f} % of the spread, {found.status}"
)
