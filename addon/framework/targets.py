# SPDX-License-Identifier: GPL-3.0-or-later
"""Which file a batch writes for each one that it reads: never one that it reads, and none twice.

Files are told apart by what they are, not by what they are called: links, letter case and `..` count.
"""

import contextlib
import itertools
import re
import unicodedata
import urllib.parse
from collections.abc import Hashable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from .files import FileError, check_suffix

HEAD = 1 << 16
"""Bytes at the head of an OBJ file, where it names its materials."""
NEEDED = {
    ".obj": re.compile(rb"^mtllib (.+?)\s*$", re.MULTILINE),
    ".gltf": re.compile(rb'"uri"\s*:\s*"([^":]+)"'),
}


@dataclass
class Target:
    """What is written for one source."""

    source: Path
    path: Path
    error: str | None = None
    """Why nothing may be written there."""


class Ledger:
    """The files that may not be written: all that are read, and those written before."""

    def __init__(self, sources: Iterable[Path]) -> None:
        """Take all sources and the files that they need."""
        self._names: dict[Hashable, str] = {}
        for source in sources:
            for path in (source, *needed_files(source)):
                self._names.setdefault(identity(path), f"{path} is an input and would be overwritten")

    def reason_against(self, path: Path) -> str | None:
        """Why a file may not be written; `None` if it may."""
        return self._names.get(identity(path))

    def add_inputs(self, paths: Iterable[Path]) -> None:
        """Take further files that are read."""
        for path in paths:
            self._names.setdefault(identity(path), f"{path} is used by an input and would be overwritten")

    def add_output(self, path: Path) -> None:
        """Take a file that was written, or that will be."""
        self._names.setdefault(identity(path), f"{path} is already the output of another file")

    def installing(self, _made: object) -> contextlib.AbstractContextManager[None]:
        """What goes around files being put in place: nothing."""
        return contextlib.nullcontext()


def assign(
    sources: Sequence[Path], out: Path, suffix: str | None, is_folder: bool = False
) -> tuple[list[Target], Ledger]:
    """The target of every source, and the ledger of what may not be written.

    `out` is a file, or a folder: if it is said to be one, if there are several sources, a suffix to be
    written, or no suffix in it.
    """
    ledger = Ledger(sources)
    planned = Ledger(())
    into_folder = is_folder or len(sources) > 1 or suffix is not None or out.is_dir() or not out.suffix
    targets = []
    for source in sources:
        path = out / (source.stem + (suffix or source.suffix.lower())) if into_folder else out
        try:
            check_suffix(path)
            path = path.resolve()
            reason = ledger.reason_against(path) or planned.reason_against(path)
        except (FileError, OSError, RuntimeError, ValueError) as error:
            reason = str(error)
        if reason is None:
            planned.add_output(path)
        targets.append(Target(source, path, reason))
    return targets, ledger


def identity(path: Path) -> Hashable:
    """What a file is, whatever it is called; of one that is not there: its folder and its name."""
    try:
        found = path.stat()
        return found.st_dev, found.st_ino
    except (OSError, ValueError):
        pass
    path = path.absolute()
    if path.parent == path:
        return str(path)
    name = unicodedata.normalize("NFC", path.name)
    return identity(path.parent), name.casefold() if _folds_case(path.parent) else name


def _folds_case(folder: Path) -> bool:
    """Whether names in a folder that differ in letter case only are one."""
    while not folder.is_dir():
        if folder.parent == folder:
            return False
        folder = folder.parent
    try:
        for known in itertools.chain(folder.iterdir(), [folder] if folder.name else []):
            other = known.with_name(known.name.swapcase())
            if other.name != known.name:
                return other.exists() and other.samefile(known)
    except OSError:
        pass
    return False


def needed_files(source: Path) -> list[Path]:
    """The files that a source names and that would be read with it."""
    pattern = NEEDED.get(source.suffix.lower())
    if pattern is None:
        return []
    try:
        with source.open("rb") as stream:
            head = stream.read() if source.suffix.lower() == ".gltf" else stream.read(HEAD)
    except OSError:
        return []
    named = (found.decode("utf-8", "replace") for found in pattern.findall(head))
    return [source.parent / urllib.parse.unquote(name) for name in named]
