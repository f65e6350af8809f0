# SPDX-License-Identifier: GPL-3.0-or-later
"""What is made of a flow's result: coordinates, volume, fewer triangles, ridges.

`finished` computes, without touching Blender's data; `write` writes.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial

import bpy
import numpy as np
import ridgeform

from ..blender import blending, kept_normals, mesh_io, rebuilding
from ..blender.welding import Weld
from ..framework import faceting
from ..framework.faceting import Facetable
from ..framework.ridges import Edges
from ..framework.settings import chosen
from ..framework.volume import keep_volume
from . import own_faces, reduction
from .own_faces import OnFacets, OwnFaces
from .settings import movement_of

KEY_NAME = "Stylized"

HARDLY_FLAT = (
    "hardly anything became flat, because its faces are as large as facets or very regular: choose the "
    "finish Facets, or subdivide it first"
)
AS_IT_WAS = "its faces are as large as facets or very regular, so that {} as it was"
MANY_FLAT = 0.3
"""From this part of what was round on, what a flow has made flat are facets of many faces each, 26 to 57 on
all that was tried. Below it they are single faces or two, hardly to be seen: letters of one face a side, a
cylinder, and a cone end below nothing, spheres at 0.05, a head of 500 vertices at 0.07, a hand of 800 at
0.16, a cow of 800 at 0.22, a torus, which gets bands, at 0.24, and all else at 0.37 and above."""

NEAR = 0.3
"""How far facets whose number neither flow nor modeler says may be from the mesh, root mean square: in
parts of what Strength lets it move. On five scans those of the flow are 0.25 to 0.31 of that from it."""

ONE_FACET = np.radians(2.0)
"""Faces that meet at less than this angle are one facet; the report counts facets so. Of the edges that Low
Poly leaves on six meshes, 18 % of the length is bent by less than half a degree and 14 % by up to two: these
lie in facets. From there on there are as many of every angle, 3 to 6 % a degree: ridges."""


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
    own: OwnFaces | None = None
    """Its faces, if they are to stay."""

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
    """How many facets there are, where the flow does not know."""
    on_facets: OnFacets | None = None
    """What has come of it if its faces lie on facets of the shape as it was."""
    moved: float = 0.0
    """How far the farthest point has gone, at most, in parts of the bounding box's diagonal."""
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
    if _stays_round(source, flow, settings):
        # All that the flow does then is to round the mesh off.
        what = "facets were made of the shape" if source.reducible is None else "the shape was reduced"
        made = Finished(flow, source.coordinates.original, [AS_IT_WAS.format(what)])
        if source.own is not None:
            _put_onto_facets(source, made, settings, progress)
            check()
    else:
        note = _note(flow, settings, source)
        made = Finished(flow, source.merged(flow.vertices), [] if note is None else [note])
        made.moved = source.moved(flow.vertices)
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
        if not isinstance(reduced, str):
            made.rebuilt = reduced
            shape = ridgeform.Mesh(reduced.points.astype(np.float64), reduced.faces.corners.reshape(-1, 3))
            # A flow without a step says how flat a shape is.
            made.n_facets = int(ridgeform.stylize(shape, iterations=0).n_facets)
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
    weld, wanted = source.facetable.weld, chosen(settings, "facets") or None
    places = weld.places(made.coordinates)
    near = {} if settings.use_fidelity else {"error": _near(places, weld, settings)}
    count = wanted or (int(made.flow.n_facets) if made.flow.flat_share[-1] >= MANY_FLAT else None)
    make = partial(
        faceting.facets_of,
        source.facetable,
        ridgeform.Mesh(places, weld.triangles),
        made.coordinates,
        coarse_to_fine=settings.coarse_to_fine,
        flat="SHARP" in settings.marks,
        progress=progress,
        check=check,
    )
    found, facet_mesh = make(**({"facets": count} if count else near))
    if near and count != wanted and found.rms > near["error"]:
        # A few large planes, and between them what the flow has left round.
        found, facet_mesh = make(**near)
    made.rebuilt, made.n_facets = facet_mesh.rebuilt, int(found.n_facets)
    made.moved += float(found.largest) / float(np.linalg.norm(np.ptp(places, axis=0)))
    made.notes += faceting.notes(found, made.rebuilt, wanted)
    if source.edges is not None:
        edges, points, least = (
            _edges(made.rebuilt, source),
            made.rebuilt.points,
            chosen(settings, "mark_angle"),
        )
        # A facet and its image in a mirror are one where nothing bends.
        made.ridges = facet_mesh.ridges() | (edges.on_planes(points) & edges.ridges(points, ONE_FACET))
        if least is not None:
            made.ridges &= edges.ridges(points, least)


