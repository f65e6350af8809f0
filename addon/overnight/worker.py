# SPDX-License-Identifier: GPL-3.0-or-later
"""A Blender process that works for another one: the same command line, started with an order.

It has the plan and all targets from the command line, reads one number of a file after the other, and writes
records. When the other process is gone it stops before anything else is put in place.
"""

import json
import os
import queue
import sys
import threading
from collections.abc import Sequence

import bpy

from ..framework.targets import Target
from .helper import MARK, VARIABLE
from .one_file import Plan, do_file

PACKAGE = __package__.rpartition(".")[0]
MODULE = """import bpy, runpy, sys
sys.path += [path for path in {paths!r} if path not in sys.path]
runpy.run_module({name!r}, run_name="__main__", alter_sys=True)"""
"""How Python begins a worker where Blender is a module: `bpy` first, which makes extensions importable, then
where this process finds the add-on and its wheels."""


class AbandonedError(BaseException):
    """The process that a worker works for is gone, or has given up on it. No `Exception`, to end it all."""


def command(arguments: Sequence[str]) -> list[str]:
    """How a worker with a command line is started, as this process was."""
    if bpy.app.binary_path:
        return [bpy.app.binary_path, "--command", "ridgeform", *arguments]
    paths = [os.path.abspath(path) for path in sys.path]
    return [sys.executable, "-c", MODULE.format(paths=paths, name=PACKAGE), *arguments]


def order(plan: Plan, threads: int, memory: int | None) -> dict[str, object]:
    """What a worker is told: how many threads and bytes it may take, and what plan it must find."""
    return {"plan": plan.journal.key, "threads": threads, "memory": memory}


def is_worker() -> bool:
    """Whether this process was started as a worker."""
    return VARIABLE in os.environ


def serve(targets: Sequence[Target], plan: Plan) -> int:
    """Do what the other process asks for, until it is gone or asks for no more."""
    given = json.loads(os.environ[VARIABLE])
    if plan.journal.key != given["plan"]:
        print("ridgeform: not what the batch began with: was its recipe changed?", file=sys.stderr)
        return 1
    limit_memory(given["memory"])
    # What Blender prints must not get among the messages.
    sys.stdout.flush()
    stream = os.fdopen(os.dup(1), "wb", buffering=0)
    os.dup2(2, 1)
    asked: queue.Queue[int | None] = queue.Queue()
    gone = threading.Event()

    def listen() -> None:
        with os.fdopen(os.dup(0), "rb") as orders:
            for line in orders:
                asked.put(int(line))
        gone.set()
        asked.put(None)

    def watch(_fraction: float) -> None:
        if gone.is_set():
            raise AbandonedError

    def say(message: object) -> None:
        stream.write(MARK + json.dumps(message).encode() + b"\n")

    threading.Thread(target=listen, daemon=True, name="ridgeform orders").start()
    try:
        say(True)
        while (index := asked.get()) is not None:
            say(do_file(targets[index], plan, watch))
    except (OSError, AbandonedError):
        pass
    return 0


def limit_memory(more: int | None) -> None:
    """Let this process take so many bytes beyond what it has, which its tools then take for what is free."""
    if more is None or not can_limit_memory():
        return
    import resource  # noqa: PLC0415

    with open("/proc/self/status", encoding="ascii") as status:
        taken = next(int(line.split()[1]) << 10 for line in status if line.startswith("VmData:"))
    hard = resource.getrlimit(resource.RLIMIT_DATA)[1]
    most = taken + more if hard == resource.RLIM_INFINITY else min(taken + more, hard)
    resource.setrlimit(resource.RLIMIT_DATA, (most, hard))


def can_limit_memory() -> bool:
    """Whether the system keeps a process to a limit that the tools know of: Linux does."""
    return sys.platform.startswith("linux")
