"""`tiles.segment`."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..errors import ArgumentError
from . import _shape, _tasks
from ._joining import joined
from ._levels import Work, cut
from ._run import Executor, Report, on_blocks
from ._store import Array, get

QUANTILES = 1001
"""Points of a block's distribution from which the median of all is found, to a thousandth of the edges."""


MEDIAN_LENGTH = 0.674490
"""The median of the size of a standard normal number: the noise of positions shows along the normal alone."""


@dataclass(frozen=True)
class Segmented:
    """What `tiles.segment` returns.

    labels : (m,) int32, the segment of each face, from 0 in the order of their first faces
    n_segments : how many there are
    noise : the standard deviation of the noise that all blocks were told, along the normal
    n_blocks : in how many blocks it was done
    """

    labels: Array
    n_segments: int
    noise: float
    n_blocks: int


def segment(
    vertices: ArrayLike,
    faces: ArrayLike,
    *,
    length_weight: float = 0.5,
    min_faces: int | None = None,
    scale: str | float = "extent",
    face_weights: ArrayLike | None = None,
    noise: float | None = None,
    memory_limit: int | None = None,
    threads: int | None = None,
    max_vertices: int = 50_000,
    rings: int = 12,
    executor: Executor | None = None,
    folder: str | Path | None = None,
    report: Report | None = None,
) -> Segmented:
    """Divide the faces of a mesh into segments, as `ridgeform.segment` does, in blocks.

    Each block is segmented with rings of faces of others around it, with the unit and the noise of the whole
    mesh. Along the line where blocks meet, two segments become one where both blocks see no border between
    them and they have most of the faces in common that both blocks have. So what is found depends on the
    size of blocks, not on that of the mesh.

    Parameters
    ----------
    vertices, faces : as for `tiles.stylize`
    length_weight, min_faces, scale, face_weights, noise, memory_limit, threads : as in `ridgeform.segment`;
        `scale` of the whole mesh
    max_vertices, rings, executor, folder, report : as for `tiles.stylize`; about 2 kB of memory for each
        vertex of a block

    Returns
    -------
    Segmented

    Raises
    ------
    ArgumentError, MeshError (no faces, none with area), SolveError, MemoryLimitError (a smaller
    `max_vertices` helps), RidgeformError where a process of the executor ended
    """
    if noise is not None and not 0.0 <= noise < np.inf:
        raise ArgumentError(f"noise: is {noise}; it must be finite and at least 0")
    with _shape.prepared((vertices, faces), (max_vertices, rings), executor, folder, report) as work:
        level = work.level(0)
        _shape.setting(level, "face_weights", "ridges", face_weights, len(get(level, "faces")))
        unit = _shape.unit(_shape.sizes(level), scale)
        n_blocks = cut(work, 0)
        known = noise_of(work, n_blocks) if noise is None else float(noise)
        options: dict[str, Any] = {
            "length_weight": length_weight,
            "min_faces": min_faces,
            "scale": unit,
            "noise": known,
            "memory_limit": memory_limit,
            "threads": threads,
        }
        calls = [(str(level), block, options) for block in range(n_blocks)]
        on_blocks(_tasks.segment, calls, work.executor, report, "segmenting")
        labels, n_segments = joined(level, n_blocks)
        return Segmented(labels=labels, n_segments=n_segments, noise=known, n_blocks=n_blocks)


def noise_of(work: Work, n_blocks: int) -> float:
    """The noise of all blocks: the median over all edges, each of which lies in one block, or between two."""
    calls = [(str(work.level(0)), block, QUANTILES) for block in range(n_blocks)]
    found = on_blocks(_tasks.noise, calls, work.executor, work.report, "measuring noise")
    values = np.concatenate([quantiles for quantiles, _ in found])
    weights = np.repeat([count for _, count in found], QUANTILES).astype(float)
    if not weights.sum() > 0.0:
        return 0.0
    order = np.argsort(values, kind="stable")
    middle = np.searchsorted(np.cumsum(weights[order]), 0.5 * weights.sum())
    return float(values[order[middle]]) / MEDIAN_LENGTH
