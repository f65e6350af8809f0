# SPDX-License-Identifier: GPL-3.0-or-later
"""One file of a batch: read, given to one tool or several in a row, written, and what the record says."""

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import bpy

from ..blender import selection
from ..blender.refusals import NothingToDoError, RefusedError
from ..framework import files
from ..framework.far_origin import offset_of
from ..framework.precision import moved_notes, rounding_notes
from ..framework.run import NO_RESULT, Run, total
from ..framework.targets import Ledger, Target
from ..framework.tool import Tool
from . import thumbnails
from .journal import Claim, Journal

POLL_SECONDS = 0.05

Watch = Callable[[float], None]
"""What is told how much of a computation is done, 0 to 1; what it raises ends the computation."""


@dataclass(frozen=True)
class Step:
    """One tool with its settings."""

    tool: Tool
    settings: object


@dataclass(frozen=True)
class Plan:
    """What is done with every file."""

    steps: Sequence[Step]
    ledger: Ledger
    journal: Journal | None = None
    pictures: bool = False
    """Whether the journal gets pictures from before and after."""


def do_file(target: Target, plan: Plan, watch: Watch) -> dict[str, object]:
    """The record of one file, done now, or done before if the journal says so."""
    if plan.journal is None or target.error is not None:
        return _attempt(target, plan, None, watch)
    with plan.journal.claim(target, plan.ledger) as claim:
        known = claim.finished_record()
        return known if known is not None else _attempt(target, plan, claim, watch)


def empty_record(source: Path) -> dict[str, object]:
    """The fields of a record, nothing done."""
    return {
        "file": str(source),
        "output": None,
        "vertices": None,
        "faces": None,
        "energy_before": None,
        "energy_after": None,
        "gap": None,
        "seconds": None,
        "resumed": False,
        "warnings": [],
        "error": None,
        "meshes": [],
    }


def _attempt(target: Target, plan: Plan, claim: Claim | None, watch: Watch) -> dict[str, object]:
    record = empty_record(target.source)
    begin = time.perf_counter()
    try:
        if target.error is not None:
            raise files.FileError(f"{target.error}: choose another output")
        offset = offset_of(target.source, target.path)
        objects = files.read_file(target.source, offset)
        # A file of Blender's own has had single precision all along.
        rounded = [] if target.source.suffix.lower() == ".blend" else rounding_notes(objects)
        protected = claim or plan.ledger
        protected.add_inputs(files.files_in_use())
        camera = thumbnails.Camera(objects) if claim is not None and plan.pictures else None
        before = camera and camera.picture(objects)
        outcomes, notes = _run_steps(objects, plan.steps, watch)
        made = record | _record_of(outcomes) | {"output": str(target.path)}
        made["warnings"] += notes + rounded + moved_notes(offset)
        made["error"] = "; ".join(error for outcome in outcomes for error in outcome.errors) or None
        made["seconds"] = round(time.perf_counter() - begin, 3)
        watch(1.0)
        if claim is not None:
            claim.record = made
            claim.pictures = camera and [before, camera.picture(_meshes())]
        files.write_file(target.path, protected, None if offset is None else (target.source, offset))
        record = made
        if claim is not None:
            claim.finish()
    except Exception as error:
        record["error"] = files.sentence_of(error)
    record["seconds"] = round(time.perf_counter() - begin, 3)
    return record


def _meshes() -> list[bpy.types.Object]:
    return [obj for obj in bpy.data.objects if obj.type == "MESH"]


@dataclass(frozen=True)
class _Outcome:
    """What a run says at its end: a later step may take its objects away."""

    summary: list[dict[str, object]]
    skipped: list[str]
    errors: list[str]


def _run_steps(
    objects: Sequence[bpy.types.Object], steps: Sequence[Step], watch: Watch
) -> tuple[list[_Outcome], list[str]]:
    """What came of all steps, and notes; a step of several that has nothing to do is passed over."""
    outcomes, notes = [], []
    idle = None
    for number, step in enumerate(steps):
        chosen = selection.usable(objects, step.tool.run.needs)
        try:
            run = step.tool.run(chosen.objects, step.settings, chosen.skipped)
        except NothingToDoError as nothing:
            idle = nothing
            notes.append(f"{step.tool.command} had nothing to do: {nothing}")
            continue
        except RefusedError as refusal:
            raise refusal if len(steps) == 1 else RefusedError(f"{step.tool.command}: {refusal}") from None
        _compute(run, lambda fraction, number=number: watch((number + fraction) / len(steps)))
        run.apply()
        outcomes.append(_Outcome(run.summary, run.skipped, run.errors))
        # A tool may have made objects, or taken some away.
        objects = _meshes()
    if not outcomes and idle is not None:
        raise idle
    return outcomes, notes


def _compute(run: Run, watch: Watch) -> None:
    run.job.start()
    try:
        while run.job.is_running:
            watch(run.job.fraction)
            time.sleep(POLL_SECONDS)
    except BaseException:
        run.job.cancel()
        raise


def _record_of(outcomes: Sequence[_Outcome]) -> dict[str, object]:
    """What the record says; energies only if there is one step, since each tool has its own."""
    done = [[e for e in outcome.summary if e["status"] not in NO_RESULT] for outcome in outcomes]
    every = [entry for outcome in outcomes for entry in outcome.summary]
    energies = dict.fromkeys(("energy_before", "energy_after"))
    if len(outcomes) == 1:
        energies = {key: _total(done[0], key) for key in energies}
    return energies | {
        "vertices": total(done[0], "vertices"),
        "faces": total(done[-1], "faces"),
        "gap": max((e["gap"] for entries in done for e in entries if e["gap"] is not None), default=None),
        "warnings": [f'"{entry["name"]}": {note}' for entry in every for note in entry["warnings"]]
        + [note for outcome in outcomes for note in outcome.skipped],
        "meshes": every,
    }


def _total(entries: Sequence[dict[str, object]], key: str) -> float | None:
    values = [entry[key] for entry in entries]
    return None if None in values else sum(values)
