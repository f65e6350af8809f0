"""Draw the truth and the labels of a mesh side by side; needs `requirements-cad.txt`.

python benchmarks/cad_picture.py PICTURE.png TITLE

Reads PICTURE.npz with `vertices`, `faces`, `truth`, and `labels`.
"""

from __future__ import annotations

import sys
from pathlib import Path

import matplotlib as mpl
import numpy as np

mpl.use("Agg")
from matplotlib import pyplot as plt
from mpl_toolkits.mplot3d.art3d import Poly3DCollection


def colors(labels: np.ndarray, normals: np.ndarray) -> np.ndarray:
    """A color for each label, shaded."""
    palette = np.random.default_rng(4).uniform(0.25, 1.0, (int(labels.max()) + 1, 3))
    light = np.array([0.3, -0.5, 0.8]) / np.sqrt(0.98)
    return palette[labels] * (0.55 + 0.45 * np.clip(normals @ light, 0, 1))[:, None]


def main(path: Path, title: str) -> None:
    """Write the picture."""
    given = np.load(path.with_suffix(".npz"))
    corners = given["vertices"][given["faces"]]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)
    figure = plt.figure(figsize=(14, 7))
    figure.suptitle(title)
    low, high = given["vertices"].min(axis=0), given["vertices"].max(axis=0)
    for k, name in enumerate(("truth", "labels")):
        axes = figure.add_subplot(1, 2, k + 1, projection="3d", title=name)
        shown = Poly3DCollection(corners, facecolors=colors(given[name], normals), edgecolors="none")
        if len(corners) < 4000:
            shown.set_edgecolor((0, 0, 0, 0.3))
            shown.set_linewidth(0.2)
        axes.add_collection3d(shown)
        for limits, a, b in zip((axes.set_xlim, axes.set_ylim, axes.set_zlim), low, high, strict=True):
            limits(a, b)
        axes.set_box_aspect(high - low)
        axes.set_axis_off()
    figure.tight_layout()
    figure.savefig(path, dpi=80)


if __name__ == "__main__":
    main(Path(sys.argv[1]), sys.argv[2])
