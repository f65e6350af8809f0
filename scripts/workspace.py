"""What the build scripts share: where things are, stamps, running commands, stopping with one clear line.

Only the standard library, and nothing newer than Python 3.8: `setup_env.py` runs in whatever Python there is.
"""

from __future__ import annotations

import hashlib
import os
import re
import subprocess
import sys
import time
from collections.abc import Iterable
from pathlib import Path
from typing import NoReturn

ROOT = Path(__file__).resolve().parents[1]
STATE = ROOT / ".ridgeform"
OUT = ROOT / "out"
WHEEL_SITE = STATE / "wheel-site"
"""The built wheel, unpacked; kept out of the environments, so that Blender can only find the bundled one."""


def python_path(*folders: Path) -> str:
    """PYTHONPATH with these folders, then `known_shapes` and what all scripts share."""
    return os.pathsep.join(map(str, [*folders, ROOT / "tests", ROOT / "scripts"]))


def stop(message: str) -> NoReturn:
    """End with one line on what is missing or went wrong."""
    sys.exit("ridgeform: " + message)


def version() -> str:
    """The version of everything: `[workspace.package] version` in Cargo.toml."""
    text = (ROOT / "Cargo.toml").read_text(encoding="utf-8")
    found = re.search(r'\[workspace\.package\][^\[]*?^version = "([^"]+)"', text, re.MULTILINE | re.DOTALL)
    if found is None:
        stop("Cargo.toml has no version under [workspace.package]")
    return found.group(1)


def files_in(folder: Path) -> list[Path]:
    """All files below a folder that belong to the sources, sorted."""
    return sorted(
        path
        for path in folder.rglob("*")
        if path.is_file() and "__pycache__" not in path.parts and path.suffix not in {".so", ".pyd"}
    )


def digest(paths: Iterable[Path], *extra: str) -> str:
    """A hash of the names and contents of files, and of further words."""
    total = hashlib.sha256(repr(extra).encode())
    for path in paths:
        total.update(str(path).encode() + b"\0" + hashlib.sha256(path.read_bytes()).digest())
    return total.hexdigest()


def is_current(stamp: Path, value: str) -> bool:
    """Whether a stamp file holds this value: then nothing has changed since it was written."""
    return stamp.is_file() and stamp.read_text(encoding="utf-8") == value


def run(
    command: list[str | Path],
    what: str,
    environment: dict[str, str] | None = None,
    quiet: bool = False,
) -> None:
    """Run a command in the project's root, under a heading; stop if it fails, with what it printed."""
    code = _run(command, what, environment, quiet)
    if code != 0:
        stop(f"{what}: failed with exit code {code}")


def run_all(parts: dict[str, tuple[list[str | Path], dict[str, str]]]) -> None:
    """Run all commands, each with an environment, even if some fail; stop at the end, naming those."""
    failed = []
    for what, (command, environment) in parts.items():
        code = _run(command, what, environment)
        if code:
            failed.append(what)
    if failed:
        stop("failed: " + ", ".join(failed))


def _run(
    command: list[str | Path], what: str, environment: dict[str, str] | None = None, quiet: bool = False
) -> int:
    print(f"== {what}", flush=True)
    begin = time.monotonic()
    done = subprocess.run(
        [str(word) for word in command],
        cwd=ROOT,
        env={**os.environ, **(environment or {})},
        stdout=subprocess.PIPE if quiet else None,
        stderr=subprocess.STDOUT if quiet else None,
        check=False,
    )
    if quiet and done.returncode != 0:
        sys.stdout.write(done.stdout.decode(errors="replace"))
    print(f"   {what}: {time.monotonic() - begin:.0f} s", flush=True)
    return done.returncode
