"""Measure what installing and importing costs: the table of docs/sizes.md.

    python scripts/setup_env.py scripts/sizes.py

Sizes of the wheel and the zip built here, unpacked too, and the time to import the package after NumPy, in a
fresh process: the shortest of nine.
"""

import platform
import subprocess
import zipfile
from pathlib import Path

from build_extension import build_extension, extension_here
from build_wheel import build_wheel
from setup_env import environments
from workspace import ROOT, WHEEL_SITE

PAGE = ROOT / "docs/sizes.md"
BEGIN, END = "<!-- sizes:begin -->\n", "<!-- sizes:end -->"
RUNS = 9
IMPORT = """
import sys, time
sys.path.insert(0, sys.argv[1])
import numpy
begin = time.perf_counter()
import ridgeform
print(time.perf_counter() - begin)
"""


def megabytes(count: int) -> str:
    """A size as a person reads it."""
    return f"{count / 1e6:.1f} MB"


def unpacked(archive: Path) -> dict[str, int]:
    """Bytes of the files in an archive, by name."""
    with zipfile.ZipFile(archive) as opened:
        return {entry.filename: entry.file_size for entry in opened.infolist()}


def import_time(python: Path) -> float:
    """Seconds that `import ridgeform` takes once NumPy is loaded, the shortest of fresh processes."""
    command = [python, "-c", IMPORT, WHEEL_SITE]
    times = [
        float(subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout)
        for _ in range(RUNS)
    ]
    return min(times)


def main() -> None:
    """Measure, and write the table into the page."""
    wheel, extension = build_wheel(), extension_here(build_extension())
    inside = unpacked(wheel)
    native = sum(size for name, size in inside.items() if name.endswith((".so", ".pyd")))
    wheels = sum(size for name, size in unpacked(extension).items() if name.endswith(".whl"))
    rows = {
        "wheel": megabytes(wheel.stat().st_size),
        "wheel, unpacked": megabytes(sum(inside.values())),
        "the native module in it": megabytes(native),
        "extension zip": megabytes(extension.stat().st_size),
        "wheels in it": megabytes(wheels),
    }
    for version, python in environments().items():
        rows[f"`import ridgeform` after NumPy, Python {version}"] = f"{1000 * import_time(python):.0f} ms"
    table = f"| {platform.system()}, {platform.machine()} | |\n|---|---:|\n"
    table += "".join(f"| {name} | {value} |\n" for name, value in rows.items())
    print(table)
    before, rest = PAGE.read_text(encoding="utf-8").split(BEGIN)
    PAGE.write_text(before + BEGIN + table + END + rest.split(END)[1], encoding="utf-8")


if __name__ == "__main__":
    main()
