"""Every call under caps on the address space: a result or an error, never a signal: `make bench-limits`.

Each call runs in a child that was forked after the arrays were made and then capped (`RLIMIT_AS`, what
`ulimit -v` sets), from the smallest cap up; once it has come to a result it is not run under larger ones.
What computes for longer than `--seconds` of processor time is asked to finish early. What was measured is
kept in `limits.json`, and another run adds what is missing or was ended for its time.

    python benchmarks/limits.py [--write] [--sizes 10000 100000] [--caps 0.25 0.5] [--call NAME] [--again]
"""

from __future__ import annotations

import argparse
import os
import resource
import signal
import sys
import time
import warnings
from pathlib import Path

import ridgeform
from reliability_page import Records, write_section
from tool_calls import CALLS, finishing_after, mesh_for

RECORDS = Path(__file__).resolve().parent / "limits.json"
SIZES = [10_000, 100_000, 300_000, 1_000_000]
CAPS = [0.25, 0.5, 1.0, 2.0, 4.0, 8.0]
"""GiB."""

SECONDS = 10
"""Processor time until a call is asked to finish early."""
PATIENCE = 12
"""So many times as long by the clock, and a child is ended: time is missing, not memory."""

REFUSALS = ("MemoryLimitError", "MemoryError", "SolveError: memory")


def run(call: str, arrays: tuple, cap: float, seconds: float) -> str:
    """What the call comes to in this process: "result", "finished early" or the name of an error."""
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    progress = finishing_after(seconds)
    begin = time.process_time()
    resource.setrlimit(resource.RLIMIT_AS, (int(cap * 2**30),) * 2)
    try:
        CALLS[call](ridgeform.Mesh(*arrays), {"progress": progress})
    except ridgeform.SolveError as error:
        return "SolveError: memory" if "of memory" in str(error) else f"SolveError: {error}"
    except BaseException as error:
        return type(error).__name__
    return "finished early" if time.process_time() - begin > seconds else "result"


def outcome(call: str, arrays: tuple, cap: float, seconds: float) -> str:
    """How one capped child ended: what [`run`] says, "signal N" or "time"."""
    read, write = os.pipe()
    child = os.fork()
    if child == 0:
        os.write(write, run(call, arrays, cap, seconds).encode()[:200])
        os._exit(0)
    os.close(write)
    ends = time.monotonic() + PATIENCE * seconds
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


def under_caps(call: str, arrays: tuple, caps: list[float], seconds: float) -> list[tuple[float, str]]:
    """The outcome under every cap up to the first that lets the call compute to its end, or for long."""
    found = []
    for cap in caps:
        found.append((cap, outcome(call, arrays, cap, seconds)))
        if found[-1][1] in ("result", "finished early", "time"):
            break
    return found


def cell(found: list[tuple[float, str]]) -> str:
    """What the table says: the smallest cap with a result, and faults by their names."""
    texts = {"result": "result", "finished early": "finished early", "time": "computed until it was ended"}
    refused = sum(answer in REFUSALS for _, answer in found)
    faults = [f"{answer} at {cap:g}" for cap, answer in found if answer not in (*REFUSALS, *texts)]
    last, answer = found[-1]
    reached = f"{texts[answer]} at {last:g} GiB" if answer in texts else "no result"
    return ", ".join([reached] + ([f"{refused} refusals"] if refused else []) + faults)


def is_fault(answer: str) -> bool:
    """Whether a process ended that should have lived."""
    return answer.startswith(("signal", "no answer"))


def main() -> None:
    """Run, print, and with `--write` put the table where the documentation shows it; fails on any signal."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--write", action="store_true", help="put the table into docs/reliability.md")
    parser.add_argument("--sizes", type=int, nargs="*", default=SIZES)
    parser.add_argument("--caps", type=float, nargs="+", default=CAPS)
    parser.add_argument("--call", action="append", help="a call")
    parser.add_argument("--seconds", type=float, default=SECONDS)
    parser.add_argument("--again", action="store_true", help="also what was measured before")
    options = parser.parse_args()
    warnings.simplefilter("ignore")
    records = Records(RECORDS)
    for size in options.sizes:
        for call in options.call or CALLS:
            before = records.of.get(call, {}).get(str(size))
            if before is not None and before[-1][1] != "time" and not options.again:
                continue
            found = under_caps(call, mesh_for(call, size), options.caps, options.seconds)
            records.keep(call, size, found)
            print(f"{call} at {size}: {cell(found)}", flush=True)
    answers = [answer for sizes in records.of.values() for found in sizes.values() for _, answer in found]
    signals = sum(map(is_fault, answers))
    summary = f"{len(answers)} runs, {signals} signals."
    print(summary)
    if options.write:
        write_section("limits", records.table(CALLS, SIZES, cell) + f"\n\n{summary}")
    sys.exit(signals > 0)


if __name__ == "__main__":
    main()
