"""A wheel whose version says of which build it is.

Blender keeps a wheel that is there when an extension comes with one of the same version: a zip over another
build of its version would run on the old module. So a wheel in a zip bears what is in it as the local part
of its version (PEP 440): `ridgeform-0.1.0+5f0c1a2b3c4d-…`.
"""

import base64
import hashlib
import zipfile
from pathlib import Path


def _entry(name: str, data: bytes) -> str:
    """A line of RECORD (PEP 376)."""
    digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
    return f"{name},sha256={digest},{len(data)}"


def stamped(wheel: Path, folder: Path) -> Path:
    """A copy of a wheel in a folder, with the first digits of what its RECORD hashes to in its version."""
    name, version, *tags = wheel.name.split("-")
    before = f"{name}-{version}.dist-info"
    with zipfile.ZipFile(wheel) as archive:
        record = archive.read(f"{before}/RECORD")
        build = f"{version}+{hashlib.sha256(record).hexdigest()[:12]}"
        after = f"{name}-{build}.dist-info"
        made = folder / "-".join([name, build, *tags])
        with zipfile.ZipFile(made, "w", zipfile.ZIP_DEFLATED) as copy:
            lines = []
            for info in archive.infolist():
                data = archive.read(info)
                if info.filename == f"{before}/RECORD":
                    continue
                if info.filename == f"{before}/METADATA":
                    said, says = (f"\nVersion: {number}\n".encode() for number in (version, build))
                    data = data.replace(said, says, 1)
                info.filename = info.filename.replace(f"{before}/", f"{after}/", 1)
                if not info.is_dir():
                    lines.append(_entry(info.filename, data))
                copy.writestr(info, data, zipfile.ZIP_DEFLATED)
            lines.append(f"{after}/RECORD,,\n")
            copy.writestr(f"{after}/RECORD", "\n".join(lines))
    return made
