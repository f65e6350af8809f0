# SPDX-License-Identifier: GPL-3.0-or-later
"""The command `ridgeform check FILES`: what is wrong with the meshes of files, for a look or for a script."""

import argparse
import time
from pathlib import Path

from ..framework import batch, files
from ..framework.tool import Command
from .examine import examine
from .kinds import Severity


def _add_arguments(parser: argparse.ArgumentParser) -> None:
    add = parser.add_argument
    add("files", nargs="+", type=Path, metavar="FILE", help=f"Files to read: {' '.join(files.FORMATS)}")
    add("--json", action="store_true", help="Print one JSON record per file on standard output")
    add(
        "--strict",
        action="store_true",
        help="End with 1 also if something was found that tools do not handle",
    )


def _run(options: argparse.Namespace) -> int:
    failed = False
    with batch.clean_output(options.json, _sentence) as emit:
        for path in options.files:
            record, is_clean = _check_file(path)
            failed |= record["error"] is not None or (options.strict and not is_clean)
            emit(record)
    return 1 if failed else 0


def _check_file(path: Path) -> tuple[dict[str, object], bool]:
    begin = time.perf_counter()
    record: dict[str, object] = {"file": str(path), "meshes": [], "seconds": None, "error": None}
    is_clean = True
    try:
        for obj in files.read_file(path):
            report = examine(obj)
            record["meshes"].append(report.as_dict())
            is_clean &= not any(report.count(severity) for severity in (Severity.STOPS, Severity.LIMITS))
    except Exception as error:
        record["error"] = files.sentence_of(error)
    record["seconds"] = round(time.perf_counter() - begin, 3)
    return record, is_clean


def _sentence(record: dict[str, object]) -> str:
    if record["error"] is not None:
        return f"{record['file']}: failed: {record['error']}"
    lines = [f"{record['file']}:"]
    for mesh in record["meshes"]:
        lines.append(f"  {mesh['name']}: {mesh['vertices']} vertices, {mesh['faces']} faces")
        for found in mesh["findings"]:
            lines += [f"    {found['text']} ({found['severity']}): {found['tools']}"]
            lines += [f"      {note}" for note in found["notes"]]
        if not mesh["findings"]:
            lines.append("    nothing wrong")
    return "\n".join(lines)


COMMAND = Command(
    name="check",
    description="Say what is wrong with the meshes of files for these tools, and write nothing",
    add_arguments=_add_arguments,
    run=_run,
)
