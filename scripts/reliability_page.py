"""The tables of `docs/reliability.md`: each between two marks, written by the command that measures it."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterable
from pathlib import Path

PAGE = Path(__file__).resolve().parents[1] / "docs/reliability.md"


def write_section(name: str, text: str) -> None:
    """Replace what stands between `<!-- name:begin -->` and `<!-- name:end -->`."""
    page = PAGE.read_text(encoding="utf-8")
    marked = re.compile(rf"(<!-- {name}:begin -->\n).*?(<!-- {name}:end -->)", re.DOTALL)
    if not marked.search(page):
        raise ValueError(f"{PAGE} has no section {name}")
    PAGE.write_text(
        marked.sub(lambda found: f"{found[1]}{text.rstrip()}\n{found[2]}", page), encoding="utf-8"
    )


class Records:
    """What was measured of every call at every size, kept in a file so that a table can be made in parts."""

    def __init__(self, path: Path) -> None:
        """Read the file if it is there."""
        self.path = path
        self.of: dict[str, dict[str, object]] = {}
        if path.exists():
            self.of = json.loads(path.read_text(encoding="utf-8"))

    def keep(self, call: str, size: int | str, record: object) -> None:
        """Put a record in the place of the one before, and into the file."""
        self.of.setdefault(call, {})[str(size)] = record
        self.path.write_text(json.dumps(self.of, indent=1) + "\n", encoding="utf-8")

    def table(self, calls: Iterable[str], sizes: Iterable[int], cell: Callable[[object], str]) -> str:
        """A row for each call, a column for each size; a dash where nothing was measured."""
        lines = ["| call | " + " | ".join(f"{size:,} vertices" for size in sizes) + " |"]
        lines.append("| --- |" + " --- |" * len(list(sizes)))
        for call in calls:
            records = [self.of.get(call, {}).get(str(size)) for size in sizes]
            cells = ["-" if record is None else cell(record) for record in records]
            lines.append(f"| {call} | " + " | ".join(cells) + " |")
        return "\n".join(lines)
