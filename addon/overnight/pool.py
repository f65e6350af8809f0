# SPDX-License-Identifier: GPL-3.0-or-later
"""Files side by side, in Blender processes of their own: one that crashes or hangs costs its file only."""

import collections
import contextlib
import json
import os
import secrets
import subprocess
import threading
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from multiprocessing import AuthenticationError
from multiprocessing.connection import Connection, Listener, wait

import ridgeform

from ..framework.targets import Target
from . import worker
from .one_file import Plan, empty_record

LOOK_SECONDS = 0.1
"""How often processes that have not reported yet, and times, are looked at."""
GRACE_SECONDS = 3.0
"""What a process gets to put away what it has begun, before it is ended."""
START_SECONDS = 300.0
"""Until when a process must have reported: Blender starts in seconds, on a busy machine in a minute."""
START_ATTEMPTS = 3
"""Processes in a row that do not start, after which no other would."""


class StartError(Exception):
    """Blender processes do not start; the message says how they ended."""


@dataclass
class _Worker:
    """A process, and what it works on."""

    number: int
    process: subprocess.Popen
    begun: float = field(default_factory=time.monotonic)
    connection: Connection | None = None
    index: int | None = None
    """The file that it works on."""


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
        self._targets, self._plan, self._arguments = targets, plan, arguments
        self._jobs, self._timeout, self._memory = jobs, timeout, memory
        self._workers: dict[int, _Worker] = {}
        self._started = 0
        self._failures = 0
        self._waiting: collections.deque[int] = collections.deque()
        self._arrivals: collections.deque[tuple[int, Connection]] = collections.deque()
        self._key = secrets.token_bytes(32)
        self._listener = Listener(authkey=self._key)
        threading.Thread(target=self._accept, daemon=True, name="ridgeform workers").start()

    def run(self, indices: Sequence[int]) -> Iterator[tuple[int, dict[str, object]]]:
        """The records of these files as they are done. `StartError`; whatever comes, all processes end."""
        self._waiting.extend(indices)
        try:
            while self._waiting or any(one.index is not None for one in self._workers.values()):
                self._fill()
                yield from self._look()
        finally:
            self._end_all()

    def _fill(self) -> None:
        """Have as many workers as there is work for, and give files to those that have none."""
        while self._arrivals:
            number, connection = self._arrivals.popleft()
            if number in self._workers:
                self._workers[number].connection = connection
                self._failures = 0
        for one in self._workers.values():
            if one.connection is not None and one.index is None and self._waiting:
                one.index, one.begun = self._waiting.popleft(), time.monotonic()
                with contextlib.suppress(OSError):
                    one.connection.send_bytes(json.dumps(one.index).encode())
        idle = sum(one.index is None for one in self._workers.values())
        for _ in range(min(self._jobs - len(self._workers), len(self._waiting) - idle)):
            self._started += 1
            address = {
                "address": self._listener.address,
                "key": self._key.hex(),
                "number": self._started,
                "memory": self._memory,
                "plan": self._plan.journal.key,
            }
            threads = max(1, available_threads() // self._jobs)
            process = worker.start(self._arguments, address, threads)
            self._workers[self._started] = _Worker(self._started, process)

    def _look(self) -> Iterator[tuple[int, dict[str, object]]]:
        connections = {one.connection: one for one in self._workers.values() if one.connection is not None}
        ready = wait(list(connections), LOOK_SECONDS) if connections else time.sleep(LOOK_SECONDS) or []
        for connection in ready:
            one = connections[connection]
            try:
                record = json.loads(connection.recv_bytes())
            except (EOFError, OSError):
                yield from self._lost(one, _how_it_ended(self._end(one)))
                continue
            index, one.index = one.index, None
            yield index, record
        for one in list(self._workers.values()):
            seconds = time.monotonic() - one.begun
            if one.connection is None and (one.process.poll() is not None or seconds > START_SECONDS):
                self._failed_to_start(one)
            elif one.index is not None and self._timeout is not None and seconds > self._timeout:
                self._end(one)
                yield from self._lost(one, f"it took longer than {self._timeout:g} s: raise --timeout")

    def _failed_to_start(self, one: _Worker) -> None:
        how = _how_it_ended(self._end(one))
        self._failures += 1
        if self._failures >= START_ATTEMPTS:
            raise StartError(f"Blender cannot be started to work on files: {how}, before it began")

    def _lost(self, one: _Worker, why: str) -> Iterator[tuple[int, dict[str, object]]]:
        """The record of the file that a worker did not finish, unless the journal knows that it did."""
        if one.index is None:
            return
        target = self._targets[one.index]
        with self._plan.journal.claim(target, self._plan.ledger) as claim:
            record = claim.finished_record()
        if record is None:
            record = empty_record(target.source) | {"error": why}
            record["seconds"] = round(time.monotonic() - one.begun, 3)
        yield one.index, record | {"resumed": False}

    def _end(self, one: _Worker, grace: float = GRACE_SECONDS) -> int:
        """End a worker, and return its exit code: closing the connection asks it to."""
        del self._workers[one.number]
        if one.connection is not None:
            one.connection.close()
        try:
            return one.process.wait(grace if one.connection is not None else 0.0)
        except subprocess.TimeoutExpired:
            one.process.kill()
            return one.process.wait()

    def _end_all(self) -> None:
        self._listener.close()
        for one in self._workers.values():
            if one.connection is not None:
                one.connection.close()
        end = time.monotonic() + GRACE_SECONDS
        for one in list(self._workers.values()):
            self._end(one, max(0.0, end - time.monotonic()))
            if one.index is not None:
                # Removes what was begun.
                with self._plan.journal.claim(self._targets[one.index], self._plan.ledger):
                    pass

    def _accept(self) -> None:
        """Take the reports of new workers, in a thread of its own."""
        while True:
            try:
                connection = self._listener.accept()
                self._arrivals.append((json.loads(connection.recv_bytes()), connection))
            except (AuthenticationError, EOFError, ValueError, ConnectionError):
                continue
            except OSError:
                return


def share_of_memory(total: int | None, jobs: int) -> int | None:
    """Bytes for each of the workers; `None` where the system cannot keep them to it."""
    if not worker.can_limit_memory():
        return None
    return (total or ridgeform.memory_available()) // jobs


def available_threads() -> int:
    """The threads that this process may use at once."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _how_it_ended(code: int) -> str:
    if code == -9:
        return "its Blender process was killed (signal 9): by hand, or because memory ran out"
    return f"its Blender process crashed ({f'signal {-code}' if code < 0 else f'exit code {code}'})"
