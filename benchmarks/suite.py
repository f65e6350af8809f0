"""What is measured: each function measures one kind of thing and returns plain records."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from pathlib import Path

from driver import Record, clarabel, iterations_of, measure, peer
from problems import Problem

GAP = 1e-3
EXACT = 1e-6
"""The certified gaps that are compared."""

LARGEST_FOR_CLARABEL = 15_000
"""Vertices up to which Clarabel is measured: beyond, one solution takes minutes."""

DENOISING = {"light": (0.02, 1e5), "heavy": (0.2, 1e3)}
"""Noise (the function spans 1) and fidelity weight of the denoising problems."""

Say = Callable[[str], None]


@dataclasses.dataclass(frozen=True)
class Flow:
    """How the flow is run."""

    fidelity: float = 500.0
    sharpness: float = 0.5

    def settings(self) -> dict[str, float]:
        """The keys for `measure`."""
        return dataclasses.asdict(self)


def _named(problem: Problem) -> Record:
    return {"problem": problem.name, "vertices": len(problem.vertices), "faces": len(problem.faces)}


def _beside(record: Record, kind: str, folder: Path, n_vertices: int, **settings: object) -> Record:
    if n_vertices <= LARGEST_FOR_CLARABEL:
        both = clarabel(kind, folder, (GAP, EXACT), **settings)
        record["clarabel"], record["clarabel_exact"] = both
    return record


def flow_step(problem: Problem, folder: Path, flow: Flow) -> Record:
    """One step from a cold start, three coordinates with joint norms, beside Clarabel on the same problem."""
    record = _named(problem)
    record["ours"] = measure("flow", folder, tolerance=GAP, **flow.settings())
    record["ours_exact"] = measure("flow", folder, tolerance=EXACT, **flow.settings())
    return _beside(record, "flow", folder, record["vertices"], **flow.settings())


def flow(problem: Problem, folder: Path, flow: Flow, steps: int = 20) -> Record:
    """A whole flow, stopped on residuals (the default) and certified, beside one numeric factorisation."""
    record = {**_named(problem), "steps": steps, "yardstick": measure("yardstick", folder, fidelity=1.0)}
    for name, tolerance in [("default", "residuals"), ("certified", GAP)]:
        found = measure("flow", folder, steps=steps, tolerance=tolerance, **flow.settings())
        factorisation = record["yardstick"]["numeric_cpu_s"] or record["yardstick"]["numeric_wall_s"]
        record[name] = {
            **found,
            "iterations": iterations_of(found),
            "in_factorisations": found["seconds"] / factorisation,
        }
    return record


def interpolation(problem: Problem, folder: Path) -> Record:
    """One function known at 40 vertices."""
    record = {**_named(problem), "kind": "interpolation", "yardstick": measure("yardstick", folder)}
    record["ours"] = measure("interpolate", folder, tolerance=GAP)
    record["ours_exact"] = measure("interpolate", folder, tolerance=EXACT)
    return _beside(record, "interpolate", folder, record["vertices"])


def denoising(problem: Problem, folder: Path, noise: str) -> Record:
    """One function under `noise`, a key of `DENOISING`."""
    fidelity = DENOISING[noise][1]
    record = {**_named(problem), "kind": f"denoising, {noise} noise"}
    record["yardstick"] = measure("yardstick", folder, fidelity=fidelity)
    record["ours"] = measure("denoise", folder, tolerance=GAP, fidelity=fidelity)
    record["ours_exact"] = measure("denoise", folder, tolerance=EXACT, fidelity=fidelity)
    return _beside(record, "denoise", folder, record["vertices"], fidelity=fidelity)


def gpytoolbox(problem: Problem, folder: Path) -> Record:
    """The interpolation once more, beside `gpytoolbox.min_l1_with_fixed`."""
    record = {**_named(problem), "ours": measure("interpolate", folder, tolerance=GAP)}
    optimum = measure("interpolate", folder, tolerance=1e-8, repeats=1, solver="faer")["objective"]
    rounds = peer("gpytoolbox", folder)["rounds"]
    for round_ in rounds:
        round_["error"] = round_["objective"] / optimum - 1
    record["ours"]["error"] = record["ours"]["objective"] / optimum - 1
    record["loosest"] = next((r for r in rounds if abs(r["error"]) <= 1e-4), None)
    record["default"] = rounds[-1]
    return record


def assembly(problem: Problem, folder: Path) -> Record:
    """`H` from positions and faces, and new values on a known pattern, beside NumPy and SciPy."""
    record = {**_named(problem), "ours": measure("assembly", folder), "scipy": peer("assembly", folder)}
    ours, scipy = record["ours"], record["scipy"]
    if ours["entries"] != scipy["entries"] or abs(ours["frobenius"] / scipy["frobenius"] - 1) > 1e-9:
        raise AssertionError(f"the two matrices of {problem.name} differ")
    return record
