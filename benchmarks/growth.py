"""How the time of every call grows with what a file can have many of: `make bench-growth`.

Each pair of a call and a shape runs at three sizes, each twice as large as the one before, in a process of
its own; the exponent is that between the last two. Faster than n log n, over at least 0.2 s, is a fault. What
was measured is kept in `growth.json`, and another run adds what is missing.

    python benchmarks/growth.py [--write] [--only SHAPE] [--call NAME] [--first SIZE] [--again]
"""

from __future__ import annotations

import argparse
import json
import math
import resource
import signal
import subprocess
import sys
import time
from pathlib import Path

from growth_shapes import SHAPES
from reliability_page import Records, write_section
from tool_calls import CALLS, PARTS_OF_CALLS

HERE = Path(__file__).resolve().parent
RECORDS = HERE / "growth.json"
SECONDS = 60
"""A call that takes more processor time is not waited for."""

MOST = 1.35
"""The exponent of n log n between 10 and 40 thousand is 1.1; the rest is noise and caches."""

SLOW = 0.2
"""Seconds below which growth is not judged."""

ONE = """
import json, sys, time
sys.path.insert(0, {here!r})
import warnings; warnings.simplefilter("ignore")
import ridgeform
from growth_shapes import SHAPES
from tool_calls import CALLS, PARTS_OF_CALLS
mesh = ridgeform.Mesh(*SHAPES[{shape!r}]({size}))
begin = time.process_time()
try:
    (CALLS | PARTS_OF_CALLS)[{call!r}](mesh, {{}}); outcome = "ok"
except ridgeform.RidgeformError as error:
    outcome = str(error)[:80]
print(json.dumps([time.process_time() - begin, outcome]))
"""


def seconds(shape: str, call: str, size: int) -> tuple[float, str]:
    """Processor time of one call, and how it ended."""
    code = ONE.format(here=str(HERE), shape=shape, call=call, size=size)
    done = subprocess.run(
        [sys.executable, "-c", code],
        capture_output=True,
        text=True,
        check=False,
        # By the clock a machine that does other things as well would make any call slow.
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (SECONDS, SECONDS)),
    )
    if done.returncode in (-signal.SIGXCPU, -signal.SIGKILL):
        return math.inf, f"over {SECONDS} s"
    if done.returncode:
        return math.nan, f"ended with {done.returncode}: {done.stderr[-200:]}"
    return tuple(json.loads(done.stdout))


def measured(shape: str, call: str, first: int) -> dict[str, object]:
    """Seconds at three sizes, the exponent between the last two, and whether that is a fault."""
    sizes = [first, 2 * first, 4 * first]
    found = []
    for size in sizes:
        found.append(seconds(shape, call, size))
        if not math.isfinite(found[-1][0]):
            break
    times = [round(t, 3) for t, _ in found]
    exponent = math.log2(max(times[-1], 1e-3) / max(times[-2], 1e-3)) if len(times) == 3 else math.inf
    is_fault = not times[-1] < SECONDS or (exponent > MOST and times[-1] > SLOW)
    return {
        "shape": shape,
        "call": call,
        "sizes": sizes,
        "seconds": times,
        "exponent": round(exponent, 2) if math.isfinite(exponent) else None,
        "outcome": found[-1][1],
        "fault": is_fault,
    }


def main() -> None:
    """Measure, print, and with `--write` put the table where the documentation shows it."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--write", action="store_true", help="put the table into docs/reliability.md")
    parser.add_argument("--only", action="append", help="a shape")
    parser.add_argument("--call", action="append", help="a call")
    parser.add_argument("--first", type=int, default=5000, help="the smallest count")
    parser.add_argument("--again", action="store_true", help="also what was measured before")
    options = parser.parse_args()
    kept = Records(RECORDS)
    for shape in options.only or SHAPES:
        for call in options.call or CALLS | PARTS_OF_CALLS:
            record = kept.of.get(shape, {}).get(call)
            if record is None or options.again:
                record = measured(shape, call, options.first)
                kept.keep(shape, call, record)
            mark = "FAULT" if record["fault"] else "ok"
            what = f"{mark:5} {shape:20} {call:22}"
            print(what, record["seconds"], record["exponent"], record["outcome"], flush=True)
    records = [record for calls in kept.of.values() for record in calls.values()]
    if options.write:
        write_section("growth", table(records))
    sys.exit(any(record["fault"] for record in records))


def table(records: list[dict[str, object]]) -> str:
    """Markdown: a row for each shape, the slowest exponent that counts, and the calls that take longest."""
    names = "many of", "calls", "largest count", "slowest call there", "seconds at three sizes"
    lines = ["| " + " | ".join([*names, "steepest growth over 0.2 s"]) + " |"]
    lines += ["| --- | --- | --- | --- | --- | --- |"]
    for shape in dict.fromkeys(record["shape"] for record in records):
        rows = [record for record in records if record["shape"] == shape]
        slowest = max(rows, key=lambda row: row["seconds"][-1])
        counted = [row for row in rows if row["seconds"][-1] > SLOW and row["exponent"] is not None]
        steepest = max(counted, key=lambda row: row["exponent"], default=None)
        growth = f"{steepest['exponent']:.2f} ({steepest['call']})" if steepest else "-"
        times = ", ".join(f"{t:.2f}" if math.isfinite(t) else f"over {SECONDS}" for t in slowest["seconds"])
        lines.append(
            f"| {shape} | {len(rows)} | {slowest['sizes'][-1]} | {slowest['call']} | {times} | {growth} |"
        )
    return "\n".join(lines) + f"\n\nMeasured {time.strftime('%Y-%m-%d')}.\n"


if __name__ == "__main__":
    main()
