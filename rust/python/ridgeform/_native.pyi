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
    @property
    def vertices(self) -> Floats | None: ...
    @property
    def faces(self) -> Indices: ...
    @property
    def edge_lengths(self) -> Floats: ...
    @property
    def n_vertices(self) -> int: ...
    @property
    def n_faces(self) -> int: ...
    @property
    def report(self) -> MeshReport: ...

@final
class MeshReport:
    @property
    def n_components(self) -> int: ...
    @property
    def n_boundary_loops(self) -> int: ...
    @property
    def nonmanifold_edges(self) -> Indices: ...
    @property
    def inconsistent_edges(self) -> Indices: ...
    @property
    def flipped_faces(self) -> Indices: ...
    @property
    def nonmanifold_vertices(self) -> Indices: ...
    @property
    def degenerate_faces(self) -> Indices: ...
    @property
    def duplicate_faces(self) -> Indices: ...
    @property
    def unreferenced_vertices(self) -> Indices: ...

@final
class SparseMatrix:
    @property
    def shape(self) -> tuple[int, int]: ...
    @property
    def nnz(self) -> int: ...
    @property
    def indptr(self) -> Indices: ...
    @property
    def indices(self) -> Indices: ...
    @property
    def data(self) -> Floats: ...
    def to_scipy(self) -> Any: ...
    def __matmul__(self, other: ArrayLike, /) -> Floats: ...

@final
class Progress:
    def __new__(cls) -> Self: ...
    @property
    def fraction(self) -> float: ...
    @property
    def stage(self) -> str: ...
    @property
    def iteration(self) -> int: ...
    @property
    def energy(self) -> float | None: ...
    @property
    def gap(self) -> float | None: ...
    @property
    def asked(self) -> int: ...
    def cancel(self) -> None: ...
    def finish(self) -> None: ...
    def snapshot(self) -> Floats | None: ...
    def numbered_snapshot(self) -> tuple[int, Floats] | None: ...
    def snapshot_surface(self) -> tuple[Floats, Indices] | None: ...

@final
class Solution:
    @property
    def values(self) -> Floats: ...
    @property
    def objective(self) -> float: ...
    @property
    def gap(self) -> float: ...
    @property
    def iterations(self) -> int: ...
    @property
    def factorisations(self) -> int: ...
    @property
    def status(self) -> Literal["solved", "inaccurate", "stopped"]: ...
    @property
    def solver(self) -> str: ...

@final
class Remeshed:
    @property
    def vertices(self) -> Floats: ...
    @property
    def faces(self) -> Indices: ...
    @property
    def origin(self) -> Indices: ...
    @property
    def edge_length(self) -> float: ...
    @property
    def iterations(self) -> int: ...
    @property
    def status(self) -> Literal["finished", "stopped"]: ...

@final
class Segmentation:
    @property
    def labels(self) -> Indices: ...
    @property
    def n_segments(self) -> int: ...
    @property
    def indicator(self) -> Floats: ...
    @property
    def values(self) -> Floats: ...
    @property
    def boundary_edges(self) -> Indices: ...
    @property
    def noise(self) -> float: ...
    @property
    def fidelity(self) -> float: ...
    @property
    def epsilons(self) -> Floats: ...
    @property
    def alternations(self) -> int: ...
    @property
    def status(self) -> Literal["solved", "inaccurate", "stopped"]: ...
    @property
    def range(self) -> tuple[int, int]: ...
    @property
    def strengths(self) -> Floats: ...
    def labels_at(self, n_segments: int) -> Indices: ...

@final
class Parts:
    @property
    def labels(self) -> Indices: ...
    @property
    def n_parts(self) -> int: ...
    @property
    def boundary_edges(self) -> Indices: ...
    @property
    def status(self) -> Literal["solved", "stopped"]: ...
    @property
    def range(self) -> tuple[int, int]: ...
    @property
    def costs(self) -> Floats: ...
    def labels_at(self, n_parts: int) -> Indices: ...

@final
class Stylized:
    @property
    def vertices(self) -> Floats: ...
    @property
    def energy(self) -> Floats: ...
    @property
    def gap(self) -> Floats: ...
    @property
    def solver_iterations(self) -> Indices: ...
    @property
    def iterations(self) -> int: ...
    @property
    def factorisations(self) -> int: ...
    @property
    def flat_share(self) -> Floats: ...
    @property
    def n_facets(self) -> int: ...
    @property
    def status(
        self,
    ) -> Literal[
        "finished",
        "reached",
        "settled",
        "inaccurate",
        "converged",
        "collapsed",
        "diverged",
        "stopped",
    ]: ...

@final
class DiffusionCurves:
    @property
    def edges(self) -> Indices: ...
    @property
    def starts(self) -> Indices: ...
    @property
    def left(self) -> Floats: ...
    @property
    def right(self) -> Floats: ...
    @property
    def points(self) -> Indices: ...
    @property
    def point_colors(self) -> Floats: ...
    @property
    def colors(self) -> Floats: ...
    @property
    def corners(self) -> Floats: ...
    @property
    def sides(self) -> Indices: ...
    @property
    def labels(self) -> Indices: ...
    @property
    def error(self) -> float: ...
    @property
    def psnr(self) -> float: ...
    @property
    def n_numbers(self) -> int: ...
    @property
    def n_numbers_before(self) -> int: ...
    @property
    def polylines(self) -> list[Indices]: ...

@final
class Redrawn:
    @property
    def colors(self) -> Floats: ...
    @property
    def corners(self) -> Floats: ...

@final
class Filled:
    @property
    def vertices(self) -> Floats: ...
    @property
    def faces(self) -> Indices: ...
    @property
    def patch(self) -> Indices: ...
    @property
    def new_vertices(self) -> Floats: ...
    @property
    def new_faces(self) -> Indices: ...
    @property
    def new_patch(self) -> Indices: ...
    @property
    def holes(self) -> list[FilledHole]: ...
    @property
    def ridges(self) -> Indices: ...
    @property
    def status(self) -> Literal["converged", "finished", "stopped"]: ...

@final
class FilledHole:
    @property
    def boundary(self) -> Indices: ...
    @property
    def status(self) -> Literal["converged", "finished", "stopped", "refused"]: ...
    @property
    def reason(self) -> str | None: ...
    @property
    def shape(self) -> Literal["flat", "smooth", "sharp"] | None: ...
    @property
    def sharpness(self) -> float: ...
    @property
    def energy(self) -> tuple[float, float]: ...
    @property
    def gap(self) -> float: ...
    @property
    def iterations(self) -> int: ...

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
    @property
    def vertices(self) -> Indices: ...
    @property
    def is_outer_border(self) -> bool: ...
    @property
    def refusal(self) -> str | None: ...

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
