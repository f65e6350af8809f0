"""What is in the zip: all that Blender and the extensions platform ask for, nothing that they refuse."""

import os
import re
import tomllib
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
REFUSED = {
    "sys.path": "changes the module search path",
    "sys.modules": "reaches into loaded modules",
    "urllib.request": "goes to the network",
    # Not the bare word: nodes have sockets too.
    "import socket": "goes to the network",
    "from socket": "goes to the network",
    "subprocess": "starts other programs",
    "eval(": "runs text as code",
    "exec(": "runs text as code",
    # Blender 4.2 then writes the scene into the context itself, and refers to it when it is gone:
    # the glTF exporter crashes on the next file.
    "context.tool_settings": "reads the tool settings of the context instead of those of the scene",
}
ALLOWED = {("overnight/", "subprocess"), ("overnight/", "sys.path")}
"""The batch command starts Blender itself, where it is asked for processes side by side; where Blender is a
module of Python, the new process is told where this one found it."""


@pytest.fixture(scope="module")
def package(extension_zip):
    """The open zip."""
    with zipfile.ZipFile(extension_zip) as archive:
        yield archive


@pytest.fixture(scope="module")
def manifest(package):
    """The manifest in the zip, with what building for one platform added to it."""
    written = tomllib.loads(package.read("blender_manifest.toml").decode())
    return written | written["build"]["generated"]


def test_version_is_that_of_the_workspace(manifest, extension_zip):
    cargo = tomllib.loads((ROOT / "Cargo.toml").read_text(encoding="utf-8"))
    version = cargo["workspace"]["package"]["version"]
    assert manifest["version"] == version
    assert version in extension_zip.name


def test_tagline_as_the_platform_wants_it(manifest):
    assert len(manifest["tagline"]) <= 64
    assert not manifest["tagline"].endswith(".")


def test_permissions_have_short_reasons(manifest):
    assert set(manifest["permissions"]) == {"files"}
    assert all(0 < len(why) <= 64 and not why.endswith(".") for why in manifest["permissions"].values())


def test_wheels_listed_are_wheels_packed(manifest, package):
    packed = {f"./{name}" for name in package.namelist() if name.endswith(".whl")}
    assert set(manifest["wheels"]) == packed


@pytest.mark.parametrize("python", ["cp311", "cp313", "cp314"])
def test_every_module_has_a_wheel_for_every_blender(manifest, python):
    for module, fitting in {
        "ridgeform": "cp311-abi3",
        "fast_simplification": f"{python}-{python}",
        "tqdm": "py3-none",
    }.items():
        assert any(f"/{module}-" in wheel and fitting in wheel for wheel in manifest["wheels"]), module


def test_native_module_asks_for_no_newer_glibc_than_blender(package):
    wheels = [name for name in package.namelist() if name.startswith("wheels/ridgeform-")]
    assert len(wheels) == 1
    with package.open(wheels[0]) as stream, zipfile.ZipFile(stream) as wheel:
        (native,) = [name for name in wheel.namelist() if name.endswith(".so")]
        asked = re.findall(rb"GLIBC_2\.(\d+)", wheel.read(native))
    assert asked
    assert max(map(int, asked)) <= 28


def test_only_sources_license_manifest_manual_and_wheels(package):
    names = [name for name in package.namelist() if not name.endswith("/")]
    assert "LICENSE" in names
    odd = [
        name
        for name in names
        if not re.search(
            r"\.(py|whl)$|^LICENSE$|^(blender_manifest|check/kinds)\.toml$|^THIRD-PARTY-NOTICES\.txt$|"
            r"^help/\w+\.html$",
            name,
        )
    ]
    assert not odd


def test_notices_of_all_that_is_packed(package):
    said = package.read("THIRD-PARTY-NOTICES.txt").decode()
    for name in package.namelist():
        if name.endswith(".whl") and "/ridgeform-" not in name:
            project, version = Path(name).name.split("-")[:2]
            assert f"\n{project} {version}\n" in said
    (own,) = (name for name in package.namelist() if "/ridgeform-" in name)
    with package.open(own) as stream, zipfile.ZipFile(stream) as wheel:
        (inside,) = (name for name in wheel.namelist() if name.endswith("THIRD-PARTY-NOTICES.txt"))
        linked = wheel.read(inside).decode().strip()
    assert linked in said
    for crate in ("clarabel 0.", "faer 0.", "numpy 0.", "pyo3 0."):
        assert f"\n{crate}" in linked


def test_every_source_names_its_license_and_breaks_no_rule(package):
    sources = [name for name in package.namelist() if name.endswith(".py")]
    assert sources
    for name in sources:
        text = package.read(name).decode()
        assert text.startswith("# SPDX-License-Identifier: GPL-3.0-or-later"), name
        for word, why in REFUSED.items():
            if not any(name.startswith(folder) and word == known for folder, known in ALLOWED):
                assert word not in text, f"{name} {why}"


def test_the_website_is_the_repository_that_built_it(manifest):
    server, name = os.environ.get("GITHUB_SERVER_URL"), os.environ.get("GITHUB_REPOSITORY")
    assert manifest.get("website") == (f"{server}/{name}" if server and name else None)