def _stays_round(source: Source, flow: ridgeform.Stylized, settings: object) -> bool:
    """Whether a flow has come to its own end, and hardly any of what was round has become flat."""
    is_done = flow.iterations > 0 and flow.status in ("reached", "settled", "converged")
    return is_done and not settings.use_fidelity and _became_flat(source, flow) < MANY_FLAT


def _became_flat(source: Source, flow: ridgeform.Stylized) -> float:
    """The part of what was round, where vertices may move, that a flow has made flat."""
    before, after = flow.flat_share[0], flow.flat_share[-1]
    if not source.free.all():
        weld = source.weld
        triangles = weld.triangles[weld.all_of(source.free)[weld.triangles].any(axis=1)]
        shapes = (weld.places(source.coordinates.original), flow.vertices)
        # A flow without a step says how flat a shape is.
        before, after = (
            ridgeform.stylize(ridgeform.Mesh(places, triangles), iterations=0).flat_share[0]
            for places in shapes
        )
    return float((after - before) / (1.0 - before)) if before < 1.0 else 1.0


def _put_onto_facets(
    source: Source, made: Finished, settings: object, progress: ridgeform.Progress | None
) -> None:
    weld = source.own.weld
    taking = weld.all_of(source.free)[weld.triangles].all(axis=1)
    if taking.any():
        made.on_facets = found = own_faces.put_onto_facets(
            source.own,
            made.coordinates,
            taking,
            _near(weld.places(made.coordinates), weld, settings),
            coarse_to_fine=settings.coarse_to_fine,
            progress=progress,
        )
        made.coordinates, made.n_facets = found.coordinates, found.n_facets
        made.moved = source.moved(source.weld.places(found.coordinates))


def _near(places: np.ndarray, weld: Weld, settings: object) -> float:
    """How far facets may be from a mesh at `places` (k, 3), root mean square, where no number is given."""
    a, b, c = (places[weld.triangles[:, corner]] for corner in range(3))
    # Movement is measured in the root of the area.
    width = float(np.sqrt(0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1).sum()))
    return NEAR * movement_of(settings.strength) * width


def _edges(rebuilt: rebuilding.Rebuilt, source: Source) -> Edges:
    faces = rebuilt.faces
    return Edges(faces.edges, (faces.starts, faces.corners, faces.corner_edges), source.edges.planes)


def _ridges(source: Source, made: Finished, least: float | None) -> np.ndarray:
    if made.rebuilt is None:
        found = made.on_facets
        ridges = (
            source.edges.ridges(made.coordinates, least)
            if found is None
            else found.ridges(source.edges, least)
        )
        return ridges & source.free[source.edges.ends].all(axis=1)
    faces, points = made.rebuilt.faces, made.rebuilt.points.astype(np.float32)
    # What is left of a facet is a few triangles, and nothing between facets is round.
    ridges = _edges(made.rebuilt, source).ridges(points, ONE_FACET if least is None else least)
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
    if made.rebuilt is not None:
        kept_normals.write(obj.data, made.rebuilt.normals)


def _keep_volume(source: Source, made: Finished) -> str | None:
    if not source.free.all():
        return "the volume was not kept, because only a part of the mesh was free to move"
    weld = source.weld
    before, after = weld.places(source.coordinates.original), weld.places(made.coordinates)
    scaled, reason = keep_volume(before, after, weld.triangles)
    made.coordinates = source.merged(scaled)
    return reason


def _note(result: ridgeform.Stylized, settings: object, source: Source) -> str | None:
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
        done = "the one step was" if steps == 1 else f"all {steps} steps were"
        notes["finished"] = f"{done} done before its facets had settled: raise Steps"
    elif result.flat_share[-1] < MANY_FLAT and source.before is None:
        # Other finishes make facets of anything.
        notes["finished"] = HARDLY_FLAT
    return notes.get(result.status)
