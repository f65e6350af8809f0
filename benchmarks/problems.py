"""The fixed problems of the benchmarks: meshes, data on them, and the folder form that `measure` reads.

Everything is generated, or comes from the public-domain scans of `blend_fixtures/sources/`; seeds are fixed.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import shapes
from numpy.typing import NDArray
from workspace import ROOT

SEED = 2024
KNOWN = 40
"""Vertices with known values in the interpolation problems."""


@dataclass(frozen=True)
class Problem:
    """A mesh, a function on its vertices, and which of its values are known."""

    name: str
    vertices: NDArray[np.float64]
    faces: NDArray[np.int64]
    values: NDArray[np.float64]
    indices: NDArray[np.int64]

    def write(self, folder: Path) -> Path:
        """Write the raw little-endian files that `measure` reads; returns the folder."""
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "vertices.f64").write_bytes(self.vertices.astype("<f8").tobytes())
        (folder / "faces.u32").write_bytes(self.faces.astype("<u4").tobytes())
        (folder / "values.f64").write_bytes(self.values.astype("<f8").tobytes())
        (folder / "indices.u32").write_bytes(self.indices.astype("<u4").tobytes())
        return folder


def problem(name: str, vertices: NDArray, faces: NDArray, noise: float = 0.0) -> Problem:
    """The problem on a mesh: a function with ridges that spans 1, normal noise of deviation `noise` on top.

    The mesh is moved and scaled so that its longest side is 1.
    """
    used = np.zeros(len(vertices), dtype=bool)
    used[faces] = True
    low, high = vertices[used].min(axis=0), vertices[used].max(axis=0)
    unit = (vertices - 0.5 * (low + high)) / (high - low).max()
    random = np.random.default_rng(SEED)
    values = ridged(unit)
    values = (values - values[used].min()) / np.ptp(values[used]) + noise * random.standard_normal(len(unit))
    indices = np.sort(random.choice(np.flatnonzero(used), min(KNOWN, used.sum()), replace=False))
    return Problem(name, unit.astype(float), faces.astype(np.int64), values, indices)


def ridged(points: NDArray[np.float64]) -> NDArray[np.float64]:
    """A continuous function of the position, piecewise linear with ridges across the whole mesh."""
    x, y, z = points.T
    return np.abs(x + 0.3 * z) + np.maximum(y, 0.5 * z) - 0.4 * np.abs(z - 0.1)


def source(name: str) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Vertices and faces of a scan of `blend_fixtures/sources/`."""
    with np.load(ROOT / f"blend_fixtures/sources/{name}.npz") as data:
        return data["vertices"].astype(float), data["faces"].astype(np.int64)


def noisy_cube(n: int) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """A cube of `6 n² + 2` vertices, each moved by a normal variate of 0.15 edge lengths."""
    vertices, faces = shapes.cube(n)
    return vertices + 0.15 * (2.0 / n) * np.random.default_rng(SEED).standard_normal(vertices.shape), faces


MESHES = {
    "cube, noisy": lambda: noisy_cube(20),
    "bust": lambda: source("bust"),
    "bust, split": lambda: shapes.subdivide(*source("bust")),
    "cube, noisy, large": lambda: noisy_cube(98),
}


def load_obj(path: Path) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Vertices and triangles (larger faces fanned) of an OBJ file."""
    vertices, faces = [], []
    for line in path.read_text(encoding="utf-8").splitlines():
        word, *rest = line.split() or [""]
        if word == "v":
            vertices.append([float(x) for x in rest[:3]])
        elif word == "f":
            corners = [int(corner.split("/")[0]) - 1 for corner in rest]
            faces += [[corners[0], *corners[i : i + 2]] for i in range(1, len(corners) - 1)]
    return np.array(vertices), np.array(faces, dtype=np.int64)
