"""The table of holes as Markdown."""

from __future__ import annotations

import statistics
from collections.abc import Iterable

from cells import columns, duration, grid
from driver import Record
from holes_cases import KINDS
from holes_run import OURS

NAMES = {
    OURS: "**ours**",
    "pyvista": "pyvista",
    "open3d": "Open3D",
    "meshfix": "MeshFix",
    "meshlib": "MeshLib",
    "meshlib_nicely": "MeshLib, nicely",
    "pymeshlab": "MeshLab",
    "pymeshlab_refined": "MeshLab, refined",
    "cgal": "CGAL",
    "cgal_fair": "CGAL, faired",
}
"""The tools, as people call them."""

ABOUT = """Shapes of side 2 with a hole and known truth, turned at random: half of the meshes irregular,
12 and 24 edges a side, holes of radius 0.3 and 0.6. Mean over these, in brackets the worst. At a ridge:
distance of the true ridge points in the hole to what fills it. On smooth shapes: distance of the filling to
the true surface. "Nothing removed" is the mesh before the hole was cut: what its density allows.
"""


def _number(value: float) -> str:
    return f"{value:.4f}" if value < 0.01 else f"{value:.3f}"


def _cell(records: list[Record], key: str) -> str:
    values = [record[key] for record in records if key in record]
    if not values:
        return "failed"
    failed = len(records) - len(values)
    worst = f" ({_number(max(values))})" if len(values) > 1 else ""
    return _number(statistics.mean(values)) + worst + (f", {failed} failed" if failed else "")


def _tools(results: Record) -> list[str]:
    return [tool for tool in NAMES if any(tool in case["tools"] for case in results["cases"])]


def by_kind(results: Record, measure: str, filling: bool = False) -> str:
    """One row for each kind of hole, `measure` is mean or rms; with `filling` never that of ridge points."""
    tools = _tools(results)
    rows = []
    for kind, about in KINDS.items():
        cases = [case for case in results["cases"] if case["kind"] == kind]
        if cases:
            key = ("fill_" if about.smooth or filling else "ridge_") + measure
            cells = [
                _cell([case["tools"][tool] for case in cases if tool in case["tools"]], key) for tool in tools
            ]
            rows.append([kind, *cells, _cell([case["before"] for case in cases], key)])
    return grid(["hole", *(NAMES[tool] for tool in tools), "nothing removed"], rows)


def ours(results: Record) -> str:
    """One row for each hole, ours only."""
    head = ["hole", "edges a side", "radius", "mesh", "ridge, mean", "ridge, RMS", "filling, mean"]
    head += ["filling, RMS", "nothing removed", "faces", "worst triangle", "time"]
    rows: list[Iterable[object]] = []
    for case in results["cases"]:
        one = case["tools"].get(OURS)
        if one is None:
            continue
        start = [
            case["kind"],
            case["density"],
            case["radius"],
            "irregular" if case["irregular"] else "regular",
        ]
        if "error" in one:
            rows.append([*start, one["error"], *[""] * 7])
            continue
        numbers = [
            _number(one[key]) if key in one else "-"
            for key in ("ridge_mean", "ridge_rms", "fill_mean", "fill_rms")
        ]
        floor = _number(case["before"].get("ridge_mean", case["before"]["fill_mean"]))
        rest = [one["faces"], f"{one['worst_quality']:.2f}", duration(one["seconds"])]
        rows.append([*start, *numbers, floor, *rest])
    return grid(head, rows) if rows else ""


def failures(results: Record) -> str:
    """What failed, a line for each tool and reason."""
    reasons: dict[tuple[str, str], int] = {}
    for case in results["cases"]:
        for tool, record in case["tools"].items():
            if "error" in record:
                key = (tool, record["error"])
                reasons[key] = reasons.get(key, 0) + 1
    lines = [f"- {NAMES[tool]}, {count} holes: {why}" for (tool, why), count in reasons.items()]
    return "\n".join(lines) + "\n" if lines else ""


LOCALITY = """Processor time on one thread, median of five. *Filling* is the call `fill_holes` on a mesh that
was read; *reading* makes a `Mesh` of two arrays, *joining* makes the arrays of the whole mesh with its patch,
where they are asked for.
"""
LONG = "Processor time on one thread.\n"
RIDGES = """The same shapes with 10 to 28 edges a side, three of five irregular, turned at random; holes of
radius 0.2 to 0.75, some longer than wide. Distances as in the tables above.
"""
STRESS = "Processor time on one thread.\n"


def limits(results: Record) -> list[str]:
    """Growth with the mesh and with the hole, and the random holes."""
    parts = []
    for key, title, about, table in (
        ("locality", "The same hole in larger meshes", LOCALITY, _locality),
        ("long", "Long loops", LONG, _long),
        ("ridges", "Random holes across ridges", RIDGES, _ridges),
        ("stress", "Random holes", STRESS, _stress),
    ):
        if key in results:
            found = results[key].get("found")
            parts += [f"## {title}\n", about, table(found) if found else results[key]["error"] + "\n"]
    return parts


def _locality(found: list[Record]) -> str:
    first: dict[str, float] = {}
    return columns(
        {
            "hole": r["hole"],
            "edges around it": r["loop_vertices"],
            "vertices": r["vertices"],
            "new faces": r["new_faces"],
            "filling": duration(r["seconds"]),
            "of the first": f"{r['seconds'] / first.setdefault(r['hole'], r['seconds']):.2f}",
            "reading": duration(r["reading"]),
            "joining": duration(r["joining"]),
        }
        for r in found
    )


def _long(found: list[Record]) -> str:
    rows = [
        [r["loop"], r["loop_vertices"], r["new_faces"], f"{r['worst_quality']:.2f}", duration(r["seconds"])]
        for r in found
    ]
    return grid(["loop", "its vertices", "new faces", "worst triangle", "time"], rows)


def _ridges(found: list[Record]) -> str:
    head = ["hole", "holes", "ridge, mean", "median", "9 of 10", "worst", "filling, mean", "worst"]
    numbers = [[f"{x:.4f}" for x in [*r["ridge"], *r["filling"]]] for r in found]
    rows = [
        [r["kind"], r["holes"], *row, f"{r['worst_quality']:.2f}"]
        for r, row in zip(found, numbers, strict=True)
    ]
    return grid([*head, "worst triangle"], rows)


def _stress(found: Record) -> str:
    text = f"{found['holes']} holes in {found['meshes']} meshes, cut out of ten: "
    text += f"{len(found['wrong'])} meshes with a fault. "
    if found["median_seconds"] is not None:
        text += f"{duration(found['median_seconds'])} a mesh, at most {duration(found['longest_seconds'])}."
    lines = [f"- {seed}: {'; '.join(words)}" for seed, words in found["wrong"].items()]
    return "\n".join([text, "", *lines] if lines else [text]) + "\n"


def full(results: Record) -> str:
    """The whole page."""
    if not results["cases"]:
        return "\n".join(limits(results))
    parts = [
        "# Holes\n",
        ABOUT,
        "## Mean distance\n",
        by_kind(results, "mean"),
        "## Root of the mean square\n",
        by_kind(results, "rms"),
        "## Mean distance of the filling to the true surface\n",
        by_kind(results, "mean", filling=True),
    ]
    why = failures(results)
    if why:
        parts += ["## What failed\n", why]
    table = ours(results)
    if table:
        parts += ["## Ours, hole by hole\n", table]
    return "\n".join(parts + limits(results))
