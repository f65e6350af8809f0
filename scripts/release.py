"""Collect a release in `out/release/`: all that is uploaded, checked, with checksums.

    python scripts/setup_env.py scripts/release.py [--wheels FOLDER] [--tag v0.1.0]

Wheels (built here, or all of FOLDER, built elsewhere), the source distribution, an extension zip for each
platform, the index of an extension repository, the licenses of all parts, a list of the parts of each wheel
(SBOM), and SHA256SUMS. With --tag, stops unless the tag, the changelog, and CITATION.cff agree on it.
"""

import argparse
import hashlib
import json
import re
import shutil
import sys
import zipfile
from pathlib import Path

from build_extension import PLATFORMS, blender_tools, build_extension
from build_wheel import build_wheel
from check_package import check, platform_of_wheel
from notices import NOTICES
from set_version import expected, places
from workspace import OUT, ROOT, STATE, run, stop, version

RELEASE = OUT / "release"


def faults_of_version(tag: str) -> list[str]:
    """Where the tag, the changelog, and the places that repeat the version do not agree."""
    faults = []
    if tag != f"v{version()}":
        faults.append(f"the tag is {tag}, the version {version()}")
    if not re.search(rf"^## \[{re.escape(version())}\]", (ROOT / "CHANGELOG.md").read_text("utf-8"), re.M):
        faults.append(f"CHANGELOG.md has no section [{version()}]")
    said = places()
    return faults + [f"{n} says {said[n]}" for n, wanted in expected(version()).items() if said[n] != wanted]


def parts_list(wheel: Path) -> bytes:
    """The SBOM (CycloneDX) of a wheel, without the folder in which it was built."""
    with zipfile.ZipFile(wheel) as archive:
        (name,) = [entry for entry in archive.namelist() if entry.endswith(".cyclonedx.json")]
        text = archive.read(name).decode()
    text = re.sub(r"path\+file://[^\"#]*?/(rust/[^\"#]*#)", r"path+file:///ridgeform/\1", text)
    json.loads(text)
    return text.encode()


def checksums(folder: Path) -> str:
    """Lines as `sha256sum --check` reads them, for all files of a folder."""
    files = sorted(path for path in folder.iterdir() if path.is_file() and path.name != "SHA256SUMS")
    return "".join(f"{hashlib.sha256(path.read_bytes()).hexdigest()}  {path.name}\n" for path in files)


def collect(wheels: list[Path]) -> None:
    """Fill the folder of the release."""
    shutil.rmtree(RELEASE, ignore_errors=True)
    RELEASE.mkdir(parents=True)
    for wheel in wheels:
        shutil.copy2(wheel, RELEASE)
        name = f"ridgeform-{version()}-{platform_of_wheel(wheel.name)}.cyclonedx.json"
        (RELEASE / name).write_bytes(parts_list(wheel))
    run([sys.executable, "-m", "maturin", "sdist", "--out", RELEASE], "source distribution", quiet=True)
    for_blender = STATE / "release-wheels"
    shutil.rmtree(for_blender, ignore_errors=True)
    for_blender.mkdir(parents=True)
    for wheel in wheels:
        # Packages that the extension needs have no wheels for the other platforms.
        if platform_of_wheel(wheel.name) in PLATFORMS:
            shutil.copy2(wheel, for_blender)
    for package in build_extension(for_blender):
        shutil.copy2(package, RELEASE)
    python, tool, _ = blender_tools()[0]
    run([python, tool, "server-generate", "--repo-dir", RELEASE], "index of extensions", quiet=True)
    listed = json.loads((RELEASE / "index.json").read_text(encoding="utf-8"))["data"]
    packages = sorted(path.name for path in RELEASE.glob("*.zip"))
    if sorted(Path(entry["archive_url"]).name for entry in listed) != packages:
        stop(f"the index of extensions does not list {', '.join(packages)}")
    shutil.copy2(NOTICES, RELEASE)
    (RELEASE / "SHA256SUMS").write_text(checksums(RELEASE), encoding="utf-8")


def main() -> None:
    """Check the version, collect, check what was collected, and list it."""
    parser = argparse.ArgumentParser(description="Collect a release in out/release/.")
    parser.add_argument("--wheels", type=Path, help="folder with wheels built elsewhere")
    parser.add_argument("--tag", help="the tag that is released, as v0.1.0")
    arguments = parser.parse_args()
    if arguments.tag and (faults := faults_of_version(arguments.tag)):
        stop("; ".join(faults))
    wheels = [build_wheel()] if arguments.wheels is None else sorted(arguments.wheels.glob("ridgeform-*.whl"))
    if not wheels:
        stop(f"{arguments.wheels} holds no wheel of Ridgeform")
    if faults := [fault for wheel in wheels for fault in check(wheel)]:
        stop("; ".join(faults))
    collect(wheels)
    if faults := [fault for package in RELEASE.glob("*.zip") for fault in check(package)]:
        stop("; ".join(faults))
    for path in sorted(RELEASE.iterdir()):
        print(f"{path.stat().st_size / 1e6:8.2f} MB  {path.name}")


if __name__ == "__main__":
    main()
