"""All tests: the Rust core, the wheel without Blender, and the extension installed in every Blender here.

python scripts/setup_env.py scripts/run_tests.py [PYTEST ARGUMENTS]
"""

import sys

from build_extension import build_extension, extension_here
from setup_env import PYTHONS, environments
from workspace import ROOT, WHEEL_SITE, run


def main(arguments: list[str]) -> None:
    """Build what is tested, and test it; ends with the first part that fails."""
    here = extension_here(build_extension())
    for version, python in environments().items():
        pytest = [python, "-m", "pytest", "-q", *arguments]
        plain = {"PYTHONPATH": str(WHEEL_SITE)}
        run(
            [*pytest, "tests/core_api", *sorted((ROOT / "tests").glob("test_*.py"))],
            f"wheel in Python {version}",
            plain,
        )
        blender = {"RIDGEFORM_EXTENSION": str(here), "PYTHONPATH": ""}
        run([*pytest, "tests/blender"], f"extension in Blender {PYTHONS[version]}", blender)
    run(["cargo", "test", "--release", "--locked", "--quiet"], "Rust tests", {"PYO3_PYTHON": sys.executable})


if __name__ == "__main__":
    main(sys.argv[1:])
