"""Figure 19: painted surfaces, the curves that are left of them, and the colors that these redraw."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import ridgeform
from numpy.typing import NDArray

from . import distances, domains
from .measures import table

Array = NDArray[np.float64]
Indices = NDArray[np.int64]
Pixels = NDArray[np.uint8]

PALETTE = np.array(
    [[0.80, 0.10, 0.05], [0.04, 0.18, 0.65], [0.90, 0.70, 0.08], [0.08, 0.42, 0.14], [0.85, 0.85, 0.80]]
)
"""Linear RGB."""
PLANE = 80
"""About so many vertices along each side of the plane."""
SHADING = 0.25
"""How much the colors of a region go up and down."""
BAND = 0.012
"""Width of the band of color on each side of a curve, as a share of the mesh's size."""
SURFACE = (0.62, 0.62, 0.62)
VISIBLE = 0.02
"""Colors on a band that differ by less are drawn as one."""


def plane_regions(vertices: Array, count: int) -> Indices:
    """A disk on a ground, or a hill, a sun, a house and a ball on it."""
    x, y = vertices[:, 0] + 0.5, vertices[:, 1] + 0.5
    if count == 2:
        return (np.hypot(x - 0.5, y - 0.5) < 0.3).astype(np.int64)
    regions = np.where(y > 0.6 + 0.08 * np.sin(6 * x), 1, 0)
    regions[np.hypot(x - 0.7, y - 0.3) < 0.2] = 2
    regions[(np.abs(x - 0.25) < 0.12) & (np.abs(y - 0.28) < 0.16)] = 3
    regions[np.hypot(x - 0.3, y - 0.8) < 0.11] = 4
    return regions


def spot_regions(vertices: Array, count: int) -> Indices:
    """Patches on a hide, or one color each for body, legs, hind part, head and belly."""
    place = (vertices - vertices.mean(axis=0)) / np.ptp(vertices, axis=0).max()
    x, y, z = place.T
    if count == 2:
        return (np.sin(9 * x) * np.sin(9 * y + 1) * np.sin(9 * z) > 0.12).astype(np.int64)
    regions = np.where(z < -0.25, 1, 0)
    regions[y > 0.28] = 2
    regions[z > 0.24] = 3
    regions[((place - [0.2, -0.1, 0.0]) ** 2).sum(axis=1) < 0.03] = 4
    return regions


def painted(vertices: Array, regions: Indices, shaded: bool) -> Array:
    """A color for each vertex: that of its region, `shaded` with gentle waves over it."""
    colors = PALETTE[regions]
    if not shaded:
        return colors
    place = 2 * np.pi * (vertices - vertices.min(axis=0)) / np.ptp(vertices, axis=0).max()
    waves = 0.5 + 0.25 * (np.sin(place[:, 0]) + np.cos(place[:, 1] + place[:, 2]))
    return colors * (1 - SHADING * waves[:, None])


def off_the_borders(
    vertices: Array, faces: Indices, regions: Indices, found: ridgeform.DiffusionCurves
) -> float:
    """The share of the curves' length that does not touch a face with several painted colors."""
    mixed = (regions[faces] != regions[faces[:, :1]]).any(axis=1)
    touching = np.zeros(len(vertices), bool)
    touching[faces[mixed]] = True
    lengths = np.linalg.norm(np.diff(vertices[found.edges], axis=1)[:, 0], axis=1)
    off = ~touching[found.edges].all(axis=1)
    return float(lengths[off].sum() / lengths.sum())


def bands(mesh: ridgeform.Mesh, found: ridgeform.DiffusionCurves) -> list[tuple[Array, tuple[float, ...]]]:
    """Segments (k, 2, 3) beside the curves, on the surface, and the color of each group of them."""
    vertices, faces = mesh.vertices, mesh.faces
    corner = vertices[faces]
    face_normals = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    normals = np.zeros_like(vertices)
    for i in range(3):
        np.add.at(normals, faces[:, i], face_normals)
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-30)
    ends = ridgeform.smooth_curves(mesh, found.edges)
    along = ends[:, 1] - ends[:, 0]
    across = np.cross(normals[found.edges].mean(axis=1), along)
    across /= np.maximum(np.linalg.norm(across, axis=1, keepdims=True), 1e-30)
    size = np.ptp(vertices, axis=0).max()
    groups = []
    for colors, side in ((found.left, 0.5), (found.right, -0.5)):
        shade = np.rint(colors.mean(axis=1) / VISIBLE).astype(int)
        moved = ends + (side * BAND * size * across)[:, None]
        for value in np.unique(shade, axis=0):
            groups.append((moved[(shade == value).all(axis=1)], tuple((VISIBLE * value).tolist())))
    return groups


