"""Environments of their own for what a benchmark measures beside Ridgeform."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

from workspace import STATE, digest, is_current


def python_of(name: str, requirements: Path, what: str) -> Path:
    """The interpreter of the environment `name` that holds the requirements, made on first use for `what`."""
    python = STATE / name / "bin/python"
    stamp = STATE / f"{name}.stamp"
    wanted = digest([requirements], sys.version)
    if not (is_current(stamp, wanted) and python.exists()):
        print(f"== environment for {what}", flush=True)
        subprocess.run([sys.executable, "-m", "venv", "--clear", str(STATE / name)], check=True)
        install = [str(python), "-m", "pip", "install", "--disable-pip-version-check", "--quiet"]
        subprocess.run([*install, "-r", str(requirements)], check=True)
        stamp.write_text(wanted, encoding="utf-8")
    return python
