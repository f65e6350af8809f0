"""The extension in every Blender that is supported and has a bpy package, installed as a user installs it.

    python scripts/setup_env.py scripts/test_all_blenders.py [--zip FILE] [PYTEST ARGUMENTS]

Blender 4.2 and 5.2 use the environments of the other tests; 4.5 and 5.0 get their own on the first run. A
Blender whose Python is not found is an error: all means all.
"""

import argparse
from pathlib import Path

from build_extension import build_extension, extension_here
from setup_env import environments, fill_environment
from workspace import run_all, stop

BLENDERS = {
    "4.2 LTS": ("3.11", ""),
    "4.5 LTS": ("3.11", "blender45"),
    "5.0": ("3.11", "blender50"),
    "5.2 LTS": ("3.13", ""),
}
"""Blender → its Python, and the list of requirements of an environment of its own."""


def main() -> None:
    """Build the extension or take the one given, and test it in every Blender."""
    parser = argparse.ArgumentParser(description="Test the extension in every supported Blender.")
    parser.add_argument("--zip", type=Path, help="an extension built before")
    options, arguments = parser.parse_known_args()
    found = environments()
    lacking = sorted({python for python, _ in BLENDERS.values()} - set(found))
    if lacking:
        stop(f"all Blenders need Python {' and '.join(lacking)} as well")
    extension = options.zip.resolve() if options.zip else extension_here(build_extension())
    parts = {}
    for blender, (version, own) in BLENDERS.items():
        python = fill_environment(own, str(found[version]), [own, "test"], "bpy") if own else found[version]
        parts[f"extension in Blender {blender}"] = (
            [python, "-m", "pytest", "-q", *(arguments or ["tests/blender"])],
            {"RIDGEFORM_EXTENSION": str(extension), "PYTHONPATH": ""},
        )
    run_all(parts)


if __name__ == "__main__":
    main()
