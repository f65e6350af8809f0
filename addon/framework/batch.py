# SPDX-License-Identifier: GPL-3.0-or-later
"""The batch command: the tools on files, without a window.

`blender --command ridgeform stylize FILES -o OUT` with the installed extension, or, from a checkout with the
wheel and the `bpy` package installed, `python -m addon stylize FILES -o OUT`.
"""

import argparse
import contextlib
import ctypes
import json
import os
import sys
import time
import traceback
from collections.abc import Iterator, Sequence
from pathlib import Path

import bpy

from ..blender import selection
from ..blender.refusals import RefusedError
from . import files, flags
from .console import ProgressBar
from .precision import rounding_notes
from .run import NO_RESULT, Run
from .targets import Ledger, Target, assign
from .tool import Tool

COMMAND = "ridgeform"
POLL_SECONDS = 0.05
INTERRUPTED = 130


def main(arguments: Sequence[str]) -> int:
    """Run the command line; returns 0, 1 if a file failed, 2 if it is wrong, 130 if interrupted."""
    try:
        options = parser().parse_args(arguments)
    except SystemExit as leaving:
        return int(leaving.code or 0)
    tool = _tools[options.tool]
    settings = flags.settings_from(options, tool.settings)
    failed = False
    try:
        with _clean_output(options.json) as emit:
            targets, ledger = assign(options.files, options.output, options.format)
            for target in targets:
                record = _one_file(target, tool.run, settings, ledger)
                failed |= record["error"] is not None
                emit(record, tool.run)
    except KeyboardInterrupt:
        return INTERRUPTED
    return 1 if failed else 0


def parser() -> argparse.ArgumentParser:
    """The parser of the whole command line."""
    made = argparse.ArgumentParser(prog=COMMAND, description="Ridgeform without a window.")
    tools = made.add_subparsers(dest="tool", required=True, metavar="TOOL")
    for name, tool in _tools.items():
        child = tools.add_parser(name, help=tool.description, description=tool.description)
        _add_files(child)
        flags.add_flags(child, tool.settings)
    return made


def _add_files(child: argparse.ArgumentParser) -> None:
    add = child.add_argument
    add("files", nargs="+", type=Path, metavar="FILE", help=f"Files to read: {' '.join(files.FORMATS)}")
    add("-o", "--output", type=Path, required=True, metavar="OUT", help="File or folder to write to")
    add(
        "--format", type=_suffix, choices=list(files.FORMATS), help="Write into the folder OUT in this format"
    )
    add("--json", action="store_true", help="Print one JSON record per file on standard output")


def _suffix(text: str) -> str:
    return "." + text.lower().lstrip(".")


def _one_file(target: Target, tool: type[Run], settings: object, ledger: Ledger) -> dict[str, object]:
    record: dict[str, object] = {
        "file": str(target.source),
        "output": None,
        "vertices": None,
        "faces": None,
        "energy_before": None,
        "energy_after": None,
        "gap": None,
        "seconds": None,
        "warnings": [],
        "error": None,
        "meshes": [],
    }
    begin = time.perf_counter()
    try:
        if target.error is not None:
            raise files.FileError(f"{target.error}: choose another output")
        run = _run_file(target.source, tool, settings, ledger)
        files.write_file(target.path, ledger)
        record |= _record_of(run) | {"output": str(target.path)}
        if run.errors:
            record["error"] = "; ".join(run.errors)
    except (files.FileError, RefusedError) as error:
        record["error"] = str(error)
    except Exception as error:
        # A fault of the program: the other files are still worth doing.
        traceback.print_exc()
        record["error"] = f"{type(error).__name__}: {error}"
    record["seconds"] = round(time.perf_counter() - begin, 3)
    return record


def _run_file(source: Path, tool: type[Run], settings: object, ledger: Ledger) -> Run:
    objects = files.read_file(source)
    # A file of Blender's own has had single precision all along.
    rounded = [] if source.suffix.lower() == ".blend" else rounding_notes(objects)
    chosen = selection.usable(objects, tool.needs)
    ledger.add_inputs(files.files_in_use())
    run = tool(chosen.objects, settings, chosen.skipped)
    run.job.start()
    try:
        with ProgressBar(source.name) as bar:
            while run.job.is_running:
                bar.show(run.job.fraction)
                time.sleep(POLL_SECONDS)
            bar.show(1.0)
    except BaseException:
        run.job.cancel()
        raise
    run.apply()
    run.skipped += rounded
    return run


def _record_of(run: Run) -> dict[str, object]:
    done = [entry for entry in run.summary if entry["status"] not in NO_RESULT]
    warnings = [f'"{entry["name"]}": {note}' for entry in run.summary for note in entry["warnings"]]
    return {
        "vertices": sum(entry["vertices"] for entry in done),
        "faces": sum(entry["faces"] for entry in done),
        "energy_before": _total(done, "energy_before"),
        "energy_after": _total(done, "energy_after"),
        "gap": max((entry["gap"] for entry in done if entry["gap"] is not None), default=None),
        "warnings": warnings + run.skipped,
        "meshes": run.summary,
    }


def _total(entries: Sequence[dict[str, object]], key: str) -> float | None:
    values = [entry[key] for entry in entries]
    return None if None in values else sum(values)


@contextlib.contextmanager
def _clean_output(as_json: bool) -> Iterator[object]:
    """Give a function that prints a record; with JSON, what Blender prints goes to standard error."""
    if not as_json:
        yield lambda record, tool: print(_sentence(record, tool), flush=True)
        return
    flush_output()
    saved = os.dup(1)
    os.dup2(2, 1)
    try:
        # Blender's add-ons print through Python, Blender itself through C: both are sent away.
        with (
            contextlib.redirect_stdout(sys.stderr),
            os.fdopen(os.dup(saved), "w", encoding="utf-8") as stream,
        ):
            yield lambda record, _tool: print(json.dumps(record, ensure_ascii=False), file=stream, flush=True)
    finally:
        flush_output()
        os.dup2(saved, 1)
        os.close(saved)


def flush_output() -> None:
    """Write out what Python and Blender have printed; Blender's own output has a buffer in C."""
    sys.stdout.flush()
    ctypes.CDLL("ucrtbase" if os.name == "nt" else None).fflush(None)


def _sentence(record: dict[str, object], tool: type[Run]) -> str:
    if record["error"] is not None:
        return f"{record['file']}: failed: {record['error']}"
    notes = "".join(f"\n  note: {note}" for note in record["warnings"])
    where = f"{record['file']} → {record['output']}"
    parts = [f"{record['vertices']} vertices"]
    if record["energy_after"] is not None:
        before = "" if record["energy_before"] is None else f"{record['energy_before']:.4g} → "
        parts.append(f"energy {before}{record['energy_after']:.4g}")
    if record["gap"] is not None:
        parts.append(f"gap {record['gap']:.1g}")
    parts += tool.phrases([entry for entry in record["meshes"] if entry["status"] not in NO_RESULT])
    return f"{where}: {', '.join(parts)}, {record['seconds']:.1f} s{notes}"


_command = None
_tools: dict[str, Tool] = {}


def offer(tools: Sequence[Tool]) -> None:
    """Take the tools that the command line has."""
    _tools.clear()
    _tools.update({tool.command: tool for tool in tools})


def register(tools: Sequence[Tool]) -> None:
    """Register `blender --command ridgeform` with these tools."""
    global _command  # noqa: PLW0603
    offer(tools)
    _command = bpy.utils.register_cli_command(COMMAND, main)


def unregister() -> None:
    """Unregister the command."""
    bpy.utils.unregister_cli_command(_command)
