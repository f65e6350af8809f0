"""Remove noise from values on a surface (temperatures, distances, weights) and keep their creases.

    python denoise_values.py

Compares the sharp energy (L1) with a smooth one (L2) on a roof-shaped function with noise.
"""

import numpy as np
import ridgeform

n = 45
x, y = (grid.ravel() for grid in np.meshgrid(np.linspace(-1, 1, n), np.linspace(-1, 1, n), indexing="ij"))
a = (n * np.arange(n - 1)[:, None] + np.arange(n - 1)).ravel()
faces = np.concatenate([np.stack([a, a + n, a + n + 1], 1), np.stack([a, a + n + 1, a + 1], 1)])
mesh = ridgeform.Mesh(np.column_stack([x, y, np.zeros_like(x)]), faces)

truth = 1 - np.abs(x + 0.5 * y)
noisy = truth + np.random.default_rng(0).normal(scale=0.1, size=truth.shape)


def error(values):
    """Root mean square error."""
    return np.sqrt(np.mean((values - truth) ** 2))


sharp = ridgeform.denoise(mesh, noisy, fidelity=1e3)
smooth = ridgeform.denoise(mesh, noisy, fidelity=3e3, energy="l2_curved_hessian")
print(
    f"noise {error(noisy):.4f}, left by L1 {error(sharp.values):.4f}, left by L2 {error(smooth.values):.4f}"
)
print(f"certified: the L1 result costs at most {100 * sharp.gap:.2f} % more than the best possible one")
