# SPDX-License-Identifier: GPL-3.0-or-later
"""Vibration modes of a surface as attributes: Rowe et al. 2024, eq. (38)."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial

import bpy
import numpy as np
import ridgeform

from ..blender import attribute_io, display, mesh_io
from ..blender.selection import Needs
from ..blender.welding import Weld
from ..framework.job import Task
from ..framework.run import Part, Run, meshes_phrase, most, total
from ..framework.surface import Surface, half_notes, surface_of
from .attribute_run import energy_on
from .settings import ModesSettings, energy_options

PREFIX = "ridgeform_mode_"


@dataclass
class Modes:
    """What came of one mesh: modes (k, count) of the welded vertices, and the energy of each."""

    values: np.ndarray
    energies: list[float]


@dataclass(kw_only=True)
class ModesPart(Part):
    """One mesh of a run."""

    weld: Weld


class VibrationModes(Run):
    """One run of vibration modes, on whole meshes."""

    name = "vibration_modes"
    takes = ModesSettings
    call = "vibration_modes"
    counted = "modes"
    needs = Needs(coordinates=False, selection=False)

    def prepare(self, obj: bpy.types.Object) -> ModesPart:
        """Read one mesh."""
        surface = surface_of(obj)
        call = partial(_modes, surface, self.settings.count, energy_options(self.settings))
        task = Task(obj.name, call, counted="mode")
        notes = surface.weld.notes + half_notes(obj, surface, "these are the modes of")
        return ModesPart(obj, task, len(obj.data.vertices), notes, weld=surface.weld)

    def write(self, parts: Sequence[ModesPart]) -> None:
        """Write the modes over those of an earlier run, and show one of them."""
        shown = []
        with mesh_io.object_mode():
            for part in parts:
                mesh, modes = part.object.data, part.task.result.values[part.weld.vertex]
                for index, mode in enumerate(modes.T):
                    attribute_io.write_floats(mesh, f"{PREFIX}{index}", mode)
                for name in _modes_beyond(mesh, modes.shape[1]):
                    mesh.attributes.remove(mesh.attributes[name])
                shown.append((part.object, f"{PREFIX}{min(self.settings.shown, modes.shape[1] - 1)}"))
            notes = display.show(shown, self.settings, signed=True)
        for part, note in zip(parts, notes, strict=True):
            part.warnings += note

    def figures(self, part: ModesPart) -> dict[str, object]:
        """How many modes there are, and the energies."""
        modes = part.task.result
        return {
            "energies": modes.energies,
            "energy_after": modes.energies[-1],
            "steps": len(modes.energies),
            "status": "finished" if len(modes.energies) == self.settings.count else "stopped",
        }

    def headline(self, done: Sequence[dict[str, object]]) -> str:
        """How many modes of which mesh, the energy of the last one, time."""
        count, energy, seconds = most(done, "steps"), most(done, "energy_after"), total(done, "seconds")
        where = meshes_phrase(done)
        return f"{count} vibration modes of {where}, energies up to {energy:.4g}, {seconds:.1f} s"


def _modes(surface: Surface, count: int, options: dict[str, object], progress: ridgeform.Progress) -> Modes:
    values = ridgeform.vibration_modes(surface.mesh, count, progress=progress, **options)
    energy = energy_on(surface.mesh, options)
    return Modes(values, [energy(mode) for mode in values.T])


def _modes_beyond(mesh: bpy.types.Mesh, count: int) -> list[str]:
    """The names of modes that an earlier run has left and this one has not written over."""
    names = mesh.attributes.keys()
    indices = (name.removeprefix(PREFIX) for name in names if name.startswith(PREFIX))
    return [f"{PREFIX}{index}" for index in indices if index.isdecimal() and int(index) >= count]
