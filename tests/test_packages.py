"""Versions agree everywhere, and packages of any platform are checked by their tags and contents."""

import base64
import hashlib
import io
import zipfile

import check_package
import pytest
import release
import set_version
import stamped_wheel
from workspace import version

HEADERS = {
    "linux-x64": b"\x7fELF" + bytes(14) + b"\x3e\x00" + bytes(44),
    "windows-x64": b"MZ" + bytes(58) + b"\x40\x00\x00\x00PE\0\0\x64\x86",
    "windows-arm64": b"MZ" + bytes(58) + b"\x40\x00\x00\x00PE\0\0\x64\xaa",
    "macos-x64": b"\xcf\xfa\xed\xfe\x07\x00\x00\x01",
    "macos-arm64": b"\xcf\xfa\xed\xfe\x0c\x00\x00\x01",
}
TAGS = {
    "linux-x64": "manylinux_2_28_x86_64",
    "windows-x64": "win_amd64",
    "windows-arm64": "win_arm64",
    "macos-x64": "macosx_11_0_x86_64",
    "macos-arm64": "macosx_11_0_arm64",
}


def wheel(header, name=None, without=""):
    """The bytes of a wheel with a native module that is only a header."""
    suffix = "pyd" if header.startswith(b"MZ") else "abi3.so"
    info = f"ridgeform-{version()}.dist-info"
    files = {
        f"ridgeform/{name or set_version.native_name(version())}.{suffix}": header,
        "ridgeform/_classes.pyi": b"",
        "ridgeform/_native.pyi": b"",
        "ridgeform/py.typed": b"",
        f"{info}/licenses/rust/LICENSE-MIT": b"",
        f"{info}/licenses/rust/LICENSE-APACHE": b"",
        f"{info}/licenses/rust/THIRD-PARTY-NOTICES.txt": b"",
        f"{info}/sboms/ridgeform-python.cyclonedx.json": (
            b'{"a": "path+file:///home/me/ridgeform/rust/python#ridgeform-python@1"}'
        ),
    }
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w") as archive:
        for file, data in files.items():
            if not without or without not in file:
                archive.writestr(file, data)
    return packed.getvalue()


def test_the_version_is_the_same_everywhere():
    assert set_version.places() == set_version.expected(version())
    assert release.faults_of_version(f"v{version()}") == []
    (fault,) = release.faults_of_version("v99.0.0")
    assert "v99.0.0" in fault


def test_native_name_is_an_identifier():
    assert set_version.native_name("1.20.3-rc.1") == "_native_1_20_3_rc_1"


@pytest.mark.parametrize("platform", HEADERS)
def test_a_wheel_is_for_the_platform_of_its_tag(platform):
    name = f"ridgeform-{version()}-cp311-abi3-{TAGS[platform]}.whl"
    assert check_package.platform_of_wheel(name) == platform
    assert check_package.platform_of_native(HEADERS[platform]) == platform
    assert check_package.faults_of_wheel(name, wheel(HEADERS[platform])) == []
    other = next(header for header in HEADERS if header != platform)
    (fault,) = check_package.faults_of_wheel(name, wheel(HEADERS[other]))
    assert other in fault


@pytest.mark.parametrize(
    ("name", "packed", "said"),
    [
        ("cp312-abi3-win_amd64", {}, "not named"),
        ("cp311-abi3-manylinux_2_34_x86_64", {}, "none of the platforms"),
        ("cp311-abi3-win_amd64", {"without": "LICENSE-MIT"}, "LICENSE-MIT"),
        ("cp311-abi3-win_amd64", {"without": "cyclonedx"}, "cyclonedx"),
        ("cp311-abi3-win_amd64", {"name": "_native"}, "native modules"),
    ],
)
def test_faults_of_wheels_are_named(name, packed, said):
    data = wheel(HEADERS["windows-x64"], **packed)
    faults = check_package.faults_of_wheel(f"ridgeform-{version()}-{name}.whl", data)
    assert any(said in fault for fault in faults)


def test_a_zip_holds_what_its_manifest_names():
    own = f"ridgeform-{version()}-cp311-abi3-win_amd64.whl"

    def extension(wheels, platforms='["windows-x64"]'):
        packed = io.BytesIO()
        with zipfile.ZipFile(packed, "w") as archive:
            text = f'version = "{version()}"\nplatforms = {platforms}\nwheels = {wheels}\n'
            archive.writestr("blender_manifest.toml", text)
            archive.writestr(f"wheels/{own}", wheel(HEADERS["windows-x64"]))
        return packed.getvalue()

    name = f"ridgeform-{version()}-windows_x64.zip"
    assert check_package.faults_of_zip(name, extension(f'["./wheels/{own}"]')) == []
    assert check_package.faults_of_zip(name, extension("[]"))
    assert check_package.faults_of_zip(name, extension(f'["./wheels/{own}"]', '["macos-x64"]'))
    assert check_package.faults_of_zip("ridgeform-macos_x64.zip", extension(f'["./wheels/{own}"]'))


def test_the_list_of_parts_names_no_folder_of_the_machine(tmp_path):
    path = tmp_path / "ridgeform.whl"
    path.write_bytes(wheel(HEADERS["linux-x64"]))
    assert b"path+file:///ridgeform/rust/python#" in release.parts_list(path)
    assert b"/home/me" not in release.parts_list(path)


def test_checksums_are_as_sha256sum_reads_them(tmp_path):
    (tmp_path / "a.txt").write_bytes(b"abc")
    (tmp_path / "SHA256SUMS").write_text("old", encoding="utf-8")
    digest = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"
    assert release.checksums(tmp_path) == f"{digest}  a.txt\n"


@pytest.fixture
def build(tmp_path):
    """Makes a wheel whose RECORD is that of a build."""

    def made(record):
        path = tmp_path / f"ridgeform-{version()}-cp311-abi3-win_amd64.whl"
        path.write_bytes(wheel(HEADERS["windows-x64"]))
        info = f"ridgeform-{version()}.dist-info"
        with zipfile.ZipFile(path, "a") as archive:
            archive.writestr(
                f"{info}/METADATA", f"Metadata-Version: 2.4\nName: ridgeform\nVersion: {version()}\n"
            )
            archive.writestr(f"{info}/RECORD", record)
        (tmp_path / "stamped").mkdir(exist_ok=True)
        return stamped_wheel.stamped(path, tmp_path / "stamped")

    return made


def test_every_build_has_a_version_of_its_own(build):
    names = [build(record).name for record in ("one", "other", "one")]
    assert names[0] == names[2] != names[1]
    assert check_package.check(build("one")) == []


def test_a_stamped_wheel_says_so_throughout(build):
    path = build("one")
    stamp = path.name.split("-")[1]
    with zipfile.ZipFile(path) as archive:
        parts = {name: archive.read(name) for name in archive.namelist()}
    info = f"ridgeform-{stamp}.dist-info"
    assert {name.split("/")[0] for name in parts} == {"ridgeform", info}
    assert f"\nVersion: {stamp}\n".encode() in parts[f"{info}/METADATA"]
    lines = [line.split(",") for line in parts.pop(f"{info}/RECORD").decode().split()]
    assert lines.pop() == [f"{info}/RECORD", "", ""]
    assert sorted(parts) == sorted(name for name, *_ in lines)
    for name, digest, size in lines:
        hashed = base64.urlsafe_b64encode(hashlib.sha256(parts[name]).digest()).decode().rstrip("=")
        assert (digest, int(size)) == (f"sha256={hashed}", len(parts[name]))
