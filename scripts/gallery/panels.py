"""One panel of a figure: a function on a flat mesh, on a surface, or as a height field, with its isolines."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pictures
from numpy.typing import NDArray
from picture_geometry import Dots, Lines, Mark
from picture_isolines import bands, isolines

from addon.blender import ramp

Array = NDArray[np.float64]
Indices = NDArray[np.int64]
Pixels = NDArray[np.uint8]

LEVELS = 16
HOLE = (0.55, 0.02, 0.03)
"""Linear RGB of the border of what is unknown."""
KNOWN = (0.6, 0.01, 0.015)
"""Linear RGB of the dots where something is known."""
LINE = Lines(np.empty((0, 2, 3)), pixels=1.3)
FROM_ABOVE = {"view": (0.0, 0.0, 1.0), "up": (0.0, 1.0, 0.0)}
TEXT_PIXELS = 14
BRIGHTNESS = 1.35
"""Factor on painted colors under the lights, which are set for a light clay."""


def even_levels(values: Array, count: int = LEVELS) -> Array:
    """Levels that cut the range of the values into `count + 1` bands of equal height."""
    return np.linspace(values.min(), values.max(), count + 2)[1:-1]


def painted(
    vertices: Array,
    faces: Indices,
    values: Array,
    levels: Array,
    *,
    known: Array | None = None,
    hole: NDArray[np.bool_] | None = None,
    colors: Array = ramp.SEQUENTIAL,
    **look: object,
) -> Pixels:
    """A function in bands between `levels`, one color each, with isolines on their borders.

    `known` are points `(k, 3)` marked by dots, `hole` faces `(m,)` whose border is drawn red. `look` goes to
    `pictures.render`.
    """
    pieces, piece_faces, band, _ = bands(vertices, faces, values, levels)
    color = ramp.colors_at(colors, band / max(len(levels), 1))[:, :3]
    if look.get("lit", True):
        color = BRIGHTNESS * color
    marks: list[Mark] = [Lines(isolines(vertices, faces, values, levels), pixels=LINE.pixels)]
    if hole is not None:
        marks.append(Lines(vertices[border(faces[hole])], HOLE, 3.0))
    if known is not None:
        marks.append(Dots(known, KNOWN, 7.0))
    return pictures.render(pieces, piece_faces, color=color, marks=marks, **({"frame": vertices} | look))


def flat(vertices: Array, faces: Indices, values: Array, levels: Array, **more: object) -> Pixels:
    """`painted`, of a mesh in the plane z = 0, from above, without light."""
    return painted(vertices, faces, values, levels, lit=False, **FROM_ABOVE, **more)


def height_field(vertices: Array, faces: Indices, values: Array, **look: object) -> Pixels:
    """A function on a mesh in the plane z = 0 as a landscape."""
    return pictures.render(np.column_stack([vertices[:, :2], values]), faces, **look)


def shaded(vertices: Array, faces: Indices, **look: object) -> Pixels:
    """A surface in clay."""
    return pictures.render(vertices, faces, **look)


def colored(vertices: Array, faces: Indices, amounts: Array, **look: object) -> Pixels:
    """What faces have `(m,)`, from 0 to 1 and above."""
    color = ramp.colors_at(ramp.SEQUENTIAL, np.clip(amounts, 0.0, 1.0))[:, :3]
    return pictures.render(vertices, faces, color=color, lit=False, **look)


def wireframe(vertices: Array, faces: Indices, **look: object) -> Pixels:
    """The edges of a mesh."""
    edges = np.unique(np.sort(faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1), axis=0)
    marks = [Lines(vertices[edges], pixels=0.6)]
    return pictures.render(vertices, faces, color=(0.8, 0.8, 0.8), marks=marks, **look)


def border(faces: Indices) -> Indices:
    """Edges `(k, 2)` of only one of the faces."""
    edges = np.sort(faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    edges, count = np.unique(edges, axis=0, return_counts=True)
    return edges[count == 1]


def page(path: Path, panels: Sequence[tuple[str, Pixels | None]], columns: int, shades: int = 64) -> None:
    """Save captioned panels, row by row."""
    rows = [panels[k : k + columns] for k in range(0, len(panels), columns)]
    pictures.sheet(
        path,
        [[picture for _, picture in row] for row in rows],
        captions=[[caption or " " for caption, _ in row] for row in rows],
        text_pixels=TEXT_PIXELS,
        shades=shades,
    )
    print(f"   {path.name}: {path.stat().st_size / 1000:.0f} kB", flush=True)
