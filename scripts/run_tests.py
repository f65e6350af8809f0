"""All tests: the Rust core, the wheel without Blender, and the extension installed in every Blender here.

python scripts/setup_env.py scripts/run_tests.py [PYTEST ARGUMENTS]
"""

import sys

from build_extension import build_extension, extension_here
from setup_env import PYTHONS, environments
from workspace import ROOT, WHEEL_SITE, run_all


def main(arguments: list[str]) -> None:
    """Build what is tested, and test all of it, even if a part fails."""
    extension = extension_here(build_extension())
    without_blender = ["tests/core_api", *sorted((ROOT / "tests").glob("test_*.py"))]
    parts = {}
    for version, python in environments().items():
        pytest = [python, "-m", "pytest", "-q", *arguments]
        parts[f"wheel in Python {version}"] = (
            [*pytest, *without_blender],
            {"PYTHONPATH": str(WHEEL_SITE)},
        )
        in_blender = {"RIDGEFORM_EXTENSION": str(extension), "PYTHONPATH": ""}
        parts[f"extension in Blender {PYTHONS[version]}"] = (
            [*pytest, "tests/blender"],
            in_blender,
        )
    parts["Rust tests"] = (
        ["cargo", "test", "--release", "--locked", "--quiet"],
        {"PYO3_PYTHON": sys.executable},
    )
    run_all(parts)


if __name__ == "__main__":
    main(sys.argv[1:])
