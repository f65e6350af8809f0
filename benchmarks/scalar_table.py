"""The tables of the scalar problems: times, growth, parts of the time, what has become slower."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from cells import duration, grid, kilobytes, ratio, seconds, solved, times
from driver import Record
from problems import SERIES
from suite import EXACT, FINE, GAP

OURS = {"ours": GAP, "ours_fine": FINE, "ours_exact": EXACT}
"""The records of a scalar problem, and the gap of each."""

SLOWER = 1.2
"""A ratio to the quadratic problem that has grown by this factor is no noise any more."""


def scalars(records: list[Record]) -> str:
    """Every class on every mesh, beside the quadratic problem and Clarabel."""
    head = ["problem", "mesh", "vertices", "L2"]
    for gap in OURS.values():
        head += [f"gap ≤ {gap:g}", "x L2"]
    head += [f"Clarabel, {GAP:g}", "faster", f"Clarabel, {EXACT:g}", "faster", "memory per vertex (Clarabel)"]
    rows = []
    for r in records:
        row = [r["kind"], r["problem"], r["vertices"], seconds(r["yardstick"])]
        for name in OURS:
            row += [solved(r.get(name)), ratio(r.get(name), r["yardstick"])]
        for peer, own in [("clarabel", "ours"), ("clarabel_exact", "ours_exact")]:
            row += [solved(r.get(peer)), ratio(r.get(peer), r.get(own))]
        memory = f"{kilobytes(r['ours'], r)} ({kilobytes(r.get('clarabel_exact'), r)})"
        rows.append([*row, memory])
    return grid(head, rows)


def by_class(records: list[Record]) -> Iterator[tuple[str, list[Record]]]:
    """The records of the growing meshes, class by class, smallest mesh first."""
    for kind in dict.fromkeys(r["kind"] for r in records):
        same = [r for r in records if r["kind"] == kind and r["problem"] in SERIES]
        yield kind, sorted(same, key=lambda r: r["vertices"])


def exponent(records: list[Record], name: str) -> float | None:
    """The `e` of the fit `time = c · vertices^e`."""
    points = [(r["vertices"], r[name]["seconds"]) for r in records if name in r]
    if len(points) < 2:
        return None
    return float(np.polyfit(*np.log(np.array(points).T), 1)[0])


def growth(records: list[Record]) -> str:
    """Exponents and memory over the growing meshes, class by class."""
    head = ["problem", "vertices", "L2", *(f"gap ≤ {gap:g}" for gap in OURS.values())]
    rows = []
    for kind, same in by_class(records):
        if len(same) > 1:
            found = [exponent(same, name) for name in ("yardstick", *OURS)]
            range_ = f"{same[0]['vertices']} to {same[-1]['vertices']}"
            memory = f"{kilobytes(same[0]['ours'], same[0])}, {kilobytes(same[-1]['ours'], same[-1])}"
            rows.append([kind, range_, *("-" if e is None else f"{e:.2f}" for e in found), memory])
    return grid([*head, "memory per vertex, smallest and largest"], rows)


def parts(records: list[Record]) -> str:
    """What a solution to the first gap is made of, as parts of its time."""
    head = ["problem", "mesh", f"gap ≤ {GAP:g}", "ordering", "factorisations", "triangular solves"]
    head += ["the rest", "one factorization", "one solve", "entries of the factor per vertex"]
    rows = []
    for r in records:
        ours, one = r["ours"], r["yardstick"]
        known = [
            part_time(one, "symbolic"),
            ours["factorisations"] * part_time(one, "numeric"),
            ours["iterations"] * part_time(one, "solve"),
        ]
        known.append(ours["seconds"] - sum(known))
        shares = [f"{100 * part / ours['seconds']:.0f} %" for part in known]
        units = [duration(part_time(one, "numeric")), duration(part_time(one, "solve"))]
        entries = f"{one['factor_entries'] / r['vertices']:.0f}"
        rows.append([r["kind"], r["problem"], seconds(ours), *shares, *units, entries])
    return grid(head, rows)


def part_time(yardstick: Record, name: str) -> float:
    """Of a part of the quadratic problem: processor time, or what the clock said."""
    cpu = yardstick[f"{name}_cpu_s"]
    return yardstick[f"{name}_wall_s"] if cpu is None else cpu


def slower(records: list[Record], kept: list[Record]) -> str:
    """What costs clearly more quadratic solutions than in the results that are kept."""
    before = {(r["kind"], r["problem"]): r for r in kept}
    rows = []
    for r in records:
        old = before.get((r["kind"], r["problem"]))
        for name, gap in OURS.items():
            now = times(r.get(name), r["yardstick"])
            then = times(old.get(name), old["yardstick"]) if old else None
            if now and then and now > SLOWER * then:
                rows.append([r["kind"], r["problem"], f"gap ≤ {gap:g}", f"{then:.1f} x", f"{now:.1f} x"])
    return grid(["problem", "mesh", "gap", "x L2 before", "x L2 now"], rows) if rows else ""


def short(records: list[Record]) -> list[list[str]]:
    """A line per class: the mesh that Clarabel can still solve, and the largest one."""
    lines = []
    for kind, same in by_class(records):
        solved_by_both = [r for r in same if "clarabel" in r]
        if not solved_by_both:
            continue
        r, last = solved_by_both[-1], same[-1]
        found = exponent(same, "ours")
        lines.append(
            [
                kind,
                seconds(r["ours"]),
                ratio(r["ours"], r["yardstick"]),
                ratio(r.get("ours_fine"), r["yardstick"]),
                ratio(r["clarabel"], r["ours"]),
                f"{ratio(last['ours'], last['yardstick'])} ({last['vertices']} vertices)",
                "-" if found is None else f"{found:.2f}",
            ]
        )
    return lines
