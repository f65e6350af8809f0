# SPDX-License-Identifier: GPL-3.0-or-later
"""Denoising an attribute: Rowe et al. 2024, eq. (23), the selection only in Edit Mode."""

from functools import partial

import bpy
import numpy as np
import ridgeform

from ..blender.attribute_io import PointValues
from ..blender.refusals import RefusedError
from ..blender.selection import Needs
from ..framework.job import Task
from ..framework.sources import as_argument, varying_means
from ..framework.surface import Surface
from .attribute_run import AttributePart, AttributeRun, Solved, energy_on
from .jumps import cut, jumping, note_on
from .settings import DenoiseSettings, denoise_fidelity_of


class Denoising(AttributeRun):
    """One run of denoising."""

    name = "denoise_attribute"
    takes = DenoiseSettings
    call = "denoise"
    suffix = "_denoised"
    done_word = "Denoised"
    needs = Needs(coordinates=False)

    def pose(self, obj: bpy.types.Object, source: PointValues, surface: Surface) -> AttributePart:
        """Denoise all values, or those of the selection with the others held."""
        weld = surface.weld
        columns, values = varying_means(obj, source, weld)
        everywhere = np.ones(len(source.values), bool)
        free = weld.all_of(self.selected(obj) if self._in_edit_mode else everywhere)
        if not free.any():
            raise RefusedError(f'Nothing is selected in "{obj.name}": select the part to work on')
        notes = []
        if self.settings.use_jumps:
            across = jumping(surface.mesh.faces, values, self.settings.jump)
            if across.all():
                raise RefusedError(f'"{source.name}" jumps everywhere on "{obj.name}": raise Jump')
            surface, joined = cut(surface, across)
            free &= joined
            notes.append(note_on(across[: weld.n_own]))
        options = self.options
        if not free.all():
            options["fixed"] = ~free
        fidelity = self.settings.fidelity
        if not self.settings.use_fidelity:
            fidelity = fidelity_for(surface.mesh, values, self.settings.strength, self.settings.energy)
            if fidelity is None:
                raise RefusedError(f'"{source.name}" is the same on all of "{obj.name}" that has an area')
        part = AttributePart(
            obj,
            Task(obj.name, partial(_denoised, surface, values, fidelity, options), counted="iteration"),
            len(source.values),
            source=source,
            weld=weld,
            computed=free[weld.vertex],
            columns=columns,
            constants=source.values[0],
        )
        part.warnings += notes
        return part


def _denoised(
    surface: Surface,
    values: np.ndarray,
    fidelity: float,
    options: dict[str, object],
    progress: ridgeform.Progress,
) -> Solved:
    energy = energy_on(surface.mesh, options)
    before = energy(as_argument(values))
    solution = ridgeform.denoise(
        surface.mesh,
        as_argument(values),
        fidelity=fidelity,
        face_weights=surface.face_weights,
        progress=progress,
        **options,
    )
    return Solved(solution.values.reshape(values.shape), before, energy(solution.values), solution)


def fidelity_for(mesh: ridgeform.Mesh, values: np.ndarray, strength: float, energy: str) -> float | None:
    """The fidelity weight of values (k, c) on a mesh that a strength stands for; `None` if nothing varies."""
    mass = ridgeform.voronoi_mass(mesh)
    area = mass.sum()
    if not area > 0:
        return None
    deviation = values - mass @ values / area
    spread = np.sqrt(mass @ (deviation**2).sum(axis=1) / area)
    return denoise_fidelity_of(strength, float(spread), float(area), energy) if spread > 0 else None
