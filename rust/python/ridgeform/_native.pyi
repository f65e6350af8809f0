"""Types of the compiled module; the documentation is in its docstrings: `help(ridgeform.stylize)`."""

from collections.abc import Sequence
from typing import Any, Final, Literal, Self, TypeAlias, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats: TypeAlias = NDArray[np.float64]
Indices: TypeAlias = NDArray[np.int32]
Coupling: TypeAlias = Literal["joint", "separate"]
Dual: TypeAlias = Literal["barycentric", "circumcentric", "circumcentric_or_barycentric"]
Energy: TypeAlias = Literal[
    "l1_hessian",
    "l2_hessian",
    "l2_curved_hessian",
    "l2_laplacian",
    "l1_hessian_stein2018",
    "l1_edge_laplacian",
]
Scale: TypeAlias = Literal["max_edge", "bounding_box", "area", "extent"]
Solver: TypeAlias = Literal["auto", "fast", "clarabel", "clarabel-qdldl", "clarabel-faer"]
# A SciPy sparse matrix has no type here: the wheel does not depend on SciPy.
AnyMatrix: TypeAlias = SparseMatrix | ArrayLike | Any

__version__: Final[str]

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
    status: Final[Literal["solved", "stopped"]]
    def at(
        self, *, facets: int | None = None, error: float | None = None, progress: Progress | None = None
    ) -> Faceted: ...

@final
class Stylized:
    vertices: Final[Floats]
    energy: Final[Floats]
    gap: Final[Floats]
    solver_iterations: Final[Indices]
    iterations: Final[int]
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

def hessian(mesh: Mesh, *, dual: Dual = "barycentric") -> SparseMatrix: ...
def hessian_norm(mesh: Mesh, values: ArrayLike, *, dual: Dual = "barycentric") -> Floats: ...
def energy(
    mesh: Mesh,
    values: ArrayLike,
    *,
    kind: Energy = "l1_hessian",
    face_weights: ArrayLike | None = None,
    dual: Dual = "barycentric",
) -> float: ...
def voronoi_mass(mesh: Mesh) -> Floats: ...
def cotangent_laplacian(mesh: Mesh) -> SparseMatrix: ...
def intrinsic_delaunay(mesh: Mesh) -> Mesh: ...
def boundary_loops(mesh: Mesh) -> list[Indices]: ...

@final
class Hole:
    vertices: Final[Indices]
    is_outer_border: Final[bool]
    refusal: Final[str | None]

