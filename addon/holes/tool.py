# SPDX-License-Identifier: GPL-3.0-or-later
"""Filling holes: Rowe et al. 2024, section 7.4.2, from reading a mesh to appending the patches to it."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import partial

import bpy
import numpy as np
import ridgeform

from ..blender import mesh_io
from ..blender.mirroring import Images
from ..blender.overlay import Overlay
from ..blender.refusals import NothingToDoError, RefusedError
from ..blender.welding import Weld
from ..framework.job import Task
from ..framework.preflight import reason_too_long
from ..framework.run import Part, Run, counted, meshes_phrase, panel_lines, total
from ..framework.settings import chosen as value_of
from ..framework.surface import welded
from .append import append
from .clipping import Pieces
from .extension import Extension, Source, extend
from .reading import picked_edges, read_source, reference_coordinates
from .settings import HoleSettings, hole_options, ridge_mask
from .surroundings import Patch

REFUSED = "refused"
"""What the wheel says the status of a hole is that it left open."""


@dataclass
class Filling:
    """What came of one mesh."""

    filled: ridgeform.Filled
    extension: Extension


@dataclass(kw_only=True)
class HolePart(Part):
    """One mesh of a run."""

    source: Source
    loops: list[np.ndarray]
    """The welded vertices of each hole that is filled."""
    n_faces: int = 0
    """How many faces were added."""
    shown: list[tuple[np.ndarray, np.ndarray]] = field(default_factory=list)
    """Vertices and triangles of the patches that the preview shows, the one in work last."""

    def see(self, surface: tuple[np.ndarray, np.ndarray]) -> None:
        """Take a patch as it is now for the preview, instead of an earlier state of it."""
        if self.shown and _same_hole(self.shown[-1][0], surface[0]):
            self.shown.pop()
        self.shown.append(surface)


class HoleFilling(Run):
    """One run of filling holes."""

    name = "fill_holes"
    takes = HoleSettings
    sums = ("holes", "hole", " filled")
    call = "mesh"

    def __init__(
        self, objects: Sequence[bpy.types.Object], settings: object, skipped: Sequence[str] = ()
    ) -> None:
        """Find the holes of the objects and prepare one task each."""
        self._overlay = Overlay()
        super().__init__(objects, settings, skipped)

    def prepare(self, obj: bpy.types.Object) -> HolePart:
        """Read one mesh, and choose which of its holes are filled."""
        coordinates = reference_coordinates(obj.data)
        weld, triangles = welded(obj, coordinates, whole=True)
        try:
            mesh = ridgeform.Mesh(weld.places(coordinates), weld.triangles)
            holes = own_holes(ridgeform.find_holes(mesh), weld)
        except ridgeform.RidgeformError as error:
            raise RefusedError(f'"{obj.name}": {error}') from error
        if not holes:
            none = {"name": obj.name, "holes": 0, "vertices_added": 0, "faces_added": 0, "ridge_edges": 0}
            raise NothingToDoError(f'"{obj.name}" has no holes', none)
        if self._in_edit_mode:
            holes = _picked(holes, weld.vertex[picked_edges(obj.data)], len(weld.first))
            if not holes:
                raise RefusedError(
                    f'No edge around a hole of "{obj.name}" is selected: select one of each hole'
                )
        chosen, reasons = _chosen(holes, self.settings, self._in_edit_mode)
        if not chosen:
            raise RefusedError(f'No hole of "{obj.name}" was filled: {"; ".join(reasons)}')
        loops = [hole.vertices for hole in chosen]
        reason = reason_too_long(obj, mesh, max(map(len, loops)))
        if reason is not None:
            raise RefusedError(reason)
        rims = np.concatenate(loops)
        rims = rims if weld.images is None else rims[rims < weld.images.n_vertices]
        source = read_source(obj.data, coordinates, triangles, weld, rims)
        part = HolePart(
            obj, Task(obj.name, None), len(coordinates), weld.notes + reasons, source=source, loops=loops
        )
        part.task.call = partial(_filled, part, mesh, hole_options(self.settings), self.settings.material)
        return part

    def show(self) -> bool:
        """Draw the patches as far as they are, over the untouched meshes; whether anything is new."""
        shown = []
        for part in self.parts:
            surface = part.task.progress.snapshot_surface() if part.task.started else None
            if surface is not None:
                part.see(surface)
            shown += [(part.object.matrix_world, *surface) for surface in part.shown]
        return self._overlay.show(shown)

    def clear(self) -> None:
        """Take the preview away: the meshes were not touched."""
        self._overlay.remove()

    def write(self, parts: Sequence[HolePart]) -> None:
        """Append the patches, select them, mark their ridges."""
        self._overlay.remove()
        with mesh_io.object_mode():
            for part in parts:
                mesh, extension = part.object.data, part.task.result.extension
                before = len(mesh.polygons)
                touched = append(part.object, extension)
                part.n_faces = len(mesh.polygons) - before
                if self.settings.marks:
                    ridges = ridge_mask(mesh_io.edges(mesh), extension.patch.ridges, len(mesh.vertices))
                    mesh_io.mark_edges(mesh, touched & ridges, self.settings.marks)

    def figures(self, part: HolePart) -> dict[str, object]:
        """How many holes and faces, ridge edges, and how the flow went."""
        filled, patch = part.task.result.filled, part.task.result.extension.patch
        done = [hole for hole in filled.holes if hole.status != REFUSED]
        return {
            "holes": len(done),
            "vertices_added": len(patch.points),
            "faces_added": part.n_faces,
            "ridge_edges": len(patch.ridges),
            "energy_before": float(sum(hole.energy[0] for hole in done)),
            "energy_after": float(sum(hole.energy[1] for hole in done)),
            "gap": float(max(hole.gap for hole in done)),
            "steps": int(max(hole.iterations for hole in done)),
            "status": str(filled.status),
        }

    @classmethod
    def lines(cls, entry: dict[str, object]) -> list[str]:
        """How many holes, faces and ridge edges there are, and how long it took."""
        filled = f"{entry['holes']} filled, {counted(entry['faces_added'], 'face')}"
        return panel_lines(entry, filled, counted(entry["ridge_edges"], "ridge edge"))

    def headline(self, done: Sequence[dict[str, object]]) -> str:
        """Holes, faces, ridges, time."""
        holes = counted(total(done, "holes"), "hole")
        faces = counted(total(done, "faces_added"), "face")
        ridges = total(done, "ridge_edges")
        along = f", ridges along {counted(ridges, 'edge')}" if ridges else ""
        seconds = total(done, "seconds")
        return f"Filled {holes} of {meshes_phrase(done)}: {faces} added{along}, {seconds:.1f} s"


def own_holes(holes: Sequence[ridgeform.Hole], weld: Weld) -> list[ridgeform.Hole]:
    """Those of the holes that lie on the mesh itself, at least in part, and not on its images alone."""
    if weld.images is None:
        return list(holes)
    n_own, is_pinned = weld.images.n_vertices, weld.images.is_pinned

    def is_own(vertices: np.ndarray) -> bool:
        return bool((vertices < n_own).all() or ((vertices < n_own) & ~is_pinned[vertices]).any())

    return [hole for hole in holes if is_own(hole.vertices)]


def _same_hole(vertices: np.ndarray, others: np.ndarray) -> bool:
    """Whether these are vertices (k, 3) of one patch at two times: those around the hole stay."""
    return vertices.shape == others.shape and bool((vertices == others).all(axis=1).any())


def _picked(holes: Sequence[ridgeform.Hole], edges: np.ndarray, n_vertices: int) -> list[ridgeform.Hole]:
    """Those of the holes that have one of the welded edges (k, 2) around them."""
    return [hole for hole in holes if ridge_mask(_around(hole), edges, n_vertices).any()]


def _around(hole: ridgeform.Hole) -> np.ndarray:
    return np.stack([hole.vertices, np.roll(hole.vertices, -1)], axis=1)


def _chosen(
    holes: Sequence[ridgeform.Hole], settings: object, picked: bool
) -> tuple[list[ridgeform.Hole], list[str]]:
    """The holes to be filled, and why others are not, with how many of them there are."""
    outer = settings.outer or (picked and all(hole.is_outer_border for hole in holes))
    most = value_of(settings, "max_edges")
    chosen, reasons = [], Counter()
    for hole in holes:
        size = len(hole.vertices)
        if hole.is_outer_border and not outer:
            reasons["it is the outer border of an open sheet"] += 1
        elif most is not None and size > most:
            reasons[f"it has more than {most} edges"] += 1
        elif hole.refusal is not None:
            reasons[hole.refusal] += 1
        else:
            chosen.append(hole)
    return chosen, _skipped(reasons)


def _skipped(reasons: Counter[str]) -> list[str]:
    return [f"{counted(count, 'hole')} skipped ({reason})" for reason, count in reasons.items()]


def _filled(
    part: HolePart,
    mesh: ridgeform.Mesh,
    options: dict[str, object],
    material: str,
    progress: ridgeform.Progress,
) -> Filling:
    filled = ridgeform.fill_holes(mesh, loops=part.loops, progress=progress, **options)
    refused = Counter(hole.reason for hole in filled.holes if hole.status == REFUSED)
    part.warnings += _skipped(refused)
    if refused.total() == len(filled.holes):
        raise ridgeform.MeshError("; ".join(_skipped(refused)))
    patch = patch_of(filled, part.source)
    return Filling(filled, extend(part.source, patch, material, lambda: part.task.cancelled))


def patch_of(filled: ridgeform.Filled, source: Source) -> Patch:
    """The new part of a filled mesh, in the vertices of the mesh before its split seams were joined."""
    weld, n = source.weld, len(source.coordinates)
    n_welded = len(weld.first)
    pieces = Pieces(
        weld.places(source.coordinates),
        filled.new_vertices,
        filled.new_faces,
        filled.new_patch,
        filled.ridges,
    )
    if weld.images is not None:
        _keep_own_side(pieces, weld.images)
    ridges = pieces.ridges
    old = weld.first[np.minimum(ridges, n_welded - 1)]
    return Patch(
        pieces.points,
        _unwelded(pieces.triangles, source),
        pieces.hole,
        np.where(ridges < n_welded, old, ridges - n_welded + n),
    )


def _keep_own_side(pieces: Pieces, images: Images) -> None:
    """Cut the patches of holes across the planes of mirrors there."""
    own = pieces.places[: images.n_vertices]
    for plane in images.planes:
        side = np.sign(float((own @ plane.normal - plane.offset).sum())) or 1.0
        is_on = np.zeros(len(pieces.places), bool)
        is_on[: images.n_vertices] = plane.is_on
        pieces.cut(side * plane.normal, side * plane.offset, is_on)
    pieces.compact()


def _unwelded(new: np.ndarray, source: Source) -> np.ndarray:
    """New triangles (p, 3) in vertices of the mesh: beside an edge of the mesh the two that this edge has."""
    weld, n, n_welded = source.weld, len(source.coordinates), len(source.weld.first)
    result = np.where(new < n_welded, weld.first[np.minimum(new, n_welded - 1)], new - n_welded + n)
    split = np.bincount(weld.vertex, minlength=n_welded) > 1
    rim = np.unique(new[new < n_welded])
    if not split[rim].any():
        return result
    wanted = {(b, a) for tri in new.tolist() for a, b in zip(tri, tri[1:] + tri[:1], strict=True)}
    sides = np.concatenate([source.triangles[:, [i, (i + 1) % 3]] for i in range(3)])
    sides = sides[np.isin(weld.vertex[sides], rim[split[rim]]).any(axis=1)]
    own = {tuple(weld.vertex[side].tolist()): side.tolist() for side in sides}
    for row, triangle in enumerate(new.tolist()):
        for i in range(3):
            edge = (triangle[(i + 1) % 3], triangle[i])
            if edge in wanted and edge in own:
                result[row, (i + 1) % 3], result[row, i] = own[edge]
    return result
