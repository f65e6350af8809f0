# SPDX-License-Identifier: GPL-3.0-or-later
"""The attribute that a tool works on: which one, what it must not have, its columns for the wheel."""

import bpy
import numpy as np

from ..blender import attribute_io, attribute_names
from ..blender.attribute_io import PointValues
from ..blender.refusals import RefusedError
from ..blender.welding import Weld


def source_of(obj: bpy.types.Object, settings: object, suffixes: tuple[str, ...]) -> PointValues:
    """The values of the attribute that is named, or else the active one; `RefusedError` if there is none.

    `suffixes` are those of results, which are no sources.
    """
    return attribute_io.read_values(obj, settings.attribute or attribute_names.default_name(obj, suffixes))


def refuse_non_finite(obj: bpy.types.Object, source: PointValues, needed: np.ndarray) -> None:
    """`RefusedError` if a value that is needed (n,) bool is not a finite number."""
    broken = np.flatnonzero(needed & ~np.isfinite(source.values).all(axis=1))
    if len(broken):
        raise RefusedError(
            f'"{source.name}" of "{obj.name}" is not a finite number at vertex {broken[0]} ({len(broken)} in '
            "all): select these vertices and fill them in with Interpolate Attribute, Fill the Selection"
        )


def refuse_mixed(obj: bpy.types.Object, source: PointValues, needed: np.ndarray) -> None:
    """`RefusedError` if a vertex that is needed (n,) bool has several colors at its face corners."""
    mixed = np.flatnonzero(needed & source.mixed)
    if len(mixed):
        raise RefusedError(
            f'The face corners of "{obj.name}" have different "{source.name}" at vertex {mixed[0]} '
            f"({len(mixed)} in all): convert it to the domain Vertex with Object Data ▸ Color Attributes ▸ "
            "Convert Attribute"
        )


def varying(values: np.ndarray) -> np.ndarray:
    """Which columns (k,) bool of values (n, k) are not the same everywhere."""
    return (values != values[:1]).any(axis=0)


def as_argument(values: np.ndarray) -> np.ndarray:
    """Values (k, c) as the wheel wants them: one column is (k,)."""
    return values[:, 0] if values.shape[1] == 1 else values


def varying_means(obj: bpy.types.Object, source: PointValues, weld: Weld) -> tuple[np.ndarray, np.ndarray]:
    """Which columns (k,) bool vary, and their means (l, c) at the welded vertices.

    `RefusedError` if none varies, or a value cannot be used.
    """
    everywhere = np.ones(len(source.values), bool)
    refuse_mixed(obj, source, everywhere)
    refuse_non_finite(obj, source, everywhere)
    columns = varying(source.values)
    if not columns.any():
        raise RefusedError(f'"{source.name}" of "{obj.name}" has the same value everywhere')
    return columns, np.stack([weld.mean_of(column) for column in source.values[:, columns].T], axis=1)
