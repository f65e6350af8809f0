# SPDX-License-Identifier: GPL-3.0-or-later
"""The journal of a batch: a folder beside OUT with one small file for each file of the batch.

An entry holds a digest of everything that a result depends on: the input and what it names, the tools with
their settings, the version. It says first, just before the result is put in place, what will be there
(`ready`), and then that it is (`done`). Whoever finds an entry, whatever ended the process before, knows from
it and from the files themselves whether there is anything left to do. Entries are written atomically.

Several processes may work with one journal: they lock what they write, and tell each other through the file
`used` which files are inputs and outputs, since no output may replace either.
"""

import contextlib
import hashlib
import json
import os
import shutil
from collections.abc import Hashable, Iterable, Iterator, Sequence
from pathlib import Path

from ..framework.files import FileError
from ..framework.targets import Ledger, Target, identity, needed_files
from ..framework.writing import sweep, write_text
from .locks import locked

READY, DONE = "ready", "done"
INSTALLING = "installing"
"""What is locked while files are put in place, and while `used` is read or written."""


class Journal:
    """The journal beside an output; `key` is all that results depend on beside the inputs."""

    def __init__(self, out: Path, key: str) -> None:
        """Take an output; nothing is written yet."""
        out = Path(os.path.abspath(out))
        self.folder = out.parent / f"{out.name or 'root'}.ridgeform"
        self.key = key
        self._used: dict[Hashable, tuple[str, str]] = {}
        self._read = 0

    def open(self, keep: bool) -> None:
        """Make the folder; entries of runs before count only if they are to be kept. `OSError`."""
        if not keep:
            shutil.rmtree(self.folder, ignore_errors=True)
        self.folder.mkdir(parents=True, exist_ok=True)
        (self.folder / "lock").touch()
        # Some shared disks know no locks: they are told apart here, before anything is done.
        with self.locked(INSTALLING):
            pass

    @contextlib.contextmanager
    def claim(self, target: Target, ledger: Ledger) -> Iterator["Claim"]:
        """Have one file to oneself among all processes."""
        with self.locked(target.path.name):
            for path in (target.path, self._path(target)):
                sweep(path)
            yield Claim(self, target, ledger)

    def locked(self, name: str) -> contextlib.AbstractContextManager[None]:
        """Hold a name among all processes; it is free again when the process ends, however it does."""
        return locked(self.folder / "lock", name)

    def entry(self, target: Target) -> dict[str, object] | None:
        """What was written for a target, `None` if nothing that can be read."""
        try:
            return json.loads(self._path(target).read_text(encoding="utf-8"))
        except (OSError, ValueError):
            return None

    def write(self, target: Target, entry: dict[str, object]) -> None:
        """Write the entry of a target. `OSError`."""
        write_text(self._path(target), json.dumps(entry, ensure_ascii=False))

    def finished(self, target: Target) -> dict[str, object] | None:
        """The record of a file that was done with these settings and is still there, else `None`.

        Also of one whose process ended after the result was put in place and before it said so.
        """
        entry = self.entry(target)
        if entry is None or entry["key"] != self.key or entry["inputs"] != digest_of(target.source):
            return None
        states = {path: content == _digest(Path(path)) for path, content in entry["files"].items()}
        whole = all(states.values())
        if entry["state"] == READY and whole:
            self.write(target, entry | {"state": DONE})
        elif entry["state"] == READY or not all(Path(path).exists() for path in states):
            return None
        record = entry["record"] | {"file": str(target.source), "resumed": True}
        if not whole:
            changed = ", ".join(Path(path).name for path, same in states.items() if not same)
            record["warnings"] = [*record["warnings"], f"{changed} was changed since, and is kept"]
        return record

    def pictures(self, target: Target) -> list[str] | None:
        """The pictures in an entry: before and after, PNG in base 64."""
        entry = self.entry(target)
        return None if entry is None else entry.get("pictures")

    def note(self, kind: str, paths: Iterable[Path], owner: str) -> None:
        """Tell all processes of inputs or outputs of a file. Others must be kept out while it is done."""
        lines = [json.dumps([kind, str(path), owner]) + "\n" for path in paths]
        if lines:
            with (self.folder / "used").open("ab") as stream:
                stream.write("".join(lines).encode())

    def reason_against(self, path: Path, owner: str) -> str | None:
        """Why a file may not be written for this owner, as other processes say; `None` if it may."""
        whose, reason = self._used.get(identity(path), (owner, ""))
        return None if whose == owner else reason

    def catch_up(self) -> None:
        """Read what other processes have noted since."""
        with contextlib.suppress(FileNotFoundError), (self.folder / "used").open("rb") as stream:
            stream.seek(self._read)
            for line in stream:
                if not line.endswith(b"\n"):
                    break
                self._read += len(line)
                kind, path, owner = json.loads(line)
                said = (
                    "is used by an input and would be overwritten"
                    if kind == "input"
                    else ("is already the output of another file")
                )
                self._used.setdefault(identity(Path(path)), (owner, f"{path} {said}"))

    def _path(self, target: Target) -> Path:
        return self.folder / f"{target.path.name}.json"


class Claim:
    """One file that a process has to itself: what protects other files from it, and its entry."""

    def __init__(self, journal: Journal, target: Target, ledger: Ledger) -> None:
        """Take a target; `record` and `pictures` are to be set before the result is written."""
        self.record: dict[str, object] = {}
        self.pictures: list[str] | None = None
        self._journal, self._target, self._ledger = journal, target, ledger
        self._inputs = digest_of(target.source)
        self._entry: dict[str, object] = {}
        self._owner = target.path.name

    def finished_record(self) -> dict[str, object] | None:
        """The record, if the file was done before."""
        return self._journal.finished(self._target)

    def add_inputs(self, paths: Iterable[Path]) -> None:
        """Take further files that are read."""
        paths = list(paths)
        self._ledger.add_inputs(paths)
        with self._journal.locked(INSTALLING):
            self._journal.note("input", paths, self._owner)

    def reason_against(self, path: Path) -> str | None:
        """Why a file may not be written; `None` if it may."""
        return self._ledger.reason_against(path) or self._journal.reason_against(path, self._owner)

    def add_output(self, path: Path) -> None:
        """Take a file that was written."""
        self._ledger.add_output(path)
        self._journal.note("output", [path], self._owner)

    @contextlib.contextmanager
    def installing(self, made: Sequence[tuple[Path, Path]]) -> Iterator[None]:
        """Say what will be there while files (written, final) are put in place. `FileError`, `OSError`."""
        if digest_of(self._target.source) != self._inputs:
            raise FileError(f"{self._target.source} was changed while it was worked on")
        self._entry = {
            "state": READY,
            "key": self._journal.key,
            "inputs": self._inputs,
            "files": {str(final): _digest(hidden) for hidden, final in made},
            "record": self.record,
            "pictures": self.pictures,
        }
        with self._journal.locked(INSTALLING):
            self._journal.catch_up()
            if self.record["error"] is None:
                self._journal.write(self._target, self._entry)
            yield

    def finish(self) -> None:
        """Say that it is done; a file with an error is not, and is tried again."""
        if self.record["error"] is None:
            self._journal.write(self._target, self._entry | {"state": DONE})


def digest_of(source: Path) -> str:
    """A digest of a file and of those that it names."""
    return ":".join(_digest(path) for path in (source, *needed_files(source)))


def _digest(path: Path) -> str:
    try:
        with path.open("rb") as stream:
            return hashlib.file_digest(stream, "sha256").hexdigest()
    except OSError:
        return ""
