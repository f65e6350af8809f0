# SPDX-License-Identifier: GPL-3.0-or-later
"""What a batch did, as text, as JSON, and as one page of HTML with pictures from before and after."""

import html
import json
from collections.abc import Mapping, Sequence
from pathlib import Path

from ..framework.writing import write_text

KINDS = (".txt", ".json", ".html")

Record = Mapping[str, object]

STYLE = """
:root { color-scheme: light dark; font: 15px/1.45 system-ui, sans-serif; }
body { margin: 2rem auto; max-width: 74rem; padding: 0 1rem; }
h1 { font-size: 1.5rem; }
table { border-collapse: collapse; width: 100%; }
th, td { text-align: left; vertical-align: top; padding: .4rem .6rem; border-bottom: 1px solid #8884; }
td.number { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
td.file { overflow-wrap: anywhere; }
img { display: block; background: #fff; border-radius: 4px; }
.failed { color: #c0262d; }
.note { opacity: .75; font-size: .87rem; }
@media (max-width: 46rem) {
  thead { display: none; }
  tr { display: flex; flex-wrap: wrap; border-bottom: 1px solid #8884; }
  td { border: 0; }
  td.file { flex-basis: 100%; }
  td.number::before { content: attr(data-label) " "; opacity: .75; }
}
@media (prefers-color-scheme: dark) { .failed { color: #ff8080; } }
"""


def headline(records: Sequence[Record], total: int) -> str:
    """How many files are done, failed, and were not begun, in one line."""
    failed = sum(record["error"] is not None for record in records)
    resumed = sum(bool(record["resumed"]) for record in records)
    parts = [f"{len(records) - failed} of {total} files done"]
    if resumed:
        parts.append(f"{resumed} of them before")
    if failed:
        parts.append(f"{failed} failed")
    if len(records) < total:
        parts.append(f"{total - len(records)} not begun")
    return ", ".join(parts)


def as_text(records: Sequence[Record], total: int) -> str:
    """The headline, and a line for each file that failed."""
    failed = [f"{record['file']}: {record['error']}" for record in records if record["error"] is not None]
    return "\n".join([headline(records, total), *failed]) + "\n"


def as_json(records: Sequence[Record], total: int) -> str:
    """The numbers and all records."""
    failed = sum(record["error"] is not None for record in records)
    content = {"files": total, "done": len(records) - failed, "failed": failed, "records": list(records)}
    return json.dumps(content, ensure_ascii=False, indent=1) + "\n"


def as_html(records: Sequence[Record], total: int, pictures: Mapping[str, Sequence[str]], title: str) -> str:
    """A page that needs no other file; `pictures` has before and after by the file's name."""
    rows = "\n".join(_row(record, pictures.get(str(record["file"]))) for record in records)
    return f"""<!DOCTYPE html>
<html lang="en">
<head><meta charset="utf-8"><meta name="viewport" content="width=device-width">
<title>{html.escape(title)}</title><style>{STYLE}</style></head>
<body>
<h1>{html.escape(title)}</h1>
<p>{html.escape(headline(records, total))}. The pictures show faces and the colors of their materials.</p>
<table>
<thead><tr><th>File</th><th>Before</th><th>After</th>
<th>Vertices</th><th>Faces</th><th>Seconds</th></tr></thead>
<tbody>
{rows}
</tbody>
</table>
</body>
</html>
"""


def _row(record: Record, pictures: Sequence[str] | None) -> str:
    said = [f'<div class="failed">{html.escape(record["error"])}</div>'] if record["error"] else []
    said += [f'<div class="note">{html.escape(note)}</div>' for note in record["warnings"]]
    if record["output"] is not None:
        said.insert(0, f'<div class="note">→ {html.escape(record["output"])}</div>')
    cells = [f'<td class="file">{html.escape(str(record["file"]))}{"".join(said)}</td>']
    for which, data in zip(("before", "after"), pictures or (None, None), strict=True):
        picture = f'<img alt="{which}" src="data:image/png;base64,{data}">' if data else ""
        cells.append(f"<td>{picture}</td>")
    for key in ("vertices", "faces", "seconds"):
        value = record[key]
        shown = "" if value is None else f"{value:.1f}" if key == "seconds" else str(value)
        label = key.title() if shown else ""
        cells.append(f'<td class="number" data-label="{label}">{shown}</td>')
    return f"<tr>{''.join(cells)}</tr>"


def write(
    path: Path, records: Sequence[Record], total: int, pictures: Mapping[str, Sequence[str]], title: str
) -> None:
    """Write a summary, by the suffix of its file. `OSError`."""
    path.parent.mkdir(parents=True, exist_ok=True)
    kind = path.suffix.lower()
    if kind == ".json":
        write_text(path, as_json(records, total))
    elif kind == ".html":
        write_text(path, as_html(records, total, pictures, title))
    else:
        write_text(path, as_text(records, total))
