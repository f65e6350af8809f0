# SPDX-License-Identifier: GPL-3.0-or-later
"""What is read of a mesh more than once while a run is prepared: large meshes take long to read."""

import contextlib
import functools
from collections.abc import Callable, Iterator

import bpy
import numpy as np

_kept: dict[tuple[str, int], np.ndarray] | None = None
"""By the function that reads and the mesh; `None` where everything is read anew."""


@contextlib.contextmanager
def reading_once() -> Iterator[None]:
    """Read everything once: in this block no mesh may change, and arrays cannot be written to."""
    global _kept  # noqa: PLW0603
    _kept = {}
    try:
        yield
    finally:
        _kept = None


def forget() -> None:
    """Read anew: a mesh has changed."""
    if _kept is not None:
        _kept.clear()


def once(read: Callable[[bpy.types.Mesh], np.ndarray]) -> Callable[[bpy.types.Mesh], np.ndarray]:
    """A function that reads an array of a mesh, which does so once within `reading_once`."""

    @functools.wraps(read)
    def kept(mesh: bpy.types.Mesh) -> np.ndarray:
        if _kept is None:
            return read(mesh)
        key = read.__name__, mesh.as_pointer()
        if key not in _kept:
            _kept[key] = read(mesh)
            _kept[key].flags.writeable = False
        return _kept[key]

    return kept
