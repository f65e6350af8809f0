"""Check wheels and extension zips without running them, those of other platforms too.

    python scripts/check_package.py FILE ...

A wheel must hold one native module for the platform of its tag, the stubs, the licenses, and a list of its
parts (SBOM); a zip must name the wheels that it holds, each for its platform.
"""

import io
import re
import sys
import tomllib
import zipfile
from pathlib import Path

from set_version import native_name
from workspace import version

TAGS = {
    "linux-x64": r"manylinux_2_28_x86_64",
    "windows-x64": r"win_amd64",
    "windows-arm64": r"win_arm64",
    "macos-x64": r"macosx_1[01]_\d+_x86_64",
    "macos-arm64": r"macosx_11_0_arm64",
}
"""The tag of our wheel for each of Blender's platforms."""

ABI = "cp311-abi3"
MACHINES = {
    0x3E: "x64",
    0x8664: "x64",
    0x01000007: "x64",
    0xAA64: "arm64",
    0xB7: "arm64",
    0x0100000C: "arm64",
}
"""Numbers of machines in the headers of ELF, PE, and Mach-O files."""


def platform_of_native(data: bytes) -> str:
    """Blender's name of the platform that a shared library is for, from its header; '' if it is none."""
    if data[:4] == b"\x7fELF":
        system, machine = "linux", int.from_bytes(data[18:20], "little")
    elif data[:4] == b"\xcf\xfa\xed\xfe":
        system, machine = "macos", int.from_bytes(data[4:8], "little")
    elif data[:2] == b"MZ":
        begin = int.from_bytes(data[0x3C:0x40], "little")
        if data[begin : begin + 4] != b"PE\0\0":
            return ""
        system, machine = "windows", int.from_bytes(data[begin + 4 : begin + 6], "little")
    else:
        return ""
    return f"{system}-{MACHINES.get(machine, '?')}"


def platform_of_wheel(name: str) -> str:
    """Blender's name of the platform that a wheel of Ridgeform is tagged for; '' if it is none."""
    tag = name.removesuffix(".whl").split("-")[-1]
    return next((target for target, pattern in TAGS.items() if re.fullmatch(pattern, tag)), "")


def faults_of_wheel(name: str, data: bytes) -> list[str]:
    """What is wrong with a wheel of Ridgeform."""
    faults = []
    target = platform_of_wheel(name)
    if not target:
        faults.append("its tag is of none of the platforms")
    if not re.match(rf"ridgeform-{re.escape(version())}(\+[0-9a-f]+)?-{ABI}-", name):
        faults.append(f"it is not named ridgeform-{version()}-{ABI}-…")
    with zipfile.ZipFile(io.BytesIO(data)) as wheel:
        names = wheel.namelist()
        native = [entry for entry in names if entry.endswith((".so", ".pyd"))]
        if [Path(entry).name.split(".")[0] for entry in native] != [native_name(version())]:
            faults.append(f"its native modules are {native}, not {native_name(version())} alone")
        elif (found := platform_of_native(wheel.read(native[0])[:4096])) != target:
            faults.append(f"its native module is for {found or 'no platform'}, its tag for {target}")
    for wanted in (
        r"ridgeform/_classes\.pyi",
        r"ridgeform/_native\.pyi",
        r"ridgeform/py\.typed",
        r".+/licenses/rust/LICENSE-MIT",
        r".+/licenses/rust/LICENSE-APACHE",
        r".+/licenses/rust/THIRD-PARTY-NOTICES\.txt",
        r".+/sboms/.+\.cyclonedx\.json",
    ):
        if not any(re.fullmatch(wanted, entry) for entry in names):
            faults.append(f"it has no {wanted}")
    return faults


def faults_of_zip(name: str, data: bytes) -> list[str]:
    """What is wrong with an extension zip, and with the wheel of Ridgeform in it."""
    faults = []
    with zipfile.ZipFile(io.BytesIO(data)) as package:
        names = package.namelist()
        manifest = tomllib.loads(package.read("blender_manifest.toml").decode())
        held = {f"./{entry}" for entry in names if entry.endswith(".whl")}
        named = set(manifest.get("wheels", []))
        if held != named:
            faults.append(f"it holds {sorted(held)}, its manifest names {sorted(named)}")
        if manifest.get("version") != version():
            faults.append(f"its manifest is of version {manifest.get('version')}")
        platforms = manifest.get("platforms", [])
        own = [
            entry for entry in names if Path(entry).name.startswith("ridgeform-") and entry.endswith(".whl")
        ]
        if [platform_of_wheel(Path(entry).name) for entry in own] != platforms or len(own) != 1:
            faults.append(f"it is for {platforms} and holds {own}")
        if not any(name.endswith(f"-{target.replace('-', '_')}.zip") for target in platforms):
            faults.append(f"it is for {platforms}, which its name does not say")
        for entry in own:
            faults += [
                f"{entry}: {fault}" for fault in faults_of_wheel(Path(entry).name, package.read(entry))
            ]
    return faults


def check(path: Path) -> list[str]:
    """What is wrong with a wheel or a zip."""
    faults_of = faults_of_wheel if path.suffix == ".whl" else faults_of_zip
    return [f"{path.name}: {fault}" for fault in faults_of(path.name, path.read_bytes())]


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    found = [fault for name in sys.argv[1:] for fault in check(Path(name))]
    print("\n".join(found) or f"{len(sys.argv) - 1} packages are sound")
    sys.exit(1 if found else 0)
