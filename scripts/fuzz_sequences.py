"""Random sequences of operators, modes, undo, and edits in Blender, for some minutes.

    python scripts/setup_env.py scripts/fuzz_sequences.py MINUTES [SEED] [--write]

Each batch is a process of its own with a seed of its own, from SEED on (by default one that no run had
before), in every Blender here in turn. What a batch that fails printed, and the steps that led there, stay in
`out/fuzz/`.
"""

import argparse
import collections
import json
import os
import subprocess
import sys
import time
from pathlib import Path

from build_extension import build_extension, extension_here
from reliability_page import write_section
from setup_env import PYTHONS, environments
from workspace import OUT, ROOT

RESULTS = OUT / "fuzz"
BATCH = 50
"""Sequences in a process: about a minute."""
KINDS = ("sequences", "steps", "operators", "runs", "finished", "changes", "undos")
"""What is counted: finished are operators and runs with a result, changes those by another hand."""
PATIENCE = 1800
"""Seconds after which a batch hangs."""


def batch(python: Path, extension: Path, seed: int, stem: Path) -> tuple[dict[str, int], str]:
    """How much was done in a batch; what went wrong, or nothing."""
    # Not with_suffix: the stem ends in a version and a seed, which would go.
    log, counts, trail = (stem.with_name(stem.name + suffix) for suffix in (".log", ".json", ".trail"))
    environment = os.environ | {
        "RIDGEFORM_EXTENSION": str(extension),
        "PYTHONPATH": "",
        "RIDGEFORM_FUZZ_SEED": str(seed),
        "RIDGEFORM_FUZZ_COUNT": str(BATCH),
        "RIDGEFORM_FUZZ_COUNTS": str(counts),
        "RIDGEFORM_FUZZ_TRAIL": str(trail),
    }
    command = [str(python), "-m", "pytest", "-q", "-x", "tests/blender/test_sequences.py"]
    for old in (counts, trail):
        old.unlink(missing_ok=True)
    with log.open("w", encoding="utf-8") as stream:
        try:
            code = subprocess.run(
                command,
                cwd=ROOT,
                env=environment,
                stdout=stream,
                stderr=stream,
                timeout=PATIENCE,
                check=False,
            ).returncode
        except subprocess.TimeoutExpired:
            return {}, f"no answer after {PATIENCE} s, see {log.relative_to(ROOT)}"
    done = json.loads(counts.read_text(encoding="utf-8")) if counts.is_file() else {}
    if code != 0:
        return done, f"exit code {code}, see {log.relative_to(ROOT)}"
    for left in (log, counts, trail):
        left.unlink(missing_ok=True)
    return done, ""


def sequences(minutes: float, seed: int | None = None, write: bool = False) -> int:
    """Batches until the time is over; the number of faults. `write` puts the counts into the docs."""
    RESULTS.mkdir(parents=True, exist_ok=True)
    extension = extension_here(build_extension())
    # Seconds since 1970, so that no run repeats another one's seeds.
    seed = int(time.time()) if seed is None else seed
    end = time.monotonic() + 60 * minutes
    total = {version: collections.Counter() for version in environments()}
    faults = collections.Counter()
    while time.monotonic() < end:
        for version, python in environments().items():
            done, fault = batch(python, extension, seed, RESULTS / f"sequences-{version}-{seed}")
            total[version].update(done)
            faults[version] += bool(fault)
            if fault:
                print(f"Blender {PYTHONS[version]}, seed {seed}: {fault}", flush=True)
        seed += 1
    text = table(total, faults)
    print(text, flush=True)
    if write:
        write_section("sequences", text)
    return faults.total()


def table(total: dict[str, collections.Counter[str]], faults: collections.Counter[str]) -> str:
    """How much was done in each Blender, as Markdown."""
    rows = [f"| Blender | {' | '.join(KINDS)} | faults |", "|---" * (len(KINDS) + 2) + "|"]
    for version, counts in total.items():
        cells = " | ".join(f"{counts[kind]:,}" for kind in KINDS)
        rows.append(f"| {PYTHONS[version]} | {cells} | {faults[version]} |")
    return "\n".join(rows)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description="Random sequences in Blender for some minutes.")
    parser.add_argument("minutes", type=float)
    parser.add_argument("seed", type=int, nargs="?")
    parser.add_argument("--write", action="store_true", help="put the counts into docs/reliability.md")
    options = parser.parse_args()
    sys.exit(1 if sequences(options.minutes, options.seed, options.write) else 0)
