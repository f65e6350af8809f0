"""Arrays in a folder that all workers see: mapped into memory to read, each written whole or not at all."""

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]


def write(path: Path, arrays: Mapping[str, Array]) -> None:
    """Write arrays under their names to one file. Whoever writes it twice leaves the same file."""
    # Two workers may do the same task, one of them given up for dead.
    partial = path.with_name(f"{path.name}.{os.getpid()}")
    with partial.open("wb") as file:
        np.savez(file, **arrays)
    partial.replace(path)


def read(path: Path) -> dict[str, Array]:
    """The arrays of one file."""
    with np.load(path) as found:
        return {name: found[name] for name in found.files}


def put(folder: Path, name: str, values: Array) -> None:
    """Keep one array of the whole mesh."""
    partial = folder / f"{name}.npy.{os.getpid()}"
    with partial.open("wb") as file:
        np.save(file, values)
    partial.replace(folder / f"{name}.npy")


def has(folder: Path, name: str) -> bool:
    """Whether there is an array of this name."""
    return (folder / f"{name}.npy").exists()


def get(folder: Path, name: str) -> Array:
    """One array of the whole mesh, to read: only the parts that are used come into memory."""
    array: Array = np.load(folder / f"{name}.npy", mmap_mode="r")
    return array


def get_if(folder: Path, name: str) -> Array | None:
    """The same where there is such an array."""
    return get(folder, name) if has(folder, name) else None


def room(folder: Path, name: str, dtype: Any, shape: tuple[int, ...]) -> Array:
    """A new array of zeros, to write."""
    return np.lib.format.open_memmap(folder / f"{name}.npy", mode="w+", dtype=dtype, shape=shape)


def block_file(folder: Path, kind: str, block: int) -> Path:
    """The file of one block."""
    return folder / f"{kind}_{block:05d}.npz"
