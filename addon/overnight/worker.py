# SPDX-License-Identifier: GPL-3.0-or-later
"""A Blender process that works for another one: the same command line, started with an address to report to.

It has the plan and all targets from the command line, gets one number of a file after the other, and answers
with records. When the other process is gone it stops before anything else is put in place.
"""

import json
import os
import subprocess
import sys
from collections.abc import Sequence
from importlib import import_module
from multiprocessing.connection import Client, Connection

import bpy

from ..framework.targets import Target
from .one_file import Plan, do_file

VARIABLE = "RIDGEFORM_WORKER"
"""The environment variable with the address, in JSON."""
PACKAGE = __package__.rpartition(".")[0]
MODULE = """import bpy, runpy, sys
sys.path += [path for path in {paths!r} if path not in sys.path]
runpy.run_module({name!r}, run_name="__main__", alter_sys=True)"""
"""How Python begins a worker where Blender is a module: `bpy` first, which makes extensions importable, then
where this process finds the add-on and its wheels."""


class AbandonedError(BaseException):
    """The process that a worker works for is gone, or has given up on it. No `Exception`, to end it all."""


def start(arguments: Sequence[str], address: dict[str, object], threads: int) -> subprocess.Popen:
    """Start a worker with a command line; `address` as `serve` wants it. `OSError`."""
    environment = os.environ | {
        VARIABLE: json.dumps(address),
        "RAYON_NUM_THREADS": str(threads),
    }
    if bpy.app.binary_path:
        command = [bpy.app.binary_path, "--command", "ridgeform", *arguments]
    else:
        paths = [os.path.abspath(path) for path in sys.path]
        command = [sys.executable, "-c", MODULE.format(paths=paths, name=__name__), *arguments]
    # In a group of its own, so that Ctrl-C reaches only who can tell it what to do.
    apart = (
        {"creationflags": subprocess.CREATE_NEW_PROCESS_GROUP} if os.name == "nt" else {"process_group": 0}
    )
    return subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=2, env=environment, **apart)


def is_worker() -> bool:
    """Whether this process was started as a worker."""
    return VARIABLE in os.environ


def serve(targets: Sequence[Target], plan: Plan) -> int:
    """Do what the other process asks for, until it is gone or asks for no more."""
    given = json.loads(os.environ[VARIABLE])
    if plan.journal.key != given["plan"]:
        print("ridgeform: the recipe was changed while the batch was running", file=sys.stderr)
        return 1
    limit_memory(given["memory"])
    with Client(given["address"], authkey=bytes.fromhex(given["key"])) as boss:
        boss.send_bytes(json.dumps(given["number"]).encode())

        def watch(_fraction: float) -> None:
            if _is_closed(boss):
                raise AbandonedError

        try:
            while True:
                index = json.loads(boss.recv_bytes())
                record = do_file(targets[index], plan, watch)
                boss.send_bytes(json.dumps(record).encode())
        except (EOFError, OSError, AbandonedError):
            return 0


def _is_closed(boss: Connection) -> bool:
    """Whether the other end is closed: it says nothing while a file is worked on."""
    try:
        return boss.poll(0)
    except OSError:
        return True


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


if __name__ == "__main__":
    import_module(f"{PACKAGE}.framework.batch").run_as_module()
