# SPDX-License-Identifier: GPL-3.0-or-later
"""Stylizing meshes piecewise flat: Rowe et al. 2024, eq. (24), from reading a mesh to writing it back."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial

import bpy
import numpy as np
import ridgeform

from ..blender import mesh_io
from ..blender.refusals import RefusedError
from ..blender.welding import Weld
from ..framework.job import Task
from ..framework.run import Part, Run, counted, meshes_phrase
from ..framework.surface import group_weights, painted_ridges, welded
from .reduction import reduce_mesh
from .ridges import dividing_angle, edge_angles
from .settings import stylize_options
from .volume import keep_volume

KEY_NAME = "Stylized"
FEW_FLAT = 0.1
"""With less than this part of its area in flat faces a shape has hardly any facets: regular spheres and tori
end at 0.00 to 0.09, a head of 500 vertices at 0.07, everything else that was tried at 0.16 and above."""
UNEVEN_SCALE = 1.1
"""Object scales that differ by more than this ratio visibly change which facets the flow prefers."""


@dataclass(kw_only=True)
class FlowPart(Part):
    """One mesh of a run of stylize."""

    coordinates: mesh_io.Coordinates
    weld: Weld
    free: np.ndarray
    """Which vertices (n,) bool may move."""

    def moved(self, vertices: np.ndarray) -> float:
        """How far the farthest vertex has gone, as a part of the bounding box's diagonal."""
        before = self.coordinates.original[self.weld.first].astype(np.float64)
        diagonal = float(np.linalg.norm(np.ptp(before, axis=0)))
        farthest = float(np.linalg.norm(np.asarray(vertices) - before, axis=1).max(initial=0.0))
        return farthest / diagonal if diagonal > 0.0 else 0.0

    def merged(self, vertices: np.ndarray) -> np.ndarray:
        """Coordinates (n, 3) float32 from welded vertices, with the old bits where none may move."""
        new = np.asarray(vertices, np.float32)[self.weld.vertex]
        return np.where(self.free[:, None], new, self.coordinates.original)


class Stylization(Run):
    """One run of stylize: the flow on each mesh, its steps shown as they are done, then the last steps."""

    name = "stylize"
    call = "stylize"
    counted = "steps"
    in_object_mode = False

    def __init__(
        self, objects: Sequence[bpy.types.Object], settings: object, skipped: Sequence[str] = ()
    ) -> None:
        """Read the meshes of the objects and prepare one task each."""
        super().__init__(objects, settings, skipped)
        self._shown: dict[int, tuple[int, float]] = {}

    def prepare(self, obj: bpy.types.Object) -> FlowPart:
        """Read coordinates, selection, mask and ridge paint of one mesh."""
        return _prepare(obj, self.settings)

    def show(self) -> bool:
        """Write the vertices after the last finished step of every part; whether any has moved on."""
        moved = False
        for index, part in enumerate(self.parts):
            progress = part.task.progress
            mark = (progress.iteration, progress.fraction)
            if not part.task.started or self._shown.get(index) == mark:
                continue
            vertices = progress.snapshot()
            if vertices is not None:
                # In Edit Mode that takes too long for every step.
                part.state.check(thorough=not part.object.data.is_editmode)
                part.coordinates.write(part.merged(vertices))
                part.state.take_coordinates()
                self._shown[index] = mark
                moved = True
        return moved

    def put_back(self, part: FlowPart) -> None:
        """Put back every bit of the coordinates."""
        part.coordinates.restore()

    def kept_settings(self) -> dict[str, object]:
        """The most flow steps that any part has made: redo repeats what was kept, not what was asked for."""
        return {"steps": max((part.task.result.iterations for part in self.done), default=1) or 1}

    def write(self, parts: Sequence[FlowPart]) -> None:
        """Write the results and do the last steps; parts without a result are restored."""
        for part in self.parts:
            if part.task.result is None:
                part.coordinates.restore()
        _write_results(parts, self.settings)

    def figures(self, part: FlowPart) -> dict[str, object]:
        """What the flow did: facets, movement, energy before and after, the largest gap, steps."""
        result = part.task.result
        return {
            "facets": int(result.n_facets),
            "flat_share": float(result.flat_share[-1]),
            "moved": part.moved(result.vertices),
            "energy_before": float(result.energy[0]),
            "energy_after": float(result.energy[-1]),
            "gap": float(result.gap.max()) if len(result.gap) else 0.0,
            "steps": int(result.iterations),
            "status": str(result.status),
        }

    def headline(self, done: Sequence[dict[str, object]]) -> str:
        """How many facets there are, how far the shape moved, and how long it took."""
        seconds = sum(entry["seconds"] for entry in done)
        facets = sum(entry["facets"] for entry in done)
        moved = max((entry["moved"] for entry in done), default=0.0)
        return (
            f"Stylized {meshes_phrase(done)} in {seconds:.1f} s: {counted(facets, 'facet')}, "
            f"moved at most {100.0 * moved:.2g} % of the size"
        )


