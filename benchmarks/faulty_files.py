"""Files under every fault, by the tests, as the table of docs/reliability.md.

python scripts/setup_env.py benchmarks/faulty_files.py
"""

import os
import subprocess
import sys
import xml.etree.ElementTree as ET
from pathlib import Path

from build_extension import build_extension, extension_here
from reliability_page import write_section
from setup_env import PYTHONS, environments
from workspace import OUT, ROOT

FAULTS = {
    "test_a_full_disk_leaves_what_was_there[{}-disk]": "full disk",
    "test_a_full_disk_leaves_what_was_there[{}-file size]": "limit on file sizes",
    "test_a_read_only_folder_stays_as_it_was[{}]": "read-only folder",
    "test_a_folder_that_vanishes_while_writing[{}]": "folder vanishes",
    "test_every_file_that_is_cut_is_noticed[{}]": "cut file noticed",
    "test_every_format_is_read_and_written[{}]": "written and read again",
}
"""What is tested for each format, by the names of the tests."""
FORMATS = (".blend", ".obj", ".ply", ".stl", ".glb", ".gltf", ".fbx", ".usd", ".usda", ".usdc", ".usdz")


def outcomes(python: Path, extension: Path, report: Path) -> dict[str, bool]:
    """Which tests there are, and whether they passed."""
    tests = sorted((ROOT / "tests/blender").glob("test_batch*.py"))
    command = [python, "-m", "pytest", "-q", f"--junitxml={report}", *tests]
    environment = {"RIDGEFORM_EXTENSION": str(extension), "PYTHONPATH": ""}
    subprocess.run(list(map(str, command)), cwd=ROOT, env=os.environ | environment, check=False)
    # Written by the line above.
    cases = ET.parse(report).getroot().iter("testcase")
    return {case.get("name"): case.find("failure") is None and case.find("error") is None for case in cases}


def table(found: dict[str, dict[str, bool]]) -> str:
    """The outcomes by format and fault, in all Blenders."""
    rows = ["| format | " + " | ".join(FAULTS.values()) + " |", "|---" * (len(FAULTS) + 1) + "|"]
    for suffix in FORMATS:
        cells = []
        for test in FAULTS:
            passed = [version for version, cases in found.items() if cases[test.format(suffix)]]
            cells.append("yes" if len(passed) == len(found) else f"only in {', '.join(passed) or 'none'}")
        rows.append(f"| {suffix} | " + " | ".join(cells) + " |")
    return f"In Blender {' and '.join(found)}.\n\n" + "\n".join(rows)


def main() -> None:
    """Run the tests, and write the table."""
    OUT.mkdir(exist_ok=True)
    extension = extension_here(build_extension())
    found = {
        PYTHONS[version]: outcomes(python, extension, OUT / f"files-{version}.xml")
        for version, python in environments().items()
    }
    text = table(found)
    write_section("files", text)
    if "only in" in text:
        sys.exit(1)


if __name__ == "__main__":
    main()
