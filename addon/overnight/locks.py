# SPDX-License-Identifier: GPL-3.0-or-later
"""Locks by name among processes, held in one file; the system frees them when a process ends."""

import contextlib
import hashlib
import os
import time
from collections.abc import Iterator
from pathlib import Path

POLL_SECONDS = 0.05
PLACES = 1 << 30
"""Bytes of the file that stand for names; it stays empty. Names that share one wait for each other."""


@contextlib.contextmanager
def locked(path: Path, name: str) -> Iterator[None]:
    """Hold a name in a lock file that is there, waiting until no other process holds it. `OSError`."""
    place = int.from_bytes(hashlib.sha256(name.encode()).digest()[:8], "little") % PLACES
    # Closing any handle of a file gives up all locks of the process on it, so each process has its own.
    handle = _handle(path)
    while not _try_lock(handle, place):
        time.sleep(POLL_SECONDS)
    try:
        yield
    finally:
        _unlock(handle, place)


_handles: dict[Path, int] = {}


def _handle(path: Path) -> int:
    known = _handles.get(path)
    if known is not None:
        # Another run may have begun the journal again.
        with contextlib.suppress(OSError):
            if os.path.samestat(os.fstat(known), path.stat()):
                return known
        os.close(known)
    _handles[path] = os.open(path, os.O_RDWR)
    return _handles[path]


if os.name == "nt":
    import msvcrt

    def _try_lock(handle: int, place: int) -> bool:
        os.lseek(handle, place, os.SEEK_SET)
        try:
            msvcrt.locking(handle, msvcrt.LK_NBLCK, 1)
        except OSError:
            return False
        return True

    def _unlock(handle: int, place: int) -> None:
        os.lseek(handle, place, os.SEEK_SET)
        msvcrt.locking(handle, msvcrt.LK_UNLCK, 1)

else:
    import errno
    import fcntl

    def _try_lock(handle: int, place: int) -> bool:
        try:
            fcntl.lockf(handle, fcntl.LOCK_EX | fcntl.LOCK_NB, 1, place)
        except OSError as error:
            if error.errno in (errno.EACCES, errno.EAGAIN):
                return False
            raise
        return True

    def _unlock(handle: int, place: int) -> None:
        fcntl.lockf(handle, fcntl.LOCK_UN, 1, place)