def stylize_objects(
    objects: Sequence[bpy.types.Object], settings: object, skipped: Sequence[str] = ()
) -> Stylization:
    """Stylize these objects here and now, without a window; `RefusedError` if none of them can be."""
    run = Stylization(objects, settings, skipped)
    run.job.run()
    run.apply()
    return run


def _prepare(obj: bpy.types.Object, settings: object) -> FlowPart:
    mesh = obj.data
    mesh_io.flush_edit_mode(obj)
    coordinates = mesh_io.open_coordinates(obj)
    vertices = coordinates.original
    weld, triangles = welded(obj, vertices)
    free = mesh_io.selected_vertices(mesh) if mesh.is_editmode else np.ones(len(vertices), bool)
    options = stylize_options(settings)
    if settings.strength_group:
        strength = weld.mean_of(group_weights(obj, settings.strength_group))
        free &= strength[weld.vertex] > 0
        options["strength"] = strength
    ridges = painted_ridges(obj, settings, triangles, weld)
    if ridges is not None:
        options["ridge_weights"] = ridges
    moving = weld.all_of(free)
    if not moving.any():
        raise RefusedError(f'No vertex of "{obj.name}" may move: the mask is empty where it is selected')
    if not moving.all():
        options["fixed"] = ~moving
    task = Task(obj.name, partial(_flow, vertices[weld.first], weld.triangles, options))
    part = FlowPart(obj, task, len(vertices), coordinates=coordinates, weld=weld, free=moving[weld.vertex])
    part.warnings += weld.notes
    scales = np.abs(obj.matrix_world.to_scale())
    if scales.max() > UNEVEN_SCALE * scales.min():
        part.warnings.append(
            "its scale is uneven, so facets follow the unscaled shape (apply the scale to avoid that)"
        )
    return part


def _flow(
    vertices: np.ndarray, triangles: np.ndarray, options: dict[str, object], progress: ridgeform.Progress
) -> ridgeform.Stylized:
    mesh = ridgeform.Mesh(vertices.astype(np.float64), triangles)
    return ridgeform.stylize(mesh, **options, progress=progress)


def _write_results(parts: Sequence[FlowPart], settings: object) -> None:
    if settings.output != "SHAPE_KEY":
        for part in parts:
            _write_result(part, settings)
        return
    for part in parts:
        part.coordinates.restore()
    # Shape keys cannot be made in Edit Mode.
    with mesh_io.object_mode():
        for part in parts:
            _write_result(part, settings)


def _write_result(part: FlowPart, settings: object) -> None:
    result = part.task.result
    note = _note(result, settings)
    if note is not None:
        part.warnings.append(note)
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


def _note(result: ridgeform.Stylized, settings: object) -> str | None:
    """What a modeler should know about how a flow ended, and do about it."""
    steps = result.iterations
    if result.status == "settled" and steps == 0:
        return "its planes already meet in ridges, so nothing was moved"
    notes = {
        "collapsed": f"the shape collapsed, step {steps} is kept: use less strength or fewer steps",
        "diverged": f"a step led far away from the shape, step {steps} is kept: its triangles are too "
        "uneven; merge vertices by distance or remesh first",
        "converged": f"nothing moved after step {steps}",
        "inaccurate": "not every step reached its tolerance "
        f"(largest gap {result.gap.max(initial=0.0):.1g}): raise Iterations",
    }
    if not settings.use_fidelity:
        notes["finished"] = f"all {steps} steps were done before its facets had settled: raise Steps"
    few = "hardly anything became flat: subdivide a coarse mesh, or raise Strength on a regular one"
    return notes.get(result.status, few if result.flat_share[-1] < FEW_FLAT else None)


def _mark_ridges(part: FlowPart, settings: object) -> None:
    obj = part.object
    mesh_io.flush_edit_mode(obj)
    ends = mesh_io.edges(obj.data)
    coordinates = mesh_io.open_coordinates(obj).original
    angles = edge_angles(coordinates, mesh_io.face_corners(obj.data), len(ends))
    least = settings.mark_angle
    if not settings.use_mark_angle:
        lengths = np.linalg.norm(coordinates[ends[:, 0]] - coordinates[ends[:, 1]], axis=1)
        least = dividing_angle(angles, lengths.astype(np.float64))
    ridges = (angles >= 0) & (angles >= least)
    if len(coordinates) == len(part.free):
        ridges &= part.free[ends].all(axis=1)
    mesh_io.mark_edges(obj.data, ridges, settings.marks)
