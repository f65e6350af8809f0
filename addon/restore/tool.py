# SPDX-License-Identifier: GPL-3.0-or-later
"""Restoring noisy parts: from reading a mesh to writing vertices and surfaces back."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial

import bpy
import numpy as np
import ridgeform

from ..blender import mesh_io, modifiers
from ..blender.refusals import RefusedError
from ..blender.stored_numbers import write_numbers
from ..blender.welding import Weld
from ..framework.job import Task
from ..framework.preflight import uneven_scale
from ..framework.ridges import Edges
from ..framework.run import Part, Run, counted, meshes_phrase, panel_lines, total
from ..framework.surface import group_weights, surface_of
from . import empties
from .settings import RestoreSettings, restore_options

SURFACE = "ridgeform_surface"
"""The face attribute with the number of the surface, -1 for none."""
KIND = "ridgeform_surface_kind"
KINDS = ("free", "plane", "sphere", "cylinder", "cone", "torus")
"""The kinds by their number in the attribute."""

LEAST_CREASE = np.radians(30.0)
"""Where a curved surface meets another one at this angle there is a crease. Its own edges are chords, bent by
themselves: as Blender's Smooth by Angle has it, so that a fillet stays smooth where it is tangent. Two planes
that meet always make one."""


@dataclass(kw_only=True)
class RestorePart(Part):
    """One mesh of a run."""

    coordinates: mesh_io.Coordinates
    weld: Weld
    moving: np.ndarray
    """Which vertices (n,) bool may move."""

    def face_labels(self) -> np.ndarray:
        """The surface (f,) of each face: that of its largest triangle, or -1."""
        own = slice(0, self.weld.n_own)
        labels = np.full(len(self.object.data.polygons), -1, np.int32)
        places = self.weld.places(self.coordinates.original)
        a, b, c = (places[self.weld.triangles[own, corner]] for corner in range(3))
        order = np.argsort(np.linalg.norm(np.cross(b - a, c - a), axis=1), kind="stable")
        # The last one that is written stays: the largest.
        faces = mesh_io.triangle_faces(self.object.data)[self.weld.rows[own]]
        labels[faces[order]] = self.task.result.labels[own][order]
        return labels

    def moved(self) -> np.ndarray:
        """The new coordinates (n, 3) float32; what is held keeps its bits."""
        before = self.coordinates.original
        after = self.weld.moved(self.task.result.vertices, before)
        still = self.task.result.vertices == self.weld.places(before)
        kept = ~self.moving | still.all(axis=1)[self.weld.vertex]
        return np.where(kept[:, None], before, after)


class Restoring(Run):
    """One run of restoring."""

    name = "restore"
    takes = RestoreSettings
    call = "restore"

    def prepare(self, obj: bpy.types.Object) -> RestorePart:
        """Read coordinates, selection and mask of one mesh."""
        mesh = obj.data
        surface = surface_of(obj, whole=True)
        weld, coordinates = surface.weld, mesh_io.open_coordinates(obj)
        n = len(coordinates.original)
        free = mesh_io.selected_vertices(mesh) if self._in_edit_mode else np.ones(n, bool)
        if self.settings.strength_group:
            free &= group_weights(obj, self.settings.strength_group) > 0
        moving = weld.all_of(free)
        if not moving.any():
            raise RefusedError(
                f'No vertex of "{obj.name}" may move: nothing is selected, or the mask is empty there'
            )
        options = restore_options(self.settings)
        if not moving.all():
            options["fixed"] = ~moving
        task = Task(obj.name, partial(_restored, surface.mesh, options))
        part = RestorePart(obj, task, n, coordinates=coordinates, weld=weld, moving=moving[weld.vertex])
        part.warnings += weld.notes
        part.warnings += modifiers.normal_notes(mesh)
        part.warnings += modifiers.key_notes(obj)
        if uneven_scale(obj) is not None:
            part.warnings.append(
                "its scale is uneven, so surfaces are found on the unscaled shape (apply the scale to "
                "avoid that)"
            )
        return part

    def write(self, parts: Sequence[RestorePart]) -> None:
        """Write coordinates, and what else was asked for."""
        with mesh_io.object_mode():
            for part in parts:
                self._write_one(part)

    def _write_one(self, part: RestorePart) -> None:
        found, obj = part.task.result, part.object
        part.warnings += _notes(found)
        moved, labels = part.moved(), part.face_labels()
        kinds = np.array([KINDS.index(surface["kind"]) for surface in found.surfaces] + [-1], np.int32)
        if found.status != "unsure":
            part.coordinates.write(moved)
            mesh_io.mark_edges(obj.data, _creases(part, moved, labels, kinds), self.settings.marks)
        if "ATTRIBUTES" in self.settings.outputs:
            write_numbers(obj.data, SURFACE, "INT", "FACE", labels)
            write_numbers(obj.data, KIND, "INT", "FACE", kinds[labels])
        if "EMPTIES" in self.settings.outputs:
            empties.remove_earlier(obj)
            empties.add(obj, found.surfaces, _middles(part, found))
        obj.data.update()

    def figures(self, part: RestorePart) -> dict[str, object]:
        """The surfaces, the noise, and how far vertices moved."""
        found = part.task.result
        before = part.coordinates.original.astype(np.float64)
        size = float(np.linalg.norm(np.ptp(before, axis=0))) or 1.0
        return {
            "surfaces": found.surfaces,
            "noise": float(found.noise),
            "moved": float(np.sqrt(((part.moved() - before) ** 2).sum(axis=1).mean())) / size,
            "held": int(found.n_held),
            "folded": int(found.n_folded),
            "relations": list(found.relations),
            "status": str(found.status),
        }

    @classmethod
    def lines(cls, entry: dict[str, object]) -> list[str]:
        """How many surfaces of which kind there are, the noise, and what is parallel or equal."""
        said = panel_lines(entry, _kinds_phrase([entry]), f"noise {entry['noise']:.3g}")
        return [*said, *entry["relations"]]

    @classmethod
    def phrases(cls, done: Sequence[dict[str, object]]) -> list[str]:
        """How many surfaces of which kind there are."""
        return [_kinds_phrase(done)] if done else []

    def headline(self, done: Sequence[dict[str, object]]) -> str:
        """How many surfaces of which kind, and how long it took."""
        return f"Restored {meshes_phrase(done)} in {total(done, 'seconds'):.1f} s: {_kinds_phrase(done)}"


def _restored(
    mesh: ridgeform.Mesh, options: dict[str, object], progress: ridgeform.Progress
) -> ridgeform.Restored:
    return ridgeform.restore(mesh, progress=progress, **options)


def _creases(part: RestorePart, moved: np.ndarray, labels: np.ndarray, kinds: np.ndarray) -> np.ndarray:
    """The edges (k,) bool where two surfaces meet at an angle, and vertices were free to move.

    Of the mesh with coordinates `moved` (n, 3), the surface of each face (f,), and the number of the kind of
    each surface, with that of no surface last.
    """
    mesh = part.object.data
    edges = Edges(mesh_io.edges(mesh), mesh_io.face_corners(mesh))
    sides = edges.sides(labels)
    are_planes = (kinds[sides] == KINDS.index("plane")).all(axis=1)
    free = part.moving[edges.ends].any(axis=1)
    return free & (sides[:, 0] != sides[:, 1]) & (are_planes | edges.ridges(moved, LEAST_CREASE))


def _kinds_phrase(done: Sequence[dict[str, object]]) -> str:
    names = [surface["kind"] for entry in done for surface in entry["surfaces"]]
    present = [kind for kind in (*KINDS[1:], "free") if kind in names]
    return ", ".join(_counted_kind(names.count(kind), kind) for kind in present) or "no surface"


def _counted_kind(count: int, kind: str) -> str:
    if kind == "torus" and count > 1:
        return f"{count} tori"
    return counted(count, "free piece" if kind == "free" else kind)


def _notes(found: ridgeform.Restored) -> list[str]:
    notes = []
    if found.status == "unsure":
        notes.append("no piece is sure to be a plane, sphere, cylinder, cone, or torus: nothing was moved")
    elif found.status == "stopped":
        notes.append("stopped early: vertices may be as they were")
    elif any(surface["kind"] == "free" for surface in found.surfaces):
        count = sum(surface["kind"] == "free" for surface in found.surfaces)
        notes.append(f"{counted(count, 'piece')} of no known kind")
    if found.status == "restored" and found.n_held:
        notes.append(f"{counted(found.n_held, 'corner')} would have moved too far and lie on fewer surfaces")
    if found.n_folded:
        notes.append(f"{counted(found.n_folded, 'triangle')} still folded: check the mesh there")
    return notes


def _middles(part: RestorePart, found: ridgeform.Restored) -> np.ndarray:
    """The middle (k, 3) of the corners of each surface's triangles."""
    middles = np.zeros((len(found.surfaces), 3))
    triangles = part.weld.triangles
    for k in range(len(found.surfaces)):
        chosen = np.unique(triangles[found.labels == k])
        if len(chosen):
            middles[k] = found.vertices[chosen].mean(axis=0)
    return middles
