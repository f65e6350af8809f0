"""Set the version everywhere: `python scripts/set_version.py 0.2.0`. Without an argument, print the version.

It is decided in Cargo.toml. The name of the native module repeats it (see rust/python/ridgeform/_native.py),
and so does CITATION.cff.
"""

import re
import subprocess
import sys

from workspace import ROOT, stop, version

PLACES = {
    "Cargo.toml": r'(?<=\n\[workspace\.package\]\nversion = ")[^"]+',
    "CITATION.cff": r"(?<=\nversion: )\S+",
    "pyproject.toml": r'(?<=\nmodule-name = "ridgeform\.)_native_\w+',
    "rust/python/src/lib.rs": r'(?<=#\[pyo3\(name = ")_native_\w+',
    "rust/python/ridgeform/_native.py": r"(?<=\nfrom \.)_native_\w+",
}
"""Files, and what in them is the version or the name of the native module."""


def native_name(number: str) -> str:
    """The native module's name in a version."""
    return "_native_" + re.sub(r"\W", "_", number)


def places() -> dict[str, str]:
    """What each place says now."""
    said = {}
    for name, pattern in PLACES.items():
        found = re.findall(pattern, (ROOT / name).read_text(encoding="utf-8"))
        if len(found) != 1:
            stop(f"{name} names the version {len(found)} times, not once")
        said[name] = found[0]
    return said


def expected(number: str) -> dict[str, str]:
    """What each place has to say in a version."""
    return {name: native_name(number) if "_native" in pattern else number for name, pattern in PLACES.items()}


def set_version(number: str) -> None:
    """Write a version into all places, and into the lock file."""
    if not re.fullmatch(r"\d+\.\d+\.\d+(-[0-9A-Za-z.-]+)?", number):
        stop(f"{number} is not a version like 0.2.0")
    places()
    for name, text in expected(number).items():
        path = ROOT / name
        new = re.sub(PLACES[name], lambda _, text=text: text, path.read_text(encoding="utf-8"))
        path.write_text(new, encoding="utf-8")
    subprocess.run(["cargo", "update", "--workspace", "--offline", "--quiet"], cwd=ROOT, check=True)


if __name__ == "__main__":
    if len(sys.argv) > 1:
        set_version(sys.argv[1])
    print(version())
