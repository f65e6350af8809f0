# SPDX-License-Identifier: GPL-3.0-or-later
"""Stylizing meshes piecewise flat: Rowe et al. 2024, eq. (24), from reading a mesh to writing it back."""

import contextlib
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import partial

import bpy
import numpy as np
import ridgeform

from .. import mesh_io
from ..finishing.reduction import reduce_mesh
from ..finishing.ridges import ridge_edges
from ..finishing.volume import keep_volume
from ..job import Job, Task, store_summary
from ..settings import ridge_weights_of, stylize_options
from ..welding import Weld, weld_seams

KEY_NAME = "Stylized"
NOT_BEGUN = "not begun"
UNEVEN_SCALE = 1.1
"""Object scales that differ by more than this ratio visibly change which facets the flow prefers."""


@dataclass
class Part:
    """One mesh of a run."""

    object: bpy.types.Object
    coordinates: mesh_io.Coordinates
    weld: Weld
    free: np.ndarray
    """Which vertices (n,) bool may move."""
    task: Task
    warnings: list[str] = field(default_factory=list)

    def merged(self, vertices: np.ndarray) -> np.ndarray:
        """Coordinates (n, 3) float32 from welded vertices, with the old bits where none may move."""
        new = np.asarray(vertices, np.float32)[self.weld.vertex]
        return np.where(self.free[:, None], new, self.coordinates.original)


class RefusedError(Exception):
    """A mesh that cannot be stylized; the message says why."""


class Stylization:
    """One run of stylize over some meshes: prepare, let `job` run, then `apply` or `restore`.

    `skipped` are sentences on objects that do not take part. Meshes that cannot be stylized are added to it,
    unless none is left: then `RefusedError` is raised.
    """

    def __init__(
        self, objects: Sequence[bpy.types.Object], settings: object, skipped: Sequence[str] = ()
    ) -> None:
        """Read the meshes of the objects and prepare one task each."""
        self.settings = settings
        self.skipped = list(skipped)
        self.parts: list[Part] = []
        for obj in objects:
            try:
                self.parts.append(_prepare(obj, settings))
            except RefusedError as refusal:
                self.skipped.append(str(refusal))
        if not self.parts:
            raise RefusedError(self.skipped[-1] if self.skipped else "Select a mesh object")
        self.job = Job([part.task for part in self.parts])
        self.summary: list[dict[str, object]] = []
        self._shown: dict[int, tuple[int, float]] = {}

    def preview(self) -> bool:
        """Write the vertices after the last finished step of every part; whether any has moved on."""
        moved = False
        for index, part in enumerate(self.parts):
            progress = part.task.progress
            mark = (progress.iteration, progress.fraction)
            if not part.task.started or self._shown.get(index) == mark:
                continue
            vertices = progress.snapshot()
            if vertices is not None:
                part.coordinates.write(part.merged(vertices))
                self._shown[index] = mark
                moved = True
        return moved

    def restore(self) -> None:
        """Put back every mesh that is still there, bit by bit."""
        for part in self.parts:
            # An object whose file was closed, or that a script deleted meanwhile, needs nothing put back.
            with contextlib.suppress(ReferenceError):
                part.coordinates.restore()

    @property
    def steps_done(self) -> int:
        """The most flow steps that any part has made."""
        return max(
            (part.task.result.iterations for part in self.parts if part.task.result is not None), default=0
        )

    def apply(self) -> None:
        """Write the results and do the last steps; parts that failed or were never begun are restored.

        An error that is not the wheel's own is a fault of the program: all is restored, and it is raised.
        """
        for part in self.parts:
            if part.task.error is not None and not isinstance(part.task.error, ridgeform.RidgeformError):
                self.restore()
                raise part.task.error
        for part in self.parts:
            if part.task.result is None:
                part.coordinates.restore()
        _write_results([part for part in self.parts if part.task.result is not None], self.settings)
        self.summary = [_summary_of(part) for part in self.parts]
        store_summary(self.summary)

    @property
    def errors(self) -> list[str]:
        """A sentence for each mesh that failed."""
        return [
            f'"{part.object.name}": {part.task.error}' for part in self.parts if part.task.error is not None
        ]

    def report(self) -> str:
        """What happened, in one line: energy before and after, gap, time, and what was skipped and why."""
        done = [entry for entry in self.summary if entry["energy_after"] is not None]
        before = sum(entry["energy_before"] for entry in done)
        after = sum(entry["energy_after"] for entry in done)
        gap = max((entry["gap"] for entry in done), default=0.0)
        steps = max((entry["steps"] for entry in done), default=0)
        seconds = sum(entry["seconds"] for entry in done)
        what = f'"{done[0]["name"]}"' if len(done) == 1 else f"{len(done)} meshes"
        energies = f"energy {before:.4g} → {after:.4g}, gap {gap:.1g}"
        notes = [f'"{entry["name"]}": {note}' for entry in self.summary for note in entry["warnings"]]
        idle = [f'"{entry["name"]}" was not begun' for entry in self.summary if entry["status"] == NOT_BEGUN]
        line = f"Stylized {what}: {energies}, {steps} steps, {seconds:.1f} s"
        return "; ".join([line, *notes, *idle, *self.skipped, *self.errors])


def stylize_objects(
    objects: Sequence[bpy.types.Object], settings: object, skipped: Sequence[str] = ()
) -> Stylization:
    """Stylize these objects here and now, without a window; `RefusedError` if none of them can be."""
    run = Stylization(objects, settings, skipped)
    run.job.run()
    run.apply()
    return run


