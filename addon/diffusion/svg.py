# SPDX-License-Identifier: GPL-3.0-or-later
"""Diffusion curves of a flat mesh as an SVG drawing: each curve with a band of color on either side."""

import bpy
import numpy as np

from ..blender import mesh_io
from ..blender.attribute_names import result_name
from ..blender.refusals import CurvesRefusedError
from . import curves_io
from .curves_io import CurvePoints
from .sources import SUFFIX

FLATNESS = 1e-3
"""A mesh counts as flat that leaves its plane by at most this part of its size."""
PIXELS = 1000.0
"""The longer side of the drawing."""
SHARPEST_MITER = 0.25
"""At sharper turns the bands are not as wide as elsewhere, so that their corners do not run away."""


def drawing(
    obj: bpy.types.Object, child: bpy.types.Object, points: CurvePoints, width: float, fill: bool
) -> str:
    """The drawing of curves on the vertices of a flat mesh object, seen from the side that its faces show.

    Bands are `width` wide, a part of the longer side; with `fill` the redrawn colors of the faces lie under
    them. `CurvesRefusedError` if the mesh is not flat.
    """
    with mesh_io.object_mode():
        places, frame = flattened(obj)
        longest = float(np.ptp(places, axis=0).max()) or 1.0
        scale = PIXELS / longest
        margin = width * PIXELS
        low = places.min(axis=0)
        # The drawing's y axis points down.
        high = places[:, 1].max()
        paper = np.column_stack([places[:, 0] - low[0], high - places[:, 1]]) * scale + margin
        # Without the teeth of the mesh's edges, as in the viewport; faces reach to the curves.
        paper[points.vertices] += points.offsets @ frame.T * (scale, -scale)
        size = np.ptp(places, axis=0) * scale + 2 * margin
        body = [*(_faces(obj, child, paper) if fill else []), *_curves(points, paper, margin)]
    box = f"0 0 {size[0]:.2f} {size[1]:.2f}"
    head = f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="{box}"'
    head += f' width="{size[0]:.0f}" height="{size[1]:.0f}">'
    return "\n".join(['<?xml version="1.0" encoding="UTF-8"?>', head, *body, "</svg>", ""])


def flattened(obj: bpy.types.Object) -> tuple[np.ndarray, np.ndarray]:
    """The vertices (n, 2) of a flat mesh in its plane, faces counterclockwise, and the plane's axes (2, 3).

    `CurvesRefusedError` if it is not flat.
    """
    coordinates = mesh_io.open_coordinates(obj).original.astype(np.float64)
    centered = coordinates - coordinates.mean(axis=0)
    _, spread, axes = np.linalg.svd(centered, full_matrices=False)
    off = np.abs(centered @ axes[2]).max()
    if not off <= FLATNESS * max(np.ptp(centered @ axes[0]), 1e-30) or not spread[1] > 0:
        raise CurvesRefusedError(
            f'"{obj.name}" is not flat: only curves of a flat mesh can be drawn on paper'
        )
    # Along the axes of space where the plane lies along them, so that drawings are not turned.
    normal = axes[2]
    nearest = np.argsort(np.abs(normal), kind="stable")
    along = np.eye(3)[min(nearest[:2])]
    along -= normal * (normal @ along)
    along /= np.linalg.norm(along)
    frame = np.stack([along, np.cross(normal, along)])
    places = centered @ frame.T
    a, b, c = (places[corner] for corner in mesh_io.triangles(obj.data).T)
    if ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]).sum() < 0:
        # Seen from the other side.
        frame *= np.array([(1,), (-1,)] if nearest[-1] == 2 or along[0] > 0.5 else [(-1,), (1,)])
    return centered @ frame.T, frame


