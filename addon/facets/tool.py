# SPDX-License-Identifier: GPL-3.0-or-later
"""Making facets of meshes, from reading a mesh to writing it back; the selected faces only in Edit Mode."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial

import bpy
import numpy as np
import ridgeform

from ..blender import kept_normals, mesh_io, modifiers, rebuilding
from ..blender.refusals import RefusedError
from ..framework import faceting
from ..framework.faceting import Facetable, FacetMesh
from ..framework.job import Task
from ..framework.run import Part, Run, counted, meshes_phrase, most, panel_lines, percent, total
from ..framework.surface import group_weights, painted_edges, surface_of
from .settings import FacetSettings, by_count, by_error


@dataclass
class Made:
    """The facets that were found, and what the mesh becomes."""

    found: ridgeform.Faceted
    mesh: FacetMesh


@dataclass(kw_only=True)
class FacetPart(Part):
    """One mesh of a run; the result of its task is a `Made`."""

    source: Facetable
    size: float
    """The diagonal of the bounding box."""


class Faceting(Run):
    """One run of making facets."""

    name = "facet"
    takes = FacetSettings
    sums = ("facets", "facet", "")
    call = "facet"

    def prepare(self, obj: bpy.types.Object) -> FacetPart:
        """Read shape, layers, selection, mask and ridge paint of one mesh."""
        mesh = obj.data
        if mesh.shape_keys is not None:
            raise RefusedError(
                f'"{obj.name}" has shape keys, which no other faces can have: apply or remove them first'
            )
        coordinates = mesh_io.positions(mesh)
        surface = surface_of(obj)
        taking = _taking(obj, self.settings, self._in_edit_mode)
        source = faceting.read(obj, surface.weld, taking)
        weights = painted_edges(obj, self.settings, mesh_io.triangles(mesh), surface.weld)
        size = float(np.linalg.norm(np.ptp(surface.mesh.vertices, axis=0)))
        task = Task(obj.name, lambda _: None, counted="iteration")
        part = FacetPart(obj, task, len(mesh.vertices), source=source, size=size)
        task.call = partial(_made, part, surface.mesh, weights, self.settings)
        part.warnings += surface.weld.notes
        part.warnings += modifiers.mirror_notes(obj, coordinates)
        part.warnings += modifiers.shape_notes(obj, "CREASE" in self.settings.marks)
        return part

    def replaces_faces(self, part: FacetPart) -> bool:
        """Facets are other faces."""
        return part.task.result is not None

    def check(self, part: FacetPart) -> None:
        """What lies on a mesh must be what was carried over."""
        # Its attributes cannot be read in Edit Mode, where the state of the mesh has to do.
        if self.replaces_faces(part) and not part.object.data.is_editmode:
            rebuilding.check(part.object, part.source.before)

    def write(self, parts: Sequence[FacetPart]) -> None:
        """Write the facets and mark the edges between them."""
        with mesh_io.object_mode():
            for part in parts:
                self._write_one(part)

    def _write_one(self, part: FacetPart) -> None:
        obj, made = part.object, part.task.result.mesh
        rows = rebuilding.write(obj, made.rebuilt)
        ridges = made.ridges()[rows]
        mesh_io.mark_edges(obj.data, ridges, self.settings.marks)
        if self.settings.mark_seams:
            mesh_io.mark_seams(obj.data, ridges)
        kept_normals.write(obj.data, made.rebuilt.normals)

    def figures(self, part: FacetPart) -> dict[str, object]:
        """How many facets there are, and how far they are from the mesh in parts of its size."""
        made = part.task.result
        found = made.found
        wanted = self.settings.facets if by_count(self.settings) else None
        return {
            "facets": int(found.n_facets),
            "rms": found.rms / part.size,
            "moved": found.largest / part.size,
            "crossings": int(found.n_crossings),
            "status": str(found.status),
            "faces": len(part.object.data.polygons),
            "warnings": part.warnings + faceting.notes(found, made.mesh.rebuilt, wanted),
        }

    @classmethod
    def lines(cls, entry: dict[str, object]) -> list[str]:
        """How many facets there are, how far they are from the mesh, time."""
        return panel_lines(
            entry, counted(entry["facets"], "facet"), f"{percent(entry['rms'])} of the size off"
        )

    def headline(self, done: Sequence[dict[str, object]]) -> str:
        """How many facets of which mesh, how far from it, time."""
        what = f"{counted(total(done, 'facets'), 'facet')} of {meshes_phrase(done)}"
        return f"{what} in {total(done, 'seconds'):.1f} s, {percent(most(done, 'rms'))} of the size off"


def _taking(obj: bpy.types.Object, settings: object, edited: bool) -> np.ndarray:
    """Which faces (f,) bool take part."""
    mesh = obj.data
    taking = mesh_io.selected_faces(mesh) if edited else np.ones(len(mesh.polygons), bool)
    if not taking.any():
        raise RefusedError(f'No face of "{obj.name}" is selected: select the faces to make facets of')
    if settings.strength_group:
        outside = group_weights(obj, settings.strength_group) == 0
        starts, corners, _ = mesh_io.face_corners(mesh)
        taking &= ~np.logical_or.reduceat(outside[corners], starts)
        if not taking.any():
            raise RefusedError(f'No face of "{obj.name}" may change: the mask is empty where it is selected')
    return taking


def _made(
    part: FacetPart,
    mesh: ridgeform.Mesh,
    weights: np.ndarray | None,
    settings: object,
    progress: ridgeform.Progress,
) -> Made:
    """The facets of a mesh, and what it becomes: in the thread of the job."""
    given: dict[str, object] = {}
    if by_count(settings):
        given["facets"] = settings.facets
    elif by_error(settings):
        given["error"] = 0.01 * settings.error * part.size
    return Made(
        *faceting.facets_of(
            part.source,
            mesh,
            part.source.before.old.coordinates,
            edge_weights=weights,
            triangles=settings.topology == "TRIANGLES",
            flat="SHARP" in settings.marks,
            progress=progress,
            check=part.task.check,
            **given,
        )
    )
