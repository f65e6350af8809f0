"""Small pictures of meshes for notebooks, as SVG: nothing but NumPy is needed.

draw((vertices, faces), (others, faces), captions=("before", "after"))
"""

from html import escape

import numpy as np

LIGHT = 0.35, 0.5, 0.8
"""To the right, up, and toward who looks."""
CLAY = np.array([0.8, 0.78, 0.75])
PALETTE = np.array(
    [
        [0.36, 0.55, 0.75],
        [0.93, 0.60, 0.35],
        [0.50, 0.70, 0.45],
        [0.80, 0.45, 0.45],
        [0.62, 0.52, 0.75],
        [0.65, 0.55, 0.45],
        [0.88, 0.65, 0.78],
        [0.60, 0.60, 0.60],
    ]
)
"""Colors of labels, over and over."""


class Pictures:
    """Pictures side by side, which a notebook shows."""

    def __init__(self, svg):
        """Take the text of an SVG file."""
        self.svg = svg

    def _repr_svg_(self):
        return self.svg


def of_labels(labels):
    """Colors (m,3) of faces by their labels (m,); clay where there is none (-1)."""
    return np.where(labels[:, None] < 0, CLAY, PALETTE[labels % len(PALETTE)])


def of_values(values, faces, low, high, bands=8):
    """Colors (m,3) of faces (m,3) by values (n,) at the vertices, from blue to orange, in bands."""
    share = np.clip((values[faces].mean(axis=1) - low) / (high - low), 0, 1 - 1e-9)
    share = (np.floor(share * bands) + 0.5) / bands
    return (1 - share)[:, None] * PALETTE[0] + share[:, None] * PALETTE[1]


def draw(*meshes, captions, colors=(), view=(0.6, -1.0, 0.5), size=260):
    """Meshes (vertices, triangles) from one side, as flat faces, those in front drawn last."""
    toward = np.asarray(view) / np.linalg.norm(view)
    right = np.cross([0.0, 0.0, 1.0], toward)
    right /= np.linalg.norm(right)
    up = np.cross(toward, right)
    light = np.array(LIGHT) @ [right, up, toward] / np.linalg.norm(LIGHT)
    first = meshes[0][0] @ np.stack([right, up], axis=1)
    middle, scale = (first.max(axis=0) + first.min(axis=0)) / 2, 0.9 * size / np.ptp(first, axis=0).max()
    parts = []
    for number, (vertices, faces) in enumerate(meshes):
        corners = vertices[faces]
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        normals /= np.maximum(np.linalg.norm(normals, axis=1), 1e-300)[:, None]
        shade = 0.45 + 0.55 * np.clip(normals @ light, 0, 1)
        color = np.clip(255 * shade[:, None] * (colors[number] if colors else CLAY), 0, 255).astype(int)
        flat = ((corners @ np.stack([right, up], axis=1) - middle) * [scale, -scale] + size / 2).round(1)
        flat[..., 0] += number * size
        seen = np.flatnonzero(normals @ toward > 0)
        for face in seen[np.argsort((corners[seen] @ toward).mean(axis=1))]:
            tint = "#{:02x}{:02x}{:02x}".format(*color[face])
            points = " ".join(f"{x:g},{y:g}" for x, y in flat[face])
            parts.append(f'<polygon points="{points}" fill="{tint}" stroke="{tint}" stroke-width="0.8"/>')
        x = (number + 0.5) * size
        parts.append(
            f'<text x="{x:g}" y="{size + 14}" text-anchor="middle" font-family="sans-serif" font-size="15" '
            f'fill="#777">{escape(captions[number])}</text>'
        )
    width, height = size * len(meshes), size + 24
    head = f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}">'
    return Pictures(head + "".join(parts) + "</svg>")
