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
from ..framework import faceting, keeping
from ..framework.faceting import Facetable, FacetMesh
from ..framework.job import Task
from ..framework.run import Part, Run, counted, meshes_phrase, most, panel_lines, percent, total
from ..framework.surface import group_weights, painted_edges, surface_of
from ..framework.volume import is_closed, volume_and_centroid
from .settings import FacetSettings, by_count, by_error, has_halves, keeps_faces, may_simplify

KEY_NAME = "Facets"

SAME_VOLUME = 1e-4
"""A volume that changes by a smaller part is kept: nobody could tell."""


@dataclass
class Made:
    """The facets that were found, and what the mesh becomes."""

    found: ridgeform.Faceted
    mesh: FacetMesh
    notes: list[str]
    """What a modeler should know of what was to be kept."""


@dataclass(kw_only=True)
class FacetPart(Part):
    """One mesh of a run; the result of its task is a `Made`."""

    source: Facetable
    size: float
    """The diagonal of the bounding box."""
    coordinates: np.ndarray
    """Where its vertices (n, 3) are, in the active shape key if it has any."""
    as_key: bool = False
    """Whether the result is a shape key."""


class Faceting(Run):
    """One run of making facets."""

    name = "facet"
    takes = FacetSettings
    sums = ("facets", "facet", "")

    @property
    def call(self) -> str:
        """On a simplified mesh it takes less."""
        simplifies = self.settings.coarse_to_fine and may_simplify(self.settings)
        return "facet_coarse_to_fine" if simplifies else "facet"

    def prepare(self, obj: bpy.types.Object) -> FacetPart:
        """Read shape, layers, selection, mask and ridge paint of one mesh."""
        mesh = obj.data
        if mesh.shape_keys is not None and not keeps_faces(self.settings):
            raise RefusedError(
                f'"{obj.name}" has shape keys, which no other faces can have: choose the topology Kept, or '
                "apply or remove them first"
            )
        coordinates = mesh_io.open_coordinates(obj).original
        surface = surface_of(obj)
        taking = _taking(obj, self.settings, self._in_edit_mode)
        source = faceting.read(obj, surface.weld, taking)
        weights = painted_edges(obj, self.settings, mesh_io.triangles(mesh), surface.weld)
        size = float(np.linalg.norm(np.ptp(surface.mesh.vertices, axis=0)))
        if has_halves(self.settings):
            _refuse_parts(obj, self.settings, taking)
        if self.settings.keep_volume and not is_closed(surface.weld.triangles, len(surface.weld.first)):
            raise RefusedError(
                f'"{obj.name}" encloses no volume to keep: it is open, or its faces disagree on the outside'
            )
        task = Task(obj.name, lambda _: None, counted="iteration")
        part = FacetPart(obj, task, len(mesh.vertices), source=source, size=size, coordinates=coordinates)
        part.as_key = keeps_faces(self.settings) and (self.settings.shape_key or mesh.shape_keys is not None)
        if keeps_faces(self.settings):
            old, polygons, rows = source.before.old, source.before.polygons, surface.weld.rows
            faces = old.faces[rows]
            weights = keeping.along_faces(
                old.corners[rows], polygons.starts[faces], polygons.sizes[faces], weights
            )
        task.call = partial(_made, part, surface.mesh, weights, self.settings)
        part.warnings += surface.weld.notes
        part.warnings += modifiers.mirror_notes(obj, coordinates)
        part.warnings += modifiers.shape_notes(obj, "CREASE" in self.settings.marks)
        return part

    def replaces_faces(self, part: FacetPart) -> bool:
        """Facets are other faces, but for a shape key."""
        return part.task.result is not None and not part.as_key

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
        if part.as_key:
            mesh_io.add_shape_key(obj, made.rebuilt.points, KEY_NAME)
            return
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
            "warnings": part.warnings + faceting.notes(found, made.mesh.rebuilt, wanted) + made.notes,
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


def _refuse_parts(obj: bpy.types.Object, settings: object, taking: np.ndarray) -> None:
    """`RefusedError` where facets cannot be mirrored, with faces `taking` (f,) bool part."""
    if not taking.all():
        raise RefusedError(
            f'Facets of a part of "{obj.name}" cannot be symmetric: select all faces and take no mask'
        )
    if settings.keep_volume:
        raise RefusedError("Symmetric facets cannot keep the volume: choose one of both")


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
    found, facet_mesh = faceting.facets_of(
        part.source,
        mesh,
        part.coordinates,
        edge_weights=weights,
        topology=settings.topology,
        flips=not part.as_key,
        keep_volume=settings.keep_volume,
        symmetric=settings.symmetric if has_halves(settings) else None,
        coarse_to_fine=settings.coarse_to_fine,
        flat="SHARP" in settings.marks,
        progress=progress,
        check=part.task.check,
        **given,
    )
    return Made(found, facet_mesh, _volume_notes(found, mesh) if settings.keep_volume else [])


def _volume_notes(found: ridgeform.Faceted, mesh: ridgeform.Mesh) -> list[str]:
    """What is to be said of a volume that was to be kept."""
    wanted, _ = volume_and_centroid(mesh.vertices, mesh.faces)
    reached, _ = volume_and_centroid(found.vertices, found.faces)
    off = reached / wanted - 1.0
    if abs(off) <= SAME_VOLUME:
        return []
    return [f"the volume changed by {percent(off)}: what is held leaves no room for more"]
