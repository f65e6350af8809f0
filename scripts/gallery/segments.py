"""Figures 1 (right), 15, 17 and 18: segmented shapes, a scan of buildings, length weights."""

from __future__ import annotations

import colorsys
from pathlib import Path

import numpy as np
import ridgeform
from known_shapes import segment_shapes
from numpy.typing import NDArray
from ridgeform import Segmentation

from . import buildings, domains
from .measures import table

Array = NDArray[np.float64]
Indices = NDArray[np.int64]
Pixels = NDArray[np.uint8]

GOLDEN = 0.618034
WEIGHTS = (1.2, 0.8, 0.5, 0.3, 0.15)
BUST_VIEW = (0.35, -1.0, 0.15)
SPOT_VIEW = (-0.9, -1.0, 0.35)


def colors(labels: Indices) -> Array:
    """A linear color for each face, unlike for neighbors in number."""
    names = np.arange(labels.max() + 1)
    wheel = [
        colorsys.hsv_to_rgb((k * GOLDEN) % 1.0, 0.3 + 0.3 * ((0.37 * k) % 1.0), 0.8 + 0.2 * ((0.29 * k) % 1))
        for k in names
    ]
    return (np.array(wheel) ** 2.2)[labels]


def border_edges(faces: Indices, labels: Indices) -> Indices:
    """The edges `(k, 2)` between faces of different labels."""
    first, second, edges = segment_shapes.face_pairs(faces)
    return edges[labels[first] != labels[second]]


def shown(vertices: Array, faces: Indices, labels: Indices, **look: object) -> Pixels:
    """Segments in colors, with their borders."""
    import pictures  # noqa: PLC0415
    from picture_geometry import Lines  # noqa: PLC0415

    marks = [Lines(vertices[border_edges(faces, labels)], pixels=1.6)]
    return pictures.render(vertices, faces, color=colors(labels), marks=marks, **look)


def segmented(vertices: Array, faces: Indices, **keywords: object) -> Segmentation:
    """The segmentation, said on the console."""
    found = ridgeform.segment(ridgeform.Mesh(vertices, faces), **keywords)
    print(f"   {len(vertices)} vertices {keywords}: {found}", flush=True)
    return found


def row(words: str, vertices: Array, found: Segmentation) -> list[str]:
    """A row of the table."""
    return [words, str(len(vertices)), str(found.n_segments), f"{found.range[0]} to {found.range[1]}"]


def draw_shapes(path: Path) -> list[list[str]]:
    """A machine part from two sides, the bust, Spot; rows of the table."""
    from . import panels  # noqa: PLC0415

    part = segment_shapes.fan(1).noisy(0.1, 1)
    views = {
        "machine part, noise 0.1": ((part.vertices, part.faces), {"view": (1.0, -1.5, 1.2)}),
        "its other side": ((part.vertices, part.faces), {"view": (-1.2, 1.0, -0.9)}),
        "bust": (domains.source("bust"), {"view": BUST_VIEW}),
        "Spot": (domains.source("spot"), {"view": SPOT_VIEW}),
    }
    pictures, rows = [], []
    for words, ((vertices, faces), look) in views.items():
        found = segmented(vertices, faces)
        picture = shown(vertices, faces, found.labels, size=270, **look)
        pictures.append((f"{words}: {found.n_segments}", picture))
        rows.append(row(words, vertices, found))
    panels.page(path, pictures, len(pictures))
    return rows


def draw_buildings(path: Path) -> list[list[str]]:
    """The scan and its segments; a row of the table."""
    import pictures  # noqa: PLC0415

    from . import panels  # noqa: PLC0415

    vertices, faces = buildings.buildings()
    found = segmented(vertices, faces)
    look = {"view": (0.5, -1.0, 1.1), "size": (540, 380), "frame": vertices, "margin": 0.01}
    segments = shown(vertices, faces, found.labels, **look)
    scan = pictures.render(vertices, faces, **look)
    panels.page(path, [("scan", scan), (f"{found.n_segments} segments", segments)], 2, shades=48)
    return [row("buildings", vertices, found)]


def draw_weights(path: Path) -> None:
    """Spot with several length weights."""
    from . import panels  # noqa: PLC0415

    vertices, faces = domains.source("spot_low_resolution")
    pictures = []
    for weight in WEIGHTS:
        found = segmented(vertices, faces, length_weight=weight)
        picture = shown(vertices, faces, found.labels, view=SPOT_VIEW, size=230)
        pictures.append((f"λ {weight:g}: {found.n_segments}", picture))
    panels.page(path, pictures, len(WEIGHTS))


def draw(folder: Path) -> dict[str, str]:
    """The three figures, and the numbers of segments."""
    rows = draw_shapes(folder / "segments.png")
    rows += draw_buildings(folder / "segments_buildings.png")
    draw_weights(folder / "segments_weights.png")
    return {"segments": table(["shape", "vertices", "segments", "nested, from to"], rows)}
