"""Make the project's Python environments in `.ridgeform/`, then run a script in the first of them.

    python3 scripts/setup_env.py SCRIPT [ARGUMENTS]

One environment for each Python that a long-term Blender uses and that is found here; one is enough. What is
missing on the machine is said in one line before anything is done. Runs in any Python from 3.8 on.
"""

from __future__ import annotations

import ctypes
import json
import os
import platform
import shutil
import subprocess
import sys
from pathlib import Path

from workspace import ROOT, STATE, digest, is_current, python_path, run, stop

PYTHONS = {"3.11": "4.2 LTS", "3.13": "5.2 LTS"}
"""Python versions, and the Blender whose `bpy` package needs them."""

BPY_LIBRARIES = {
    "libX11.so.6": "libx11-6",
    "libXext.so.6": "libxext6",
    "libXrender.so.1": "libxrender1",
    "libXxf86vm.so.1": "libxxf86vm1",
    "libXfixes.so.3": "libxfixes3",
    "libXi.so.6": "libxi6",
    "libxkbcommon.so.0": "libxkbcommon0",
    "libSM.so.6": "libsm6",
    "libICE.so.6": "libice6",
    "libGL.so.1": "libgl1",
    "libEGL.so.1": "libegl1",
    "libgomp.so.1": "libgomp1",
}
"""Libraries of the system that `import bpy` needs (EGL: its pictures), and their Debian packages."""


def environment_python(version: str) -> Path:
    """The interpreter of the environment for a Python version."""
    folder = STATE / ("py" + version.replace(".", ""))
    return folder / ("Scripts/python.exe" if os.name == "nt" else "bin/python")


def environments() -> dict[str, Path]:
    """The interpreters in use by Python version, oldest first: that one has the build tools."""
    return {version: environment_python(version) for version in os.environ["RIDGEFORM_VERSIONS"].split()}


def find_pythons() -> dict[str, str]:
    """Interpreters by version: those of RIDGEFORM_PYTHON, else of PATH and of pyenv, that really run."""
    chosen = os.environ.get("RIDGEFORM_PYTHON")
    if chosen:
        candidates = [shutil.which(name) or name for name in chosen.split(os.pathsep)]
    else:
        names = [f"python{version}" for version in PYTHONS] + ["python3", "python"]
        candidates = [sys.executable] + [path for path in map(shutil.which, names) if path]
        pyenv = Path(os.environ.get("PYENV_ROOT", Path.home() / ".pyenv")) / "versions"
        candidates += [
            str(path) for version in PYTHONS for path in sorted(pyenv.glob(f"{version}.*/bin/python"))
        ]
    found: dict[str, str] = {}
    for candidate in candidates:
        version = _version_of(candidate)
        if version in PYTHONS:
            found.setdefault(version, candidate)
    return {version: found[version] for version in PYTHONS if version in found}


def _version_of(python: str) -> str | None:
    # A pyenv shim exists for versions that are not active, and Debian ships Python without ensurepip.
    code = "import ensurepip, json, sys, venv; print(json.dumps(sys.version_info[:2]))"
    try:
        answer = subprocess.run(
            [python, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, check=True
        )
        return "{}.{}".format(*json.loads(answer.stdout))
    except (OSError, ValueError, subprocess.CalledProcessError):
        return None


def missing(pythons: dict[str, str]) -> list[str]:
    """What this machine lacks, each with its cure."""
    lacks = []
    if shutil.which("cargo") is None:
        lacks.append("the Rust toolchain (`cargo` 1.88 or newer on the PATH, see rustup.rs)")
    if os.name != "nt" and shutil.which("cc") is None:
        lacks.append("a C compiler (`cc`, for example the package gcc)")
    if not pythons:
        lacks.append(
            "Python 3.11 or 3.13 with its venv module (on the PATH, in pyenv, or named by RIDGEFORM_PYTHON)"
        )
    if sys.platform.startswith("linux"):
        packages = [package for library, package in BPY_LIBRARIES.items() if not _loads(library)]
        if packages:
            lacks.append(
                "system libraries of the bpy package (Debian packages {})".format(" ".join(packages))
            )
    return lacks


def _loads(library: str) -> bool:
    try:
        ctypes.CDLL(library)
    except OSError:
        return False
    return True


def fill_environment(name: str, python: str, requirements: list[str], imported: str) -> Path:
    """Create the environment `.ridgeform/NAME`, or bring it up to date; returns its interpreter.

    Nothing is done if the lists of requirements have not changed; else the module `imported` must load.
    """
    lists = [ROOT / f"scripts/requirements-{part}.txt" for part in requirements]
    stamp = STATE / f"{name}.stamp"
    wanted = digest(lists, os.path.realpath(python), platform.machine())
    own = STATE / name / ("Scripts/python.exe" if os.name == "nt" else "bin/python")
    if is_current(stamp, wanted) and own.exists():
        return own
    stamp.unlink(missing_ok=True)
    run([python, "-m", "venv", "--clear", STATE / name], f"environment {name}")
    install: list[str | Path] = [own, "-m", "pip", "install", "--disable-pip-version-check", "--quiet"]
    for path in lists:
        install += ["-r", path]
    run(install, f"packages of {name}")
    run([own, "-c", f"import {imported}"], f"import of {imported} in {name}", quiet=True)
    stamp.write_text(wanted, encoding="utf-8")
    return own


def make_environment(version: str, python: str, with_build_tools: bool) -> None:
    """Create the environment of one Python, or bring it up to date."""
    name = environment_python(version).parents[1].name
    fill_environment(name, python, [name, "test", *(["build"] if with_build_tools else [])], "bpy")


def main(arguments: list[str]) -> int:
    """Check, set up, and run the script that is named."""
    pythons = find_pythons()
    lacks = missing(pythons)
    if lacks:
        stop("this machine lacks " + "; and ".join(lacks))
    STATE.mkdir(exist_ok=True)
    for version, python in pythons.items():
        make_environment(version, python, with_build_tools=version == next(iter(pythons)))
    if not arguments:
        return 0
    os.environ["RIDGEFORM_VERSIONS"] = " ".join(pythons)
    os.environ["PYTHONPATH"] = python_path()
    first = environment_python(next(iter(pythons)))
    return subprocess.run([str(first), *arguments], cwd=str(ROOT), check=False).returncode


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
