"""Meshes that nobody modeled, each from a few drawn numbers, so that a failing one shrinks."""

from dataclasses import dataclass

import numpy as np
from hypothesis import strategies as st
from known_shapes import shapes

LARGE = ["grid", "sphere", "torus", "cube", "moebius", "soup", "fan"]
TINY = ["one face", "book", "band", "triples", "few vertices", "few faces"]
BASES = TINY * 4 + LARGE
"""Most are tiny: faults of connections and of numbers show on few faces."""
FAULTS = [
    "none",
    "holes",
    "fins",
    "bow tie",
    "repeated faces",
    "both sides",
    "degenerate",
    "flat",
    "line",
    "point",
    "needles",
    "loose vertices",
    "mixed orientation",
    "self-intersecting",
    "zero edges",
]
SIZES = ["one", "extreme", "mixed", "far away", "denormal"]


@dataclass(frozen=True)
class MeshPlan:
    """What a mesh is made from."""

    base: str
    resolution: int
    fault: str
    size: str
    exponent: int
    seed: int

    def make(self) -> tuple[np.ndarray, np.ndarray]:
        """Vertices (n,3) and faces (m,3)."""
        rng = np.random.default_rng(self.seed)
        vertices, faces = _base(self.base, self.resolution, rng)
        vertices, faces = _faulty(self.fault, np.array(vertices, float), np.array(faces), rng)
        return _sized(self.size, self.exponent, vertices, rng), faces


def mesh_plans() -> st.SearchStrategy[MeshPlan]:
    """All of them; half are of a sane size, and a third without fault."""
    return st.builds(
        MeshPlan,
        base=st.sampled_from(BASES),
        resolution=st.integers(1, 5),
        fault=st.sampled_from(FAULTS) | st.just("none"),
        size=st.just("one") | st.sampled_from(SIZES),
        exponent=st.integers(-1000, 1000),
        seed=st.integers(0, 2**32 - 1),
    )


def _noisy(shape: tuple[np.ndarray, np.ndarray], noise: float) -> tuple[np.ndarray, np.ndarray]:
    return shapes.add_noise(*shape, noise), shape[1]


def _soup(n: int, m: int, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    return rng.normal(size=(n, 3)), rng.integers(0, n, (m, 3))


def _fan(n: int) -> tuple[np.ndarray, np.ndarray]:
    angles = 2 * np.pi * np.arange(n) / n
    rim = np.c_[np.cos(angles), np.sin(angles), 0 * angles]
    i = np.arange(n)
    return np.r_[[[0, 0, 0.3]], rim], np.c_[0 * i, 1 + i, 1 + (i + 1) % n]


def _base(base: str, k: int, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    makers = {
        "grid": lambda: _noisy(shapes.grid(2 * k, 2 * k), rng.choice([0, 0.1])),
        "sphere": lambda: _noisy(shapes.icosphere((k + 1) // 2), rng.choice([0, 0.1, 0.5])),
        "torus": lambda: shapes.torus(3 * k, 2 + k),
        "cube": lambda: shapes.cube(k),
        "moebius": shapes.moebius_strip,
        "soup": lambda: _soup(4 * k, 6 * k, rng),
        "fan": lambda: _fan(12 * k**2),
    }
    if base in TINY:
        faces = _tiny_faces(base, k, rng)
        return _places(int(faces.max()) + 1, rng), faces
    return makers[base]()


def _tiny_faces(base: str, k: int, rng: np.random.Generator) -> np.ndarray:
    """Up to some twenty faces."""
    i = np.arange(2 * k)
    if base == "one face":
        return np.array([[0, 1, 2], [1, 2, 0], [0, 2, 1]])[rng.integers(0, 3, k)]
    if base == "book":
        return np.c_[0 * i, 0 * i + 1, 2 + i]
    if base == "band":
        # With an odd number of faces one with a twist.
        n = 2 * k + 2 + rng.integers(0, 2)
        i = np.arange(n)
        return np.c_[i % n, (i + 1 + i % 2) % n, (i + 2 - i % 2) % n]
    n = 3 + k % 4
    if base == "triples":
        triples = np.array([[a, b, c] for a in range(n) for b in range(a) for c in range(b)])
        return triples[np.r_[True, rng.random(len(triples) - 1) < 0.5]]
    return rng.integers(0, n, (k if base == "few faces" else 3 * k, 3))


def _places(n: int, rng: np.random.Generator) -> np.ndarray:
    """Anywhere, on a lattice of few places, in a plane, or in line; or nearly so."""
    kind = rng.integers(0, 4)
    free = rng.normal(size=(n, 3))
    on = [free, rng.integers(0, 3, (n, 3)) / 3.0, free * [1, 1, 0], np.arange(n)[:, None] / 3.0 * np.ones(3)]
    return on[kind] + rng.choice([0.0, 0.0, 1e-16, 1e-12, 1e-6]) * rng.normal(size=(n, 3))


def _faulty(
    fault: str, vertices: np.ndarray, faces: np.ndarray, rng: np.random.Generator
) -> tuple[np.ndarray, np.ndarray]:
    n, m = len(vertices), len(faces)
    some = rng.integers(0, m, 4)
    if fault == "holes":
        faces = faces[rng.random(m) > rng.choice([0.05, 0.3])]
    elif fault == "fins":
        faces = np.r_[faces, np.c_[faces[some, :2], n + np.arange(4)]]
        vertices = np.r_[vertices, rng.normal(size=(4, 3))]
    elif fault == "bow tie":
        other = faces + n
        other[other == n] = 0
        vertices, faces = np.r_[vertices, vertices + 3], np.r_[faces, other]
    elif fault == "repeated faces":
        faces = np.r_[faces, faces[some], faces[some[:2]]]
    elif fault == "both sides":
        faces = np.r_[faces, faces[:, ::-1]]
    elif fault == "degenerate":
        faces[some[0], 1] = faces[some[0], 0]
        faces[some[1]] = faces[some[1], 0]
        vertices[faces[some[2], 1]] = vertices[faces[some[2], 0]]
    elif fault in ("flat", "line", "point"):
        vertices[:, {"flat": [2], "line": [1, 2], "point": [0, 1, 2]}[fault]] = 2.5
    elif fault == "needles":
        vertices[:, 1] *= 10.0 ** rng.uniform(-16, -3)
    elif fault == "loose vertices":
        vertices = np.r_[vertices, rng.normal(size=(n, 3))]
    elif fault == "mixed orientation":
        turned = rng.random(m) < 0.4
        faces[turned] = faces[turned][:, ::-1]
    elif fault == "self-intersecting":
        vertices = vertices + rng.normal(scale=0.7, size=vertices.shape)
    elif fault == "zero edges":
        vertices[faces[some, 0]] = vertices[faces[some, 1]]
    return vertices, faces


def _sized(size: str, exponent: int, vertices: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    if size == "extreme":
        return np.ldexp(vertices, exponent)
    if size == "mixed":
        return vertices * 10.0 ** rng.uniform(-30, 30, (len(vertices), 1))
    if size == "far away":
        return vertices + 2.0 ** (abs(exponent) % 54)
    if size == "denormal":
        return np.round(vertices * 50) * 5e-324
    return vertices
