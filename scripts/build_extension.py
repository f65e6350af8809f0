"""Build the extension: one zip for each platform, checked with Blender's own tool.

    python scripts/setup_env.py scripts/build_extension.py [--wheels FOLDER]

Takes the wheel built here, or all wheels of Ridgeform in FOLDER (built elsewhere, for other platforms too).
The wheels of requirements-extension.txt are added for every Python and platform. Zips go to
`.ridgeform/extension/`.
"""

import argparse
import json
import os
import platform
import shutil
import subprocess
import sys
from pathlib import Path

import help_pages
import stamped_wheel
from build_wheel import build_wheel
from notices import NOTICES, extension_notices
from setup_env import environments
from workspace import ROOT, STATE, digest, files_in, is_current, run, stop, version

EXTENSION = STATE / "extension"
STAGE = STATE / "stage"
BUNDLED = STATE / "bundled-wheels"
BUNDLED_LIST = ROOT / "scripts/requirements-extension.txt"

PYTHON_TAGS = ("311", "313", "314")
"""Pythons of Blender 4.2 to 5.1, of the bpy package of 5.2, and of Blender 5.2 itself."""

PLATFORMS = {
    "linux-x64": ("manylinux_2_28_x86_64", "manylinux_2_24_x86_64", "manylinux2014_x86_64"),
    "windows-x64": ("win_amd64",),
    "macos-arm64": ("macosx_11_0_arm64",),
    "macos-x64": ("macosx_11_0_x86_64",),
}
"""Blender's platforms, and the newest wheel tags that run there (pip adds older ones of macOS)."""


def target_of(wheel: Path) -> str:
    """Blender's name of the platform that a wheel of Ridgeform is for."""
    tag = wheel.stem.split("-")[-1]
    for target, (newest, *_) in PLATFORMS.items():
        system, machine = newest.split("_")[0], newest.split("_", 3)[-1]
        if tag.startswith(system) and tag.endswith(machine):
            return target
    stop(f"{wheel.name} is for none of the platforms {', '.join(PLATFORMS)}")


def extension_here(built: list[Path]) -> Path:
    """The one of the zips that is for this machine."""
    system = {"linux": "linux", "win32": "windows", "darwin": "macos"}.get(sys.platform, sys.platform)
    name = f"-{system}_{'arm64' if platform.machine().lower() in {'arm64', 'aarch64'} else 'x64'}.zip"
    for path in built:
        if path.name.endswith(name):
            return path
    stop(f"no extension was built for this machine: {', '.join(path.name for path in built)}")


def bundled_wheels(target: str) -> list[Path]:
    """The wheels of other packages for a target, downloaded once."""
    folder = BUNDLED / target
    stamp = BUNDLED / f"{target}.stamp"
    wanted = digest([BUNDLED_LIST], target, *PYTHON_TAGS, *PLATFORMS[target])
    if not is_current(stamp, wanted):
        shutil.rmtree(folder, ignore_errors=True)
        for tag in PYTHON_TAGS:
            command = [sys.executable, "-m", "pip", "download", "--disable-pip-version-check", "--quiet"]
            command += ["--no-deps", "--only-binary=:all:", "--dest", folder, "-r", BUNDLED_LIST]
            command += [
                "--implementation",
                "cp",
                "--python-version",
                tag,
                "--abi",
                f"cp{tag}",
                "--abi",
                "none",
            ]
            for name in PLATFORMS[target]:
                command += ["--platform", name]
            run(command, f"bundled wheels for Python {tag[0]}.{tag[1:]} on {target}")
        stamp.write_text(wanted, encoding="utf-8")
    return sorted(folder.glob("*.whl"))


