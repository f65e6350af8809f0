# SPDX-License-Identifier: GPL-3.0-or-later
"""What denoising and interpolating an attribute share: reading it, writing the result, the report."""

from abc import abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import ClassVar

import bpy
import numpy as np
import ridgeform

from ..blender import attribute_io, attribute_names, display, mesh_io
from ..blender.attribute_io import PointValues
from ..blender.refusals import RefusedError
from ..blender.welding import Weld
from ..framework.run import Part, Run, meshes_phrase, most, total
from ..framework.sources import source_of
from ..framework.surface import Surface, painted_ridges, surface_of
from .settings import solve_options

SUFFIXES = ("_denoised", "_interpolated")
VISIBLE = 1e-5
"""A value changed by less to fit its range is not worth a word: solutions are exact to about that."""


@dataclass
class Solved:
    """What came of one mesh."""

    values: np.ndarray
    """Values (k, c) of the welded vertices."""
    energy_before: float | None
    energy_after: float
    solution: ridgeform.Solution


@dataclass(kw_only=True)
class AttributePart(Part):
    """One mesh of a run on an attribute."""

    source: PointValues
    weld: Weld
    computed: np.ndarray
    """Which vertices (n,) bool take the result."""
    columns: np.ndarray
    """Which components (k,) bool are computed."""
    constants: np.ndarray
    """The components (k,) where they are the same everywhere, and so were not computed."""
    target: str = ""
    """The name of the result."""

    def merged(self) -> np.ndarray:
        """The values (n, k) float32 to be written: the result, with the old bits where none was asked for."""
        new = attribute_io.limited(self.source.data_type, self._full())
        return np.where(self.computed[:, None], new.astype(np.float32), self.source.values)

    def limited_vertices(self) -> int:
        """How many vertices have a value that does not fit into the range of its type."""
        full = self._full()
        off = np.abs(attribute_io.limited(self.source.data_type, full) - full) > VISIBLE
        return int((off.any(axis=1) & self.computed).sum())

    def _full(self) -> np.ndarray:
        full = np.repeat(self.constants[None].astype(np.float64), self.n_vertices, axis=0)
        full[:, self.columns] = self.task.result.values[self.weld.vertex]
        return full


class AttributeRun(Run):
    """A run of a tool on one attribute of each mesh."""

    suffix: ClassVar[str]
    """What the name of a new attribute ends with."""
    done_word: ClassVar[str]

    def prepare(self, obj: bpy.types.Object) -> AttributePart:
        """Read the attribute, the selection and the ridge paint of one mesh."""
        source = source_of(obj, self.settings, SUFFIXES)
        if self.settings.output == "IN_PLACE":
            reason = attribute_io.reason_locked(obj, source)
            if reason is not None:
                raise RefusedError(reason)
        surface = surface_of(obj, whole=True)
        triangles = mesh_io.triangles(obj.data)
        surface.face_weights = painted_ridges(obj, self.settings, triangles, surface.weld)
        part = self.pose(obj, source, surface)
        part.warnings += surface.weld.notes
        return part

    @abstractmethod
    def pose(self, obj: bpy.types.Object, source: PointValues, surface: Surface) -> AttributePart:
        """Make the problem of one mesh; `RefusedError` if there is none to be solved."""

    def selected(self, obj: bpy.types.Object) -> np.ndarray:
        """Which vertices (n,) bool of a mesh, now in Object Mode, are selected."""
        return mesh_io.selected_vertices(obj.data)

    @property
    def options(self) -> dict[str, object]:
        """The keyword arguments for the wheel that are the same for every mesh."""
        return solve_options(self.settings)

    def write(self, parts: Sequence[AttributePart]) -> None:
        """Write the results, and show them."""
        with mesh_io.object_mode():
            for part in parts:
                in_place = self.settings.output == "IN_PLACE"
                name = part.source.name
                target = name if in_place else attribute_names.result_name(name, self.suffix)
                part.target = attribute_io.write_values(part.object, part.source, part.merged(), target)
                part.warnings += _notes(part)
            notes = display.show([(part.object, part.target) for part in parts], self.settings)
        for part, note in zip(parts, notes, strict=True):
            part.warnings += note

    def figures(self, part: AttributePart) -> dict[str, object]:
        """Energies, gap, iterations, and the names of the attributes."""
        solved = part.task.result
        return {
            "attribute": part.source.name,
            "result": part.target,
            "energy_before": solved.energy_before,
            "energy_after": solved.energy_after,
            "gap": float(solved.solution.gap),
            "steps": int(solved.solution.iterations),
            "status": str(solved.solution.status),
        }

    def headline(self, done: Sequence[dict[str, object]]) -> str:
        """Which attribute of which mesh, energies, gap, time."""
        names = sorted({str(entry["attribute"]) for entry in done})
        results = sorted({str(entry["result"]) for entry in done})
        into = f' into "{results[0]}"' if len(results) == 1 and results != names else ""
        what = f'"{names[0]}"' if len(names) == 1 else f"{len(names)} attributes"
        after = f"{total(done, 'energy_after'):.4g}"
        befores = [entry["energy_before"] for entry in done if entry["energy_before"] is not None]
        energy = f"{sum(befores):.4g} → {after}" if befores else after
        gap, seconds = most(done, "gap"), total(done, "seconds")
        where = meshes_phrase(done)
        return f"{self.done_word} {what} of {where}{into}: energy {energy}, gap {gap:.1g}, {seconds:.1f} s"


def energy_on(mesh: ridgeform.Mesh, options: dict[str, object]) -> Callable[[np.ndarray], float]:
    """The energy of values (k,) or (k, c) that the options stand for, on the edges it is solved on."""
    edges = ridgeform.intrinsic_delaunay(mesh) if options["delaunay"] else mesh
    return partial(ridgeform.energy, edges, kind=options["energy"], dual=options["dual"])


def _notes(part: AttributePart) -> list[str]:
    notes = []
    solution = part.task.result.solution
    if solution.status == "inaccurate":
        notes.append(f"the tolerance was not reached, the gap is {solution.gap:.1g}")
    elif solution.status == "stopped":
        notes.append("stopped early, the result so far is kept")
    limited = part.limited_vertices()
    if limited:
        notes.append(f"values were clamped to their valid range at {limited} vertices")
    return notes
