"""Close the holes of a mesh; the ridges that they cut off come back.

    python fill_holes.py

A bent sheet (a roof) with a hole across its ridge. The outer border of the sheet is no hole and stays open.
"""

import numpy as np
import ridgeform

n = 31
x, y = (grid.ravel() for grid in np.meshgrid(np.linspace(-1, 1, n), np.linspace(-1, 1, n), indexing="ij"))
vertices = np.column_stack([x, y, 0.6 - 0.6 * np.abs(x)])  # the ridge is the line x = 0
a = (n * np.arange(n - 1)[:, None] + np.arange(n - 1)).ravel()
faces = np.concatenate([np.stack([a, a + n, a + n + 1], 1), np.stack([a, a + n + 1, a + 1], 1)])
inside = (np.abs(vertices[a, :2] + 1 / (n - 1)) < 0.3).all(axis=1)  # squares, by their centers

mesh = ridgeform.Mesh(vertices, faces[~np.tile(inside, 2)])
for hole in ridgeform.find_holes(mesh):
    kind = "the outer border" if hole.is_outer_border else "a hole"
    print(f"{kind} of {len(hole.vertices)} edges" + (f", refused: {hole.refusal}" if hole.refusal else ""))

filled = ridgeform.fill_holes(mesh)
new = filled.new_vertices
off = np.abs(new[:, 2] - (0.6 - 0.6 * np.abs(new[:, 0]))).max()
print(f"{len(filled.new_faces)} new faces, ridges along {len(filled.ridges)} edges")
print(f"largest distance to the true roof: {off:.6f}")
