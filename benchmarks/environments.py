"""Environments of their own for what a benchmark measures beside Ridgeform."""

from __future__ import annotations

import functools
import os
import subprocess
import sys
from pathlib import Path

from workspace import STATE, digest, is_current, stop


def python_of(name: str, requirements: Path, what: str) -> Path:
    """The interpreter of the environment `name` that holds the requirements, made on first use for `what`."""
    python, missing = python_with(name, requirements, what)
    if missing:
        stop(f"{what}: " + "; ".join(missing.values()))
    return python


@functools.cache
def python_with(name: str, requirements: Path, what: str) -> tuple[Path, dict[str, str]]:
    """The same, with what pip said of each package that could not be installed: the others are there."""
    python = STATE / name / ("Scripts/python.exe" if os.name == "nt" else "bin/python")
    stamp = STATE / f"{name}.stamp"
    wanted = digest([requirements], sys.version)
    if is_current(stamp, wanted) and python.exists():
        return python, {}
    print(f"== environment for {what}", flush=True)
    subprocess.run([sys.executable, "-m", "venv", "--clear", str(STATE / name)], check=True)
    install = [str(python), "-m", "pip", "install", "--disable-pip-version-check", "--quiet"]
    missing = {}
    # All at once, so that they agree on what they share; one by one where that fails.
    if subprocess.run([*install, "-r", str(requirements)], check=False).returncode:
        for package in requirements.read_text(encoding="utf-8").split():
            done = subprocess.run([*install, package], stderr=subprocess.PIPE, text=True, check=False)
            if done.returncode:
                missing[package] = done.stderr.strip().splitlines()[-1]
                print(f"   {missing[package]}", flush=True)
    if not missing:
        stamp.write_text(wanted, encoding="utf-8")
    return python, missing
