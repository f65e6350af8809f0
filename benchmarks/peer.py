"""Time one Python peer on one problem and print a line of JSON.

    python benchmarks/peer.py assembly|gpytoolbox FOLDER [REPEATS]

Runs in the environment of `requirements.txt`. FOLDER is what `Problem.write` wrote.
"""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import scipy_assembly
from numpy.typing import NDArray

PRECISIONS = (1e-2, 1e-3, 1e-4, 1e-6, 1e-9)
"""Of SCS, absolute and relative; 1e-9 is what gpytoolbox sets by default."""

BUDGET = 30.0
"""Seconds after which a measurement is not repeated any more."""


def sample(work: Callable[[], Any], repeats: int) -> dict[str, list[float]]:
    """Wall and processor times of `work`."""
    wall, cpu = [], []
    for _ in range(repeats):
        begin = time.perf_counter(), time.process_time()
        work()
        wall.append(time.perf_counter() - begin[0])
        cpu.append(time.process_time() - begin[1])
        if sum(wall) > BUDGET:
            break
    return {"wall_s": wall, "cpu_s": cpu}


def assembly(vertices: NDArray, faces: NDArray, repeats: int) -> dict[str, Any]:
    """From positions and faces to `H`, and new values on a known pattern."""
    matrix = scipy_assembly.hessian(vertices, faces)
    pattern = scipy_assembly.Pattern(vertices, faces)
    lengths = scipy_assembly.edge_lengths(vertices, faces)
    again = sample(lambda: pattern.values(lengths), repeats)
    return {
        **sample(lambda: scipy_assembly.hessian(vertices, faces), repeats),
        "again_wall_s": again["wall_s"],
        "again_cpu_s": again["cpu_s"],
        "entries": int(matrix.nnz),
        "frobenius": float(np.sqrt((matrix.data**2).sum())),
    }


def gpytoolbox(vertices: NDArray, faces: NDArray, folder: Path, repeats: int) -> dict[str, Any]:
    """`min_l1_with_fixed` with SCS at several precisions, each with its time and the objective it reached."""
    # Only this peer needs it.
    from gpytoolbox import min_l1_with_fixed  # noqa: PLC0415

    indices = np.fromfile(folder / "indices.u32", "<u4").astype(int)
    values = np.fromfile(folder / "values.f64", "<f8")
    matrix = scipy_assembly.hessian(vertices, faces)
    rounds = []
    for precision in PRECISIONS:
        found = []

        def work(eps: float = precision, found: list = found) -> None:
            settings = {"eps_abs": eps, "eps_rel": eps, "max_iters": 1_000_000}
            found.append(
                min_l1_with_fixed(G=matrix, k=indices, y=values[indices], d=4, solver="scs", params=settings)
            )

        times = sample(work, repeats)
        u = found[-1].copy()
        # What SCS leaves between the known values and its own is not charged to it.
        u[indices] = values[indices]
        objective = float(np.linalg.norm((matrix @ u).reshape(-1, 4), axis=1).sum())
        rounds.append({"precision": precision, "objective": objective, **times})
    return {"rounds": rounds}


def main(arguments: list[str]) -> None:
    """Measure what is named."""
    kind, folder, *rest = arguments
    repeats = int(rest[0]) if rest else 5
    vertices = np.fromfile(Path(folder) / "vertices.f64", "<f8").reshape(-1, 3)
    faces = np.fromfile(Path(folder) / "faces.u32", "<u4").reshape(-1, 3).astype(np.int64)
    if kind == "assembly":
        answer = assembly(vertices, faces, repeats)
    elif kind == "gpytoolbox":
        answer = gpytoolbox(vertices, faces, Path(folder), repeats)
    else:
        sys.exit(f"no peer is called {kind}")
    print(json.dumps(answer))


if __name__ == "__main__":
    main(sys.argv[1:])
