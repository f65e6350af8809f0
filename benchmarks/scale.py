"""How Stylize scales, at half strength: `make bench-scale`, which writes `benchmarks/scale.md`.

    python benchmarks/scale.py [--sizes 9000 35000 ...] [--threads 1 2] [--full-up-to 140000] [--peer PYTHON]

Each run has a process of its own. The full flow, all of whose steps are on the mesh itself, runs up to
140,000 vertices. PEER is the interpreter of an environment with `requirements-scale.txt`, which is made where
none is given. What is there of an interrupted run is kept in `benchmarks/scale.json`.
"""

import argparse
import json
import math
import subprocess
import sys
from pathlib import Path

from environments import python_of

HERE = Path(__file__).resolve().parent
SIZES = [9_000, 35_000, 140_000, 560_000, 1_000_000]
KEPT = HERE / "scale.json"
PAGE = HERE / "scale.md"

HEAD = """# How Stylize scales

`make bench-scale`, at the add-on's settings for half strength, on one shape at any density (a ring with
relief, `benchmarks/scale_shapes.py`), clean and with noise of a tenth of an edge. Seconds are processor
time, and elapsed time in brackets, on a machine of two cores, with two threads alone, with one beside other
work. *Preview* is when the first result was there to be shown. Flat share is the part of the area in flat
faces. *Apart* is the distance of the vertices from those of the full flow, with all steps on the mesh itself,
root mean square, in parts of how far those had moved: where facets lie on a round shape is chance. MeshLib
denoises by normals (`meshlib` 3.1.4.297, its default settings). Sizes that are missing were not measured yet.
"""

TITLES = (
    "vertices", "noise", "threads", "preview", "end", "bytes a vertex", "energy", "flat share",
    "steps on the mesh itself", "full flow", "its energy", "its flat share", "apart", "MeshLib",
)  # fmt: skip


def run(*arguments: object, python: str = sys.executable, script: str = "scale_run.py") -> dict[str, float]:
    """What one process says of its run."""
    done = subprocess.run(
        [python, HERE / script, *map(str, arguments)], capture_output=True, text=True, check=False
    )
    if done.returncode:
        sys.exit(f"{script} {arguments}: {done.stderr[-500:]}")
    found: dict[str, float] = json.loads(done.stdout)
    return found


def peer_python() -> str:
    """The interpreter of an environment for the peer, made on first use."""
    return str(python_of("bench-scale", HERE / "requirements-scale.txt", "the peer"))


def growth(kept: dict[str, dict[str, float]], noise: float) -> float | None:
    """The exponent of the time between the smallest mesh that gets levels, and the largest."""
    found = sorted(
        (row["vertices"], row["processor"])
        for row in kept.values()
        if row["noise"] == noise and row["threads"] == 1 and row["vertices"] > 18_000
    )
    if len(found) < 2:
        return None
    (n, t), (m, s) = found[0], found[-1]
    return math.log(s / t) / math.log(m / n)


def line(row: dict[str, float]) -> str:
    """One row of the table."""
    full = row.get("full_processor")
    cells = [
        f"{row['vertices']:,}",
        f"{row['noise']:g}",
        f"{row['threads']}",
        f"{row['preview']:.1f} s ({row['preview_elapsed']:.1f})",
        f"{row['processor']:.1f} s ({row['elapsed']:.1f})",
        f"{row['bytes']:,.0f}",
        f"{row['energy']:.1f}",
        f"{row['flat']:.2f}",
        f"{row['own_steps']} of {row['steps']}",
        "-" if full is None else f"{full:.1f} s",
        "-" if full is None else f"{row['full_energy']:.1f}",
        "-" if full is None else f"{row['full_flat']:.2f}",
        "-" if full is None else f"{row['distance']:.2f}",
        "-" if "peer" not in row else f"{row['peer']:.1f} s",
    ]
    return "| " + " | ".join(cells) + " |"


def main() -> None:
    """Measure what is not there, and write the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--sizes", type=int, nargs="+", default=SIZES)
    parser.add_argument("--threads", type=int, nargs="+", default=[1, 2])
    parser.add_argument("--full-up-to", type=int, default=140_000, help="vertices")
    parser.add_argument("--peer", help="the interpreter of an environment with requirements-scale.txt")
    given = parser.parse_args()
    peer = given.peer or peer_python()
    kept = json.loads(KEPT.read_text(encoding="utf-8")) if KEPT.exists() else {}
    for size in given.sizes:
        for noise in (0.0, 0.1):
            for threads in given.threads:
                name = f"{size} {noise} {threads}"
                if name not in kept:
                    has_full = size <= given.full_up_to and threads == 1
                    kept[name] = run(size, noise, threads, int(has_full))
                if threads == 1 and "peer" not in kept[name]:
                    kept[name]["peer"] = run(size, noise, python=peer, script="scale_peer.py")["processor"]
                KEPT.write_text(json.dumps(kept, indent=1), encoding="utf-8")
                print(line(kept[name]), flush=True)
    rows = sorted(kept.values(), key=lambda row: (row["vertices"], row["noise"], row["threads"]))
    table = [f"| {' | '.join(TITLES)} |", "|" + len(TITLES) * "---|", *map(line, rows)]
    text = HEAD + "\n" + "\n".join(table) + "\n"
    exponents = [
        f"{growth(kept, noise):.2f} with noise of {noise:g}"
        for noise in (0.0, 0.1)
        if growth(kept, noise) is not None
    ]
    if exponents:
        text += f"\nBy levels time grows with vertices to the power of {', '.join(exponents)}.\n"
    PAGE.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
