# SPDX-License-Identifier: GPL-3.0-or-later
"""A Blender process that works for this one: numbers of files go in, records come out.

Nothing but the standard library is needed here, and no other module of the add-on: a farm's workers, which
know neither Blender nor the add-on, get this module by value.
"""

import contextlib
import json
import os
import queue
import subprocess
import sys
import threading
import time
from collections.abc import Mapping, Sequence

VARIABLE = "RIDGEFORM_WORKER"
"""The environment variable that makes a command line a worker's, with its order in JSON."""
MARK = b"ridgeform-record "
"""What a line with a message begins with: Blender prints others while it starts."""
GRACE_SECONDS = 3.0
"""What a process gets to put away what it has begun, before it is ended."""
START_SECONDS = 300.0
"""Until when a process must have reported: Blender starts in seconds, on a busy machine in a minute."""
KEPT = "ridgeform_helpers"
"""The attribute of a Dask worker with its processes."""
LOOK_SECONDS = 0.1
"""How often times are looked at."""

Events = queue.Queue[tuple["Helper", object]]
"""Messages of processes: `True` when one is ready, then records, `None` when it is at its end."""


class Helper:
    """One such process."""

    def __init__(self, command: Sequence[str], order: Mapping[str, object], folder: str, events: Events):
        """Start it in a folder. `OSError`."""
        environment = os.environ | {VARIABLE: json.dumps(order), "RAYON_NUM_THREADS": str(order["threads"])}
        # In a group of its own, so that Ctrl-C reaches only who can tell it what to do.
        apart = (
            {"creationflags": subprocess.CREATE_NEW_PROCESS_GROUP}
            if os.name == "nt"
            else {"process_group": 0}
        )
        self.process = subprocess.Popen(
            command,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            env=environment,
            cwd=folder,
            **apart,
        )
        self.begun = time.monotonic()
        """When it was started, or was given its file."""
        self.is_ready = False
        self.index: int | None = None
        """The file that it works on."""
        self._events = events
        threading.Thread(target=self._listen, daemon=True, name="ridgeform helper").start()

    def ask(self, index: int) -> None:
        """Have it work on a file."""
        self.index, self.begun = index, time.monotonic()
        # If it is gone, its end is among the events.
        with contextlib.suppress(OSError):
            self.process.stdin.write(f"{index}\n".encode())
            self.process.stdin.flush()

    def end(self, grace: float = GRACE_SECONDS) -> str:
        """End it, and say how it ended: closing its input asks it to."""
        with contextlib.suppress(OSError):
            self.process.stdin.close()
        try:
            code = self.process.wait(grace if self.is_ready else 0.0)
        except subprocess.TimeoutExpired:
            self.process.kill()
            code = self.process.wait()
        if code == -9:
            return "its Blender process was killed (signal 9): by hand, or because memory ran out"
        return f"its Blender process crashed ({f'signal {-code}' if code < 0 else f'exit code {code}'})"

    @property
    def seconds(self) -> float:
        """How long it has been starting, or working on its file."""
        return time.monotonic() - self.begun

    def _listen(self) -> None:
        for line in self.process.stdout:
            if line.startswith(MARK):
                self._events.put((self, json.loads(line.removeprefix(MARK))))
            else:
                sys.stderr.write(line.decode(errors="replace"))
        self._events.put((self, None))


def too_long(timeout: float) -> str:
    """What is said of a file that was given up."""
    return f"it took longer than {timeout:g} s: raise --timeout"


def record_of(
    held: dict[object, Helper],
    command: Sequence[str],
    order: Mapping[str, object],
    folder: str,
    *,
    index: int,
    timeout: float | None,
) -> dict[str, object]:
    """The record of one file, or `{"lost": why}`; the process is kept in `held` for the next one."""
    key = json.dumps([command, order, folder, threading.get_ident()])
    one = held.get(key)
    if one is None:
        one = held[key] = Helper(command, order, folder, queue.Queue())
    if one.is_ready:
        one.ask(index)
    while True:
        try:
            _, message = one._events.get(timeout=LOOK_SECONDS)
        except queue.Empty:
            late = timeout if one.is_ready else START_SECONDS
            if late is None or one.seconds <= late:
                continue
            del held[key]
            one.end()
            return {"lost": too_long(late) if one.is_ready else "Blender did not start"}
        if message is None:
            del held[key]
            how = one.end()
            return {"lost": how if one.is_ready else f"Blender did not start: {how}"}
        if message is True:
            one.is_ready = True
            one.ask(index)
            continue
        return message


def in_dask(
    command: Sequence[str], order: Mapping[str, object], folder: str, index: int, timeout: float | None
) -> dict[str, object]:
    """`record_of` as a task of a Dask worker, which keeps the processes that it has begun."""
    from distributed import get_worker  # noqa: PLC0415

    held = vars(get_worker()).setdefault(KEPT, {})
    return record_of(held, command, order, folder, index=index, timeout=timeout)


def end_in_dask(dask_worker: object) -> None:
    """End the processes that a Dask worker keeps."""
    held = vars(dask_worker).get(KEPT, {})
    while held:
        held.popitem()[1].end()
