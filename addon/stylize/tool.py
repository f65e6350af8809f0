# SPDX-License-Identifier: GPL-3.0-or-later
"""Stylizing meshes piecewise flat: Rowe et al. 2024, eq. (24), from reading a mesh to writing it back."""

import contextlib
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial

import bpy
import numpy as np
import ridgeform

from ..blender import mesh_io, modifiers, rebuilding
from ..blender.polygons import Polygons
from ..blender.refusals import RefusedError
from ..blender.welding import Weld
from ..framework import faceting
from ..framework.job import Task
from ..framework.preflight import uneven_scale
from ..framework.ridges import Edges
from ..framework.run import Part, Run, counted, meshes_phrase, most, panel_lines, percent, total
from ..framework.surface import group_weights, painted_ridges, welded
from . import finish, recorded, reduction
from .finish import Source
from .own_faces import OwnFaces
from .settings import StylizeSettings, stylize_options


@dataclass(kw_only=True)
class FlowPart(Part):
    """One mesh of a run of stylize; the result of its task is a `Finished`."""

    source: Source
    flow: recorded.Flow


class Stylization(Run):
    """One run of stylize: the flow on each mesh, its steps shown as they are done, then the finish."""

    name = "stylize"
    takes = StylizeSettings
    call = "stylize"
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
                part.source.coordinates.write(part.source.merged(vertices))
                part.state.take_coordinates()
                self._shown[index] = mark
                moved = True
        return moved

    def watch(self) -> None:
        """Take down every step."""
        super().watch()
        for part in self.parts:
            if part.task.started:
                part.flow.watch(part.task.progress)

    def remember(self) -> None:
        """Keep the flows that were computed."""
        for part in self.done:
            if part.flow.result is not None:
                recorded.keep(part.flow)

    def forget(self) -> None:
        """Let go of the steps, too."""
        super().forget()
        recorded.forget()

    def put_back(self, part: FlowPart) -> None:
        """Put back every bit of the coordinates."""
        part.source.coordinates.restore()

    def replaces_faces(self, part: FlowPart) -> bool:
        """Whether the finish made other faces."""
        return part.task.result is not None and part.task.result.rebuilt is not None

    def check(self, part: FlowPart) -> None:
        """What lies on a mesh whose faces are replaced must be what was carried over."""
        if self.replaces_faces(part):
            rebuilding.check(part.object, part.source.before)

    def kept_settings(self) -> dict[str, object]:
        """The steps that were made, if the flow was told to keep them: to be repeated."""
        flows = [part.task.result.flow for part in self.done]
        if not any(flow.status == "stopped" for flow in flows):
            return {}
        return {"steps": max(1, *(flow.iterations for flow in flows))}

    def write(self, parts: Sequence[FlowPart]) -> None:
        """Write the results with all that is made of them; parts without a result are restored."""
        leaves_mesh = self.settings.output != "POSITIONS"
        for part in self.parts:
            if leaves_mesh or part.task.result is None:
                part.source.coordinates.restore()
        # Neither shape keys nor attributes of vectors can be made in Edit Mode.
        with mesh_io.object_mode() if leaves_mesh else contextlib.nullcontext():
            for part in parts:
                finish.write(part.object, part.source, part.task.result, self.settings)

    def figures(self, part: FlowPart) -> dict[str, object]:
        """What the flow did: facets, movement, energy before and after, the largest gap, steps."""
        result, made = part.task.result.flow, part.task.result.n_facets
        return {
            "facets": int(result.n_facets) if made is None else made,
            "flat_share": float(result.flat_share[-1]),
            "moved": part.task.result.moved,
            "energy_before": float(result.energy[0]),
            "energy_after": float(result.energy[-1]),
            "gap": float(result.gap.max()) if len(result.gap) else 0.0,
            "steps": int(result.iterations),
            "status": str(result.status),
            "warnings": part.warnings + part.task.result.notes,
        }

    @classmethod
    def lines(cls, entry: dict[str, object]) -> list[str]:
        """What the panel says of a mesh: facets, steps, movement."""
        how = f"{counted(entry['steps'], 'step')}, moved {percent(entry['moved'])}"
        return panel_lines(entry, counted(entry["facets"], "facet"), how)

    def headline(self, done: Sequence[dict[str, object]]) -> str:
        """How many facets there are, how far the shape moved, and how long it took."""
        what = f"Stylized {meshes_phrase(done)} in {total(done, 'seconds'):.1f} s"
        facets = counted(total(done, "facets"), "facet")
        return f"{what}: {facets}, moved at most {percent(most(done, 'moved'))} of the size"


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
    weld, triangles = welded(obj, vertices, whole=True)
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
    source = Source(coordinates, weld, moving[weld.vertex])
    _prepare_finish(obj, settings, source)
    if settings.marks:
        planes = () if weld.images is None else weld.images.planes
        source.edges = Edges(mesh_io.edges(mesh), mesh_io.face_corners(mesh), planes)
    del options["iterations"]
    flow = recorded.Flow(weld.places(vertices), weld.triangles, options)
    task = Task(obj.name, lambda _: None, most=settings.steps)
    part = FlowPart(obj, task, len(vertices), source=source, flow=flow)
    task.call = partial(_stylized, part, settings)
    part.warnings += weld.notes
    part.warnings += modifiers.shape_notes(obj, "CREASE" in settings.marks)
    part.warnings += modifiers.normal_notes(mesh)
    if settings.output == "POSITIONS":
        part.warnings += modifiers.key_notes(obj) + modifiers.blend_notes(obj)
    if uneven_scale(obj) is not None:
        part.warnings.append(
            "its scale is uneven, so facets follow the unscaled shape (apply the scale to avoid that)"
        )
    return part