def _curves(points: CurvePoints, paper: np.ndarray, width: float) -> list[str]:
    """The elements of all curves, a group each."""
    lines = []
    begin = 0
    for index, (size, closed) in enumerate(zip(points.sizes.tolist(), points.cyclic.tolist(), strict=True)):
        rows = np.arange(begin, begin + size)
        begin += size
        line = paper[points.vertices[rows]]
        if size == 1:
            x, y = line[0]
            color = _hex(points.left[rows])[0]
            lines.append(
                f'<circle id="point{index}" cx="{x:.2f}" cy="{y:.2f}" r="{width:.2f}" fill="{color}"/>'
            )
            continue
        lines.append(f'<g id="curve{index}">')
        offset = _miters(line, closed) * width
        for name, colors, sign in (("left", points.left[rows], 1.0), ("right", points.right[rows], -1.0)):
            lines += _band(name, line, line + sign * offset, colors, closed)
        path = "M" + "L".join(f"{x:.2f} {y:.2f}" for x, y in line) + ("Z" if closed else "")
        lines.append(
            f'<path class="curve" d="{path}" fill="none" stroke="#000" stroke-width="{width / 12:.2f}"/>'
        )
        lines.append("</g>")
    return lines


def _miters(line: np.ndarray, closed: bool) -> np.ndarray:
    """For each point (p, 2) the way to a parallel line on its left at distance 1, y pointing down."""
    edges = np.roll(line, -1, axis=0) - line
    lengths = np.linalg.norm(edges, axis=1, keepdims=True)
    normals = np.column_stack([edges[:, 1], -edges[:, 0]]) / np.where(lengths > 0, lengths, 1.0)
    before = np.roll(normals, 1, axis=0)
    if not closed:
        normals[-1] = normals[-2]
        before[0] = normals[0]
    mean = normals + before
    # A miter reaches 1 / cos(half the turn) far; |mean|² = 4 cos².
    squared = np.maximum((mean**2).sum(axis=1, keepdims=True), 4 * SHARPEST_MITER)
    return 2 * mean / squared


def _band(name: str, line: np.ndarray, outer: np.ndarray, colors: np.ndarray, closed: bool) -> list[str]:
    """The band on one side of a curve: one polygon for each stretch of one color."""
    n = len(line)
    ends = np.stack([np.arange(n), (np.arange(n) + 1) % n], axis=1)[: n if closed else n - 1]
    shades = _hex((colors[ends[:, 0]] + colors[ends[:, 1]]) / 2)
    polygons = []
    first = 0
    for last in range(1, len(ends) + 1):
        if last < len(ends) and shades[last] == shades[first]:
            continue
        rows = np.append(ends[first:last, 0], ends[last - 1, 1])
        outline = np.concatenate([line[rows], outer[rows][::-1]])
        polygons.append(f'<polygon class="{name}" points="{_text(outline)}" fill="{shades[first]}"/>')
        first = last
    return polygons


def _faces(obj: bpy.types.Object, child: bpy.types.Object, paper: np.ndarray) -> list[str]:
    """A polygon for each face, in the mean of the redrawn colors at its corners."""
    mesh = obj.data
    name = result_name(child.data[curves_io.MARK], SUFFIX)
    attribute = mesh.attributes.get(name)
    if attribute is None or attribute.domain != "CORNER":
        raise CurvesRefusedError(
            f'"{obj.name}" has no colors "{name}" to fill with: redraw from the curves first'
        )
    colors = np.empty(4 * len(mesh.loops), np.float32)
    attribute.data.foreach_get("color", colors)
    colors = colors.reshape(-1, 4)
    starts, vertices, _ = mesh_io.face_corners(mesh)
    ends = np.append(starts[1:], len(vertices))
    means = np.add.reduceat(colors, starts, axis=0) / (ends - starts)[:, None]
    faces = zip(starts.tolist(), ends.tolist(), _hex(means), strict=True)
    # A thin line in the same color closes the gaps that drawing programs leave between polygons.
    shown = 'fill="{0}" stroke="{0}" stroke-width="0.5"'.format
    return [
        f'<polygon points="{_text(paper[vertices[begin:end]])}" {shown(color)}/>'
        for begin, end, color in faces
    ]


def _text(outline: np.ndarray) -> str:
    return " ".join(f"{x:.2f},{y:.2f}" for x, y in outline)


def _hex(colors: np.ndarray) -> list[str]:
    """Linear colors (p, 4) as they are written in a drawing, `#rrggbb` in sRGB."""
    linear = np.clip(np.nan_to_num(colors[:, :3]), 0.0, 1.0)
    encoded = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    return ["#" + bytes(row).hex() for row in np.round(255 * encoded).astype(np.uint8)]