def find_holes(mesh: Mesh) -> list[Hole]: ...
def weld(
    vertices: ArrayLike, faces: ArrayLike, *, tolerance: float | None = None
) -> tuple[Floats, Indices, Indices]: ...
def orient(faces: ArrayLike) -> tuple[Indices, NDArray[np.bool_]]: ...
def interpolate(
    mesh: Mesh,
    indices: ArrayLike,
    values: ArrayLike,
    *,
    energy: Energy = "l1_hessian",
    face_weights: ArrayLike | None = None,
    linear_constraints: tuple[AnyMatrix, ArrayLike] | None = None,
    coupling: Coupling = "joint",
    dual: Dual = "barycentric",
    delaunay: bool = False,
    sharpness: float = 0.0,
    solver: Solver = "auto",
    tolerance: float | None = 1e-3,
    max_iterations: int | None = None,
    memory_limit: int | None = None,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Solution: ...
def denoise(
    mesh: Mesh,
    values: ArrayLike,
    *,
    fidelity: float,
    energy: Energy = "l1_hessian",
    fixed: ArrayLike | None = None,
    face_weights: ArrayLike | None = None,
    linear_constraints: tuple[AnyMatrix, ArrayLike] | None = None,
    coupling: Coupling = "joint",
    dual: Dual = "barycentric",
    delaunay: bool = False,
    sharpness: float = 0.0,
    solver: Solver = "auto",
    tolerance: float | None = 1e-3,
    max_iterations: int | None = None,
    memory_limit: int | None = None,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Solution: ...
def vibration_modes(
    mesh: Mesh,
    count: int,
    *,
    energy: Energy = "l1_hessian",
    face_weights: ArrayLike | None = None,
    dual: Dual = "barycentric",
    delaunay: bool = False,
    solver: Solver = "auto",
    tolerance: float | None = 1e-3,
    max_iterations: int | None = None,
    memory_limit: int | None = None,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Floats: ...
def segment(
    mesh: Mesh,
    *,
    values: ArrayLike | None = None,
    length_weight: float = 0.5,
    fidelity: float | None = None,
    epsilon_start: float = 0.1,
    epsilon_end: float = 0.001,
    inner_tolerance: float = 1e-5,
    cut_threshold: float = 0.6,
    min_faces: int | None = None,
    scale: Literal["extent", "bounding_box", "area", "max_edge"] = "extent",
    method: Literal["fitted", "paper"] = "fitted",
    n_segments: int | None = None,
    face_weights: ArrayLike | None = None,
    edge_weights: ArrayLike | None = None,
    faces: ArrayLike | None = None,
    solver: Solver = "auto",
    tolerance: float | None = None,
    max_iterations: int | None = None,
    memory_limit: int | None = None,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Segmentation: ...
def parts(
    mesh: Mesh,
    *,
    n_parts: int | None = None,
    coarseness: float = 1.0,
    face_weights: ArrayLike | None = None,
    edge_weights: ArrayLike | None = None,
    faces: ArrayLike | None = None,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Parts: ...
def facet(
    mesh: Mesh,
    *,
    facets: int | None = None,
    error: float | None = None,
    edge_weights: ArrayLike | None = None,
    faces: ArrayLike | None = None,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Faceted: ...
def stylize(
    mesh: Mesh,
    *,
    iterations: int = 20,
    fidelity: float = 500.0,
    movement: float | None = None,
    flat_share: float | None = None,
    sharpness: float = 0.5,
    coupling: Coupling = "joint",
    scale: Scale = "max_edge",
    fixed: ArrayLike | None = None,
    strength: ArrayLike | None = None,
    ridge_weights: ArrayLike | None = None,
    delaunay: bool = False,
    dual: Dual = "barycentric",
    solver: Solver = "auto",
    tolerance: float | None = 1e-3,
    max_iterations: int | None = None,
    memory_limit: int | None = None,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Stylized: ...
def diffusion_curves(
    mesh: Mesh,
    colors: ArrayLike,
    *,
    labels: ArrayLike | None = None,
    n_regions: int | None = None,
    length_weight: float = 0.5,
    min_faces: int = 20,
    face_groups: ArrayLike | None = None,
    fidelity: float = 1e3,
    rims: bool = False,
    refine: bool = True,
    color_error: float = 0.0,
    progress: Progress | None = None,
) -> DiffusionCurves: ...
def redraw(
    mesh: Mesh,
    edges: ArrayLike,
    left: ArrayLike,
    right: ArrayLike,
    *,
    points: ArrayLike | None = None,
    point_colors: ArrayLike | None = None,
    sides: ArrayLike | None = None,
    progress: Progress | None = None,
) -> Redrawn: ...
def smooth_curves(mesh: Mesh, edges: ArrayLike) -> Floats: ...
def trace_curves(
    mesh: Mesh,
    points: ArrayLike,
    *,
    starts: ArrayLike | None = None,
    closed: ArrayLike | None = None,
) -> tuple[Indices, Indices, Floats]: ...
def fill_holes(
    mesh: Mesh,
    *,
    loops: Sequence[int] | Sequence[ArrayLike] | None = None,
    max_edges: int | None = None,
    outer: bool = False,
    edge_length: float | None = None,
    iterations: int = 50,
    fidelity: float = 50.0,
    shape: Literal["auto", "flat", "smooth", "sharp"] = "auto",
    sharpness: float | Literal["auto"] = "auto",
    coupling: Coupling = "joint",
    scale: Scale = "max_edge",
    dual: Dual = "barycentric",
    solver: Solver = "auto",
    tolerance: float | None = None,
    max_iterations: int | None = None,
    memory_limit: int | None = None,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Filled: ...
def memory_available() -> int: ...
def memory_estimate(
    tool: str,
    mesh: Mesh | tuple[int, int],
    *,
    columns: int = 1,
    solver: Solver = "auto",
    longest: int | None = None,
) -> int: ...
def remesh(
    mesh: Mesh,
    *,
    edge_length: float | None = None,
    iterations: int = 10,
    fixed: ArrayLike | None = None,
    feature_angle: float | None = 45.0,
    progress: Progress | None = None,
) -> Remeshed: ...
