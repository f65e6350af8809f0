"""What calls take at their peak, beside what `memory_estimate` says: `make bench-memory`.

Each call runs in a process of its own. The peak is that of resident memory while the call runs, less what
there was before (Linux: `VmHWM`, set back before the call). A call that did not end has a dash.

    python benchmarks/peaks.py [--write] [--sizes 10000 100000] [--call NAME]
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
from pathlib import Path

from reliability_page import write_section
from tool_calls import ESTIMATED

HERE = Path(__file__).resolve().parent
SIZES = [10_000, 100_000, 300_000, 1_000_000]
SECONDS = 1800

ONE = """
import json, sys
sys.path.insert(0, {here!r})
import warnings; warnings.simplefilter("ignore")
import ridgeform
from tool_calls import CALLS, ESTIMATED, bumpy_grid

def kept(name):
    with open("/proc/self/status") as file:
        return next(1024 * int(line.split()[1]) for line in file if line.startswith(name))

vertices, faces = bumpy_grid({size})
mesh = ridgeform.Mesh(vertices, faces)
before = kept("VmRSS:")
with open("/proc/self/clear_refs", "w") as file:
    file.write("5")
CALLS[{call!r}](mesh, {{}})
taken = kept("VmHWM:") - before
tool, columns, solver = ESTIMATED[{call!r}]
said = ridgeform.memory_estimate(tool, mesh, columns=columns, solver=solver)
print(json.dumps([taken, said]))
"""


def peak(call: str, size: int) -> tuple[int, int] | None:
    """Bytes taken and bytes said, or None where the call did not end."""
    code = ONE.format(here=str(HERE), call=call, size=size)
    try:
        done = subprocess.run(
            [sys.executable, "-c", code], capture_output=True, text=True, timeout=SECONDS, check=False
        )
    except subprocess.TimeoutExpired:
        return None
    return tuple(json.loads(done.stdout)) if done.returncode == 0 else None


def main() -> None:
    """Measure, print, and with `--write` put the table where the documentation shows it."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--write", action="store_true", help="put the table into docs/reliability.md")
    parser.add_argument("--sizes", type=int, nargs="+", default=SIZES)
    parser.add_argument("--call", action="append", help="a call")
    options = parser.parse_args()
    lines = ["| call | " + " | ".join(f"{size:,} vertices" for size in options.sizes) + " |"]
    lines.append("| --- |" + " --- |" * len(options.sizes))
    for call in options.call or ESTIMATED:
        cells = []
        for size in options.sizes:
            found = peak(call, size)
            cells.append(
                "-" if found is None else f"{found[0] / 1e6:.0f} MB, {100 * (found[1] / found[0] - 1):+.0f} %"
            )
        lines.append(f"| {call} | " + " | ".join(cells) + " |")
        print(lines[-1], flush=True)
    if options.write:
        write_section("memory", "\n".join(lines))


if __name__ == "__main__":
    main()
