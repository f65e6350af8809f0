# SPDX-License-Identifier: GPL-3.0-or-later
"""Interpolating an attribute: Rowe et al. 2024, eq. (22), from the selection or into it."""

from functools import partial

import bpy
import numpy as np
import ridgeform

from ..blender.attribute_io import PointValues, read_values
from ..blender.attribute_names import GROUP
from ..blender.refusals import RefusedError
from ..blender.selection import Needs
from ..blender.welding import connected_parts
from ..framework.job import Task
from ..framework.sources import as_argument, refuse_mixed, refuse_non_finite, varying
from ..framework.surface import Surface
from .attribute_run import AttributePart, AttributeRun, Solved, energy_on
from .jumps import cut, jumping, note_on
from .settings import InterpolateSettings


class Interpolation(AttributeRun):
    """One run of interpolating."""

    name = "interpolate_attribute"
    takes = InterpolateSettings
    call = "interpolate"
    suffix = "_interpolated"
    done_word = "Interpolated"
    needs = Needs(coordinates=False, selection=False)

    def pose(self, obj: bpy.types.Object, source: PointValues, surface: Surface) -> AttributePart:
        """Compute all values that are not known; connected parts without a known one stay as they are."""
        known = self._known(obj, source)
        if not known.any():
            raise RefusedError(f'No value of "{source.name}" of "{obj.name}" is known: {self._cure(False)}')
        refuse_mixed(obj, source, known)
        refuse_non_finite(obj, source, known)
        weld = surface.weld
        count = weld.sum_of(known)
        given = count > 0
        columns = varying(source.values[known])
        if not columns.any():
            # One value everywhere is a problem like any other, and the wheel says how exact its answer is.
            columns[:] = True
        # A value that is not known may be anything, NaN too.
        kept = np.where(known[:, None], source.values[:, columns], 0.0)
        sums = np.stack([weld.sum_of(column) for column in kept.T], axis=1)
        values = sums / np.maximum(count, 1.0)[:, None]
        notes = []
        triangles = weld.triangles
        if self.settings.use_jumps:
            across = jumping(triangles, values, self.settings.jump, given)
            if across.all():
                raise RefusedError(f'"{source.name}" jumps everywhere on "{obj.name}": raise Jump')
            triangles = triangles[~across]
            surface, _ = cut(surface, across)
            notes.append(note_on(across[: weld.n_own]))
        part = connected_parts(triangles, len(weld.first))
        idle = ~np.isin(part, part[given])
        computed = ~given & ~idle
        if not computed.any():
            raise RefusedError(f'Every value of "{source.name}" of "{obj.name}" is known: {self._cure(True)}')
        indices = np.flatnonzero(given | idle)
        call = partial(_interpolated, surface, indices, values[indices], self.options)
        made = AttributePart(
            obj,
            Task(obj.name, call, counted="iteration"),
            len(known),
            source=source,
            weld=weld,
            computed=computed[weld.vertex],
            columns=columns,
            constants=source.values[np.argmax(known)],
        )
        made.warnings += notes
        n_idle = len(np.unique(part[idle & np.isin(np.arange(len(part)), weld.triangles[: weld.n_own])]))
        if n_idle:
            made.warnings.append(f"{n_idle} connected parts without a known value stay as they are")
        return made

    def _known(self, obj: bpy.types.Object, source: PointValues) -> np.ndarray:
        known = self.settings.known
        if known == "GROUP":
            name = self.settings.known_group
            if name:
                if name not in obj.vertex_groups:
                    raise RefusedError(f'"{obj.name}" has no vertex group "{name}"')
                return read_values(obj, name).member
            if source.data_type != GROUP:
                raise RefusedError("Choose the vertex group of the vertices whose values are known")
            return source.member
        selected = self.selected(obj)
        return selected if known == "SELECTED" else ~selected

    def _cure(self, all_known: bool) -> str:
        return {
            ("SELECTED", False): "select the vertices whose values are known, in Edit Mode",
            ("SELECTED", True): "select fewer vertices, in Edit Mode",
            ("UNSELECTED", False): "select only the vertices to be filled in, in Edit Mode",
            ("UNSELECTED", True): "select the vertices to be filled in, in Edit Mode",
            ("GROUP", False): "assign the vertices whose values are known to the vertex group",
            ("GROUP", True): "remove the vertices to be filled in from the vertex group",
        }[self.settings.known, all_known]


def _interpolated(
    surface: Surface,
    indices: np.ndarray,
    values: np.ndarray,
    options: dict[str, object],
    progress: ridgeform.Progress,
) -> Solved:
    solution = ridgeform.interpolate(
        surface.mesh,
        indices,
        as_argument(values),
        face_weights=surface.face_weights,
        progress=progress,
        **options,
    )
    after = energy_on(surface.mesh, options)(solution.values)
    return Solved(solution.values.reshape(-1, values.shape[1]), None, after, solution)
