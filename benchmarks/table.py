"""The results as Markdown: the full tables, and the few lines for the README."""

from __future__ import annotations

from pathlib import Path

import scalar_table
from cells import grid, kilobytes, ratio, seconds, solved
from classes import HEAVY, HOLE, LEAST_WEIGHT, LIGHT
from driver import Record
from suite import EXACT, FINE, GAP
from workspace import stop

BEGIN, END = "<!-- bench:begin -->", "<!-- bench:end -->"


def flow_steps(records: list[Record]) -> str:
    """A flow step beside Clarabel."""
    head = ["mesh", "vertices", f"ours, gap ≤ {GAP:g}", f"Clarabel, gap ≤ {GAP:g}", "faster"]
    head += [f"ours, gap ≤ {EXACT:g}", f"Clarabel, gap ≤ {EXACT:g}", "faster", "memory per vertex (Clarabel)"]
    return grid(head, ([r["problem"], r["vertices"], *_beside(r)] for r in records))


def _beside(r: Record) -> list[str]:
    peer, exact = r.get("clarabel"), r.get("clarabel_exact")
    return [
        solved(r["ours"]),
        solved(peer),
        ratio(peer, r["ours"]),
        solved(r["ours_exact"]),
        solved(exact),
        ratio(exact, r["ours_exact"]),
        f"{kilobytes(r['ours'], r)} ({kilobytes(peer, r)})",
    ]


def flows(records: list[Record]) -> str:
    """Whole flows in units of a factorization."""
    head = ["mesh", "vertices", "one numeric factorization"]
    head += [
        "20 steps, default",
        "in factorizations",
        f"20 steps, gap ≤ {GAP:g} each",
        "in factorizations",
    ]
    rows = []
    for r in records:
        row = [r["problem"], r["vertices"], seconds(r["yardstick"], "numeric_cpu_s")]
        for name in ("default", "certified"):
            row += [solved(r[name]), f"{r[name]['in_factorisations']:.0f}"]
        rows.append(row)
    return grid(head, rows)


def gpytoolbox(records: list[Record]) -> str:
    """SCS through gpytoolbox."""
    head = [
        "mesh",
        "vertices",
        "solver",
        "precision asked",
        "relative error of the objective",
        "time",
        "ours faster",
    ]
    rows = []
    for r in records:
        start = [r["problem"], r["vertices"]]
        rows.append([*start, "ours", f"gap ≤ {GAP:g}", f"{r['ours']['error']:.1e}", seconds(r["ours"]), "1"])
        for name in ("loosest", "default"):
            peer = r[name]
            if peer is not None:
                what = [
                    f"SCS {peer['precision']:g}",
                    f"{peer['error']:.1e}",
                    seconds(peer),
                ]
                rows.append([*start, "`min_l1_with_fixed`", *what, ratio(peer, r["ours"])])
    return grid(head, rows)


def assemblies(records: list[Record]) -> str:
    """Assembly beside SciPy."""
    head = ["mesh", "faces", "ours, from positions and faces", "NumPy and SciPy", "faster"]
    head += ["ours, new values on a known pattern", "NumPy", "faster"]
    rows = []
    for r in records:
        ours, peer, again = r["ours"], r["scipy"], "again_cpu_s"
        row = [r["problem"], r["faces"], seconds(ours), seconds(peer), ratio(peer, ours)]
        rows.append([*row, seconds(ours, again), seconds(peer, again), ratio(peer, ours, again)])
    return grid(head, rows)


SCALAR = (
    "Values known at 10, 40 or 1000 vertices (at most half of them), or everywhere but in a hole of"
    f" {100 * HOLE:g} % of the vertices. Noise of standard deviation {LIGHT[0]:g} (light, fidelity"
    f" {LIGHT[1]:g}) or {HEAVY[0]:g} (heavy, fidelity {HEAVY[1]:g}) on a function that spans 1. Weights:"
    f" light noise, fidelity {HEAVY[1]:g}, the squares of a segmentation's indicator, down to"
    f" {LEAST_WEIGHT:g} on the ridges. Constraints: heavy noise, eight means and three differences known."
    " Coordinates: the positions themselves, one norm over all three. The longest side of the mesh is 1. L2:"
    " the quadratic problem on the same mesh, one factorization, one solve, the same Cholesky, without the"
    " linear constraints. Everything is counted from the mesh on. Clarabel as for the flow step below."
)

