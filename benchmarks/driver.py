"""Build and run the Rust program that measures, or a Python peer; medians of what they print."""

from __future__ import annotations

import functools
import json
import os
import statistics
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from environments import python_of
from workspace import ROOT, run

MEASURE = ROOT / "target/release/examples/measure"
REQUIREMENTS = ROOT / "benchmarks/requirements.txt"
ONE_THREAD = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1", "RAYON_NUM_THREADS": "1"}
CLARABEL = ("qdldl", "faer")
"""The factorizations that Clarabel can use."""

EFFORT = {"repeats": 5, "budget": 2.0}
"""Samples of one measurement, and the seconds after which no further one is taken."""

Record = dict[str, Any]


def hurry() -> None:
    """Take one sample of everything."""
    EFFORT["repeats"] = 1


def build() -> None:
    """Build the Rust program."""
    command = ["cargo", "build", "--release", "--locked", "--workspace", "--examples", "--quiet"]
    run(command, "the program that measures", {"PYO3_PYTHON": sys.executable})


def peer_python() -> Path:
    """The interpreter of the environment that holds the peers; made on first use."""
    return python_of("bench", REQUIREMENTS, "the peers")


def _answer(command: list[str | Path]) -> Record:
    done = subprocess.run(
        [str(word) for word in command],
        cwd=ROOT,
        env={**os.environ, **ONE_THREAD},
        stdout=subprocess.PIPE,
        check=True,
        text=True,
    )
    return with_medians(json.loads(done.stdout))


def with_medians(record: Record) -> Record:
    """Replace the lists of times by their medians, and say how many there were."""
    answer: Record = {}
    for name, value in record.items():
        if name.endswith("_s"):
            answer[name] = statistics.median(value) if value else None
        elif name == "rounds":
            answer[name] = [with_medians(part) for part in value]
        else:
            answer[name] = value
    if "wall_s" in record:
        answer["runs"] = len(record["wall_s"])
        # Where the system does not tell processor time, the clock has to do.
        answer["seconds"] = answer["wall_s"] if answer["cpu_s"] is None else answer["cpu_s"]
    return answer


def measure(kind: str, folder: Path, **settings: object) -> Record:
    """What the Rust program says of one problem; `settings` are its keys."""
    words = {**EFFORT, **settings}
    return _answer([MEASURE, kind, folder, *(f"{key}={value}" for key, value in words.items())])


def peer(kind: str, folder: Path) -> Record:
    """What a Python peer says of one problem."""
    return _answer([peer_python(), ROOT / "benchmarks/peer.py", kind, folder, str(EFFORT["repeats"])])


def gap_of(record: Record) -> float:
    """The relative duality gap reached, of all steps the largest."""
    return max(record["gaps"]) if "gaps" in record else record["gap"]


def iterations_of(record: Record) -> int:
    """The solver's iterations, of all steps together."""
    count = record["iterations"]
    return sum(count) if isinstance(count, list) else count


def clarabel(kind: str, folder: Path, gaps: Sequence[float], **settings: object) -> list[Record]:
    """Clarabel with its faster factorization, stopped at the first iterate with each certified gap (falling).

    Its own stopping rule also asks for feasibility and would go on for some iterations more: that is not
    charged to it.
    """
    trials = {
        method: measure(
            kind, folder, tolerance=gaps[-1], solver=method, repeats=1, max_iterations=2, **settings
        )
        for method in CLARABEL
    }
    method = min(trials, key=lambda name: trials[name]["seconds"])
    settings |= {"solver": method, "tolerance": gaps[-1]}
    last = measure(kind, folder, repeats=1, **settings)

    @functools.cache
    def after(count: int) -> Record:
        return measure(kind, folder, repeats=1, max_iterations=count, **settings)

    records, missed = [], 0
    for gap in gaps:
        reached = iterations_of(last)
        while reached - missed > 1:
            middle = (missed + reached) // 2
            if gap_of(after(middle)) <= gap:
                reached = middle
            else:
                missed = middle
        found = after(reached)
        if found["seconds"] < EFFORT["budget"]:
            found = measure(kind, folder, max_iterations=reached, **settings)
        records.append({**found, "solver": f"clarabel_{method}"})
    return records
