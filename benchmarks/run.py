"""Measure against peers and the L2 yardstick, and write the tables: `results.md`, `results.json`, README.

    python scripts/setup_env.py benchmarks/run.py [--quick | --large] [--only WORD]
    python scripts/setup_env.py benchmarks/run.py --mesh FILE.obj [--fidelity N] [--sharpness P]

`--quick` takes the smallest mesh only, `--only` the scalar problems with that word in their name, `--mesh`
only the flow on that file: they print and keep nothing. `--large` adds 200 thousand and a million vertices.
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import driver
import scalar_table
import suite
import table
from classes import CLASSES, points
from problems import Mesh, Problem, load_obj, mesh

ROOT = Path(__file__).resolve().parents[1]

RESULTS = ROOT / "benchmarks/results"

QUICK = ["cube 1k"]
SCALAR = ["cube 1k", "cube 8k", "bust 9k", "cube 40k"]
FLOW = ["cube 2k", "bust 9k"]
ASSEMBLY = ["cube 2k", "bust 9k", "cube 200k"]
"""The meshes of each section."""

LARGE = {
    "cube 200k": tuple(CLASSES),
    "cube 1M": ("interpolation, 40 points", "hole", "denoising, heavy noise"),
}
"""The meshes that `--large` adds, and the classes solved on them."""


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

    def __call__(self, work: Callable[..., driver.Record], problem: Problem, *more: object) -> driver.Record:
        """One record of `suite`."""
        words = [work.__name__, problem.name, *(word for word in more if isinstance(word, str))]
        print(f"{time.monotonic() - self.begin:6.0f} s  {', '.join(words)}", flush=True)
        with tempfile.TemporaryDirectory(dir=self.scratch) as folder:
            return work(problem, problem.write(Path(folder)), *more)


known_points = points(40)
"""The problem of a mesh where the function on it hardly matters."""


def measure_scalar(bench: Bench, meshes: list[str], word: str, large: bool) -> list[driver.Record]:
    """Every class with the word in its name on every mesh, class by class."""
    records = []
    for name in meshes + (list(LARGE) if large else []):
        kinds = [kind for kind in LARGE.get(name, CLASSES) if word in kind]
        if kinds:
            one = mesh(name)
            records += [bench(suite.scalar, CLASSES[kind](one), kind) for kind in kinds]
    return sorted(records, key=lambda record: list(CLASSES).index(record["kind"]))


def measure_all(bench: Bench, quick: bool, large: bool) -> driver.Record:
    """Every section of the table."""
    flow = suite.Flow()
    flows = [known_points(mesh(name)) for name in (QUICK if quick else FLOW)]
    assemblies = QUICK if quick else ASSEMBLY
    return {
        "scalar": measure_scalar(bench, QUICK if quick else SCALAR, "", large),
        "flow_step": [bench(suite.flow_step, one, flow) for one in flows],
        "flow": [bench(suite.flow, one, flow) for one in flows],
        "gpytoolbox": [bench(suite.gpytoolbox, flows[0])],
        "assembly": [bench(suite.assembly, known_points(mesh(name))) for name in assemblies],
    }


def measure_mesh(bench: Bench, path: Path, flow: suite.Flow) -> driver.Record:
    """The flow on a mesh of the user's."""
    one = known_points(Mesh.of(path.stem, *load_obj(path)))
    return {"flow_step": [bench(suite.flow_step, one, flow)], "flow": [bench(suite.flow, one, flow)]}


def main() -> None:
    """Measure, print, and keep the full run."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--quick", action="store_true", help="the smallest mesh, one sample; keeps nothing")
    parser.add_argument("--large", action="store_true", help="200 thousand and a million vertices as well")
    parser.add_argument("--only", metavar="WORD", help="scalar problems with this word only; keeps nothing")
    parser.add_argument("--mesh", type=Path, help="measure the flow on this OBJ file instead; keeps nothing")
    parser.add_argument(
        "--fidelity", type=float, default=suite.Flow.fidelity, help="of the flow, with --mesh"
    )
    parser.add_argument(
        "--sharpness", type=float, default=suite.Flow.sharpness, help="of the flow, with --mesh"
    )
    choice = parser.parse_args()
    driver.build()
    if choice.quick:
        driver.hurry()
    results: driver.Record = {"machine": machine()}
    with tempfile.TemporaryDirectory() as scratch:
        bench = Bench(Path(scratch))
        if choice.mesh:
            results |= measure_mesh(bench, choice.mesh, suite.Flow(choice.fidelity, choice.sharpness))
        elif choice.only:
            meshes = QUICK if choice.quick else SCALAR
            results["scalar"] = measure_scalar(bench, meshes, choice.only, choice.large)
        else:
            results |= measure_all(bench, choice.quick, choice.large)
    print()
    print(table.full(results))
    kept = RESULTS.with_suffix(".json")
    if kept.exists() and "scalar" in results:
        before = json.loads(kept.read_text(encoding="utf-8"))["scalar"]
        print(scalar_table.slower(results["scalar"], before) or "Nothing has become slower.")
    if not (choice.quick or choice.only or choice.mesh):
        text = json.dumps(results, indent=1) + "\n"
        kept.write_text(text, encoding="utf-8")
        RESULTS.with_suffix(".md").write_text(table.full(results), encoding="utf-8")
        table.put_into(ROOT / "README.md", table.short(results))


if __name__ == "__main__":
    main()
