"""The results as Markdown: the full tables, and the few lines for the README."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from driver import Record, gap_of, iterations_of
from suite import DENOISING, EXACT, GAP
from workspace import stop

BEGIN, END = "<!-- bench:begin -->", "<!-- bench:end -->"


def seconds(record: Record | None, name: str = "seconds") -> str:
    """A time with its unit, three digits at most."""
    if record is None or record.get(name) is None:
        return "-"
    value = record[name]
    for unit, factor in [("s", 1.0), ("ms", 1e3)]:
        if value * factor >= 1:
            return f"{value * factor:.3g} {unit}"
    return f"{value * 1e6:.3g} µs"


def ratio(slow: Record | None, fast: Record | None, name: str = "seconds") -> str:
    """How often `fast` goes into `slow`."""
    if slow is None or fast is None:
        return "-"
    value = slow[name] / fast[name]
    return f"{value:.0f} x" if value >= 20 else f"{value:.1f} x"


def grid(head: Iterable[str], rows: Iterable[Iterable[object]]) -> str:
    """A Markdown table."""
    head = list(head)
    lines = [head, ["---"] * len(head), *rows]
    return "".join("| " + " | ".join(str(cell) for cell in line) + " |\n" for line in lines)


def solved(record: Record | None) -> str:
    """Time, and in brackets iterations and runs."""
    if record is None:
        return "-"
    note = f"{iterations_of(record)} it." + ("" if record["runs"] >= 5 else f", {record['runs']} runs")
    missed = (
        "" if record["complete"] or "clarabel" in str(record.get("solver")) else f", gap {gap_of(record):.0e}"
    )
    return f"{seconds(record)} ({note}{missed})"


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


def kilobytes(record: Record | None, of: Record) -> str:
    """The peak of memory per vertex."""
    return "-" if record is None else f"{record['peak_bytes'] / of['vertices'] / 1000:.1f} kB"


def flows(records: list[Record]) -> str:
    """Whole flows in units of a factorisation."""
    head = ["mesh", "vertices", "one numeric factorisation"]
    head += [
        "20 steps, default",
        "in factorisations",
        f"20 steps, gap ≤ {GAP:g} each",
        "in factorisations",
    ]
    rows = []
    for r in records:
        row = [r["problem"], r["vertices"], seconds(r["yardstick"], "numeric_cpu_s")]
        for name in ("default", "certified"):
            row += [solved(r[name]), f"{r[name]['in_factorisations']:.0f}"]
        rows.append(row)
    return grid(head, rows)


def scalars(records: list[Record]) -> str:
    """Scalar problems beside the quadratic one and Clarabel."""
    head = [
        "problem",
        "mesh",
        "vertices",
        "L2",
        f"ours, gap ≤ {GAP:g}",
        "x L2",
        f"Clarabel, gap ≤ {GAP:g}",
        "faster",
    ]
    head += [
        f"ours, gap ≤ {EXACT:g}",
        "x L2",
        f"Clarabel, gap ≤ {EXACT:g}",
        "faster",
        "memory per vertex (Clarabel)",
    ]
    rows = []
    for r in records:
        ours, peer, faster, exact, peer_exact, faster_exact, memory = _beside(r)
        row = [r["kind"], r["problem"], r["vertices"], seconds(r["yardstick"])]
        row += [ours, ratio(r["ours"], r["yardstick"]), peer, faster]
        row += [exact, ratio(r["ours_exact"], r["yardstick"]), peer_exact, faster_exact, memory]
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
                    f"{seconds(peer)} ({peer['runs']} runs)",
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


NOISES = ", ".join(
    f"{amount:g} (fidelity {fidelity:g}, {name})" for name, (amount, fidelity) in DENOISING.items()
)

SECTIONS = {
    "flow_step": (
        "One flow step",
        "Three coordinates, one norm per face over all of them, from a cold start, fidelity 500 in units of"
        " the longest edge, sharpness 0.5. Everything is counted, from the mesh on. Clarabel: the faster of"
        " its factorisations `qdldl` and `faer`, stopped at its first iterate whose gap, computed in the same"
        " way, is small enough.",
        flow_steps,
    ),
    "flow": (
        "A flow of 20 steps",
        "Beside one numeric factorisation of the same matrix. By default each step stops on residuals.",
        flows,
    ),
    "scalar": (
        "Interpolation and denoising of a function",
        f"40 known values, or noise of standard deviation {NOISES} on a function that spans 1; the longest"
        " side of the mesh is 1. L2: the quadratic problem on the same mesh, one factorisation, one solve,"
        " the same Cholesky, everything counted from the mesh on, as for ours.",
        scalars,
    ),
    "gpytoolbox": (
        "The interpolation with gpytoolbox",
        "At its loosest precision with an objective within 1e-4 of the optimum, and at its default.",
        gpytoolbox,
    ),
    "assembly": ("Assembling the Hessian", "Both matrices have the same entries.", assemblies),
}


def header(results: Record) -> str:
    """What was measured where."""
    m = results["machine"]
    return (
        f"{m['processor']}, {m['cores']} cores, {m['system']}. Processor time of one thread, medians of 5"
        " runs where nothing else is said. Gaps are relative duality gaps, computed"
        " from the points returned.\n"
    )


def full(results: Record) -> str:
    """All tables."""
    parts = ["# Benchmarks\n\n`make bench` makes this page. " + header(results)]
    for name, (title, text, draw) in SECTIONS.items():
        if name in results:
            parts.append(f"\n## {title}\n\n{text}\n\n{draw(results[name])}")
    return "".join(parts)


def short(results: Record) -> str:
    """The few lines for the README."""
    rows = []
    for r in results["flow_step"]:
        rows.append(["a flow step", r["problem"], r["vertices"], *_short(r), "-"])
    for r in results["scalar"]:
        rows.append([r["kind"], r["problem"], r["vertices"], *_short(r), ratio(r["ours"], r["yardstick"])])
    head = ["what", "mesh", "vertices", f"time to gap {GAP:g}", "Clarabel", "faster", "in L2 solutions"]
    return header(results) + "\n" + grid(head, rows)


def _short(r: Record) -> list[str]:
    peer = r.get("clarabel")
    return [seconds(r["ours"]), seconds(peer), ratio(peer, r["ours"])]


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
