# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether a .blend file is whole: a chain of blocks up to one that ends it, compressed or not."""

import struct
from pathlib import Path
from typing import BinaryIO

ZSTD = b"\x28\xb5\x2f\xfd"
SEEK_TABLE = 0x8F92EAB1
"""The last four bytes of a compressed file: Zstandard's seekable format."""
HEADS = {
    b"BLENDER-": (12, struct.Struct("<4sI16x")),
    b"BLENDER1": (17, struct.Struct("<4s12xq8x")),
}
"""How long the head of a file is, until 4.5 and from 5.0 on, and how a block begins: its code and length."""


class IncompleteError(Exception):
    """A file that ends too early; the message says how that shows."""


def check(path: Path) -> None:
    """`IncompleteError` if the file ends too early."""
    with path.open("rb") as stream:
        start = stream.read(8)
        whole = _whole_table(stream) if start.startswith(ZSTD) else _whole_chain(stream, start)
    if not whole:
        raise IncompleteError("it has no end")


def _whole_chain(stream: BinaryIO, start: bytes) -> bool:
    if start not in HEADS:
        return False
    place, head = HEADS[start]
    size = stream.seek(0, 2)
    while place + head.size <= size:
        stream.seek(place)
        code, length = head.unpack(stream.read(head.size))
        if code == b"ENDB":
            return True
        place += head.size + length
    return False


def _whole_table(stream: BinaryIO) -> bool:
    """Whether the table of frames at the end is there and their lengths add up to the file's."""
    size = stream.seek(0, 2)
    if size < 17:
        return False
    stream.seek(size - 9)
    count, flags, mark = struct.unpack("<IBI", stream.read(9))
    entry = 12 if flags & 0x80 else 8
    begin = size - 9 - count * entry
    if mark != SEEK_TABLE or begin < 8:
        return False
    stream.seek(begin)
    table = stream.read(count * entry)
    return sum(struct.unpack_from("<I", table, i * entry)[0] for i in range(count)) == begin - 8
