"""Every call under caps on the address space: a result or an error, never a signal: `make bench-limits`.

Each call runs in a child that was forked after the arrays were made and then capped (`RLIMIT_AS`, what
`ulimit -v` sets), from the smallest cap up; once it has come to a result it is not run under larger ones.

    python benchmarks/limits.py [--write] [--sizes 10000 100000] [--caps 0.25 0.5] [--call NAME]
"""

from __future__ import annotations

import argparse
import os
import resource
import signal
import sys
import time

import ridgeform
from reliability_page import write_section
from tool_calls import CALLS, bumpy_grid

SIZES = [10_000, 100_000, 300_000, 1_000_000]
CAPS = [0.25, 0.5, 1.0, 1.5, 2.0, 4.0, 8.0]
"""GiB."""

SECONDS = 900
"""A child that takes longer is ended; it was not a fault of memory."""


def outcome(call: str, arrays: tuple, cap: float) -> str:
    """How one capped child ended: "result", the name of an error, "signal N" or "time"."""
    read, write = os.pipe()
    child = os.fork()
    if child == 0:
        answer = "no answer"
        try:
            resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
            resource.setrlimit(resource.RLIMIT_AS, (int(cap * 2**30),) * 2)
            CALLS[call](ridgeform.Mesh(*arrays), {})
            answer = "result"
        except BaseException as error:
            answer = type(error).__name__
        os.write(write, answer.encode())
        os._exit(0)
    os.close(write)
    ends = time.monotonic() + SECONDS
    while True:
        done, status = os.waitpid(child, os.WNOHANG)
        if done:
            break
        if time.monotonic() > ends:
            os.kill(child, signal.SIGKILL)
            os.waitpid(child, 0)
            os.close(read)
            return "time"
        time.sleep(0.01)
    answer = os.read(read, 200).decode()
    os.close(read)
    if os.WIFSIGNALED(status):
        return f"signal {os.WTERMSIG(status)}"
    return answer or "no answer"


def under_caps(call: str, arrays: tuple, caps: list[float]) -> list[tuple[float, str]]:
    """The outcome under every cap up to the first result."""
    found = []
    for cap in caps:
        found.append((cap, outcome(call, arrays, cap)))
        if found[-1][1] == "result":
            break
    return found


def cell(found: list[tuple[float, str]]) -> str:
    """What the table says: the smallest cap with a result, and faults by their names."""
    faults = [
        f"{answer} at {cap:g}"
        for cap, answer in found
        if answer not in ("result", "MemoryLimitError", "MemoryError")
    ]
    refused = sum(answer in ("MemoryLimitError", "MemoryError") for _, answer in found)
    result = next((f"result from {cap:g} GiB on" for cap, answer in found if answer == "result"), "no result")
    return ", ".join([result] + ([f"{refused} refusals"] if refused else []) + faults)


def main() -> None:
    """Run, print, and with `--write` put the table where the documentation shows it; fails on any signal."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--write", action="store_true", help="put the table into docs/reliability.md")
    parser.add_argument("--sizes", type=int, nargs="+", default=SIZES)
    parser.add_argument("--caps", type=float, nargs="+", default=CAPS)
    parser.add_argument("--call", action="append", help="a call")
    options = parser.parse_args()
    lines = ["| call | " + " | ".join(f"{size:,} vertices" for size in options.sizes) + " |"]
    lines.append("| --- |" + " --- |" * len(options.sizes))
    signals = runs = 0
    meshes = {size: bumpy_grid(size) for size in options.sizes}
    for call in options.call or CALLS:
        cells = []
        for size in options.sizes:
            found = under_caps(call, meshes[size], options.caps)
            runs += len(found)
            signals += sum(answer.startswith(("signal", "no answer")) for _, answer in found)
            cells.append(cell(found))
            print(f"{call} at {size}: {cells[-1]}", flush=True)
        lines.append(f"| {call} | " + " | ".join(cells) + " |")
    summary = f"{runs} runs, {signals} signals."
    print(summary)
    if options.write:
        write_section("limits", "\n".join([*lines, "", summary]))
    sys.exit(signals > 0)


if __name__ == "__main__":
    main()
