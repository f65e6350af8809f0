"""The operator itself, as a SciPy sparse matrix, for methods of your own. Needs SciPy.

python hessian_matrix.py
"""

import numpy as np
import ridgeform

n = 20
x, y = (grid.ravel() for grid in np.meshgrid(np.linspace(-1, 1, n), np.linspace(-1, 1, n), indexing="ij"))
a = (n * np.arange(n - 1)[:, None] + np.arange(n - 1)).ravel()
faces = np.concatenate([np.stack([a, a + n, a + n + 1], 1), np.stack([a, a + n + 1, a + 1], 1)])
mesh = ridgeform.Mesh(np.column_stack([x, y, np.zeros_like(x)]), faces)

hessian = ridgeform.hessian(mesh).to_scipy()  # four rows for each face: a 2 x 2 matrix
print(f"{hessian.shape[0]} x {hessian.shape[1]}, {hessian.nnz} entries")

plane, fold = 2 * x - y + 3, np.abs(x)
print(f"largest entry for a plane: {np.abs(hessian @ plane).max():.1e}")
norms = np.linalg.norm((hessian @ fold).reshape(-1, 4), axis=1)
print(f"energy of a fold: {norms.sum():.3f}, the same by name: {ridgeform.energy(mesh, fold):.3f}")
print(f"faces that bend: {(norms > 1e-9).sum()} of {mesh.n_faces}, all along the fold")
