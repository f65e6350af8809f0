"""Fill holes with known truth by every tool, and write the tables: `holes.md`, `holes.json`.

    python scripts/setup_env.py benchmarks/holes.py [--only WORDS] [--tools TOOL ...] [--stress [COUNT]]
        [--again] [--limits KIND ...] [--site FOLDER]

`--only` takes the kinds of holes with these words in their name, `--tools` some tools, `--stress` random
holes only: these print and keep nothing. `--again` measures ours in the table again and keeps the rows of the
peers, `--limits` only how filling grows, or the random holes. `--site` names a folder with the package
`ridgeform`, instead of building the wheel. The peers get an environment of their own; what cannot be
installed, crashes or takes too long is named in the table.
"""

from __future__ import annotations

import argparse
import json
import tempfile
from pathlib import Path

import holes_run
import holes_table
import numpy as np
from build_wheel import build_wheel
from driver import Record
from holes_cases import cases, holed
from run import machine
from workspace import WHEEL_SITE

ROOT = Path(__file__).resolve().parents[1]

RESULTS = ROOT / "benchmarks/holes"
LIMITS = ("locality", "long", "ridges", "stress")
"""What `holes_limits.py` measures."""


def measure(words: str, tools: list[str], site: Path, scratch: Path) -> list[Record]:
    """A record for each hole, with one for each tool."""
    chosen = cases(words)
    made = {case.name: holed(case) for case in chosen}
    records = [{**case.__dict__, "before": holes_run.before(made[case.name]), "tools": {}} for case in chosen]
    for tool in tools:
        print(f"== {tool}", flush=True)
        folder = scratch / tool
        folder.mkdir()
        for name, one in made.items():
            np.savez(folder / f"{name}.in.npz", vertices=one.vertices, faces=one.faces)
        holes_run.fill(tool, folder, site)
        for case, record in zip(chosen, records, strict=True):
            record["tools"][tool] = holes_run.measured(made[case.name], folder, case.name)
    return records


def main() -> None:
    """Measure, print, and keep the full run."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--only", metavar="WORDS", default="", help="kinds of holes; keeps nothing")
    parser.add_argument("--tools", nargs="+", choices=list(holes_table.NAMES), help="tools; keeps nothing")
    parser.add_argument("--site", type=Path, help="a folder with the package to be measured")
    parser.add_argument(
        "--stress", nargs="?", const="500", metavar="COUNT", help="only random holes; keeps nothing"
    )
    parser.add_argument("--again", action="store_true", help="measure ours again, keep the peers")
    parser.add_argument("--limits", nargs="+", choices=LIMITS, help="measure these again, keep the rest")
    choice = parser.parse_args()
    tools = choice.tools or list(holes_table.NAMES)
    if holes_run.OURS in tools and choice.site is None:
        build_wheel()
    site = choice.site or WHEEL_SITE
    full = not (choice.only or choice.tools or choice.stress)
    results: Record = {"machine": machine(), "cases": []}
    if choice.limits or choice.again:
        results = json.loads(RESULTS.with_suffix(".json").read_text(encoding="utf-8"))
    if choice.again:
        with tempfile.TemporaryDirectory() as scratch:
            again = measure("", [holes_run.OURS], site, Path(scratch))
        for old, new in zip(results["cases"], again, strict=True):
            old["tools"] |= new["tools"]
    elif choice.stress:
        results["stress"] = holes_run.limit("stress", site, choice.stress)
    elif not choice.limits:
        with tempfile.TemporaryDirectory() as scratch:
            results["cases"] = measure(choice.only, tools, site, Path(scratch))
    if full:
        for kind in choice.limits or (() if choice.again else LIMITS):
            print(f"== {kind}", flush=True)
            results[kind] = holes_run.limit(kind, site)
    text = holes_table.full(results)
    print()
    print(text)
    if full:
        RESULTS.with_suffix(".json").write_text(json.dumps(results, indent=1) + "\n", encoding="utf-8")
        RESULTS.with_suffix(".md").write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