def _prepare(obj: bpy.types.Object, settings: object) -> Part:
    mesh = obj.data
    mesh_io.flush_edit_mode(obj)
    triangles = mesh_io.triangles(mesh)
    if len(triangles) == 0:
        raise RefusedError(f'"{obj.name}" has no faces')
    coordinates = mesh_io.open_coordinates(obj)
    vertices = coordinates.original
    broken = np.flatnonzero(~np.isfinite(vertices).all(axis=1))
    if len(broken):
        raise RefusedError(
            f'Vertex {broken[0]} of "{obj.name}" has a coordinate that is not a finite number '
            f"({len(broken)} in all): delete or move it"
        )
    weld = weld_seams(vertices, triangles)
    free = mesh_io.selected_vertices(mesh) if mesh.is_editmode else np.ones(len(vertices), bool)
    options = stylize_options(settings)
    if settings.strength_group:
        strength = weld.mean_of(_group(obj, settings.strength_group))
        free &= strength[weld.vertex] > 0
        options["strength"] = strength
    if settings.ridge_group:
        painted = _group(obj, settings.ridge_group)
        options["ridge_weights"] = ridge_weights_of(painted, triangles[weld.kept], settings.avoid_ridges)
    moving = weld.all_of(free)
    if not moving.any():
        raise RefusedError(f'No vertex of "{obj.name}" may move: the mask is empty where it is selected')
    if not moving.all():
        options["fixed"] = ~moving
    call = partial(_flow, vertices[weld.first], weld.triangles, options)
    part = Part(obj, coordinates, weld, moving[weld.vertex], Task(obj.name, call))
    scales = np.abs(obj.matrix_world.to_scale())
    if scales.max() > UNEVEN_SCALE * scales.min():
        part.warnings.append(
            "its scale is uneven, so facets follow the unscaled shape (apply the scale to avoid that)"
        )
    return part


def _group(obj: bpy.types.Object, name: str) -> np.ndarray:
    if name not in obj.vertex_groups:
        raise RefusedError(f'"{obj.name}" has no vertex group "{name}"')
    return mesh_io.group_weights(obj, name)


def _flow(
    vertices: np.ndarray, triangles: np.ndarray, options: dict[str, object], progress: ridgeform.Progress
) -> ridgeform.Stylized:
    mesh = ridgeform.Mesh(vertices.astype(np.float64), triangles)
    return ridgeform.stylize(mesh, **options, progress=progress)


def _write_results(parts: list[Part], settings: object) -> None:
    if settings.output == "SHAPE_KEY":
        for part in parts:
            part.coordinates.restore()
    # Shape keys cannot be made in Edit Mode: leave it once, for all its objects, and come back.
    edited = settings.output == "SHAPE_KEY" and any(part.object.data.is_editmode for part in parts)
    if edited:
        bpy.ops.object.mode_set(mode="OBJECT")
    for part in parts:
        _write_result(part, settings)
    if edited:
        bpy.ops.object.mode_set(mode="EDIT")


def _write_result(part: Part, settings: object) -> None:
    result = part.task.result
    if result.status == "collapsed":
        part.warnings.append(
            f"the shape collapsed, step {result.iterations} is kept: less strength or fewer steps avoid it"
        )
    elif result.status == "converged":
        part.warnings.append(f"nothing moved any more after step {result.iterations}")
    coordinates = part.merged(result.vertices)
    if settings.keep_volume:
        if part.free.all():
            first = part.weld.first
            scaled, reason = keep_volume(
                part.coordinates.original[first], coordinates[first], part.weld.triangles
            )
            coordinates = part.merged(scaled)
        else:
            reason = "the volume was not kept, because only a part of the mesh was free to move"
        if reason is not None:
            part.warnings.append(reason)
    if settings.output == "SHAPE_KEY":
        mesh_io.add_shape_key(part.object, coordinates, KEY_NAME)
    else:
        part.coordinates.write(coordinates)
    if settings.reduce:
        note = reduce_mesh(part.object, settings.reduce_ratio)
        if note is not None:
            part.warnings.append(note)
    if settings.marks:
        _mark_ridges(part, settings)


def _mark_ridges(part: Part, settings: object) -> None:
    obj = part.object
    mesh_io.flush_edit_mode(obj)
    ends = mesh_io.edges(obj.data)
    coordinates = mesh_io.open_coordinates(obj).original
    ridges = ridge_edges(coordinates, mesh_io.face_corners(obj.data), len(ends), settings.mark_angle)
    if len(coordinates) == len(part.free):
        ridges &= part.free[ends].all(axis=1)
    mesh_io.mark_edges(obj.data, ridges, settings.marks)


def _summary_of(part: Part) -> dict[str, object]:
    entry = {
        "name": part.object.name,
        "vertices": len(part.coordinates.original),
        "faces": len(part.object.data.polygons),
        "energy_before": None,
        "energy_after": None,
        "gap": None,
        "steps": 0,
        "status": NOT_BEGUN if part.task.error is None else "failed",
        "seconds": part.task.seconds,
        "warnings": list(part.warnings),
        "error": None if part.task.error is None else str(part.task.error),
    }
    result = part.task.result
    if result is not None:
        entry |= {
            "energy_before": float(result.energy[0]),
            "energy_after": float(result.energy[-1]),
            "gap": float(result.gap.max()) if len(result.gap) else 0.0,
            "steps": int(result.iterations),
            "status": str(result.status),
        }
    return entry
