"""Cells and grids of Markdown tables."""

from __future__ import annotations

from collections.abc import Iterable

from driver import Record, gap_of, iterations_of


def duration(value: float) -> str:
    """A time with its unit, three digits at most."""
    for unit, factor in [("s", 1.0), ("ms", 1e3)]:
        if value * factor >= 1:
            return f"{value * factor:.3g} {unit}"
    return f"{value * 1e6:.3g} µs"


def seconds(record: Record | None, name: str = "seconds") -> str:
    """The time in a record."""
    return "-" if record is None or record.get(name) is None else duration(record[name])


def times(slow: Record | None, fast: Record | None, name: str = "seconds") -> float | None:
    """How often `fast` goes into `slow`."""
    return None if slow is None or fast is None else slow[name] / fast[name]


def ratio(slow: Record | None, fast: Record | None, name: str = "seconds") -> str:
    """The same, to be read."""
    value = times(slow, fast, name)
    if value is None:
        return "-"
    return f"{value:.0f} x" if value >= 20 else f"{value:.1f} x"


def grid(head: Iterable[str], rows: Iterable[Iterable[object]]) -> str:
    """A Markdown table."""
    head = list(head)
    lines = [head, ["---"] * len(head), *rows]
    return "".join("| " + " | ".join(str(cell) for cell in line) + " |\n" for line in lines)


def columns(rows: Iterable[dict[str, object]]) -> str:
    """A Markdown table of rows whose cells are named by their columns."""
    rows = list(rows)
    return grid(rows[0] if rows else (), (row.values() for row in rows))


def solved(record: Record | None) -> str:
    """Time, and in brackets iterations, factorizations and the gap where it was missed."""
    if record is None:
        return "-"
    note = f"{iterations_of(record)} it."
    if record.get("factorisations"):
        note += f", {record['factorisations']} fact."
    if not record["complete"] and "clarabel" not in str(record.get("solver")):
        note += f", gap {gap_of(record):.0e}"
    return f"{seconds(record)} ({note})"


def kilobytes(record: Record | None, of: Record) -> str:
    """The peak of memory per vertex."""
    return "-" if record is None else f"{record['peak_bytes'] / of['vertices'] / 1000:.1f} kB"
