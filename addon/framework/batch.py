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
import shutil
import signal
import sys
import threading
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

import bpy

from ..overnight import driver, recipe, report, worker
from ..overnight.one_file import Step
from . import files, flags
from .run import NO_RESULT
from .tool import Command, Tool

COMMAND = "ridgeform"
RUN = "run"
"""The word for recipes in place of a tool."""
INTERRUPTED = 130


def main(arguments: Sequence[str]) -> int:
    """Run the command line; returns 0, 1 if a file failed, 2 if it is wrong, 130 if interrupted."""
    try:
        options = parser().parse_args(arguments)
    except SystemExit as leaving:
        return int(leaving.code or 0)
    command = _commands.get(options.tool)
    try:
        return _drive(options, arguments) if command is None else command.run(options)
    except (recipe.RecipeError, driver.RefusalError) as error:
        print(f"{COMMAND}: error: {error}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        return INTERRUPTED


def _drive(options: argparse.Namespace, arguments: Sequence[str]) -> int:
    """Run tools on files, or serve the process that does."""
    steps = steps_of(options)
    if worker.is_worker():
        return driver.serve(options, steps)
    with _interruptible(), clean_output(options.json, _sentence) as emit:
        return driver.drive(options, steps, arguments, lambda record: emit(record, steps))


def steps_of(options: argparse.Namespace) -> list[Step]:
    """The tools that parsed options ask for, each with its settings; `RecipeError`."""
    if options.tool == RUN:
        return recipe.read(options.recipe, _tools)
    tool = _tools[options.tool]
    return [Step(tool, flags.settings_from(options, tool.settings))]


def parser() -> argparse.ArgumentParser:
    """The parser of the whole command line."""
    made = argparse.ArgumentParser(prog=COMMAND, description="Ridgeform without a window.")
    tools = made.add_subparsers(dest="tool", required=True, metavar="TOOL")
    for name, tool in _tools.items():
        child = tools.add_parser(name, help=tool.description, description=tool.description)
        _add_files(child)
        flags.add_flags(child, tool.settings)
    text = "Several tools in a row, as a recipe says"
    child = tools.add_parser(RUN, help=text, description=text)
    child.add_argument(
        "recipe", type=Path, metavar="RECIPE", help="A TOML file with a [[step]] for each tool"
    )
    _add_files(child)
    for name, command in _commands.items():
        command.add_arguments(
            tools.add_parser(name, help=command.description, description=command.description)
        )
    return made


def _add_files(child: argparse.ArgumentParser) -> None:
    add = child.add_argument
    add("files", nargs="+", type=Path, metavar="FILE", help=f"Files to read: {' '.join(files.FORMATS)}")
    add("-o", "--output", action=_Output, required=True, metavar="OUT", help="File or folder/ to write to")
    add(
        "--format", type=_suffix, choices=list(files.FORMATS), help="Write into the folder OUT in this format"
    )
    add("--json", action="store_true", help="Print one JSON record per file on standard output")
    add(
        "--jobs",
        type=_count,
        metavar="N",
        help="Work on N files at once, each in a Blender process of its own: one that crashes costs its file",
    )
    add(
        "--memory",
        type=_positive,
        metavar="GB",
        help="With --jobs, what its processes may take together (what is free)",
    )
    add(
        "--timeout",
        type=_positive,
        metavar="SECONDS",
        help="Give a file up that takes longer; in a process of its own, as with --jobs 1",
    )
    add("--dask", metavar="ADDRESS", help="Work on the Dask cluster with this scheduler: tcp://host:8786")
    add("--resume", action="store_true", help="Do only what a run before with the same options has not done")
    add("--pictures", action="store_true", help="Keep pictures in the journal for the page of a later run")
    add(
        "--report",
        type=_report,
        action="append",
        default=[],
        metavar="FILE",
        help="Write a summary: .txt, .json, or .html with pictures before and after; may be repeated",
    )


class _Output(argparse.Action):
    """Where to write: a path forgets the slash at its end, which says that it is a folder."""

    def __call__(
        self, _parser: object, options: argparse.Namespace, text: str, _option: str | None = None
    ) -> None:
        """Keep the path, and whether it was given as a folder."""
        options.output, options.is_folder = Path(text), text.endswith(("/", os.sep))


def _suffix(text: str) -> str:
    return "." + text.lower().lstrip(".")


def _count(text: str) -> int:
    if not text.isdecimal() or int(text) < 1:
        raise argparse.ArgumentTypeError(f'"{text}" is not a whole number of at least 1')
    return int(text)


def _positive(text: str) -> float:
    with contextlib.suppress(ValueError):
        if 0.0 < float(text) < float("inf"):
            return float(text)
    raise argparse.ArgumentTypeError(f'"{text}" is not a positive number')


def _report(text: str) -> Path:
    path = Path(text)
    if path.suffix.lower() not in report.KINDS:
        raise argparse.ArgumentTypeError(f'"{text}" does not end in {", ".join(report.KINDS)}')
    return path


@contextlib.contextmanager
def _interruptible() -> Iterator[None]:
    """Have Ctrl-C raise `KeyboardInterrupt`: Blender takes the first for a wish to stop a render."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        yield
    finally:
        # A handler of Blender's own cannot be put back, nor is there anything left to interrupt.
        if before is not None:
            signal.signal(signal.SIGINT, before)


@contextlib.contextmanager
def clean_output(as_json: bool, sentence: Callable[..., str]) -> Iterator[Callable[..., None]]:
    """Give a function that prints a record: as a sentence of it and what else is given, or as JSON.

    With JSON, what Blender prints goes to standard error.
    """
    if not as_json:

        def say(record: dict[str, object], *more: object) -> None:
            # Else what Blender prints comes after what is said of it, and after the summary.
            flush_output()
            print(sentence(record, *more), flush=True)

        yield say
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
            yield lambda record, *_more: print(
                json.dumps(record, ensure_ascii=False), file=stream, flush=True
            )
    finally:
        flush_output()
        os.dup2(saved, 1)
        os.close(saved)


def flush_output() -> None:
    """Write out what Python and Blender have printed; Blender's own output has a buffer in C."""
    sys.stdout.flush()
    ctypes.CDLL("ucrtbase" if os.name == "nt" else None).fflush(None)


def _sentence(record: dict[str, object], steps: Sequence[Step]) -> str:
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
    done = [entry for entry in record["meshes"] if entry["status"] not in NO_RESULT]
    for name, run in {step.tool.run.name: step.tool.run for step in steps}.items():
        entries = [entry for entry in done if entry["tool"] == name]
        parts += run.phrases(entries) if entries else []
    again = "done before, " if record["resumed"] else ""
    return f"{where}: {again}{', '.join(parts)}, {record['seconds']:.1f} s{notes}"


def run_as_module(tools: Sequence[Tool], commands: Sequence[Command]) -> None:
    """Run the command line of this process, with these tools and others, and end it: Blender as a module."""
    offer(tools, commands)
    code = main(sys.argv[1:])
    sys.stdout.flush()
    sys.stderr.flush()
    # bpy 4.2 crashes when Python shuts down after its glTF add-on was used, which would hide the exit code.
    shutil.rmtree(bpy.app.tempdir, ignore_errors=True)
    os._exit(code)


_command = None
_tools: dict[str, Tool] = {}
_commands: dict[str, Command] = {}


def offer(tools: Sequence[Tool], commands: Sequence[Command] = ()) -> None:
    """Take the tools that the command line has, and what else it has."""
    _tools.clear()
    _tools.update({tool.command: tool for tool in tools})
    _commands.clear()
    _commands.update({command.name: command for command in commands})


def register(tools: Sequence[Tool], commands: Sequence[Command] = ()) -> None:
    """Register `blender --command ridgeform` with these tools and other commands."""
    global _command  # noqa: PLW0603
    offer(tools, commands)
    _command = bpy.utils.register_cli_command(COMMAND, main)


def unregister() -> None:
    """Unregister the command."""
    bpy.utils.unregister_cli_command(_command)
