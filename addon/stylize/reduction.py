# SPDX-License-Identifier: GPL-3.0-or-later
"""Reducing the triangle count with fast-simplification, attributes carried over."""

import importlib.util
from collections.abc import Callable
from dataclasses import replace

import bpy
import numpy as np

from ..blender import kept_normals, rebuilding
from ..blender.carrying import MarkedEdges, carried
from ..blender.polygons import Polygons
from ..blender.rebuilding import Before, Rebuilt
from ..blender.surface_map import SurfaceMap
from ..blender.welding import weld_seams
from .kept_edges import kept_edges, regions_of
from .simplify import FEWEST, Simplified, simplify

MORE = 1.1
"""So many times as many triangles as were asked for are worth a word."""


def reason_against(mesh: bpy.types.Mesh, leaves_mesh: bool = False) -> str | None:
    """Why the triangles of a mesh cannot be reduced; `None` if they can.

    `leaves_mesh`: the mesh is to stay as it is.
    """
    reason = rebuilding.reason_against(mesh, leaves_mesh)
    if reason is not None:
        return f"its triangles were not reduced, because {reason}"
    if importlib.util.find_spec("fast_simplification") is None:
        return "its triangles were not reduced, because the module fast-simplification is not installed"
    return None


def reduce(
    source: Before,
    coordinates: np.ndarray,
    ratio: float,
    held: np.ndarray,
    check: Callable[[], None] = lambda: None,
) -> Rebuilt | str:
    """Simplify a mesh that has moved to coordinates (n, 3) to `ratio` of its triangles; else why not.

    Vertices `held` (n,) bool stay, and so do borders, marks, and the borders of materials and UV islands,
    which only lose vertices. UVs, colors and other corner attributes, materials, vertex groups and point
    attributes are taken from the nearest point of the surface between them. No Blender data is touched;
    `check` is called now and then, and may raise to stop.
    """
    triangles = source.old.triangles
    coordinates = coordinates.astype(np.float64)
    # Split seams are joined: otherwise their two sides would be simplified apart, and gape.
    weld = weld_seams(coordinates, triangles)
    wanted = max(FEWEST, round(ratio * len(triangles)))
    if wanted >= len(weld.triangles):
        return f"its {len(triangles)} triangles were not reduced, because there are few enough"
    old = replace(source.old, coordinates=coordinates)
    kept = kept_edges(old, source.layers, weld)
    check()
    share = wanted / len(weld.triangles)
    made = simplify(
        coordinates[weld.first], weld.triangles, kept, held=~weld.all_of(~held), ratio=share, check=check
    )
    points, faces, number = _sound(made)
    if len(faces) == 0:
        return "its triangles were not reduced, because nothing would be left"
    if len(faces) >= len(weld.triangles):
        return (
            f"its {len(triangles)} triangles were not reduced, because all of their vertices must stay "
            "(borders, marks, mask)"
        )
    check()
    # Triangles that closed up are on no chart that is asked for.
    chart = np.full(len(triangles), len(weld.triangles))
    chart[weld.rows] = kept.region
    surface = SurfaceMap(coordinates, triangles, chart)
    check()
    ends = number[made.ends]
    region = regions_of(faces, ends, made.edge, made.forward, kept)
    unknown = np.flatnonzero(region < 0)
    if len(unknown):
        region[unknown] = chart[surface.nearest(points[faces[unknown]].mean(axis=1))[0]]
    first = np.empty(len(weld.triangles) + 1, np.int64)
    first[chart] = np.arange(len(triangles))
    marked = MarkedEdges(ends, kept.of_mesh[made.edge])
    check()
    polygons = Polygons.of_triangles(faces)
    layers = carried(source.layers, old, surface, points, polygons, anchors=first[region], marked=marked)
    said = [f"reduced from {len(triangles)} to {len(faces)} triangles"]
    if len(faces) > MORE * wanted:
        said.append(
            f"{wanted} were asked for, but borders (of UV islands and materials too), marks, masks, and thin "
            "places keep their vertices"
        )
    normals = source.kept_normals(points, polygons, coordinates)
    said += [*_losses(source), *filter(None, [kept_normals.note(normals)])]
    return Rebuilt(points, polygons, layers, "; ".join(said), normals)


def _losses(before: Before) -> list[str]:
    """Sentences on what no reduced mesh keeps."""
    triangles = before.old.triangles
    facts = (
        (int(before.old.faces.max(initial=-1)) + 1 != len(triangles), "quads and n-gons became triangles"),
        (before.n_loose > 0, f"vertices without a face were dropped ({before.n_loose})"),
    )
    return [sentence for applies, sentence in facts if applies]


def _sound(made: Simplified) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Without faces that name a vertex twice or exist already, and vertices without a face.

    Points (p, 3), triangles (q, 3), and the number of each point before among these, -1 for none.
    """
    faces = np.asarray(made.faces, np.int64)
    ordered = np.sort(faces, axis=1)
    proper = (ordered[:, 0] != ordered[:, 1]) & (ordered[:, 1] != ordered[:, 2])
    _, first = np.unique(ordered, axis=0, return_index=True)
    once = np.zeros(len(faces), bool)
    once[first] = True
    faces = faces[proper & once]
    used, renumbered = np.unique(faces, return_inverse=True)
    number = np.full(len(made.points), -1)
    number[used] = np.arange(len(used))
    return made.points[used], renumbered.reshape(-1, 3).astype(np.int32), number
