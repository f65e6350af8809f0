"""What is measured: each function measures one kind of thing and returns plain records."""

from __future__ import annotations

import dataclasses
from pathlib import Path

from driver import Record, clarabel, iterations_of, measure, peer
from problems import Problem

GAP, FINE, EXACT = 1e-3, 1e-4, 1e-6
"""The certified gaps that are measured."""

LARGEST_FOR_CLARABEL = 2_000
"""Vertices up to which Clarabel solves every class of problem; the flow step and `ON_SCANS` up to 15 000."""

ON_SCANS = ("interpolation, 40 points", "hole", "denoising, heavy noise")
"""Classes that Clarabel solves on a scan as well."""

LARGE, MOST_ITERATIONS = 100_000, 200
"""On meshes with more vertices, smaller gaps get so many iterations, and the table says what is reached."""

LARGEST_FOR_FINE = 300_000
"""Vertices up to which more than a gap of 1e-3 is measured."""


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


def _beside(record: Record, kind: str, folder: Path, most: int, **settings: object) -> Record:
    if record["vertices"] <= most:
        both = clarabel(kind, folder, (GAP, EXACT), **settings)
        record["clarabel"], record["clarabel_exact"] = both
    return record


def flow_step(problem: Problem, folder: Path, flow: Flow) -> Record:
    """One step from a cold start, three coordinates with joint norms, beside Clarabel on the same problem."""
    record = _named(problem)
    record["ours"] = measure("flow", folder, tolerance=GAP, **flow.settings())
    record["ours_exact"] = measure("flow", folder, tolerance=EXACT, **flow.settings())
    return _beside(record, "flow", folder, 15_000, **flow.settings())


def flow(problem: Problem, folder: Path, flow: Flow, steps: int = 20) -> Record:
    """A whole flow, stopped on residuals (the default) and certified, beside one numeric factorization."""
    record = {**_named(problem), "steps": steps, "yardstick": measure("yardstick", folder, fidelity=1.0)}
    for name, tolerance in [("default", "residuals"), ("certified", GAP)]:
        found = measure("flow", folder, steps=steps, tolerance=tolerance, **flow.settings())
        factorization = record["yardstick"]["numeric_cpu_s"] or record["yardstick"]["numeric_wall_s"]
        record[name] = {
            **found,
            "iterations": iterations_of(found),
            "in_factorisations": found["seconds"] / factorization,
        }
    return record


def scalar(problem: Problem, folder: Path, name: str) -> Record:
    """A problem of a class: ours to three gaps, the quadratic one, and Clarabel where it takes seconds."""
    record = {**_named(problem), "kind": name}
    kind, settings = "interpolate", {}
    if problem.fidelity > 0:
        kind, settings = "denoise", {"fidelity": problem.fidelity}
    record["yardstick"] = measure("yardstick", folder, **settings)
    record["ours"] = measure(kind, folder, tolerance=GAP, **settings)
    if record["vertices"] <= LARGEST_FOR_FINE:
        for ours, gap in [("ours_fine", FINE), ("ours_exact", EXACT)]:
            bound = {"max_iterations": MOST_ITERATIONS} if record["vertices"] > LARGE else {}
            record[ours] = measure(kind, folder, tolerance=gap, **bound, **settings)
    most = 15_000 if name in ON_SCANS else LARGEST_FOR_CLARABEL
    return _beside(record, kind, folder, most, **settings)


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
