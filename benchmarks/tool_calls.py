"""Every tool of the package on one mesh, as the tables of reliability call it: few iterations."""

from __future__ import annotations

import signal
from collections.abc import Callable
from typing import Any

import numpy as np
import ridgeform

Call = Callable[[ridgeform.Mesh, dict[str, Any]], Any]

EVERY_THOUSANDTH = 1000


def bumpy_grid(
    n_vertices: int, noise: float = 0.02, most_radius: float = 12
) -> tuple[np.ndarray, np.ndarray]:
    """Vertices `(n,3)` and faces `(m,3)` of a square grid at unit steps, with noise and a round hole."""
    side = max(round(float(np.sqrt(n_vertices))), 12)
    x, y = np.meshgrid(np.arange(side, dtype=float), np.arange(side, dtype=float), indexing="ij")
    vertices = np.column_stack([x.ravel(), y.ravel(), np.zeros(x.size)])
    vertices += np.random.default_rng(0).normal(scale=noise, size=vertices.shape)
    vertices[:, 2] += 3 * np.sin(x.ravel() / side * 9) * np.cos(y.ravel() / side * 7)
    corner = (np.arange(side - 1)[:, None] * side + np.arange(side - 1)).ravel()
    faces = np.concatenate(
        [
            np.column_stack([corner, corner + side, corner + side + 1]),
            np.column_stack([corner, corner + side + 1, corner + 1]),
        ]
    )
    center = vertices[faces].mean(1)[:, :2] - side / 2
    return vertices, faces[np.hypot(*center.T) > min(side / 6, most_radius)].astype(np.int32)


def _pins(mesh: ridgeform.Mesh) -> tuple[np.ndarray, np.ndarray]:
    pins = np.arange(0, mesh.n_vertices, EVERY_THOUSANDTH)
    pins = pins[np.isin(pins, mesh.faces)]
    return pins, np.sin(pins * 1.0)


def _heights(mesh: ridgeform.Mesh) -> np.ndarray:
    return np.ascontiguousarray(mesh.vertices[:, 2])


def _paint(mesh: ridgeform.Mesh) -> np.ndarray:
    x, y = mesh.vertices[:, 0], mesh.vertices[:, 1]
    size = x.max()
    stripes = (np.floor(3 * x / size) + np.floor(2 * y / size)) % 2
    return np.column_stack([stripes, x / size, y / size])


def _sides(mesh: ridgeform.Mesh) -> np.ndarray:
    """Every edge once."""
    faces = mesh.faces
    sides = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    return np.unique(np.sort(sides), axis=0)


def _redrawn(mesh: ridgeform.Mesh) -> ridgeform.Redrawn:
    """From colors along every edge."""
    edges = _sides(mesh)
    colors = np.linspace(0, 1, 6 * len(edges)).reshape(-1, 2, 3)
    return ridgeform.redraw(mesh, edges, colors, colors)


