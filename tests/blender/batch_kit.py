"""Files for the tests of batches, and how batches are run."""

import json
import subprocess
import sys
import time
from pathlib import Path

import addon_kit as kit
from bl_ext.user_default.ridgeform.framework import batch, files
from bl_ext.user_default.ridgeform.overnight import worker

STEPS = ("--steps", "1")


def boxes(folder, count, suffix=".ply"):
    """Some boxes with noise, each in a file."""
    folder.mkdir(exist_ok=True)
    paths = [folder / f"box{number}{suffix}" for number in range(count)]
    for number, path in enumerate(paths):
        kit.empty_scene()
        kit.bumpy_box(seed=number)
        files.write_file(path)
    return paths


def records(capfd, *arguments):
    """Exit code and records of a command with JSON."""
    batch.flush_output()
    capfd.readouterr()
    code = batch.main([*map(str, arguments), "--json"])
    return code, [json.loads(line) for line in capfd.readouterr().out.splitlines()]


def run(capfd, tool, *arguments):
    """The same, the records by the name of the input."""
    code, found = records(capfd, tool, *arguments)
    return code, {Path(record["file"]).name: record for record in found}


def start(*arguments):
    """The command in a process of its own."""
    code = worker.MODULE.format(paths=sys.path, name=worker.PACKAGE)
    command = [sys.executable, "-c", code, *map(str, arguments)]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE)


def until(condition, seconds=120.0):
    """Wait until something holds."""
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, "it never came to that"
        time.sleep(0.02)


def state_of(folder):
    """What tells whether a file was written again, by its name: nothing may be left over beside them."""
    assert [path.name for path in folder.iterdir() if path.name.startswith(".")] == []
    return inodes(folder)


def inodes(folder):
    """The same while files are being written."""
    found = (path for path in folder.iterdir() if not path.name.startswith("."))
    return {path.name: (path.stat().st_ino, path.stat().st_mtime_ns) for path in found}
