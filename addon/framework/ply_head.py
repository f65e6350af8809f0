# SPDX-License-Identifier: GPL-3.0-or-later
"""The vertices of a PLY file, text or binary, and a copy of the file with other ones."""

import shutil
from dataclasses import dataclass
from pathlib import Path

import numpy as np

TYPES = {
    "char": "i1",
    "int8": "i1",
    "uchar": "u1",
    "uint8": "u1",
    "short": "i2",
    "int16": "i2",
    "ushort": "u2",
    "uint16": "u2",
    "int": "i4",
    "int32": "i4",
    "uint": "u4",
    "uint32": "u4",
    "float": "f4",
    "float32": "f4",
    "double": "f8",
    "float64": "f8",
}
"""What NumPy calls a type of the format."""


@dataclass
class Vertices:
    """The head of a file, and its vertices, which are the first element."""

    head: list[str]
    """Its lines, without the last one."""
    rows: np.ndarray
    """A structured array (n,): the properties by their names."""
    is_text: bool
    end: int
    """The byte at which the vertices end."""

    def with_doubles(self, names: str) -> np.ndarray:
        """A copy of the rows with some properties, of one letter each, in double precision."""
        order = "" if self.is_text else self.rows.dtype[0].str[0].replace("|", "<")
        kinds = [
            (name, f"{order}f8" if name in names else self.rows.dtype[name].str)
            for name in self.rows.dtype.names
        ]
        rows = np.empty(len(self.rows), kinds)
        for name in self.rows.dtype.names:
            rows[name] = self.rows[name]
        return rows


def read_vertices(path: Path) -> Vertices:
    """Read head and vertices; `ValueError` or `LookupError` where they are none that can be read so."""
    with path.open("rb") as stream:
        head = []
        for line in iter(stream.readline, b""):
            text = line.decode("latin-1").strip()
            if text == "end_header":
                break
            head.append(text)
        words = [line.split() for line in head]
        form = next((line[1] for line in words if line[:1] == ["format"]), "none")
        first = next((k for k, line in enumerate(words) if line[:1] == ["element"]), len(words))
        if words[first][1] != "vertex":
            raise ValueError("its vertices do not come first")
        own = [line for line in words[first + 1 :] if line[:1] in (["property"], ["element"])]
        last = next((k for k, line in enumerate(own) if line[0] == "element"), len(own))
        order = {"ascii": "=", "binary_little_endian": "<", "binary_big_endian": ">"}[form]
        kinds = [(name, order + TYPES[kind]) for _, kind, name in own[:last]]
        count = int(words[first][2])
        if form == "ascii":
            lines = [stream.readline().split() for _ in range(count)]
            rows = np.empty(count, [(name, "=f8" if kind[1] == "f" else kind) for name, kind in kinds])
            for column, (name, _) in enumerate(kinds):
                rows[name] = np.array([line[column] for line in lines], np.float64)
        else:
            rows = np.frombuffer(stream.read(count * np.dtype(kinds).itemsize), kinds, count)
        return Vertices(head, rows, form == "ascii", stream.tell())


def write_vertices(path: Path, target: Path, found: Vertices, rows: np.ndarray) -> None:
    """Copy a file with other rows, whose properties have the names of those that were found."""
    doubles = {name for name in rows.dtype.names if rows.dtype[name].str[1:] == "f8"}
    with path.open("rb") as stream, target.open("wb") as made:
        at_vertices = False
        for line in found.head:
            words = line.split()
            at_vertices = words[:2] == ["element", "vertex"] or (at_vertices and words[:1] != ["element"])
            is_double = at_vertices and words[:1] == ["property"] and words[-1] in doubles
            text = f"property double {words[-1]}" if is_double else line
            made.write(text.encode("latin-1") + b"\n")
        made.write(b"end_header\n")
        if found.is_text:
            for row in rows.tolist():
                made.write(" ".join(map(repr, row)).encode() + b"\n")
        else:
            made.write(rows.tobytes())
        stream.seek(found.end)
        shutil.copyfileobj(stream, made)
