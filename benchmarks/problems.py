"""The meshes of the benchmarks and the folder form of a problem that `measure` reads.

Everything is generated, or comes from the public-domain scans of `blend_fixtures/sources/`; seeds are fixed.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from known_shapes import shapes
from numpy.typing import NDArray
from workspace import ROOT

SEED = 2024


@dataclass(frozen=True)
class Problem:
    """A mesh, one or three functions on its vertices, and what is known or asked of them."""

    name: str
    vertices: NDArray[np.float64]
    faces: NDArray[np.int64]
    values: NDArray[np.float64]
    indices: NDArray[np.int64] = field(default_factory=lambda: np.arange(0))
    weights: NDArray[np.float64] | None = None
    constraints: tuple[NDArray[np.float64], NDArray[np.float64]] | None = None
    """A dense matrix `A` (p x n) and `b` (p) of `A u = b`."""
    fidelity: float = 0.0
    """Of denoising; zero: interpolation of the values at `indices`."""

    def write(self, folder: Path) -> Path:
        """Write the raw little-endian files that `measure` reads; returns the folder."""
        folder.mkdir(parents=True, exist_ok=True)

        def put(name: str, numbers: NDArray, kind: str) -> None:
            (folder / name).write_bytes(np.asarray(numbers).astype(kind).tobytes())

        put("vertices.f64", self.vertices, "<f8")
        put("faces.u32", self.faces, "<u4")
        put("values.f64", self.values.T, "<f8")
        put("indices.u32", self.indices, "<u4")
        if self.weights is not None:
            put("weights.f64", self.weights, "<f8")
        if self.constraints is not None:
            matrix, right = self.constraints
            rows, columns = np.nonzero(matrix)
            put("constraint_rows.u32", rows, "<u4")
            put("constraint_columns.u32", columns, "<u4")
            put("constraint_values.f64", matrix[rows, columns], "<f8")
            put("constraint_right.f64", right, "<f8")
        return folder


@dataclass(frozen=True)
class Mesh:
    """A mesh, moved and scaled so that its longest side is 1."""

    name: str
    vertices: NDArray[np.float64]
    faces: NDArray[np.int64]

    @staticmethod
    def of(name: str, vertices: NDArray, faces: NDArray) -> Mesh:
        """The mesh in its unit."""
        used = vertices[np.unique(faces)]
        low, high = used.min(axis=0), used.max(axis=0)
        unit = (vertices - 0.5 * (low + high)) / (high - low).max()
        return Mesh(name, unit.astype(float), faces.astype(np.int64))

    def used(self) -> NDArray[np.int64]:
        """The vertices that have faces."""
        return np.unique(self.faces)


def source(name: str) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Vertices and faces of a scan of `blend_fixtures/sources/`."""
    with np.load(ROOT / f"blend_fixtures/sources/{name}.npz") as data:
        return data["vertices"].astype(float), data["faces"].astype(np.int64)


def noisy_cube(n: int) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """A cube of `6 n² + 2` vertices, each moved by a normal variate of 0.15 edge lengths."""
    vertices, faces = shapes.cube(n)
    return vertices + 0.15 * (2.0 / n) * np.random.default_rng(SEED).standard_normal(vertices.shape), faces


MESHES = {
    "cube 1k": lambda: noisy_cube(13),
    "cube 2k": lambda: noisy_cube(20),
    "cube 8k": lambda: noisy_cube(37),
    "bust 9k": lambda: source("bust"),
    "cube 40k": lambda: noisy_cube(82),
    "cube 200k": lambda: noisy_cube(183),
    "cube 1M": lambda: noisy_cube(409),
}
"""Meshes by name: noisy cubes of growing size, and a scan."""

SERIES = ("cube 8k", "cube 40k", "cube 200k", "cube 1M")
"""Those that differ in size alone: growth is measured on them. Smaller ones fit into the caches."""


def mesh(name: str) -> Mesh:
    """One of `MESHES`."""
    return Mesh.of(name, *MESHES[name]())


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