def stage(wheels: list[Path], targets: list[str]) -> None:
    """Lay out the extension's folder: the add-on, the wheels, the manifest with its gaps filled."""
    shutil.rmtree(STAGE, ignore_errors=True)
    shutil.copytree(ROOT / "addon", STAGE, ignore=shutil.ignore_patterns("__pycache__"))
    (STAGE / "wheels").mkdir()
    for wheel in wheels:
        if wheel.name.startswith("ridgeform-"):
            stamped_wheel.stamped(wheel, STAGE / "wheels")
        else:
            shutil.copy2(wheel, STAGE / "wheels")
    (STAGE / NOTICES.name).write_text(extension_notices(wheels), encoding="utf-8")
    help_pages.write_help(STAGE / "help")
    names = sorted(f"./wheels/{wheel.name}" for wheel in (STAGE / "wheels").glob("*.whl"))
    manifest = STAGE / "blender_manifest.toml"
    text = manifest.read_text(encoding="utf-8")
    # A list of plain strings is written the same in JSON and in TOML.
    address = website()
    if address is None:
        text = text.replace('website = "@WEBSITE@"\n', "")
    else:
        text = text.replace("@WEBSITE@", address)
    for gap, filling in (("VERSION", version()), ("PLATFORMS", targets), ("WHEELS", names)):
        if f'"@{gap}@"' not in text:
            stop(f'addon/blender_manifest.toml has no "@{gap}@" to fill in')
        text = text.replace(
            f'"@{gap}@"', json.dumps(filling, indent=4 if isinstance(filling, list) else None)
        )
    manifest.write_text(text, encoding="utf-8")


def website() -> str | None:
    """The address of the repository that builds this in its workflows; `None` elsewhere."""
    server, name = os.environ.get("GITHUB_SERVER_URL"), os.environ.get("GITHUB_REPOSITORY")
    return f"{server}/{name}" if server and name else None


def blender_tools() -> list[tuple[Path, Path, Path]]:
    """For every Blender here: its Python, its `blender_ext.py`, and its list of valid tags."""
    found = []
    for python in environments().values():
        code = "import bpy; print(bpy.utils.system_resource('SCRIPTS'))"
        answer = subprocess.run([python, "-c", code], stdout=subprocess.PIPE, check=True, text=True)
        scripts = Path(answer.stdout.strip().splitlines()[-1])
        tool = scripts / "addons_core/bl_pkg/cli/blender_ext.py"
        found.append((python, tool, scripts / "modules/_bpy_internal/extensions/tags.py"))
    return found


def build_extension(wheels_folder: Path | None = None) -> list[Path]:
    """Build and validate the zips, or find them built; returns their paths."""
    own = (
        [build_wheel()]
        if wheels_folder is None
        else sorted(wheels_folder.glob(f"ridgeform-{version()}-*.whl"))
    )
    if not own:
        stop(f"{wheels_folder} holds no wheel of Ridgeform {version()}")
    targets = sorted({target_of(wheel) for wheel in own})
    wheels = own + [wheel for target in targets for wheel in bundled_wheels(target)]
    stamp = STATE / "extension.stamp"
    pages = sorted((ROOT / "docs").glob("manual*.md"))
    scripts = [Path(module) for module in (__file__, help_pages.__file__, stamped_wheel.__file__)]
    wanted = digest(
        [*files_in(ROOT / "addon"), NOTICES, *pages, *wheels, *scripts], version(), website() or ""
    )
    built = sorted(EXTENSION.glob("*.zip"))
    if is_current(stamp, wanted) and built:
        return built
    stamp.unlink(missing_ok=True)
    stage(wheels, targets)
    shutil.rmtree(EXTENSION, ignore_errors=True)
    EXTENSION.mkdir(parents=True)
    tools = blender_tools()
    python, tool, tags = tools[0]
    command = [python, tool, "build", "--source-dir", STAGE, "--output-dir", EXTENSION, "--split-platforms"]
    run([*command, "--valid-tags", tags], "extension", quiet=True)
    built = sorted(EXTENSION.glob("*.zip"))
    if len(built) != len(targets):
        stop(f"{len(built)} extension files were built for {len(targets)} targets")
    for path in built:
        for python, tool, tags in tools:
            run([python, tool, "validate", "--valid-tags", tags, path], f"check of {path.name}", quiet=True)
    stamp.write_text(wanted, encoding="utf-8")
    return built


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description="Build the extension.")
    parser.add_argument("--wheels", type=Path, help="folder with wheels built elsewhere")
    for path in build_extension(parser.parse_args().wheels):
        print(path.relative_to(ROOT))
