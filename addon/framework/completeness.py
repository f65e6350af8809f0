# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether a file that Blender has written is whole.

Blender's exporters written in C++ say nothing of a disk that fills up: the file ends early, and the operator
reports success. Every format says somewhere how long it is or how it ends, which is compared with what is
there.
"""

import json
import re
import struct
import urllib.parse
import zipfile
from collections import Counter
from collections.abc import Callable
from pathlib import Path

import bpy
import numpy as np

from ..blender import mesh_io
from . import completeness_blend, completeness_ply
from .completeness_blend import IncompleteError

FBX_END = bytes.fromhex("f85a8c6adef5d97eece90ce3758f290b")
PNG_END = b"IEND\xaeB`\x82"
USD_BINARY = b"PXR-USDC"
USD_HEADER = 24
"""Bytes of the head of a binary USD file: what it is, its version, where its table of sections is."""
USD_SECTION = struct.Struct("<16sqq")
"""A section: its name, where it begins, how long it is."""


def check_whole(main: Path) -> None:
    """`IncompleteError` if a file, or one that it needs and that was written with it, ends too early."""
    try:
        CHECKS[main.suffix.lower()](main)
    except (LookupError, ValueError, struct.error) as error:
        raise IncompleteError("it cannot be read") from error


def check_image(path: Path) -> None:
    """The same for an image or another file that was written along."""
    content = path.read_bytes()
    if not content or (path.suffix.lower() == ".png" and not content.endswith(PNG_END)):
        raise IncompleteError(f"{path.name} ends early")


def _stl(path: Path) -> None:
    with path.open("rb") as stream:
        head = stream.read(84)
    if len(head) < 84 or path.stat().st_size != 84 + 50 * struct.unpack_from("<I", head, 80)[0]:
        raise IncompleteError(f"{path.stat().st_size} bytes are too few for its triangles")


def _obj(path: Path) -> None:
    """A text without an end of its own: its faces and loose edges are counted, its materials looked up."""
    found, line, materials, libraries = Counter(), b"\n", set(), []
    with path.open("rb") as stream:
        for line in stream:
            word, _, rest = line.partition(b" ")
            found[word] += 1
            if word == b"usemtl":
                materials.add(rest.strip())
            elif word == b"mtllib":
                libraries.append(rest.strip().decode())
    faces, edges = _visible_faces_and_loose_edges()
    if not line.endswith(b"\n") or found[b"f"] < faces or found[b"l"] < edges:
        raise IncompleteError(f"{found[b'f']} faces of {faces} and {found[b'l']} loose edges of {edges}")
    defined = set()
    for library in libraries:
        text = (path.parent / library).read_bytes()
        defined |= {name.strip() for name in re.findall(rb"^newmtl (.*)$", text, re.MULTILINE)}
        if text and not text.endswith(b"\n"):
            raise IncompleteError(f"{library} ends early")
    if not materials <= defined:
        raise IncompleteError("some of its materials are missing")


def _visible_faces_and_loose_edges() -> tuple[int, int]:
    """How many of them the meshes have that the exporter sees."""
    faces, edges = 0, 0
    for instance in bpy.context.evaluated_depsgraph_get().object_instances:
        if instance.show_self and not instance.is_instance and instance.object.type == "MESH":
            mesh = instance.object.data
            faces += len(mesh.polygons)
            edges += len(mesh.edges) - len(np.unique(mesh_io.corner_edges(mesh)))
    return faces, edges


def _glb(path: Path) -> None:
    with path.open("rb") as stream:
        head = stream.read(12)
    if len(head) < 12 or struct.unpack_from("<I", head, 8)[0] != path.stat().st_size:
        raise IncompleteError(f"{path.stat().st_size} bytes are not its length")


def _gltf(path: Path) -> None:
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
    except ValueError as error:
        raise IncompleteError("it ends early") from error
    for buffer in content.get("buffers", ()):
        named = path.parent / urllib.parse.unquote(buffer["uri"])
        if not named.is_file() or named.stat().st_size != buffer["byteLength"]:
            raise IncompleteError(f"{named.name} is not of its length")
    for image in content.get("images", ()):
        if "uri" in image and not (path.parent / urllib.parse.unquote(image["uri"])).is_file():
            raise IncompleteError(f"{image['uri']} is missing")


def _fbx(path: Path) -> None:
    with path.open("rb") as stream:
        stream.seek(-min(len(FBX_END), path.stat().st_size), 2)
        if stream.read() != FBX_END:
            raise IncompleteError("it has no end")


def _usd(path: Path) -> None:
    _check_usd(path.read_bytes())


def _check_usd(content: bytes) -> None:
    if not content.startswith(USD_BINARY):
        bare = re.sub(rb'"(?:[^"\\\n]|\\.)*"', b"", content)
        pairs = ((b"{", b"}"), (b"[", b"]"), (b"(", b")"))
        closed = bare.rstrip().endswith(b"}") and all(bare.count(a) == bare.count(b) for a, b in pairs)
        if not content.startswith(b"#usda") or not closed:
            raise IncompleteError("it ends early")
        return
    size = len(content)
    table = struct.unpack_from("<q", content, 16)[0] if size >= USD_HEADER else size
    if not USD_HEADER <= table <= size - 8:
        raise IncompleteError("its table of contents is missing")
    end = table + 8
    for _ in range(struct.unpack_from("<Q", content, table)[0]):
        if end + USD_SECTION.size > size:
            raise IncompleteError("its table of contents ends early")
        _, begin, length = USD_SECTION.unpack_from(content, end)
        if not 0 <= begin <= begin + length <= size:
            raise IncompleteError("a section is missing")
        end += USD_SECTION.size


def _usdz(path: Path) -> None:
    try:
        with zipfile.ZipFile(path) as archive:
            names = archive.namelist()
            broken = archive.testzip()
            scene = archive.read(names[0]) if names and broken is None else b""
    except (zipfile.BadZipFile, EOFError) as error:
        raise IncompleteError("it is no whole archive") from error
    if broken is not None:
        raise IncompleteError(f"{broken} in it is broken")
    _check_usd(scene)


CHECKS: dict[str, Callable[[Path], None]] = {
    ".blend": completeness_blend.check,
    ".obj": _obj,
    ".ply": completeness_ply.check,
    ".stl": _stl,
    ".glb": _glb,
    ".gltf": _gltf,
    ".fbx": _fbx,
    ".usd": _usd,
    ".usda": _usd,
    ".usdc": _usd,
    ".usdz": _usdz,
}
"""How to tell for each kind of file."""