def _halfway(found: ridgeform.Segmentation | ridgeform.Parts) -> np.ndarray:
    fewest, most = found.range
    return found.labels_at((fewest + most) // 2)


CALLS: dict[str, Call] = {
    "report": lambda mesh, options: mesh.report,
    "hessian": lambda mesh, options: ridgeform.hessian(mesh),
    "cotangent_laplacian": lambda mesh, options: ridgeform.cotangent_laplacian(mesh),
    "energy": lambda mesh, options: ridgeform.energy(mesh, _heights(mesh)),
    "intrinsic_delaunay": lambda mesh, options: ridgeform.intrinsic_delaunay(mesh),
    "find_holes": lambda mesh, options: ridgeform.find_holes(mesh),
    "stylize": lambda mesh, options: ridgeform.stylize(mesh, iterations=1, **options),
    "denoise": lambda mesh, options: ridgeform.denoise(
        mesh, _heights(mesh), fidelity=1.0, max_iterations=30, **options
    ),
    "denoise 3 columns": lambda mesh, options: ridgeform.denoise(
        mesh, mesh.vertices, fidelity=1.0, max_iterations=10, **options
    ),
    "denoise l2": lambda mesh, options: ridgeform.denoise(
        mesh, _heights(mesh), fidelity=1.0, energy="l2_hessian", **options
    ),
    "interpolate": lambda mesh, options: ridgeform.interpolate(
        mesh, *_pins(mesh), max_iterations=30, **options
    ),
    "interpolate clarabel": lambda mesh, options: ridgeform.interpolate(
        mesh, *_pins(mesh), solver="clarabel", max_iterations=2, **options
    ),
    "denoise clarabel": lambda mesh, options: ridgeform.denoise(
        mesh, mesh.vertices, fidelity=1.0, solver="clarabel", max_iterations=2, **options
    ),
    "vibration_modes": lambda mesh, options: ridgeform.vibration_modes(mesh, 3, max_iterations=10, **options),
    "vibration_modes l2": lambda mesh, options: ridgeform.vibration_modes(
        mesh, 3, energy="l2_hessian", max_iterations=10, **options
    ),
    "segment": lambda mesh, options: ridgeform.segment(mesh, **options),
    "segment paper": lambda mesh, options: ridgeform.segment(
        mesh, method="paper", epsilon_end=0.05, max_iterations=10, **options
    ),
    "parts": lambda mesh, options: ridgeform.parts(mesh, **options),
    "facet": lambda mesh, options: ridgeform.facet(mesh, facets=200, **options),
    "restore": lambda mesh, options: ridgeform.restore(mesh, **options),
    "fill_holes": lambda mesh, options: ridgeform.fill_holes(mesh, iterations=1, **options),
    "fill_holes outer": lambda mesh, options: ridgeform.fill_holes(mesh, iterations=1, outer=True, **options),
    "remesh": lambda mesh, options: ridgeform.remesh(mesh, iterations=2, **options),
    "diffusion_curves": lambda mesh, options: ridgeform.diffusion_curves(mesh, _paint(mesh)),
    "trace_curves": lambda mesh, options: ridgeform.trace_curves(
        mesh, mesh.vertices[:: EVERY_THOUSANDTH // 10]
    ),
}
"""Name in the tables → the call; `options` are keywords that all tools take, such as `progress`."""

PARTS_OF_CALLS: dict[str, Call] = {
    "voronoi_mass": lambda mesh, options: ridgeform.voronoi_mass(mesh),
    "hessian_norm": lambda mesh, options: ridgeform.hessian_norm(mesh, _heights(mesh)),
    "boundary_loops": lambda mesh, options: ridgeform.boundary_loops(mesh),
    "orient": lambda mesh, options: ridgeform.orient(mesh.faces),
    "weld": lambda mesh, options: ridgeform.weld(mesh.vertices, mesh.faces),
    "coarsen": lambda mesh, options: ridgeform.coarsen(mesh, max(mesh.n_vertices // 4, 1)),
    "smooth_curves": lambda mesh, options: ridgeform.smooth_curves(mesh, _sides(mesh)),
    "redraw": lambda mesh, options: _redrawn(mesh),
    "segment, labels_at": lambda mesh, options: _halfway(ridgeform.segment(mesh)),
    "parts, labels_at": lambda mesh, options: _halfway(ridgeform.parts(mesh)),
    "facet, at": lambda mesh, options: ridgeform.facet(mesh, facets=20).at(facets=10),
}
"""What the package has beside its tools, for the table of growth alone."""

ESTIMATED: dict[str, tuple[str, int, str]] = {
    "hessian": ("hessian", 1, "auto"),
    "cotangent_laplacian": ("cotangent_laplacian", 1, "auto"),
    "energy": ("energy", 1, "auto"),
    "stylize": ("stylize", 3, "auto"),
    "denoise": ("denoise", 1, "auto"),
    "denoise 3 columns": ("denoise", 3, "auto"),
    "denoise l2": ("denoise_quadratic", 1, "auto"),
    "interpolate": ("interpolate", 1, "auto"),
    "interpolate clarabel": ("interpolate", 1, "clarabel"),
    "denoise clarabel": ("denoise", 3, "clarabel"),
    "vibration_modes": ("vibration_modes", 3, "auto"),
    "vibration_modes l2": ("vibration_modes_quadratic", 3, "auto"),
    "segment": ("segment_coarse_to_fine", 3, "auto"),
    "segment paper": ("segment", 3, "auto"),
    "parts": ("parts", 1, "auto"),
    "facet": ("facet_coarse_to_fine", 1, "auto"),
    "restore": ("restore", 3, "auto"),
    "fill_holes": ("fill_holes", 3, "auto"),
    "remesh": ("remesh", 1, "auto"),
    "diffusion_curves": ("diffusion_curves", 3, "auto"),
    "trace_curves": ("trace_curves", 1, "auto"),
}
"""Calls whose peak `memory_estimate` says: the tool, columns and solver to ask it for."""

WIDE_HOLE = {"fill_holes"}
"""Calls whose memory is that of the hole: it grows with the mesh there."""


def mesh_for(call: str, n_vertices: int) -> tuple[np.ndarray, np.ndarray]:
    """Vertices and faces that a call is made on."""
    return bumpy_grid(n_vertices, most_radius=np.inf if call in WIDE_HOLE else 12)


def finishing_after(seconds: float) -> ridgeform.Progress:
    """A handle that asks the call to finish once this process has computed for so many seconds more."""
    progress = ridgeform.Progress()
    # No thread: what it keeps would count under a cap.
    signal.signal(signal.SIGPROF, lambda *_: progress.finish())
    signal.setitimer(signal.ITIMER_PROF, seconds)
    return progress
