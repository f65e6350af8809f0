# SPDX-License-Identifier: GPL-3.0-or-later
"""Writing files so that none is ever lost: under another name first, checked, and then put in place at once.

What is there already stays as it is until the new file is whole and on the disk.
"""

import contextlib
import filecmp
import hashlib
import os
import re
import secrets
import shutil
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Protocol

from .completeness import check_image, check_whole
from .completeness_blend import IncompleteError

ROOM = 1 << 16
"""Bytes; a disk with less room than this is called full."""
MAPS = re.compile(rb"^((?:map_|bump|disp|decal|refl|norm)\S*\s(?:.*\s)?)", re.MULTILINE)
"""How a line of a material file begins that names an image."""


class Protected(Protocol):
    """What says whether a file may be written."""

    def reason_against(self, path: Path) -> str | None:
        """Why it may not; `None` if it may."""

    def add_output(self, path: Path) -> None:
        """Take note of a file that was written."""

    def installing(self, made: Sequence[tuple[Path, Path]]) -> contextlib.AbstractContextManager[None]:
        """What goes around files (written, final) being put in place."""


def write_whole(
    path: Path, export: Callable[[str], object], several: bool, protected: Protected | None = None
) -> None:
    """Have `path` and what goes along with it written by `export`, which gets the path to write to.

    `several` formats write more files than one, into the same folder. `OSError` or `IncompleteError` if that
    cannot be done, and whatever `export` raises: then everything is as it was.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    with _hidden_place(path, several) as hidden:
        export(str(hidden))
        if not hidden.is_file():
            raise IncompleteError("it was not written")
        _check(hidden)
        made = [(hidden, path)]
        if several:
            _shorten_paths(hidden, path)
            others = (file for file in sorted(hidden.parent.rglob("*")) if file.is_file() and file != hidden)
            made = [(file, path.parent / file.relative_to(hidden.parent)) for file in others] + made
            for file, _ in made[:-1]:
                check_image(file)
        for file, _ in made:
            flush(file)
        with contextlib.nullcontext() if protected is None else protected.installing(made):
            _install(_needed(made, protected), protected)


def write_text(path: Path, text: str) -> None:
    """Write a text; `OSError` if that cannot be done: then the file that was there is as it was."""
    with _hidden_place(path, several=False) as hidden:
        hidden.write_text(text, encoding="utf-8")
        flush(hidden)
        os.replace(hidden, path)


def sweep(path: Path) -> None:
    """Remove what a process that was ended has left beside a file that it was about to write."""
    for left in path.parent.glob(f"{_hidden_stem(path)}*"):
        _remove(left)


def flush(path: Path) -> None:
    """Have a file written to the disk; `OSError` if it does not fit there."""
    with path.open("rb+") as stream:
        os.fsync(stream.fileno())


@contextlib.contextmanager
def _hidden_place(path: Path, several: bool) -> Iterator[Path]:
    """A path to write to first: beside the target, or in a folder beside it under the target's own name.

    Beside it, because paths to other files may be stored relative to the file that names them, and since only
    there it can be put in place in one step.
    """
    hidden = path.parent / (_hidden_stem(path) + secrets.token_hex(6))
    try:
        if several:
            hidden.mkdir()
        else:
            # Where nothing can be written, this says why in the system's words, which exporters do not.
            hidden.touch(exist_ok=False)
            hidden.unlink()
        yield hidden / path.name if several else hidden.with_suffix(path.suffix)
    finally:
        with contextlib.suppress(OSError):
            for left in path.parent.glob(f"{hidden.name}*"):
                _remove(left)


def _hidden_stem(path: Path) -> str:
    """How the names of what is written for a file begin; plain, whatever the file is called."""
    return f".ridgeform-{hashlib.sha256(os.fsencode(path.name)).hexdigest()[:8]}-"


def _remove(left: Path) -> None:
    with contextlib.suppress(OSError):
        shutil.rmtree(left) if left.is_dir() else left.unlink(missing_ok=True)


def _check(hidden: Path) -> None:
    try:
        check_whole(hidden)
    except IncompleteError as error:
        room = shutil.disk_usage(hidden.parent).free
        why = "the disk is full" if room < ROOM else "is the disk full, or are files limited in size?"
        raise IncompleteError(f"Blender left it incomplete ({error}): {why}") from error


def _shorten_paths(hidden: Path, path: Path) -> None:
    """Name images below the target's folder relative to it, as Blender does when it writes there itself."""
    library = hidden.with_suffix(".mtl")
    if path.suffix.lower() != ".obj" or not library.is_file():
        return
    text = library.read_bytes()
    folder = re.escape(os.fsencode(path.parent.as_posix().rstrip("/") + "/"))
    short = re.sub(MAPS.pattern + folder, rb"\1", text, flags=re.MULTILINE)
    if short != text:
        library.write_bytes(short)


def _needed(made: Sequence[tuple[Path, Path]], protected: Protected | None) -> list[tuple[Path, Path]]:
    """Those of the files that are not there already; `IncompleteError` if one would destroy another's."""
    main = made[-1][1]
    result = []
    for file, final in made:
        if final != main and final.is_file() and filecmp.cmp(file, final, shallow=False):
            continue
        reason = None if protected is None else protected.reason_against(final)
        if reason is None and final.exists() and (final.is_dir() or final.stem != main.stem):
            reason = f"{final} is there and is something else"
        if reason is not None:
            raise IncompleteError(f"{reason}: choose another output")
        result.append((file, final))
    return result


def _install(made: Sequence[tuple[Path, Path]], protected: Protected | None) -> None:
    """Put the files in place, the main one last; if one cannot be, all are as they were."""
    undo: list[tuple[Path, Path | None]] = []
    try:
        for file, final in made:
            final.parent.mkdir(parents=True, exist_ok=True)
            kept = None
            if final.exists():
                shutil.copymode(final, file)
                if (file, final) != made[-1]:
                    kept = file.with_name(f"{file.name}.kept")
                    os.replace(final, kept)
                    undo.append((final, kept))
            os.replace(file, final)
            if kept is None:
                undo.append((final, None))
    except BaseException:
        for final, kept in reversed(undo):
            with contextlib.suppress(OSError):
                final.unlink() if kept is None else os.replace(kept, final)
        raise
    _flush_folder(made[-1][1].parent)
    if protected is not None:
        for _, final in made:
            protected.add_output(final)


def _flush_folder(folder: Path) -> None:
    # Windows has no such thing.
    with contextlib.suppress(OSError):
        handle = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(handle)
        finally:
            os.close(handle)
