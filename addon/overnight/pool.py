# SPDX-License-Identifier: GPL-3.0-or-later
"""Files side by side, in Blender processes of their own: one that crashes or hangs costs its file only."""

import collections
import os
import queue
import time
from collections.abc import Iterator, Sequence

import ridgeform

from ..framework.targets import Target
from . import helper, worker
from .helper import Helper
from .one_file import Plan, empty_record

START_ATTEMPTS = 3
"""Processes in a row that do not start, after which no other would."""

Records = Iterator[tuple[int, dict[str, object]]]


class StartError(Exception):
    """Blender processes do not start; the message says how they ended."""


class Pool:
    """Some workers for the files of one plan."""

    def __init__(
        self,
        targets: Sequence[Target],
        plan: Plan,
        arguments: Sequence[str],
        *,
        jobs: int,
        timeout: float | None,
        memory: int | None,
    ) -> None:
        """Take all targets, the command line, how many workers, seconds for a file, bytes for each worker."""
        self._targets, self._plan = targets, plan
        self._jobs, self._timeout = jobs, timeout
        self._command = worker.command(arguments)
        self._order = worker.order(plan, max(1, available_threads() // jobs), memory)
        self._helpers: list[Helper] = []
        self._failures = 0
        self._waiting: collections.deque[int] = collections.deque()
        self._events: helper.Events = queue.Queue()

    def run(self, indices: Sequence[int]) -> Records:
        """The records of these files as they are done. `StartError`; whatever comes, all processes end."""
        self._waiting.extend(indices)
        try:
            while self._waiting or any(one.index is not None for one in self._helpers):
                self._fill()
                yield from self._look()
        finally:
            self._end_all()

    def _fill(self) -> None:
        """Give files to workers that have none, and have as many workers as there is work for."""
        for one in self._helpers:
            if one.is_ready and one.index is None and self._waiting:
                one.ask(self._waiting.popleft())
        idle = sum(one.index is None for one in self._helpers)
        for _ in range(min(self._jobs - len(self._helpers), len(self._waiting) - idle)):
            self._helpers.append(Helper(self._command, self._order, os.getcwd(), self._events))

    def _look(self) -> Records:
        """What has happened; waits for it a little."""
        with_events = True
        try:
            one, message = self._events.get(timeout=helper.LOOK_SECONDS)
        except queue.Empty:
            with_events = False
        if with_events and one in self._helpers:
            if message is None:
                yield from self._at_its_end(one)
            elif message is True:
                one.is_ready, self._failures = True, 0
            else:
                index, one.index = one.index, None
                yield index, message
        for one in list(self._helpers):
            if not one.is_ready and one.seconds > helper.START_SECONDS:
                yield from self._at_its_end(one)
            elif one.index is not None and self._timeout is not None and one.seconds > self._timeout:
                self._helpers.remove(one)
                one.end()
                yield one.index, lost(self._targets[one.index], self._plan, helper.too_long(self._timeout))

    def _at_its_end(self, one: Helper) -> Records:
        """Take a worker off that is at its end; the record of its file, if it had one."""
        self._helpers.remove(one)
        how = one.end()
        if one.index is not None:
            yield one.index, lost(self._targets[one.index], self._plan, how)
        elif not one.is_ready:
            self._failures += 1
            if self._failures >= START_ATTEMPTS:
                raise StartError(f"Blender cannot be started to work on files: {how}, before it began")

    def _end_all(self) -> None:
        for one in self._helpers:
            one.process.stdin.close()
        end = time.monotonic() + helper.GRACE_SECONDS
        for one in self._helpers:
            one.end(max(0.0, end - time.monotonic()))
            if one.index is not None:
                # Removes what was begun.
                with self._plan.journal.claim(self._targets[one.index], self._plan.ledger):
                    pass


def lost(target: Target, plan: Plan, why: str) -> dict[str, object]:
    """The record of a file whose process did not answer, and removes what it has left behind.

    The journal may know that the file was done, and only the answer is missing.
    """
    with plan.journal.claim(target, plan.ledger) as claim:
        record = claim.finished_record()
    return empty_record(target.source) | {"error": why} if record is None else record | {"resumed": False}


def share_of_memory(total: int | None, jobs: int) -> int | None:
    """Bytes for each of the workers; `None` where the system cannot keep them to it."""
    if not worker.can_limit_memory():
        return None
    return (total or ridgeform.memory_available()) // jobs


def available_threads() -> int:
    """The threads that this process may use at once."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
