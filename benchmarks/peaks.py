"""What calls take at their peak, beside what `memory_estimate` says: `make bench-memory`.

Each call runs in a process of its own. The peak is that of resident memory while the call runs, less what
there was before (Linux: `VmHWM`, set back before the call). A call that has had a minute of processor time is
asked to finish early, but for Clarabel, which would not end. It has a dash if it has not ended after ten, or
would take more than `MOST`. What was measured is kept in `peaks.json`, and another run adds what is missing.

    python benchmarks/peaks.py [--write] [--sizes 10000 100000] [--call NAME] [--again]
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
from pathlib import Path

from reliability_page import Records, write_section
from tool_calls import ESTIMATED

HERE = Path(__file__).resolve().parent
SIZES = [10_000, 30_000, 100_000, 300_000]
RECORDS = HERE / "peaks.json"
SECONDS = 60
"""Processor time until a call is asked to finish early."""
PATIENCE = 10
"""So many times as long, and it is ended."""
MOST = 7 * 10**9
"""Bytes that this machine can spare."""

ONE = """
import json, sys
sys.path.insert(0, {here!r})
import warnings; warnings.simplefilter("ignore")
import ridgeform
from tool_calls import CALLS, ESTIMATED, finishing_after, mesh_for

def kept(name):
    with open("/proc/self/status") as file:
        return next(1024 * int(line.split()[1]) for line in file if line.startswith(name))

vertices, faces = mesh_for({call!r}, {size})
mesh = ridgeform.Mesh(vertices, faces)
tool, columns, solver = ESTIMATED[{call!r}]
rims = [len(hole.vertices) for hole in ridgeform.find_holes(mesh) if not hole.is_outer_border]
more = {{"longest": max(rims)}} if tool == "fill_holes" else {{}}
said = ridgeform.memory_estimate(tool, mesh, columns=columns, solver=solver, **more)
if said > {most}:
    sys.exit("too much")
before = kept("VmRSS:")
with open("/proc/self/clear_refs", "w") as file:
    file.write("5")
CALLS[{call!r}](mesh, {{}} if solver == "clarabel" else {{"progress": finishing_after({seconds})}})
taken = kept("VmHWM:") - before
print(json.dumps([taken, said]))
"""


def peak(call: str, size: int) -> tuple[int, int] | None:
    """Bytes taken and bytes said, or None where the call did not end."""
    code = ONE.format(here=str(HERE), call=call, size=size, seconds=SECONDS, most=MOST)
    try:
        done = subprocess.run(
            [sys.executable, "-c", code],
            capture_output=True,
            text=True,
            timeout=SECONDS * PATIENCE,
            check=False,
        )
    except subprocess.TimeoutExpired:
        return None
    return tuple(json.loads(done.stdout)) if done.returncode == 0 else None


def main() -> None:
    """Measure, print, and with `--write` put the table where the documentation shows it."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--write", action="store_true", help="put the table into docs/reliability.md")
    parser.add_argument("--sizes", type=int, nargs="*", default=SIZES)
    parser.add_argument("--call", action="append", help="a call")
    parser.add_argument("--again", action="store_true", help="also what was measured before")
    options = parser.parse_args()
    records = Records(RECORDS)
    for size in options.sizes:
        for call in options.call or ESTIMATED:
            if records.of.get(call, {}).get(str(size)) is None or options.again:
                records.keep(call, size, peak(call, size))
            print(f"{call} at {size}: {cell(records.of[call][str(size)] or [0, 0])}", flush=True)
    if options.write:
        write_section("memory", records.table(ESTIMATED, SIZES, cell))


def cell(found: list[int]) -> str:
    """What was taken, and by how much the estimate is off."""
    taken, said = found
    return f"{taken / 1e6:.0f} MB, {100 * (said / max(taken, 1) - 1):+.0f} %"


if __name__ == "__main__":
    main()
