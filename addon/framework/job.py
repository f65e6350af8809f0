# SPDX-License-Identifier: GPL-3.0-or-later
"""Running calls of the wheel: in this thread, or in another one while Blender goes on drawing.

No Blender data is touched here. The wheel releases the interpreter lock while it computes; whoever started a
job polls it and writes to Blender from the main thread.
"""

import threading
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import ridgeform


@dataclass
class Task:
    """One call of the wheel: what to call, and what came of it."""

    name: str
    call: Callable[[ridgeform.Progress], object]
    counted: str = "step"
    """What the progress counts."""
    most: int | None = None
    """How many of these there can be, if it is known."""
    progress: ridgeform.Progress = field(default_factory=ridgeform.Progress)
    result: object | None = None
    error: Exception | None = None
    seconds: float = 0.0
    started: bool = False
    cancelled: bool = False
    """Whether the result is no longer wanted: for calls that do more than one call of the wheel."""
    stage: str = ""
    """What it is doing beside calls of the wheel."""

    def run(self) -> None:
        """Call, and keep the result or the error."""
        self.started = True
        begin = time.perf_counter()
        try:
            self.result = self.call(self.progress)
        except Exception as error:
            self.error = error
        self.seconds = time.perf_counter() - begin

    def check(self) -> None:
        """`Cancelled` if the result is no longer wanted."""
        if self.cancelled:
            raise ridgeform.Cancelled(self.name)


class Job:
    """Some tasks, run one after the other."""

    def __init__(self, tasks: Sequence[Task]) -> None:
        """Take the tasks; nothing runs yet."""
        self.tasks = list(tasks)
        self._thread: threading.Thread | None = None
        self._stop = threading.Event()
        self.is_canceled = False
        """Whether no result is wanted any more."""

    def run(self) -> None:
        """Run all tasks in this thread."""
        for task in self.tasks:
            if self._stop.is_set():
                return
            task.run()

    def start(self) -> None:
        """Run all tasks in a thread of their own."""
        self._thread = threading.Thread(target=self.run, name="ridgeform")
        self._thread.start()

    @property
    def is_running(self) -> bool:
        """Whether the thread is still at work."""
        return self._thread is not None and self._thread.is_alive()

    @property
    def current(self) -> Task:
        """The task at work, or the last one."""
        begun = [task for task in self.tasks if task.started]
        return begun[-1] if begun else self.tasks[0]

    @property
    def fraction(self) -> float:
        """How much of all tasks is done, 0 to 1."""
        done = sum(1.0 if task.seconds else task.progress.fraction for task in self.tasks if task.started)
        return done / len(self.tasks)

    def finish(self) -> None:
        """Ask the running task to return what it has reached, and start no other."""
        self._stop.set()
        for task in self.tasks:
            task.progress.finish()

    def cancel(self, wait: float | None = None) -> bool:
        """Ask the running task to stop without a result; whether it has, after at most `wait` seconds."""
        self.is_canceled = True
        self._stop.set()
        for task in self.tasks:
            task.cancelled = True
            task.progress.cancel()
        return self.join(wait)

    def join(self, wait: float | None = None) -> bool:
        """Wait for the thread to end, for at most so many seconds; whether it has."""
        if self._thread is not None:
            self._thread.join(wait)
        return not self.is_running


_last_summary: list[dict[str, object]] = []
_last_uids: list[int] = []
_is_shown = False


def last_summary() -> list[dict[str, object]]:
    """What the last run did: one dictionary per mesh, with plain values that JSON can hold.

    Keys: tool, name, vertices, faces, energy_before, energy_after, gap, steps, status, seconds, warnings,
    error; for the tools on attributes also attribute and result.
    """
    return [dict(entry) for entry in _last_summary]


def shown_summary() -> list[dict[str, object]]:
    """The same, as long as what was done is there: nothing after an undo step or in another file."""
    return last_summary() if _is_shown else []


def shown_uids() -> list[int]:
    """The session UIDs of the objects of `shown_summary`, where they were said."""
    return list(_last_uids) if _is_shown else []


def store_summary(entries: Sequence[dict[str, object]], uids: Sequence[int] = ()) -> None:
    """Make this the answer of `last_summary`, of objects with these session UIDs."""
    global _is_shown  # noqa: PLW0603
    _last_summary[:] = [dict(entry) for entry in entries]
    _last_uids[:] = uids
    _is_shown = True


def hide_summary() -> None:
    """Say that what was done may no longer be there."""
    global _is_shown  # noqa: PLW0603
    _is_shown = False
