# SPDX-License-Identifier: GPL-3.0-or-later
"""A batch from its parsed command line to its summaries: what was done before, what is left, who does it."""

import argparse
import contextlib
import hashlib
import json
import sys
from collections.abc import Callable, Iterator, Sequence

import bpy
import ridgeform

from ..framework.console import ProgressBar
from ..framework.targets import Target, assign
from . import dask_cluster, report, worker
from .journal import Journal
from .one_file import Plan, Step, do_file
from .pool import Pool, StartError, share_of_memory

Records = Iterator[tuple[int, dict[str, object]]]


class RefusalError(Exception):
    """A command line that cannot be followed; the message says why."""


def drive(
    options: argparse.Namespace,
    steps: Sequence[Step],
    arguments: Sequence[str],
    emit: Callable[[dict[str, object]], None],
) -> int:
    """Do all files, have each record emitted, and write the summaries; returns the exit code.

    `RefusalError` before anything is done; `KeyboardInterrupt` when the summaries of what was done are
    written.
    """
    if options.memory is not None and options.jobs is None:
        raise RefusalError("--memory is divided among processes: give --jobs as well")
    if options.memory is not None and not worker.can_limit_memory():
        raise RefusalError("--memory can be kept to on Linux only: choose fewer --jobs instead")
    if options.dask is not None and options.jobs is not None:
        raise RefusalError("--dask has workers of its own: leave --jobs out")
    targets, plan = _planned(options, steps)
    if _needs_journal(options):
        plan = _with_journal(plan, options)
    records: dict[int, dict[str, object]] = {}
    try:
        with contextlib.closing(_all_records(targets, plan, options, arguments)) as found:
            for index, record in found:
                records[index] = record
                emit(record)
    except (StartError, dask_cluster.DaskError) as error:
        print(f"ridgeform: error: {error}", file=sys.stderr)
    finally:
        said = _summarize(options, targets, [records[index] for index in sorted(records)], plan, steps)
    done = len(records) == len(targets) and all(record["error"] is None for record in records.values())
    return 0 if done and said else 1


def serve(options: argparse.Namespace, steps: Sequence[Step]) -> int:
    """Do what another process with the same command line asks for."""
    targets, plan = _planned(options, steps)
    return worker.serve(targets, _plan_with(plan, _journal(options, steps)))


def _planned(options: argparse.Namespace, steps: Sequence[Step]) -> tuple[list[Target], Plan]:
    targets, ledger = assign(options.files, options.output, options.format, options.is_folder)
    pictures = options.pictures or any(path.suffix.lower() == ".html" for path in options.report)
    return targets, Plan(steps, ledger, None, pictures)


def _needs_journal(options: argparse.Namespace) -> bool:
    return len(options.files) > 1 or _wants_journal(options)


def _wants_journal(options: argparse.Namespace) -> bool:
    return bool(
        options.resume
        or options.jobs
        or options.dask
        or options.pictures
        or options.timeout
        or options.report
    )


def _journal(options: argparse.Namespace, steps: Sequence[Step]) -> Journal:
    """The journal of a run, with a key of all that results depend on beside the inputs."""
    settings = [
        (
            step.tool.command,
            {name: sorted(v) if isinstance(v, set) else v for name, v in vars(step.settings).items()},
        )
        for step in steps
    ]
    versions = ridgeform.__version__, bpy.app.version_string
    text = json.dumps([versions, settings, options.format], sort_keys=True)
    return Journal(options.output, hashlib.sha256(text.encode()).hexdigest())


def _with_journal(plan: Plan, options: argparse.Namespace) -> Plan:
    journal = _journal(options, plan.steps)
    try:
        journal.open(keep=options.resume)
    except OSError as error:
        reason = f"the journal {journal.folder} cannot be written: {error.strerror}"
        if _wants_journal(options):
            raise RefusalError(f"{reason}; choose an OUT in a folder that can be written") from error
        print(f"ridgeform: {reason}, so that this run cannot be resumed", file=sys.stderr)
        return plan
    return _plan_with(plan, journal)


def _plan_with(plan: Plan, journal: Journal) -> Plan:
    return Plan(plan.steps, plan.ledger, journal, plan.pictures)


def _all_records(
    targets: Sequence[Target], plan: Plan, options: argparse.Namespace, arguments: Sequence[str]
) -> Records:
    if options.jobs is None and options.timeout is None and options.dask is None:
        for index, target in enumerate(targets):
            with ProgressBar(target.source.name) as bar:
                record = do_file(target, plan, bar.show)
            yield index, record
        return
    left = []
    for index, target in enumerate(targets):
        # No process is started for what was done before or cannot be done.
        if target.error is not None:
            yield index, do_file(target, plan, lambda _fraction: None)
        elif (known := plan.journal.finished(target)) is not None:
            yield index, known
        else:
            left.append(index)
    if left:
        yield from _side_by_side(targets, plan, options, arguments, left)


def _side_by_side(
    targets: Sequence[Target],
    plan: Plan,
    options: argparse.Namespace,
    arguments: Sequence[str],
    left: Sequence[int],
) -> Records:
    if options.dask is not None:
        made = dask_cluster.run(
            targets, plan, arguments, indices=left, address=options.dask, timeout=options.timeout
        )
    else:
        jobs = min(options.jobs or 1, len(left))
        total = None if options.memory is None else int(1e9 * options.memory)
        memory = share_of_memory(total, jobs)
        made = Pool(targets, plan, arguments, jobs=jobs, timeout=options.timeout, memory=memory).run(left)
    with ProgressBar(f"{len(left)} files") as bar, contextlib.closing(made) as found:
        for done, (index, record) in enumerate(found, 1):
            bar.show(done / len(left))
            yield index, record


def _summarize(
    options: argparse.Namespace,
    targets: Sequence[Target],
    records: Sequence[dict[str, object]],
    plan: Plan,
    steps: Sequence[Step],
) -> bool:
    """Print the summary of several files, and write those that were asked for; whether that was possible."""
    if len(targets) > 1 and not options.json:
        print(report.as_text(records, len(targets)), end="", flush=True)
    pictures = {}
    if plan.pictures:
        found = {str(target.source): plan.journal.pictures(target) for target in targets}
        done = {record["file"] for record in records if record["error"] is None}
        pictures = {name: pair for name, pair in found.items() if pair and name in done}
    title = "Ridgeform: " + ", ".join(step.tool.label for step in steps)
    written = True
    for path in options.report:
        try:
            report.write(path, records, len(targets), pictures, title)
        except OSError as error:
            print(f"ridgeform: error: {path} was not written: {error.strerror}", file=sys.stderr)
            written = False
    return written
