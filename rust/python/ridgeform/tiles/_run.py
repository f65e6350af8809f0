"""Tasks one after the other, on processes, or on a cluster: whatever has `submit`."""

from collections.abc import Callable, Iterable
from concurrent.futures import BrokenExecutor
from typing import Any, Protocol

from ..errors import ArgumentError, RidgeformError

Report = Callable[[str, int, int], None]
"""Told what is being done, and how many blocks of how many are."""


class Executor(Protocol):
    """Whatever runs functions elsewhere: of `concurrent.futures`, or the client of a Dask cluster."""

    def submit(self, function: Callable[..., Any], /, *arguments: Any) -> Any:
        """Begins a call, and returns its future."""


def checked(executor: Executor | None) -> Executor | None:
    """Raises ArgumentError for what runs nothing."""
    if executor is not None and not callable(getattr(executor, "submit", None)):
        kind = type(executor).__name__
        raise ArgumentError(
            f"executor: a {kind} has no submit(); give an executor of concurrent.futures, a dask.distributed "
            "Client, or None to work in this process"
        )
    return executor


def on_blocks(
    task: Callable[..., Any],
    arguments: Iterable[tuple[Any, ...]],
    executor: Executor | None,
    report: Report | None,
    stage: str,
) -> list[Any]:
    """What the task returns for each of the arguments, in their order.

    Raises what a task raises, and RidgeformError where the workers are gone.
    """
    calls = list(arguments)
    answers: list[Any] = []
    if report is not None:
        report(stage, 0, len(calls))
    if executor is None:
        for call in calls:
            answers.append(task(*call))
            if report is not None:
                report(stage, len(answers), len(calls))
        return answers
    futures = [executor.submit(task, *call) for call in calls]
    try:
        for future in futures:
            answers.append(future.result())
            if report is not None:
                report(stage, len(answers), len(calls))
    except BrokenExecutor as error:
        raise RidgeformError(
            f"a process ended while {stage} (killed, or out of memory): {error}; use fewer processes or a "
            "smaller max_vertices"
        ) from error
    finally:
        for future in futures[len(answers) :]:
            future.cancel()
    return answers
