"""`tiles.stylize`."""

from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from . import _shape
from ._flow import Plan, flow
from ._run import Executor, Report
from ._store import Array, get

ENOUGH = 9000
"""The most vertices of the coarsest level of a shape of unit size, as in `ridgeform.stylize`."""


@dataclass(frozen=True)
class Stylized:
    """What `tiles.stylize` returns.

    vertices : (n,3) float64, the new positions
    energy : the energy of the coordinates of the mesh before, and after every step on the mesh of that step,
        (steps + 1,) float64
    gap : the largest certified relative duality gap of a block's problem
    level_vertices : the vertices of the mesh that each step was done on, (steps,) int32
    n_blocks : blocks of every level, the mesh itself first
    iterations : steps of the flow on the coarsest level
    status : as in `ridgeform.Stylized`, of the coarsest level; "inaccurate", "collapsed" or "diverged" also
        where that is so of a block, which a step then leaves as it was
    """

    vertices: Array
    energy: Array
    gap: float
    level_vertices: Array
    n_blocks: list[int]
    iterations: int
    status: str


def stylize(
    vertices: ArrayLike,
    faces: ArrayLike,
    *,
    iterations: int = 20,
    fidelity: float = 500.0,
    movement: float | None = None,
    flat_share: float | None = None,
    sharpness: float = 0.5,
    coupling: Literal["joint", "separate"] = "joint",
    scale: str | float = "max_edge",
    fixed: ArrayLike | None = None,
    strength: ArrayLike | None = None,
    ridge_weights: ArrayLike | None = None,
    dual: str = "barycentric",
    tolerance: float | None = 1e-3,
    memory_limit: int | None = None,
    threads: int | None = None,
    max_vertices: int = 50_000,
    rings: int = 12,
    executor: Executor | None = None,
    folder: str | Path | None = None,
    report: Report | None = None,
) -> Stylized:
    """Turn a mesh piecewise flat, as `ridgeform.stylize` does, in blocks.

    The whole flow is done on a coarser mesh, which edge collapses leave of this one and which is small enough
    to be one block; the last two steps, as short as its first, on finer ones and on the mesh itself in blocks
    of at most `max_vertices`, each with rings of faces of others around it. Unit and weights are those of the
    whole mesh. After each step a vertex that several blocks have is where the mean of them has it, with
    weights that fall to 0 toward the rim of a block, so that it has one place and there is no seam.

    Parameters
    ----------
    vertices : (n,3) array, also one that is mapped into memory (`numpy.load` with `mmap_mode`)
    faces : (m,3) array of whole numbers
    iterations, fidelity, movement, flat_share, sharpness, coupling, scale, fixed, strength, ridge_weights,
        dual, tolerance, memory_limit, threads : as in `ridgeform.stylize`; `scale` in the units of the whole
        mesh: with a length, the size of what shall remain, such as that of a house, a larger city becomes no
        coarser
    max_vertices : vertices of a block, without the rings, >= 100; about 7 kB of memory each
    rings : rings of faces around a block, >= 2
    executor : None (in this process), an executor of `concurrent.futures`, or a `dask.distributed.Client`;
        all processes must see `folder`
    folder : where files are kept while it works, about 1 kB a vertex; None for the system's temporary folder
    report : called with what is being done, how many blocks of it are, and of how many; or None

    Returns
    -------
    Stylized

    Raises
    ------
    ArgumentError, MeshError (no faces, none with area), SolveError, MemoryLimitError (a smaller
    `max_vertices` helps), RidgeformError where a process of the executor ended
    """
    with _shape.prepared((vertices, faces), (max_vertices, rings), executor, folder, report) as work:
        level = work.level(0)
        n, m = len(get(level, "vertices")), len(get(level, "faces"))
        _shape.setting(level, "strength", "strength", strength, n, most=1.0)
        _shape.setting(level, "ridge_weights", "ridges", ridge_weights, m)
        _shape.held(level, fixed, n)
        sizes = _shape.sizes(level)
        unit = _shape.unit(sizes, scale)
        # A level has as many vertices for an area as that of a shape of unit size; words mean the whole.
        units = 1.0 if isinstance(scale, str) else max(1.0, (sizes["area"] / unit) ** 2)
        plan = Plan(
            iterations=iterations,
            sharpness=sharpness,
            enough=round(min(max_vertices, ENOUGH * units)),
            ends={"fidelity": fidelity, "movement": movement, "flat_share": flat_share},
            step={
                "scale": unit,
                "coupling": coupling,
                "dual": dual,
                "tolerance": tolerance,
                "memory_limit": memory_limit,
                "threads": threads,
            },
        )
        account = flow(work, plan)
        return Stylized(
            vertices=np.array(get(level, "points")),
            energy=np.array(account.energy),
            gap=max(account.gap, default=0.0),
            level_vertices=np.array(account.level_vertices, np.int32),
            n_blocks=account.n_blocks,
            iterations=account.iterations,
            status=account.status,
        )
