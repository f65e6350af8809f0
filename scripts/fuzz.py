"""Fuzz the wheel, the core, and the add-on: random calls and sequences for some minutes, and what holds then.

    python scripts/setup_env.py scripts/fuzz.py MINUTES [core | wheel | blender] [--write]

The kept seeds come first, then ones that no run had before. A fault of the wheel is shown as small as can be
and its seed is added to `tests/fuzz/seeds.txt`; seeds of the core are shown, for
`rust/core/tests/fuzz_seeds.txt`. The tests run what is kept there. For Blender see `fuzz_sequences.py`.

`--write` adds the calls of core and wheel to the table in docs/reliability.md. They add up from run to run;
after a fault they begin at zero.
"""

import collections
import json
import os
import re
import subprocess
import sys
import time

from build_wheel import build_wheel
from fuzz_sequences import sequences
from reliability_page import PAGE, write_section
from setup_env import environments
from workspace import ROOT, WHEEL_SITE

SEEDS = ROOT / "tests/fuzz/seeds.txt"
BATCH = 200
# No batch takes a minute: one that takes ten hangs.
PATIENCE = 600


def batch(python: str, seed: int) -> tuple[dict[str, int], str]:
    """How the calls of a batch ended; what went wrong, or nothing."""
    command = [python, "-m", "fuzz.worker", str(seed), str(BATCH)]
    paths = os.pathsep.join([str(WHEEL_SITE), str(ROOT / "tests")])
    environment = {**os.environ, "PYTHONPATH": paths, "RAYON_NUM_THREADS": "1"}
    try:
        done = subprocess.run(
            command, env=environment, capture_output=True, text=True, timeout=PATIENCE, check=False
        )
    except subprocess.TimeoutExpired as hang:
        return {}, f"no answer after {hang.timeout} s"
    if done.returncode != 0:
        return {}, f"exit code {done.returncode}\n{done.stdout}{done.stderr}"
    return json.loads(done.stdout.splitlines()[-1])["ends"], ""


def wheel(python: str, minutes: float) -> tuple[int, int]:
    """Batches until the time is over; the numbers of calls and of faults."""
    kept = [int(line) for line in SEEDS.read_text(encoding="utf-8").split()]
    end = time.monotonic() + 60 * minutes
    # Seconds since 1970, so that no run repeats another one's seeds.
    fresh = int(time.time()) * 1000
    ends: collections.Counter[str] = collections.Counter()
    faults = 0
    while kept or time.monotonic() < end:
        seed, known = (kept.pop(0), True) if kept else (fresh, False)
        fresh += not known
        found, fault = batch(python, seed)
        ends.update(found)
        if fault:
            faults += 1
            print(f"seed {seed}: {fault}", flush=True)
            if not known:
                with SEEDS.open("a", encoding="utf-8") as file:
                    file.write(f"{seed}\n")
    print(f"wheel: {ends.total()} calls, {faults} faults: {dict(ends.most_common())}", flush=True)
    return ends.total(), faults


def core(minutes: float) -> tuple[int, int]:
    """The same of the core; the numbers of calls and of faults, at least one where it died."""
    command = ["cargo", "test", "--release", "--locked", "--quiet", "--workspace", "--test", "fuzz"]
    environment = {**os.environ, "RIDGEFORM_FUZZ_SECONDS": str(round(60 * minutes))}
    done = subprocess.run(
        [*command, "--", "--nocapture"],
        cwd=ROOT,
        env=environment,
        stdout=subprocess.PIPE,
        text=True,
        check=False,
    )
    print(done.stdout, flush=True)
    counted = re.search(r"core: (\d+) calls, (\d+) faults", done.stdout)
    calls, faults = map(int, counted.groups()) if counted else (0, 0)
    return calls, max(faults, int(done.returncode != 0))


def write(part: str, calls: int, faults: int) -> None:
    """Add the calls to the row of a part; a fault sets what was there to zero."""
    rows = dict(
        re.findall(r"^\| (core|wheel) \| ([\d,]+) \|", PAGE.read_text(encoding="utf-8"), re.MULTILINE)
    )
    total = {name: int(count.replace(",", "")) for name, count in rows.items()}
    total[part] = 0 if faults else total.get(part, 0) + calls
    lines = ["| calls of | in a row without a fault |", "| --- | ---: |"]
    lines += [f"| {name} | {total[name]:,} |" for name in sorted(total)]
    write_section("fuzz", "\n".join([*lines, f"| both | {sum(total.values()):,} |"]))


def main(arguments: list[str]) -> None:
    """The time in equal shares, or all for one."""
    is_kept = "--write" in arguments
    arguments = [word for word in arguments if word != "--write"]
    minutes = float(arguments[0]) if arguments else 1.0
    parts = arguments[1:] or ["wheel", "core", "blender"]
    faults = 0
    for part in (part for part in ("wheel", "core") if part in parts):
        if part == "wheel":
            build_wheel()
            calls, found = wheel(next(iter(environments().values())), minutes / len(parts))
        else:
            calls, found = core(minutes / len(parts))
        faults += found
        if is_kept:
            write(part, calls, found)
    if "blender" in parts:
        faults += sequences(minutes / len(parts))
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main(sys.argv[1:])
