"""Types of the compiled module; the documentation is in its docstrings: `help(ridgeform.stylize)`.

Classes are in `_classes.pyi`, which is no module of its own.
"""

from collections.abc import Sequence
from typing import Any, Final, Literal, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._classes import (
    Coarsened as Coarsened,
    DiffusionCurves as DiffusionCurves,
    Faceted as Faceted,
    Filled as Filled,
    FilledHole as FilledHole,
    Floats,
    Hole as Hole,
    Indices,
    Mesh as Mesh,
    MeshReport as MeshReport,
    Parts as Parts,
    Progress as Progress,
    Redrawn as Redrawn,
    Remeshed as Remeshed,
    Restored as Restored,
    Segmentation as Segmentation,
    Solution as Solution,
    SparseMatrix as SparseMatrix,
    Stylized as Stylized,
)

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
    fixed: ArrayLike | None = None,
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
def restore(
    mesh: Mesh,
    *,
    max_move: float | None = None,
    noise: float | None = None,
    regularize: float | None = None,
    free: bool = True,
    fixed: ArrayLike | None = None,
    faces: ArrayLike | None = None,
    solver: Solver = "auto",
    tolerance: float | None = 1e-3,
    max_iterations: int | None = None,
    memory_limit: int | None = None,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Restored: ...
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
    scale: Literal["extent", "bounding_box", "area", "max_edge"] | float = "extent",
    method: Literal["fitted", "paper"] = "fitted",
    fillets: Literal["automatic", "apart", "joined"] = "automatic",
    n_segments: int | None = None,
    face_weights: ArrayLike | None = None,
    edge_weights: ArrayLike | None = None,
    faces: ArrayLike | None = None,
    noise: float | None = None,
    coarse_to_fine: bool | None = None,
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
    keep_triangles: bool = False,
    keep_volume: bool = False,
    symmetric: Literal["x", "y", "z", "auto"] | None = None,
    coarse_to_fine: bool | None = None,
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
    scale: Scale | float = "max_edge",
    fixed: ArrayLike | None = None,
    strength: ArrayLike | None = None,
    ridge_weights: ArrayLike | None = None,
    delaunay: bool = False,
    dual: Dual = "barycentric",
    coarse_to_fine: bool | None = None,
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
def coarsen(
    mesh: Mesh,
    n_vertices: int,
    *,
    kept: ArrayLike | None = None,
    held: ArrayLike | None = None,
    progress: Progress | None = None,
) -> Coarsened: ...
def remesh(
    mesh: Mesh,
    *,
    edge_length: float | None = None,
    iterations: int = 10,
    fixed: ArrayLike | None = None,
    feature_angle: float | None = 45.0,
    progress: Progress | None = None,
) -> Remeshed: ...