def _prepare_finish(obj: bpy.types.Object, settings: object, source: Source) -> None:
    """Read what the faces of a mesh are replaced from, if they are to be and can be."""
    leaves_mesh = settings.output != "POSITIONS"
    if settings.finish == "LOW_POLY":
        source.refusal = reduction.reason_against(obj.data, leaves_mesh)
        if source.refusal is None:
            source.reducible = rebuilding.read(obj)
    elif settings.finish == "FACETS":
        reason = rebuilding.reason_against(obj.data, leaves_mesh)
        if reason is not None:
            source.refusal = f"facets were not made, because {reason}"
            return
        starts, corners, _ = mesh_io.face_corners(obj.data)
        taking = np.logical_and.reduceat(source.free[corners], starts)
        source.facetable = faceting.read(obj, _own_weld(obj, source), taking)
    else:
        source.own = _own_faces(obj, source)


def _own_weld(obj: bpy.types.Object, source: Source) -> Weld:
    """The surface of a mesh without the images of mirrors."""
    return source.weld if source.weld.images is None else welded(obj, source.coordinates.original)[0]


def _own_faces(obj: bpy.types.Object, source: Source) -> OwnFaces:
    weld, images = _own_weld(obj, source), source.weld.images
    starts, corners, _ = mesh_io.face_corners(obj.data)
    return OwnFaces(
        weld,
        mesh_io.triangle_faces(obj.data)[weld.rows],
        mesh_io.triangle_corners(obj.data)[weld.rows],
        Polygons(corners, starts),
        () if images is None else images.planes,
    )


def _stylized(part: FlowPart, settings: object, progress: ridgeform.Progress) -> finish.Finished:
    """The flow of a mesh, and what is made of its result: in the thread of the job."""
    task, source, flow = part.task, part.source, part.flow
    known = recorded.known(flow)
    result = None if known is None else known.after(settings.steps)
    if result is None:
        mesh = ridgeform.Mesh(flow.vertices, flow.triangles)
        result = ridgeform.stylize(mesh, iterations=settings.steps, **flow.options, progress=progress)
        flow.result = result
    task.check()
    if source.reducible is not None:
        task.stage = "reducing the triangles"
    elif source.facetable is not None:
        task.stage = "making facets"
    return finish.finished(source, result, settings, task.progress, task.check)
