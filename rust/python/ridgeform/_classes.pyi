"""Types of the classes of the compiled module; their documentation is in their docstrings."""

from typing import Any, Final, Literal, Self, TypeAlias, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats: TypeAlias = NDArray[np.float64]
Indices: TypeAlias = NDArray[np.int32]

@final
class Mesh:
    def __new__(cls, vertices: ArrayLike, faces: ArrayLike) -> Self: ...
    @staticmethod
    def from_edge_lengths(faces: ArrayLike, lengths: ArrayLike, n_vertices: int | None = None) -> Mesh: ...
    vertices: Final[Floats | None]
    faces: Final[Indices]
    edge_lengths: Final[Floats]
    n_vertices: Final[int]
    n_faces: Final[int]
    report: Final[MeshReport]

@final
class MeshReport:
    n_components: Final[int]
    n_boundary_loops: Final[int]
    nonmanifold_edges: Final[Indices]
    inconsistent_edges: Final[Indices]
    flipped_faces: Final[Indices]
    nonmanifold_vertices: Final[Indices]
    degenerate_faces: Final[Indices]
    duplicate_faces: Final[Indices]
    doubled_faces: Final[Indices]
    t_junctions: Final[Indices]
    unreferenced_vertices: Final[Indices]

@final
class SparseMatrix:
    shape: Final[tuple[int, int]]
    nnz: Final[int]
    indptr: Final[Indices]
    indices: Final[Indices]
    data: Final[Floats]
    def to_scipy(self) -> Any: ...
    def __matmul__(self, other: ArrayLike, /) -> Floats: ...

@final
class Progress:
    def __new__(cls) -> Self: ...
    fraction: Final[float]
    stage: Final[str]
    iteration: Final[int]
    energy: Final[float | None]
    gap: Final[float | None]
    asked: Final[int]
    def cancel(self) -> None: ...
    def finish(self) -> None: ...
    def snapshot(self) -> Floats | None: ...
    def numbered_snapshot(self) -> tuple[int, Floats] | None: ...
    def snapshot_surface(self) -> tuple[Floats, Indices] | None: ...

@final
class Solution:
    values: Final[Floats]
    objective: Final[float]
    gap: Final[float]
    iterations: Final[int]
    factorisations: Final[int]
    status: Final[Literal["solved", "inaccurate", "stopped"]]
    solver: Final[str]

@final
class Remeshed:
    vertices: Final[Floats]
    faces: Final[Indices]
    origin: Final[Indices]
    edge_length: Final[float]
    iterations: Final[int]
    status: Final[Literal["finished", "stopped"]]

@final
class Coarsened:
    vertices: Final[Floats]
    faces: Final[Indices]
    parents: Final[Indices]
    places: Final[Indices]
    weights: Final[Floats]

@final
class Restored:
    vertices: Final[Floats]
    labels: Final[Indices]
    surfaces: Final[list[dict[str, Any]]]
    noise: Final[float]
    relations: Final[list[str]]
    n_held: Final[int]
    n_folded: Final[int]
    status: Final[Literal["restored", "unsure", "stopped"]]

@final
class Segmentation:
    labels: Final[Indices]
    n_segments: Final[int]
    indicator: Final[Floats]
    values: Final[Floats]
    boundary_edges: Final[Indices]
    noise: Final[float]
    fidelity: Final[float]
    epsilons: Final[Floats]
    alternations: Final[int]
    status: Final[Literal["solved", "inaccurate", "stopped"]]
    range: Final[tuple[int, int]]
    strengths: Final[Floats]
    def labels_at(self, n_segments: int) -> Indices: ...

@final
class Parts:
    labels: Final[Indices]
    n_parts: Final[int]
    boundary_edges: Final[Indices]
    status: Final[Literal["solved", "stopped"]]
    range: Final[tuple[int, int]]
    costs: Final[Floats]
    def labels_at(self, n_parts: int) -> Indices: ...

@final
class Faceted:
    vertices: Final[Floats]
    origins: Final[Indices]
    polygon_vertices: Final[Indices]
    polygon_starts: Final[Indices]
    polygon_facets: Final[Indices]
    faces: Final[Indices]
    face_facets: Final[Indices]
    labels: Final[Indices]
    planes: Final[Floats]
    n_facets: Final[int]
    rms: Final[float]
    largest: Final[float]
    n_crossings: Final[int]
    kept_vertices: Final[Floats | None]
    kept_corners: Final[Indices | None]
    n_flipped: Final[int]
    n_folded: Final[int]
    status: Final[Literal["solved", "stopped"]]
    def at(
        self, *, facets: int | None = None, error: float | None = None, progress: Progress | None = None
    ) -> Faceted: ...

@final
class Stylized:
    vertices: Final[Floats]
    energy: Final[Floats]
    fidelities: Final[Floats]
    gap: Final[Floats]
    solver_iterations: Final[Indices]
    iterations: Final[int]
    level_vertices: Final[Indices]
    factorisations: Final[int]
    flat_share: Final[Floats]
    n_facets: Final[int]
    status: Final[
        Literal[
            "finished",
            "reached",
            "settled",
            "inaccurate",
            "converged",
            "collapsed",
            "diverged",
            "stopped",
        ]
    ]

@final
class DiffusionCurves:
    edges: Final[Indices]
    starts: Final[Indices]
    left: Final[Floats]
    right: Final[Floats]
    points: Final[Indices]
    point_colors: Final[Floats]
    colors: Final[Floats]
    corners: Final[Floats]
    sides: Final[Indices]
    labels: Final[Indices]
    error: Final[float]
    psnr: Final[float]
    n_numbers: Final[int]
    n_numbers_before: Final[int]
    polylines: Final[list[Indices]]

@final
class Redrawn:
    colors: Final[Floats]
    corners: Final[Floats]

@final
class Hole:
    vertices: Final[Indices]
    is_outer_border: Final[bool]
    refusal: Final[str | None]

@final
class Filled:
    vertices: Final[Floats]
    faces: Final[Indices]
    patch: Final[Indices]
    new_vertices: Final[Floats]
    new_faces: Final[Indices]
    new_patch: Final[Indices]
    holes: Final[list[FilledHole]]
    ridges: Final[Indices]
    status: Final[Literal["converged", "finished", "stopped"]]

@final
class FilledHole:
    boundary: Final[Indices]
    status: Final[Literal["converged", "finished", "stopped", "refused"]]
    reason: Final[str | None]
    shape: Final[Literal["flat", "smooth", "sharp"] | None]
    sharpness: Final[float]
    energy: Final[tuple[float, float]]
    gap: Final[float]
    iterations: Final[int]