PARTS = (
    "The floor of this kind of solver is one ordering, one factorization, and a triangular solve an"
    " iteration; the rest is passes over the faces, assembly and certificates. One factorization and one"
    " solve are those of the L2 problem; solves for linear constraints and the first penalty count as the"
    " rest."
)

SECTIONS = {
    "scalar": ("Functions on a mesh", SCALAR, "scalar", scalar_table.scalars),
    "growth": (
        "Growth with the mesh",
        "The `e` of a fit of vertices^e to the times on cubes of growing size.",
        "scalar",
        scalar_table.growth,
    ),
    "parts": (f"Parts of the time to a gap of {GAP:g}", PARTS, "scalar", scalar_table.parts),
    "flow_step": (
        "One flow step",
        "Three coordinates, one norm per face over all of them, from a cold start, fidelity 500 in units of"
        " the longest edge, sharpness 0.5. Everything is counted, from the mesh on. Clarabel: the faster of"
        " its factorizations `qdldl` and `faer`, stopped at its first iterate whose gap, computed in the same"
        " way, is small enough.",
        "flow_step",
        flow_steps,
    ),
    "flow": (
        "A flow of 20 steps",
        "Beside one numeric factorization of the same matrix. By default each step stops on residuals.",
        "flow",
        flows,
    ),
    "gpytoolbox": (
        "The interpolation with gpytoolbox",
        "At its loosest precision with an objective within 1e-4 of the optimum, and at its default.",
        "gpytoolbox",
        gpytoolbox,
    ),
    "assembly": ("Assembling the Hessian", "Both matrices have the same entries.", "assembly", assemblies),
}
"""Title, text, the records to draw, and how."""


def header(results: Record) -> str:
    """What was measured where."""
    m = results["machine"]
    return (
        f"{m['processor']}, {m['cores']} cores, {m['system']}. Processor time of one thread, medians of 5"
        " runs, fewer where they take seconds. Gaps are relative duality gaps, computed"
        " from the points returned.\n"
    )


def full(results: Record) -> str:
    """All tables."""
    parts = ["# Benchmarks\n\n`make bench` makes this page. " + header(results)]
    for title, text, name, draw in SECTIONS.values():
        if name in results:
            parts.append(f"\n## {title}\n\n{text}\n\n{draw(results[name])}")
    return "".join(parts)


def short(results: Record) -> str:
    """The few lines for the README."""
    steps = [
        [
            f"a flow step, {r['problem']}",
            seconds(r["ours"]),
            "-",
            "-",
            ratio(r.get("clarabel"), r["ours"]),
            "-",
            "-",
        ]
        for r in results["flow_step"]
    ]
    head = ["8k vertices", f"time to gap {GAP:g}", "in L2 solutions", f"the same to gap {FINE:g}"]
    head += ["faster than Clarabel", "in L2 solutions, largest mesh", "time grows like vertices to the"]
    lines = grid(head, scalar_table.short(results["scalar"]) + steps)
    return header(results) + "\n" + lines + "\nAll of it: [results](benchmarks/results.md).\n"


def put_into(path: Path, text: str) -> None:
    """Replace what stands between the markers in a file, if it has them."""
    old = path.read_text(encoding="utf-8")
    if BEGIN not in old:
        return
    before, _, rest = old.partition(BEGIN)
    _, found, after = rest.partition(END)
    if not found:
        stop(f"{path.name} has {BEGIN} but not {END}")
    path.write_text(f"{before}{BEGIN}\n{text}{END}{after}", encoding="utf-8")
