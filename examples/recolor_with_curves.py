"""Turn a painted surface into its few diffusion curves, change a color, and redraw it.

    python recolor_with_curves.py mesh.npz

The file holds `vertices` (n,3) and `faces` (m,3). The paint is white above and blue below.
"""

import sys

import numpy as np
import ridgeform

data = np.load(sys.argv[1])
mesh = ridgeform.Mesh(data["vertices"], data["faces"])
height = mesh.vertices[:, 2]
colors = np.where(height[:, None] > np.median(height), [1.0, 1.0, 1.0], [0.1, 0.2, 0.8])

found = ridgeform.diffusion_curves(mesh, colors)
print(f"{len(found.polylines)} curves: {found.n_numbers} numbers instead of {found.n_numbers_before}")
print(f"redrawn with {found.psnr:.1f} dB (inf: exactly)")


def repainted(side):
    """The colors of one side of the curves, with red in place of blue."""
    return np.where(side[..., :1] < 0.5, [0.8, 0.1, 0.1], side)


edited = ridgeform.redraw(
    mesh, found.edges, repainted(found.left), repainted(found.right), sides=found.sides,
    points=found.points, point_colors=repainted(found.point_colors),
)  # fmt: skip
print(f"red vertices after the edit: {(edited.colors[:, 0] > 2 * edited.colors[:, 2]).sum()}")