def draw(folder: Path) -> dict[str, str]:
    """Two planes and two Spots: painted, curves, redrawn."""
    from picture_geometry import Lines  # noqa: PLC0415

    from . import panels  # noqa: PLC0415

    plane, spot = domains.irregular_square(PLANE, seed=2), domains.source("spot")
    pictures: list[tuple[str, Pixels]] = []
    rows = []
    for name, (vertices, faces), regions_of in (
        ("plane", plane, plane_regions),
        ("Spot", spot, spot_regions),
    ):
        mesh = ridgeform.Mesh(vertices, faces)
        look = {"size": (300, 264), "margin": 0.03}
        look |= {"lit": False, **panels.FROM_ABOVE} if name == "plane" else {"view": distances.SPOT_VIEW}
        brightness = 1.0 if name == "plane" else panels.BRIGHTNESS
        for count, shaded in ((2, False), (5, False), (2, True), (5, True)):
            regions = regions_of(vertices, count)
            colors = painted(vertices, regions, shaded)
            found = ridgeform.diffusion_curves(mesh, colors, color_error=0.01)
            exact = ridgeform.diffusion_curves(mesh, colors, labels=found.labels, refine=False)
            kind = f"{name}, {count} colors" + (", shaded" if shaded else "")
            off = off_the_borders(vertices, faces, regions, found)
            numbers = f"{found.n_numbers} for {found.n_numbers_before}"
            cells = [kind, str(found.labels.max() + 1), str(len(found.starts) - 1), numbers]
            rows.append([*cells, _decibels(found.psnr), _decibels(exact.psnr), f"{off:.0%}"])
            print("   " + ", ".join(rows[-1]), flush=True)
            if (count, shaded) not in {(2, False), (5, True)}:
                continue
            unit = look | {"frame": vertices}
            width = BAND * np.ptp(vertices, axis=0).max()
            marks = [
                Lines(segments, color, _pixels(width, vertices, look))
                for segments, color in bands(mesh, found)
            ]
            pictures.append(("painted", _shown(vertices, faces, brightness * colors[faces], unit)))
            shown = panels.pictures.render(vertices, faces, color=SURFACE, marks=marks, **unit)
            pictures.append((f"{len(found.starts) - 1} curves, {numbers} numbers", shown))
            redrawn = _shown(vertices, faces, brightness * found.corners, unit)
            pictures.append((f"redrawn, {_decibels(found.psnr)}", redrawn))
    panels.page(folder / "curves.png", pictures, 3, shades=32)
    # The last of them, for a slider in the manual.
    panels.page(folder / "curves_spot.png", pictures[-3:], 3, shades=32)
    header = ["paint", "regions", "curves", "numbers", "PSNR", "without least squares", "off the borders"]
    return {"curves": table(header, rows)}


def _decibels(psnr: float) -> str:
    """A ratio in words; beyond 100 dB nothing but rounding is left."""
    return f"{psnr:.1f} dB" if psnr < 100 else "exact"


def _pixels(width: float, vertices: Array, look: dict[str, object]) -> float:
    """A width on a mesh in pixels of its picture."""
    from picture_geometry import camera_axes  # noqa: PLC0415
    from pictures import UP  # noqa: PLC0415

    seen = vertices @ camera_axes(look["view"], look.get("up", UP)).T
    pixels, margin = np.array(look["size"]), look["margin"]
    return float(width * (pixels * (1 - 2 * margin) / np.ptp(seen, axis=0)[:2]).min())


def _shown(vertices: Array, faces: Indices, corners: Array, look: dict[str, object]) -> Pixels:
    """Colors at the corners (m, 3, 3) of faces: each face is cut into nine, of one color each."""
    from . import panels  # noqa: PLC0415

    weights = _ninths()
    pieces = np.einsum("pij,fjk->fpik", weights, vertices[faces]).reshape(-1, 3)
    color = np.einsum("pj,fjk->fpk", weights.mean(axis=1), corners).reshape(-1, 3)
    return panels.pictures.render(pieces, np.arange(len(pieces)).reshape(-1, 3), color=color, **look)


def _ninths() -> Array:
    """Barycentric coordinates (9, 3, 3) of the corners of the nine parts of a triangle."""
    parts = []
    for i in range(3):
        for j in range(3 - i):
            a, b, c = (i, j), (i + 1, j), (i, j + 1)
            parts.append((a, b, c))
            if i + j < 2:
                parts.append((b, (i + 1, j + 1), c))
    points = np.array(parts, float) / 3
    return np.concatenate([1 - points.sum(axis=2, keepdims=True), points], axis=2)
