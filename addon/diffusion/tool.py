# SPDX-License-Identifier: GPL-3.0-or-later
"""Diffusion curves of painted meshes: Rowe et al. 2024, section 7.6."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial

import bpy
import numpy as np
import ridgeform

from ..blender import mesh_io
from ..blender.attribute_names import FACE_NUMBERS
from ..blender.refusals import RefusedError
from ..blender.selection import Needs
from ..framework.job import Task
from ..framework.run import Part, Run, counted, meshes_phrase, total
from ..framework.settings import chosen
from ..framework.surface import Surface, half_notes, surface_of
from . import curves_io, drawing
from .layout import curve_points
from .settings import DiffusionSettings
from .sources import Colors, attribute_colors, image_colors

EXACT = 120.0
"""Decibels beyond which colors are exact, but for the rounding of single precision."""


@dataclass(kw_only=True)
class DiffusionPart(Part):
    """One mesh of a run."""

    surface: Surface
    colors: Colors
    alpha: float
    """The alpha of the colors where it is the same everywhere, and so was not computed."""
    target: str = ""
    """The name of the rebuilt colors."""


class DiffusionCurves(Run):
    """One run of diffusion curves, on whole meshes."""

    name = "diffusion_curves"
    takes = DiffusionSettings
    call = "diffusion_curves"
    needs = Needs(coordinates=False, selection=False)

    def prepare(self, obj: bpy.types.Object) -> DiffusionPart:
        """Read the colors and the regions of one mesh."""
        from_image = self.settings.source == "IMAGE"
        colors = image_colors(obj) if from_image else attribute_colors(obj, self.settings.attribute)
        surface = surface_of(obj)
        # One of the vertices that lie in the same place, not their mean: see `attribute_colors`.
        values = colors.values[surface.weld.first]
        opaque = bool((values[:, 3] == values[0, 3]).all())
        values = values[:, :3] if opaque else values
        task = Task(obj.name, self._call(obj, surface, values), counted="stage")
        return DiffusionPart(
            obj,
            task,
            len(obj.data.vertices),
            [*colors.notes, *half_notes(obj, surface, "the curves are those of")],
            surface=surface,
            colors=colors,
            alpha=float(colors.values[surface.weld.first[0], 3]),
        )

    def _call(self, obj: bpy.types.Object, surface: Surface, values: np.ndarray) -> partial:
        settings = self.settings
        faces = mesh_io.triangle_faces(obj.data)[surface.weld.rows]
        if settings.regions == "COLORS":
            regions = {
                "n_regions": chosen(settings, "count"),
                "min_faces": settings.least_faces,
                "face_groups": faces,
            }
        else:
            regions = {"labels": _face_labels(obj, settings)[faces]}
        options = {
            "fidelity": settings.fidelity,
            "rims": settings.rims,
            "refine": settings.refine,
            "color_error": settings.color_error,
        }
        return partial(_drawn, surface.mesh, values, regions | options)

    def write(self, parts: Sequence[DiffusionPart]) -> None:
        """Write the curves as child objects and the rebuilt colors as an attribute, and show them."""
        with mesh_io.object_mode():
            for part in parts:
                found = part.task.result
                points = curve_points(found, part.surface.mesh, part.surface.weld, part.alpha)
                child = curves_io.write_curves(part.object, points, part.colors.name)
                part.target = drawing.write_corners(
                    part.object, part.surface.weld, found.corners, part.colors.name, part.alpha
                )
                part.warnings += drawing.show(part.object, part.target) if self.settings.show else []
                if not len(found.edges):
                    part.warnings.append(f'there is only one region, so "{child.name}" has no curve')

    def figures(self, part: DiffusionPart) -> dict[str, object]:
        """How good the rebuilt colors are, and how many numbers the curves are."""
        found = part.task.result
        return {
            "attribute": part.colors.name,
            "result": part.target,
            "curves": len(found.starts) - 1,
            "regions": len(np.unique(found.labels)),
            "psnr": float(found.psnr) if found.psnr < EXACT else None,
            "numbers_before": int(found.n_numbers_before),
            "numbers_after": int(found.n_numbers),
            "steps": len(found.starts) - 1,
            "status": "finished",
        }

    @classmethod
    def lines(cls, entry: dict[str, object]) -> list[str]:
        """How many curves there are, how good they are, and how few numbers."""
        quality = "exact" if entry["psnr"] is None else f"{entry['psnr']:.1f} dB"
        return [
            f"{entry['name']}: {counted(entry['curves'], 'curve')}, {quality}",
            f"{entry['numbers_after']} numbers instead of {entry['numbers_before']}",
        ]

    @classmethod
    def phrases(cls, done: Sequence[dict[str, object]]) -> list[str]:
        """How many curves and numbers there are."""
        curves, before, after = _totals(done)
        return [f"{counted(curves, 'curve')}, {after} numbers instead of {before}"] if done else []

    def headline(self, done: Sequence[dict[str, object]]) -> str:
        """How many curves of which mesh, how few numbers they are, and how good they are."""
        curves, before, after = _totals(done)
        quality = [entry["psnr"] for entry in done if entry["psnr"] is not None]
        error = f"PSNR {min(quality):.1f} dB" if quality else "no error"
        seconds = total(done, "seconds")
        what = f"{counted(curves, 'curve')} of {meshes_phrase(done)}"
        return f"{what}: {after} numbers instead of {before}, {error}, {seconds:.1f} s"


def _totals(done: Sequence[dict[str, object]]) -> tuple[int, int, int]:
    """Curves, and the numbers before and after, of all meshes."""
    return tuple(total(done, key) for key in ("curves", "numbers_before", "numbers_after"))


def _face_labels(obj: bpy.types.Object, settings: object) -> np.ndarray:
    """The region (f,) of every face by its material slot or an attribute; `RefusedError` if there is none."""
    mesh = obj.data
    labels = np.empty(len(mesh.polygons), np.int32)
    if settings.regions == "MATERIALS":
        mesh.polygons.foreach_get("material_index", labels)
        return labels
    attribute = mesh.attributes.get(settings.region_attribute)
    if attribute is None or (attribute.data_type, attribute.domain) != FACE_NUMBERS:
        raise RefusedError(
            f'"{obj.name}" has no integer attribute "{settings.region_attribute}" on its faces'
        )
    attribute.data.foreach_get("value", labels)
    return labels


def _drawn(
    mesh: ridgeform.Mesh, values: np.ndarray, options: dict[str, object], progress: ridgeform.Progress
) -> ridgeform.DiffusionCurves:
    return ridgeform.diffusion_curves(mesh, values, progress=progress, **options)
