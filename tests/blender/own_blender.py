"""A Blender of its own, with a folder for its user's: what is loaded here stays loaded."""

import subprocess
import sys
from pathlib import Path


def run_in_blender(code: str, folder: Path, *arguments: object) -> tuple[str, str]:
    """Run Python code, and return what it wrote to the console: output, and errors."""
    done = subprocess.run(
        [sys.executable, "-c", code, *map(str, arguments)],
        env={"BLENDER_USER_RESOURCES": str(folder), "PATH": "", "HOME": str(folder)},
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout, done.stderr
