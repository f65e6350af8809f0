"""Measure against peers and the L2 yardstick, and write the tables: `results.md`, `results.json`, README.

    python scripts/setup_env.py benchmarks/run.py [--quick] [--mesh FILE.obj [--fidelity N] [--sharpness P]]

`--quick` takes the small problems only, `--mesh` only the flow on that file; both print and keep nothing.
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
# Beside this folder: the shapes of the tests, and what all scripts share.
sys.path[:0] = [str(ROOT / "scripts"), str(ROOT / "tests")]

import driver  # noqa: E402
import suite  # noqa: E402
import table  # noqa: E402
from problems import MESHES, Problem, load_obj, problem  # noqa: E402

RESULTS = ROOT / "benchmarks/results"


def machine() -> driver.Record:
    """Processor, cores, system and load: no names."""
    model = platform.processor() or platform.machine()
    cpuinfo = Path("/proc/cpuinfo")
    if cpuinfo.exists():
        names = [
            line for line in cpuinfo.read_text(encoding="utf-8").splitlines() if line.startswith("model name")
        ]
        model = names[0].partition(":")[2].strip() if names else model
    load = os.getloadavg()[0] if hasattr(os, "getloadavg") else None
    return {"processor": model, "cores": os.cpu_count(), "system": platform.system(), "load_at_start": load}


class Bench:
    """Runs measurements one by one, and writes the problems where `measure` finds them."""

    def __init__(self, scratch: Path) -> None:
        """Keep problems under `scratch`."""
        self.scratch = scratch
        self.begin = time.monotonic()

    def folder(self, problem: Problem) -> Path:
        """The problem as files."""
        return problem.write(self.scratch / problem.name.replace(" ", "_"))

    def __call__(self, work: Callable[..., driver.Record], problem: Problem, *more: object) -> driver.Record:
        """One record of `suite`."""
        words = [work.__name__, problem.name, *(word for word in more if isinstance(word, str))]
        print(f"{time.monotonic() - self.begin:6.0f} s  {', '.join(words)}", flush=True)
        return work(problem, self.folder(problem), *more)


def measure_all(bench: Bench, quick: bool) -> driver.Record:
    """Every section of the table."""
    names = list(MESHES)[:1] if quick else list(MESHES)
    meshes = {name: MESHES[name]() for name in names}
    clean = [problem(name, *mesh) for name, mesh in meshes.items()]
    flow = suite.Flow()
    scalar = []
    for one in clean:
        scalar.append(bench(suite.interpolation, one))
        for noise, (amount, _) in suite.DENOISING.items():
            scalar.append(bench(suite.denoising, problem(one.name, *meshes[one.name], noise=amount), noise))
    return {
        "flow_step": [bench(suite.flow_step, one, flow) for one in clean],
        "flow": [bench(suite.flow, one, flow) for one in clean],
        "scalar": scalar,
        "gpytoolbox": [bench(suite.gpytoolbox, clean[0])],
        "assembly": [bench(suite.assembly, one) for one in clean],
    }


def measure_mesh(bench: Bench, path: Path, flow: suite.Flow) -> driver.Record:
    """The flow on a mesh of the user's."""
    one = problem(path.stem, *load_obj(path))
    return {"flow_step": [bench(suite.flow_step, one, flow)], "flow": [bench(suite.flow, one, flow)]}


def main() -> None:
    """Measure, print, and keep the full run."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--quick", action="store_true", help="small problems only; keeps nothing")
    parser.add_argument("--mesh", type=Path, help="measure the flow on this OBJ file instead; keeps nothing")
    parser.add_argument(
        "--fidelity", type=float, default=suite.Flow.fidelity, help="of the flow, with --mesh"
    )
    parser.add_argument(
        "--sharpness", type=float, default=suite.Flow.sharpness, help="of the flow, with --mesh"
    )
    choice = parser.parse_args()
    driver.build()
    results: driver.Record = {"machine": machine()}
    with tempfile.TemporaryDirectory() as scratch:
        bench = Bench(Path(scratch))
        if choice.mesh:
            results |= measure_mesh(bench, choice.mesh, suite.Flow(choice.fidelity, choice.sharpness))
        else:
            results |= measure_all(bench, choice.quick)
    print()
    print(table.full(results))
    if not (choice.quick or choice.mesh):
        text = json.dumps(results, indent=1) + "\n"
        RESULTS.with_suffix(".json").write_text(text, encoding="utf-8")
        RESULTS.with_suffix(".md").write_text(table.full(results), encoding="utf-8")
        table.put_into(ROOT / "README.md", table.short(results))


if __name__ == "__main__":
    main()
