"""Divide a mesh into the faces that a person would name, in as many segments as you like from one run.

    python segment_parts.py mesh.npz

The file holds `vertices` (n,3) and `faces` (m,3), as `numpy.savez` writes them.
"""

import sys

import numpy as np
import ridgeform

data = np.load(sys.argv[1])
mesh = ridgeform.Mesh(data["vertices"], data["faces"])
found = ridgeform.segment(mesh)

fewest, most = found.range
print(f"{found.n_segments} segments; any number from {fewest} to {most} is possible without computing again")

corners = mesh.vertices[mesh.faces]
areas = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1) / 2
for label, area in enumerate(np.bincount(found.labels, areas)):
    print(f"segment {label}: {100 * area / areas.sum():.1f} % of the area")

coarse = found.labels_at(max(fewest, min(4, most)))
print(f"as {coarse.max() + 1} segments: {np.bincount(coarse).tolist()} faces")
