"""The tests of batches and tiles on a Dask cluster, in an environment of their own: distributed is optional.

python scripts/setup_env.py scripts/test_dask.py [PYTEST ARGUMENTS]
"""

import sys

from build_extension import build_extension, extension_here
from build_wheel import build_wheel
from setup_env import PYTHONS, environment_python, environments, fill_environment
from workspace import WHEEL_SITE, run


def main(arguments: list[str]) -> None:
    """Make the environment for the oldest Python here, and run the tests in it."""
    version = next(iter(environments()))
    name = environment_python(version).parents[1].name
    python = fill_environment("dask", sys.executable, [name, "test", "dask"], "distributed")
    extension = extension_here(build_extension())
    run(
        [python, "-m", "pytest", "-q", *arguments, "tests/blender/test_dask.py"],
        f"Dask with Blender {PYTHONS[version]}",
        {"RIDGEFORM_EXTENSION": str(extension), "PYTHONPATH": ""},
    )
    build_wheel()
    run(
        [python, "-m", "pytest", "-q", *arguments, "tests/core_api/test_tiles_dask.py"],
        "tiles on Dask",
        {"PYTHONPATH": str(WHEEL_SITE)},
    )


if __name__ == "__main__":
    main(sys.argv[1:])
