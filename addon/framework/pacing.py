# SPDX-License-Identifier: GPL-3.0-or-later
"""How far a job is and how long it will take, between the reports that it makes; and how often to draw it."""

import time
from collections.abc import Callable

from .job import Job

SHARE = 0.1
"""The part of its time that a run may spend on showing where it is."""
WITHIN = 0.9
"""How much of a step may be shown as done while it is not."""

Clock = Callable[[], float]


class Estimate:
    """Where a job is that says so now and then: a fraction that moves on, elapsed and remaining time."""

    def __init__(self, clock: Clock = time.monotonic) -> None:
        """Begin now."""
        self._clock = clock
        self._begun = self._changed = clock()
        self._fraction = 0.0
        self._reports = 0

    def update(self, fraction: float) -> None:
        """Take the fraction (0 to 1) that is done, as the job says."""
        if fraction > self._fraction:
            self._fraction, self._changed = fraction, self._clock()
            self._reports += 1

    @property
    def elapsed(self) -> float:
        """Seconds since the beginning."""
        return self._clock() - self._begun

    @property
    def remaining(self) -> float | None:
        """Seconds that are left, if all goes on as so far; `None` before the first report."""
        if not self._reports:
            return None
        whole = (self._changed - self._begun) / self._fraction
        return max(whole - self.elapsed, 0.0)

    @property
    def fraction(self) -> float:
        """How much is done, with the share of this step that the time since the last one stands for."""
        if not self._reports:
            return 0.0
        step = (self._changed - self._begun) / self._reports
        within = min((self._clock() - self._changed) / step, WITHIN) if step > 0.0 else 0.0
        return min(self._fraction + within * self._fraction / self._reports, 1.0)


class Throttle:
    """When to draw, such that drawing takes its share of the time and no more, as measured.

    Blender draws what was changed several times, to smooth its edges. So all counts by which the calls come
    later than they should from one drawing to the next, wherever a view was drawn in between. Calls that are
    late by themselves do not count: a job on all processors delays each of them a little, and would put off
    drawing for good.
    """

    def __init__(self, interval: float, drawn: Callable[[], int], clock: Clock = time.monotonic) -> None:
        """Begin.

        `interval` is what passes between two calls when nothing is drawn, and `drawn` says how often views
        have been drawn so far.
        """
        self._clock = clock
        self._interval = interval
        self._drawn = drawn
        self._began: float | None = None
        self._called = 0.0
        self._count: int | None = 0
        self._cost = 0.0

    def is_due(self) -> bool:
        """Whether to draw now; call it first whenever there is time to."""
        now, count = self._clock(), self._drawn()
        if self._began is None:
            return True
        if count != self._count:
            self._cost += max(now - self._called - self._interval, 0.0)
        self._called, self._count = now, count
        return now - self._began >= self._cost / SHARE

    def began(self, when: float) -> None:
        """Something was made to be drawn, from this time on, which took time as well."""
        self._began = self._called = when
        self._count = None
        self._cost = 0.0

    def now(self) -> float:
        """The time."""
        return self._clock()


def status_line(job: Job, estimate: Estimate) -> str:
    """Where a job is, for the status bar: which mesh, what is done, step, elapsed and remaining time."""
    task = job.current
    progress = task.progress
    done = progress.iteration
    stage = task.stage or progress.stage or ("computing" if task.started else "starting")
    parts = [f"{task.name}: {stage}"]
    if task.stage:
        pass
    elif task.most is not None:
        parts.append(f"{task.counted} {min(done + 1, task.most)} of at most {task.most}")
    elif done:
        parts.append(f"{task.counted} {done}")
    parts.append(f"{duration(estimate.elapsed)} elapsed")
    remaining = estimate.remaining
    if remaining is not None and remaining >= 1.0:
        parts.append(f"about {duration(remaining)} left")
    return ", ".join(parts)


def duration(seconds: float) -> str:
    """Seconds as a person would say them."""
    whole = int(seconds)
    return f"{whole} s" if whole < 60 else f"{whole // 60} min {whole % 60} s"
