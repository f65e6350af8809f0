# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether a binary PLY file is whole: its head says how many elements of which properties follow."""

import mmap
import struct
from pathlib import Path

from .completeness_blend import IncompleteError

FORMATS = {
    "char": "b",
    "uchar": "B",
    "short": "h",
    "ushort": "H",
    "int": "i",
    "uint": "I",
    "float": "f",
    "double": "d",
}
"""A number of each type, as `struct` calls it."""
Property = tuple[struct.Struct, struct.Struct | None]
"""A number, or the count of a list and a number of it."""


def check(path: Path) -> None:
    """`IncompleteError` if the file is not as long as its head says."""
    with path.open("rb") as stream:
        elements = _head(stream)
        place = stream.tell()
        with mmap.mmap(stream.fileno(), 0, access=mmap.ACCESS_READ) as content:
            for count, properties in elements:
                place = _end_of(content, place, count, properties)
            if place != len(content):
                raise IncompleteError(f"{len(content)} bytes are there, {place} were to be written")


def _head(stream: object) -> list[tuple[int, list[Property]]]:
    elements: list[tuple[int, list[Property]]] = []
    order = "<"
    for line in iter(stream.readline, b""):
        words = line.decode("latin-1").split()
        if words[:1] == ["end_header"]:
            return elements
        if words[:1] == ["format"]:
            order = ">" if "big" in words[1] else "<"
        elif words[:1] == ["element"]:
            elements.append((int(words[2]), []))
        elif words[:2] == ["property", "list"]:
            elements[-1][1].append(tuple(struct.Struct(order + FORMATS[word]) for word in words[2:4]))
        elif words[:1] == ["property"]:
            elements[-1][1].append((struct.Struct(order + FORMATS[words[1]]), None))
    raise IncompleteError("its head ends early")


def _end_of(content: mmap.mmap, place: int, count: int, properties: list[Property]) -> int:
    """Where elements end that begin at a place."""
    if all(item is None for _, item in properties):
        return place + count * sum(number.size for number, _ in properties)
    for _ in range(count):
        for number, item in properties:
            if place + number.size > len(content):
                raise IncompleteError("elements are missing")
            length = 0 if item is None else number.unpack_from(content, place)[0] * item.size
            place += number.size + length
    return place
