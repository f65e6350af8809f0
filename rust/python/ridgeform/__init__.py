"""Ridgeform: the L1 surface Hessian as a modeler's tool.

Make a `Mesh` from arrays, then call a function per problem: `stylize` turns it piecewise flat, `facet`
makes flat polygons of it, `segment` finds the faces that it is made of and `parts` its limbs, `restore`
puts noisy parts onto the surfaces that they were made of, `fill_holes` closes holes so that the ridges
around them go on, `denoise` and `interpolate` find functions on it with sparse second derivatives,
`vibration_modes` those of least energy, `diffusion_curves` the few curves that redraw a painted surface,
and `remesh` evens out its triangles and `coarsen` leaves fewer of them; `hessian` and its companions are
the operators behind them. Arrays of any numeric dtype and memory order go in; fresh C-contiguous `float64`
and `int32` arrays come out. Long calls release the interpreter lock, report to a `Progress`, and hear
Ctrl-C. Every failure is a `RidgeformError`. `ridgeform.tiles` does the same to meshes that are larger than
memory.

Source: Rowe, Jacobson and Stein, Sharpening and Sparsifying with Surface Hessians, SIGGRAPH Asia 2024.
"""

from importlib.metadata import PackageNotFoundError as _PackageNotFoundError, version as _version
from types import BuiltinFunctionType

from ._arguments import named
from ._native import (
    Coarsened,
    DiffusionCurves,
    Faceted,
    Filled,
    FilledHole,
    Hole,
    Mesh,
    MeshReport,
    Parts,
    Progress,
    Redrawn,
    Remeshed,
    Restored,
    Segmentation,
    Solution,
    SparseMatrix,
    Stylized,
    __version__,
    boundary_loops,
    coarsen,
    cotangent_laplacian,
    denoise,
    diffusion_curves,
    energy,
    facet,
    fill_holes,
    find_holes,
    hessian,
    hessian_norm,
    interpolate,
    intrinsic_delaunay,
    memory_available,
    memory_estimate,
    orient,
    parts,
    redraw,
    remesh,
    restore,
    segment,
    smooth_curves,
    stylize,
    trace_curves,
    vibration_modes,
    voronoi_mass,
    weld,
)
from .errors import ArgumentError, Cancelled, MemoryLimitError, MeshError, RidgeformError, SolveError

__all__ = [
    "ArgumentError",
    "Cancelled",
    "Coarsened",
    "DiffusionCurves",
    "Faceted",
    "Filled",
    "FilledHole",
    "Hole",
    "MemoryLimitError",
    "Mesh",
    "MeshError",
    "MeshReport",
    "Parts",
    "Progress",
    "Redrawn",
    "Remeshed",
    "Restored",
    "RidgeformError",
    "Segmentation",
    "Solution",
    "SolveError",
    "SparseMatrix",
    "Stylized",
    "__version__",
    "boundary_loops",
    "coarsen",
    "cotangent_laplacian",
    "denoise",
    "diffusion_curves",
    "energy",
    "facet",
    "fill_holes",
    "find_holes",
    "hessian",
    "hessian_norm",
    "interpolate",
    "intrinsic_delaunay",
    "memory_available",
    "memory_estimate",
    "orient",
    "parts",
    "redraw",
    "remesh",
    "restore",
    "segment",
    "smooth_curves",
    "stylize",
    "trace_curves",
    "vibration_modes",
    "voronoi_mass",
    "weld",
]

try:
    __build__ = _version("ridgeform")
    """The version, with the build as its local part in an extension of Blender."""
except _PackageNotFoundError:
    __build__ = __version__

for _name in __all__:
    if isinstance(globals()[_name], BuiltinFunctionType):
        globals()[_name] = named(globals()[_name])
