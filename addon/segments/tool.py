# SPDX-License-Identifier: GPL-3.0-or-later
"""Segmenting a shape or an attribute: Rowe et al. 2024, eq. (41), the selected faces only in Edit Mode."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial

import bpy
import numpy as np
import ridgeform

from ..blender import attribute_io, attribute_names, display, mesh_io
from ..blender.attribute_io import PointValues
from ..blender.refusals import RefusedError
from ..blender.selection import Needs
from ..blender.stored_numbers import write_numbers
from ..blender.welding import Weld
from ..framework.job import Task
from ..framework.results import Results
from ..framework.run import Part, Run, counted, meshes_phrase, panel_lines, total
from ..framework.sources import (
    as_argument,
    source_of,
    varying_means,
)
from ..framework.surface import Surface, painted_ridges, surface_of
from . import earlier, groups, layers, slots
from .existing import border_weights
from .objects import separate
from .settings import (
    SegmentSettings,
    by_count,
    may_simplify,
    of_parts,
    parts_options,
    segment_options,
)

SUFFIX = "_sharpened"
KEY_NAME = "Sharpened"


@dataclass(kw_only=True)
class SegmentPart(Part):
    """One mesh of a run."""

    weld: Weld
    faces: np.ndarray
    """The face (l,) of each welded triangle of the mesh itself."""
    areas: np.ndarray
    """The area (l,) of each of them."""
    taking: np.ndarray
    """Which faces (f,) bool take part."""
    source: PointValues | None
    """What the segments are found on, if not the shape."""
    columns: np.ndarray | None = None
    """Which components (k,) bool of it vary."""
    n_segments: int = 0

    def face_labels(self, labels: np.ndarray) -> np.ndarray:
        """The segment (f,) of each face, from 0: that of most of its area, given the triangles', or -1."""
        labels = labels[: len(self.faces)]
        chosen = labels >= 0
        if not chosen.any():
            return np.full(len(self.taking), -1, np.int32)
        count = int(labels.max()) + 1
        keys, place = np.unique(
            self.faces[chosen].astype(np.int64) * count + labels[chosen], return_inverse=True
        )
        area = np.bincount(place, weights=self.areas[chosen])
        # Sorted by face and then area: the last entry of a face is its largest.
        order = np.lexsort((area, keys // count))
        result = np.full(len(self.taking), -1, np.int64)
        result[keys[order] // count] = keys[order] % count
        result[~self.taking] = -1
        found, compact = np.unique(result, return_inverse=True)
        return (compact.reshape(-1) - int(found[0] == -1)).astype(np.int32)

    def labels_at(self, count: int) -> np.ndarray:
        """The segments (f,) of the faces when the mesh itself has `count`, or as near as that goes."""
        found = self.task.result
        labels = self.face_labels(found.labels_at(count))
        if self.weld.images is not None:
            # Some of those on mesh and images together lie on images alone.
            for more in range(count + 1, found.range[1] + 1):
                if labels.max() + 1 >= count:
                    break
                labels = self.face_labels(found.labels_at(more))
        return labels

    def possible(self) -> list[int]:
        """From how few to how many segments there might be on the mesh itself."""
        found = self.task.result
        if self.weld.images is None:
            return list(map(int, found.range))
        return [int(self.face_labels(found.labels_at(count)).max()) + 1 for count in found.range]

    def face_means(self, values: np.ndarray) -> np.ndarray:
        """The mean (f,) over the area of values (l,) of triangles."""
        values = values[: len(self.faces)]
        n = len(self.taking)
        weights = self.areas + np.finfo(float).tiny
        total = np.bincount(self.faces, weights=weights, minlength=n)
        sums = np.bincount(self.faces, weights=weights * values, minlength=n)
        return np.divide(sums, total, out=np.ones(n), where=total > 0)


class Segmenting(Run):
    """One run of segmenting."""

    name = "segment"
    takes = SegmentSettings
    needs = Needs(coordinates=False)

    @property
    def call(self) -> str:
        """Parts take less than a third of what segments do, and segments on a simplified mesh still less."""
        if of_parts(self.settings):
            return "parts"
        simplifies = self.settings.coarse_to_fine and may_simplify(self.settings)
        return "segment_coarse_to_fine" if simplifies else "segment"

    def prepare(self, obj: bpy.types.Object) -> SegmentPart:
        """Read shape or attribute, selection and paint of one mesh."""
        taking = (
            mesh_io.selected_faces(obj.data) if self._in_edit_mode else np.ones(len(obj.data.polygons), bool)
        )
        if not taking.any():
            raise RefusedError(f'No face of "{obj.name}" is selected: select the faces to segment')
        surface = surface_of(obj, whole=True)
        weld = surface.weld
        faces = mesh_io.triangle_faces(obj.data)[weld.rows]
        parts = of_parts(self.settings)
        options = parts_options(self.settings) if parts else segment_options(self.settings)
        source, columns = None, None
        if parts:
            weights = border_weights(obj.data, self.settings.existing, weld)
            if weights is not None:
                options["edge_weights"] = weights
        elif self.settings.source == "ATTRIBUTE":
            source = source_of(obj, self.settings, (SUFFIX,))
            columns, values = varying_means(obj, source, weld)
            options["values"] = as_argument(values)
        weights = painted_ridges(obj, self.settings, mesh_io.triangles(obj.data), weld)
        if weights is not None:
            options["face_weights"] = weights
        if not taking.all():
            options["faces"] = taking[faces]
        task = Task(obj.name, partial(_segmented, surface, self.settings.kind, options), counted="iteration")
        part = SegmentPart(
            obj,
            task,
            len(obj.data.vertices),
            weld=weld,
            faces=faces[: weld.n_own],
            areas=_areas(surface.mesh)[: weld.n_own],
            taking=taking,
            source=source,
            columns=columns,
        )
        part.warnings += weld.notes
        return part

    def write(self, parts: Sequence[SegmentPart]) -> None:
        """Write what was asked for."""
        with mesh_io.object_mode():
            for part in parts:
                self._write_one(part)
        if "MATERIALS" in self.settings.outputs and parts:
            display.show_materials()

    def _write_one(self, part: SegmentPart) -> None:
        mesh, found, outputs = part.object.data, part.task.result, self.settings.outputs
        labels = (
            part.labels_at(self.settings.count) if by_count(self.settings) else part.face_labels(found.labels)
        )
        part.n_segments = int(labels.max()) + 1
        part.warnings += self._notes(part)
        taking = part.taking & (labels >= 0)
        whole = layers.merged_labels(mesh, labels, part.taking)
        earlier.clear(part.object, part.taking, outputs)
        if "FACE_SETS" in outputs:
            layers.write_face_sets(mesh, labels, taking)
        write_numbers(mesh, layers.SEGMENT, "INT", "FACE", whole)
        marks = [kind for kind in layers.MARKS if kind in outputs]
        if marks:
            borders = layers.border_edges(mesh, labels)
            layers.mark_borders(mesh, borders, layers.edges_within(mesh, part.taking), marks)
        if "VERTEX_GROUPS" in outputs:
            groups.write_groups(part.object, whole, self.settings.transition)
        if "INDICATOR" in outputs and not of_parts(self.settings):
            write_numbers(mesh, layers.INDICATOR, "FLOAT", "FACE", part.face_means(found.indicator))
        if "SHARPENED" in outputs and not of_parts(self.settings):
            _write_sharpened(part)
        if "MATERIALS" in outputs:
            had_others = slots.assign(mesh, labels, taking, part.object.name)
            if had_others:
                part.warnings.append("its materials are kept: Restore Materials brings them back")
        mesh.update()
        if "OBJECTS" in outputs and not self._in_edit_mode:
            _separate(part, labels, self.settings.use_caps)

    def _notes(self, part: SegmentPart) -> list[str]:
        notes = []
        if by_count(self.settings) and part.n_segments != self.settings.count:
            fewest, most = part.possible()
            asked = f"{self.settings.count} {self._called}s were asked for"
            notes.append(f"{asked}, {fewest} to {most} are possible")
        if part.task.result.status == "inaccurate":
            notes.append("the tolerance was not reached")
        elif part.task.result.status == "stopped":
            notes.append("stopped early, the result so far is kept")
        if of_parts(self.settings) and {"INDICATOR", "SHARPENED"} & set(self.settings.outputs):
            notes.append("parts have no indicator and no sharpened surface")
        if of_parts(self.settings) and self.settings.source == "ATTRIBUTE":
            notes.append("parts are found on the shape, not on an attribute")
        if "OBJECTS" in self.settings.outputs and self._in_edit_mode:
            notes.append(f"{self._called}s become objects only in Object Mode")
        return notes

    @property
    def _called(self) -> str:
        """What users call a segment of this kind."""
        return "part" if of_parts(self.settings) else "segment"

    def figures(self, part: SegmentPart) -> dict[str, object]:
        """How many segments there are, and from how few to how many there might be."""
        found = part.task.result
        return {
            "attribute": part.source.name if part.source is not None else None,
            "segments": part.n_segments,
            "called": self._called,
            "possible": part.possible(),
            **({} if of_parts(self.settings) else _course(found)),
            "status": str(found.status),
        }

    @classmethod
    def lines(cls, entry: dict[str, object]) -> list[str]:
        """How many segments there are, how many there might be, and how long it took."""
        fewest, most = entry["possible"]
        return panel_lines(entry, _counted([entry]), f"{fewest} to {most} are possible")

    @classmethod
    def phrases(cls, done: Sequence[dict[str, object]]) -> list[str]:
        """How many segments there are."""
        return [_counted(done)] if done else []

    def headline(self, done: Sequence[dict[str, object]]) -> str:
        """How many segments of which mesh, how many there might be, time."""
        fewest, most = (sum(ends) for ends in zip(*(entry["possible"] for entry in done), strict=True))
        seconds = total(done, "seconds")
        where = meshes_phrase(done)
        return f"{_counted(done)} on {where} ({fewest} to {most} are possible), {seconds:.1f} s"


def _counted(done: Sequence[dict[str, object]]) -> str:
    """How many segments or parts there are; summaries of versions before do not say which."""
    called = done[0].get("called", "segment") if done else "segment"
    return counted(total(done, "segments"), called)


def _course(found: ridgeform.Segmentation) -> dict[str, object]:
    """The noise that was found, and how often the functional took turns."""
    return {"noise": float(found.noise), "steps": int(found.alternations)}


Found = ridgeform.Segmentation | ridgeform.Parts

_known = Results()


def forget() -> None:
    """Let go of the results that are kept."""
    _known.forget()


def _segmented(
    surface: Surface, kind: str, options: dict[str, object], progress: ridgeform.Progress
) -> Found:
    """The result for a mesh and options."""
    call = ridgeform.parts if kind == "PARTS" else ridgeform.segment
    given = options | {"kind": kind}
    return _known.of(surface.mesh, given, lambda: call(surface.mesh, progress=progress, **options))[0]


def _areas(mesh: ridgeform.Mesh) -> np.ndarray:
    a, b, c = (mesh.vertices[mesh.faces[:, corner]] for corner in range(3))
    return 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)


def _write_sharpened(part: SegmentPart) -> None:
    values = part.task.result.values
    if part.source is None:
        coordinates = mesh_io.open_coordinates(part.object).original
        mesh_io.add_shape_key(part.object, part.weld.moved(values, coordinates), KEY_NAME)
        return
    full = part.source.values.astype(np.float64)
    full[:, part.columns] = values.reshape(len(values), -1)[part.weld.vertex]
    name = attribute_names.result_name(part.source.name, SUFFIX)
    limited = attribute_io.limited(part.source.data_type, full)
    attribute_io.write_values(part.object, part.source, limited.astype(np.float32), name)


def _separate(part: SegmentPart, labels: np.ndarray, caps: bool) -> None:
    made = separate(part.object, labels, caps)
    if len(made) > 1:
        part.warnings.append(f"separated into {len(made)} objects")
