# SPDX-License-Identifier: GPL-3.0-or-later
"""What is made of a flow's result: coordinates, volume, fewer triangles, ridges.

`finished` computes, without touching Blender's data; `write` writes.
"""

from collections.abc import Callable
from dataclasses import dataclass, field

import bpy
import numpy as np
import ridgeform

from ..blender import blending, mesh_io, rebuilding
from ..blender.welding import Weld
from ..framework import faceting
from ..framework.faceting import Facetable
from ..framework.settings import chosen
from . import reduction
from .ridges import Edges
from .volume import keep_volume

KEY_NAME = "Stylized"
FEW_FLAT = 0.2
"""With less than this part of its area in flat faces a shape has hardly any facets to be seen: spheres end at
0.05, a head of 500 vertices at 0.07, a hand of 800 at 0.16; a torus, which gets bands, at 0.24, and all else
that was tried at 0.43 and above."""

ONE_FACET = np.radians(2.0)
"""Faces that meet at less than this angle are one facet; the report counts facets so."""


@dataclass
class Source:
    """A mesh as it was read."""

    coordinates: mesh_io.Coordinates
    weld: Weld
    free: np.ndarray
    """Which vertices (n,) bool may move."""
    reducible: rebuilding.Before | None = None
    """What its triangles are reduced from, if they are to be."""
    facetable: Facetable | None = None
    """What facets are made from, if they are to be."""
    refusal: str | None = None
    """Why it keeps its faces, although they are to be replaced."""
    edges: Edges | None = None
    """Its edges, if ridges are to be marked."""

    @property
    def before(self) -> rebuilding.Before | None:
        """What lies on the mesh whose faces are to be replaced."""
        return self.reducible if self.facetable is None else self.facetable.before

    def merged(self, vertices: np.ndarray) -> np.ndarray:
        """Coordinates (n, 3) float32 from welded vertices, with the old bits where none may move."""
        original = self.coordinates.original
        return np.where(self.free[:, None], self.weld.moved(vertices, original), original)

    def moved(self, vertices: np.ndarray) -> float:
        """How far the farthest of the welded vertices has gone, as a part of the bounding box's diagonal."""
        before = self.weld.places(self.coordinates.original)
        diagonal = float(np.linalg.norm(np.ptp(before, axis=0)))
        farthest = float(np.linalg.norm(np.asarray(vertices) - before, axis=1).max(initial=0.0))
        return farthest / diagonal if diagonal > 0.0 else 0.0


@dataclass
class Finished:
    """The result of a flow, and what is to be written of it."""

    flow: ridgeform.Stylized
    coordinates: np.ndarray
    """The coordinates (n, 3) float32."""
    notes: list[str] = field(default_factory=list)
    rebuilt: rebuilding.Rebuilt | None = None
    """The mesh with other faces, if it gets any."""
    n_facets: int | None = None
    """How many of them are facets, if facets were made."""
    ridges: np.ndarray | None = None
    """The edges (k,) bool to be marked, of other faces in their order."""


def finished(
    source: Source,
    flow: ridgeform.Stylized,
    settings: object,
    progress: ridgeform.Progress | None = None,
    check: Callable[[], None] = lambda: None,
) -> Finished:
    """What is to be written of a flow's result; `check` may raise to stop."""
    note = _note(flow, settings)
    made = Finished(flow, source.merged(flow.vertices), [] if note is None else [note])
    if settings.keep_volume:
        reason = _keep_volume(source, made)
        if reason is not None:
            made.notes.append(reason)
    if source.refusal is not None:
        made.notes.append(source.refusal)
    elif source.reducible is not None:
        reduced = reduction.reduce(
            source.reducible, made.coordinates, settings.reduce_ratio, ~source.free, check
        )
        made.notes.append(reduced if isinstance(reduced, str) else reduced.note)
        made.rebuilt = None if isinstance(reduced, str) else reduced
    check()
    if source.facetable is not None:
        _make_facets(source, made, settings, progress, check)
    elif source.edges is not None:
        made.ridges = _ridges(source, made, chosen(settings, "mark_angle"))
    return made


def _make_facets(
    source: Source,
    made: Finished,
    settings: object,
    progress: ridgeform.Progress,
    check: Callable[[], None],
) -> None:
    places = source.facetable.weld.places(made.coordinates)
    mesh = ridgeform.Mesh(places, source.facetable.weld.triangles)
    wanted, flow = chosen(settings, "facets"), made.flow
    # What the flow has made flat are the facets that it leaves; where hardly anything is, the shape says.
    flat = int(flow.n_facets) if flow.flat_share[-1] >= FEW_FLAT else 0
    found, facet_mesh = faceting.facets_of(
        source.facetable,
        mesh,
        made.coordinates,
        facets=wanted or flat or None,
        flat="SHARP" in settings.marks,
        progress=progress,
        check=check,
    )
    made.rebuilt, made.n_facets = facet_mesh.rebuilt, int(found.n_facets)
    made.notes += faceting.notes(found, wanted)
    if source.edges is not None:
        made.ridges, least = facet_mesh.ridges(), chosen(settings, "mark_angle")
        if least is not None:
            made.ridges &= _edges(made.rebuilt).ridges(made.rebuilt.points, least)


def _edges(rebuilt: rebuilding.Rebuilt) -> Edges:
    faces = rebuilt.faces
    return Edges(faces.edges, (faces.starts, faces.corners, faces.corner_edges))


def _ridges(source: Source, made: Finished, least: float | None) -> np.ndarray:
    if made.rebuilt is None:
        return source.edges.ridges(made.coordinates, least) & source.free[source.edges.ends].all(axis=1)
    faces, points = made.rebuilt.faces, made.rebuilt.points.astype(np.float32)
    # What is left of a facet is a few triangles, and nothing between facets is round.
    ridges = _edges(made.rebuilt).ridges(points, ONE_FACET if least is None else least)
    held = np.isin(_rows(points), _rows(made.coordinates[~source.free]))
    return ridges & ~held[faces.edges].any(axis=1)


def _rows(points: np.ndarray) -> np.ndarray:
    """Points (n, 3) float32 as single values (n,), to be compared bit by bit."""
    return np.ascontiguousarray(points).view("V12").ravel()


def write(obj: bpy.types.Object, source: Source, made: Finished, settings: object) -> None:
    """Write a result to the mesh of an object, which may show a preview."""
    if settings.output == "SHAPE_KEY":
        mesh_io.add_shape_key(obj, made.coordinates, KEY_NAME)
    elif settings.output == "ATTRIBUTE":
        blending.store(obj.data, made.coordinates)
        blending.add_modifier(obj)
    else:
        source.coordinates.write(made.coordinates)
    ridges = made.ridges
    if made.rebuilt is not None:
        rows = rebuilding.write(obj, made.rebuilt)
        ridges = None if ridges is None else ridges[rows]
    if ridges is not None:
        mesh_io.mark_edges(obj.data, ridges, settings.marks)


def _keep_volume(source: Source, made: Finished) -> str | None:
    if not source.free.all():
        return "the volume was not kept, because only a part of the mesh was free to move"
    weld = source.weld
    before, after = weld.places(source.coordinates.original), weld.places(made.coordinates)
    scaled, reason = keep_volume(before, after, weld.triangles)
    made.coordinates = source.merged(scaled)
    return reason


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
