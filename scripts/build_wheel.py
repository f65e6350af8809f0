"""Build the wheel of the native module, once for all Pythons from 3.11 on, if its sources have changed.

    python scripts/setup_env.py scripts/build_wheel.py

The wheel goes to `.ridgeform/wheels/`, and unpacked to `.ridgeform/wheel-site/` for tests without Blender.
"""

import os
import shutil
import sys
import zipfile
from pathlib import Path

from workspace import ROOT, STATE, WHEEL_SITE, digest, files_in, is_current, run, stop, version

WHEELS = STATE / "wheels"


def sources() -> list[Path]:
    """Everything that decides what is in the wheel."""
    crates = [
        path
        for path in files_in(ROOT / "rust")
        if not {"tests", "benches", "examples"} & set(path.relative_to(ROOT).parts)
    ]
    tops = ["Cargo.toml", "Cargo.lock", "pyproject.toml", "scripts/zig_link.sh", "scripts/build_wheel.py"]
    return crates + [ROOT / name for name in tops]


def build_wheel() -> Path:
    """Build the wheel, or find it built; returns its path."""
    stamp = STATE / "wheel.stamp"
    wanted = digest(sources(), sys.version)
    built = sorted(WHEELS.glob(f"ridgeform-{version()}-*.whl"))
    if is_current(stamp, wanted) and len(built) == 1:
        return built[0]
    stamp.unlink(missing_ok=True)
    shutil.rmtree(WHEELS, ignore_errors=True)
    command = [sys.executable, "-m", "maturin", "build", "--release", "--locked", "--quiet"]
    command += ["--interpreter", sys.executable, "--out", WHEELS]
    if sys.platform.startswith("linux"):
        # Blender runs on glibc 2.28 and later.
        link = ROOT / "scripts/zig_link.sh"
        command += [
            "--compatibility",
            "manylinux_2_28",
            "--",
            "-C",
            f"linker={link}",
            "-C",
            "linker-flavor=gcc",
        ]
    cache = os.environ.get("ZIG_GLOBAL_CACHE_DIR", str(STATE / "zig-cache"))
    run(command, "wheel", {"RIDGEFORM_ZIG_PYTHON": sys.executable, "ZIG_GLOBAL_CACHE_DIR": cache})
    built = sorted(WHEELS.glob(f"ridgeform-{version()}-*.whl"))
    if len(built) != 1:
        stop(f"maturin left {len(built)} wheels of version {version()} in {WHEELS}, not one")
    shutil.rmtree(WHEEL_SITE, ignore_errors=True)
    with zipfile.ZipFile(built[0]) as wheel:
        wheel.extractall(WHEEL_SITE)
    stamp.write_text(wanted, encoding="utf-8")
    return built[0]


if __name__ == "__main__":
    print(build_wheel().relative_to(ROOT))
