"""A city as an aerial survey has it: ground with relief, houses on it, noise, in tiles that adjoin.

The surface is one sheet of rows and columns of vertices. On every lot they run over the roof of a house, down
its walls, and over the ground to the lot's border, so that walls have as many triangles as anything else.
"""

from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

LOT = 64
"""Vertices along a lot."""

SPACING = 0.5
"""Meters between them on flat ground."""

ROOF, WALL = 13, 10
"""Rings of vertices around the middle of a lot that lie on the roof, and on the walls."""


class City(NamedTuple):
    """Vertices, (n,3) in meters, triangles, and to which plane or ground each belongs."""

    vertices: NDArray[np.float64]
    faces: NDArray[np.int32]
    labels: NDArray[np.int32]
    side: int
    """Vertices along a side."""


def ground(x: NDArray[np.float64], y: NDArray[np.float64]) -> NDArray[np.float64]:
    """The height of the relief: hills of some hundred meters."""
    return 6.0 * np.sin(x / 67.0) * np.cos(y / 83.0) + 3.0 * np.sin((x + 2.0 * y) / 141.0)


def lot(random: np.random.Generator, corner: NDArray[np.float64]) -> NDArray[np.float64]:
    """The vertices of one lot, (LOT, LOT, 3), for a house of random size, height, roof, and direction."""
    half = LOT // 2
    i = np.arange(LOT) - half
    u, v = np.meshgrid(i, i, indexing="ij")
    ring = np.maximum(np.abs(u), np.abs(v)).astype(float)
    width = random.uniform(0.85, 1.15, 2) * SPACING * ROOF
    eaves, rise = random.uniform(4.0, 6.0), random.uniform(0.5, 0.8)
    turn = random.uniform(-0.6, 0.6)
    # Where a ring's corner is, in parts of the house, and how far on to the lot's border.
    on_roof = np.minimum(ring / ROOF, 1.0)
    down = np.clip((ring - ROOF) / WALL, 0.0, 1.0)
    out = np.clip((ring - ROOF - WALL) / (half - ROOF - WALL), 0.0, 1.0)
    direction = np.stack([u, v], -1) / np.maximum(ring, 1.0)[..., None]
    house = direction * on_roof[..., None] * width
    angle = turn * (1.0 - out)
    c, s = np.cos(angle), np.sin(angle)
    turned = np.stack([c * house[..., 0] - s * house[..., 1], s * house[..., 0] + c * house[..., 1]], -1)
    border = direction * SPACING * half
    flat = turned * (1.0 - out)[..., None] + border * out[..., None]
    middle = corner + SPACING * half
    place = flat + middle
    low = ground(place[..., 0], place[..., 1])
    roof = ground(*middle) + eaves + rise * (width[0] - np.abs(house[..., 0]))
    height = np.where(ring <= ROOF, roof, low + (1.0 - down) * (roof - low))
    return np.concatenate([place, height[..., None]], -1)


def plane_names(rows: int) -> NDArray[np.int32]:
    """The plane of each cell of one lot: 0 ground, 1 and 2 the roof, 3 to 6 the walls."""
    half = LOT // 2
    i = np.arange(rows) - half + 0.5
    u, v = np.meshgrid(i, i, indexing="ij")
    ring = np.maximum(np.abs(u), np.abs(v))
    names = np.where(u < 0, 1, 2)
    names = np.where(np.abs(u) > np.abs(v), np.where(u < 0, 3, 4), np.where(v < 0, 5, 6)) * (
        ring > ROOF
    ) + names * (ring <= ROOF)
    return np.where(ring > ROOF + WALL, 0, names).astype(np.int32)


def city(lots: int, noise: float = 0.05, seed: int = 0) -> City:
    """A square of so many lots a side; the noise in parts of the spacing."""
    side = lots * LOT + 1
    grid = np.empty((side, side, 3))
    x = SPACING * np.arange(side)
    for edge in (np.s_[-1, :], np.s_[:, -1]):
        along = np.meshgrid(x, x, indexing="ij")
        grid[edge] = np.stack([along[0][edge], along[1][edge], ground(along[0][edge], along[1][edge])], -1)
    random = np.random.default_rng(seed)
    names = np.zeros((side - 1, side - 1), np.int32)
    pattern = plane_names(LOT)
    for a in range(lots):
        for b in range(lots):
            rows, columns = slice(a * LOT, (a + 1) * LOT), slice(b * LOT, (b + 1) * LOT)
            grid[rows, columns] = lot(random, SPACING * LOT * np.array([a, b], float))
            names[rows, columns] = np.where(pattern > 0, pattern + 6 * (a * lots + b), 0)
    vertices = grid.reshape(-1, 3)
    vertices += random.normal(scale=noise * SPACING, size=vertices.shape)
    return City(vertices, sheet(side), np.repeat(names.ravel(), 2), side)


def sheet(n: int) -> NDArray[np.int32]:
    """The triangles of `n` rows of `n` vertices."""
    along = np.arange(n - 1, dtype=np.int32)
    a = (along[:, None] * n + along).ravel()
    return np.stack([a, a + n, a + n + 1, a, a + n + 1, a + 1], 1).reshape(-1, 3).astype(np.int32)


def write_tiles(made: City, folder: Path, tiles: int) -> None:
    """Writes so many tiles a side, each a file of its own: vertices on borders are in two and four files."""
    folder.mkdir(parents=True, exist_ok=True)
    cells = (made.side - 1) // tiles
    grid = made.vertices.reshape(made.side, made.side, 3)
    labels = made.labels.reshape(made.side - 1, made.side - 1, 2)
    n = cells + 1
    faces = sheet(n)
    for a in range(tiles):
        for b in range(tiles):
            rows, columns = a * cells, b * cells
            np.savez(
                folder / f"tile_{a}_{b}.npz",
                vertices=grid[rows : rows + n, columns : columns + n].reshape(-1, 3),
                faces=faces,
                truth=labels[rows : rows + cells, columns : columns + cells].ravel(),
            )
