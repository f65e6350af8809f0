# SPDX-License-Identifier: GPL-3.0-or-later
"""Results that are kept, so that what is made of them changes at once. No Blender data here."""

import hashlib
from collections import OrderedDict
from collections.abc import Callable, Mapping

import numpy as np
import ridgeform


class Results:
    """The last results of a tool, found by all that went in, bit by bit; each is as large as its mesh."""

    MOST = 4

    def __init__(self) -> None:
        """Begin with none."""
        self._kept: OrderedDict[bytes, object] = OrderedDict()

    def __len__(self) -> int:
        """How many there are."""
        return len(self._kept)

    def of(
        self, mesh: ridgeform.Mesh, options: Mapping[str, object], call: Callable[[], object]
    ) -> tuple[object, bool]:
        """The result for a mesh and options, and whether it was there already; stopped ones are not kept."""
        key = _digest(mesh, options)
        if key in self._kept:
            self._kept.move_to_end(key)
            return self._kept[key], True
        found = call()
        if found.status != "stopped":
            self._kept[key] = found
            while len(self._kept) > self.MOST:
                self._kept.popitem(last=False)
        return found, False

    def forget(self) -> None:
        """Let go of all."""
        self._kept.clear()


def _digest(mesh: ridgeform.Mesh, options: Mapping[str, object]) -> bytes:
    total = hashlib.blake2b(mesh.vertices.tobytes())
    total.update(mesh.faces.tobytes())
    for name in sorted(options):
        value = options[name]
        total.update(name.encode())
        if isinstance(value, np.ndarray):
            total.update(repr((value.dtype.str, value.shape)).encode() + value.tobytes())
        else:
            total.update(repr(value).encode())
    return total.digest()
