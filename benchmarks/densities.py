"""Segment shapes at several densities, and compare what comes out: `densities.md`.

    python scripts/setup_env.py benchmarks/densities.py [MESH.obj ...] [--only WORDS] [--site FOLDER]

Meshes that are given are remeshed to several densities. `--only` takes the shapes with these words in their
name; this, or meshes, print and keep nothing. `--site` names a folder with the package `ridgeform`, instead
of building the wheel.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path

import bpy
import numpy as np
from build_wheel import build_wheel
from cells import grid
from facets import Mesh, bundled
from known_shapes import shapes
from known_shapes.segment_shapes import SHAPES, adjusted_rand_index
from mathutils.bvhtree import BVHTree
from numpy.typing import NDArray
from problems import load_obj
from workspace import WHEEL_SITE

ROOT = Path(__file__).resolve().parents[1]
RESULTS = ROOT / "benchmarks/densities.md"
COUNTS = (2000, 8000, 32_000, 126_000)
POINTS = 20_000
LITTLE = 0.003
"""Noise, in parts of an edge, that changes nothing that one sees."""


def subdivided(add: Callable[[], None], levels: range) -> Iterator[Mesh]:
    """What `add` adds, as Blender's Subdivision Surface has it on these levels."""
    for level in levels:
        bpy.ops.wm.read_factory_settings(use_empty=True)
        add()
        added = bpy.context.object
        added.modifiers.new("", "SUBSURF").levels = level
        bpy.ops.object.modifier_apply(modifier=added.modifiers[0].name)
        data = added.data
        data.calc_loop_triangles()
        yield (
            np.array([v.co[:] for v in data.vertices], float),
            np.array([t.vertices[:] for t in data.loop_triangles], np.int64),
        )


def add_mesh(mesh: Mesh) -> None:
    """Add it to the scene, and make it the active object."""
    data = bpy.data.meshes.new("mesh")
    data.from_pydata(mesh[0].tolist(), [], mesh[1].tolist())
    added = bpy.data.objects.new("mesh", data)
    bpy.context.collection.objects.link(added)
    bpy.context.view_layer.objects.active = added


def remeshed(mesh: Mesh) -> Iterator[Mesh]:
    """The surface with edges of one length, at all densities."""
    import ridgeform  # noqa: PLC0415

    a, b, c = (mesh[0][mesh[1][:, i]] for i in range(3))
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2
    for count in COUNTS:
        edge = np.sqrt(area / count / np.sqrt(0.75))
        found = ridgeform.remesh(ridgeform.Mesh(*mesh), edge_length=edge)
        yield found.vertices, found.faces.astype(np.int64)


def rounded_box(radius: float) -> Iterator[Mesh]:
    """A box whose edges are rounded by that radius."""
    for count in COUNTS:
        yield shapes.rounded_box(round((count / 6) ** 0.5) + 1, radius)


def divided(name: str, levels: int, noise: float = 0.0) -> Iterator[Mesh]:
    """A shape of the table of segments, its triangles cut in four, under noise in parts of an edge."""
    part = SHAPES[name](0)
    for level in range(levels):
        vertices, faces = shapes.subdivide(part.vertices, part.faces, level)
        yield shapes.add_noise(vertices, faces, noise, 3), faces


CASES: dict[str, Callable[[], Iterator[Mesh]]] = {
    "monkey": lambda: subdivided(bpy.ops.mesh.primitive_monkey_add, range(1, 5)),
    "Spot, subdivided": lambda: subdivided(partial(add_mesh, bundled("spot_low_resolution")), range(1, 4)),
    "bust, remeshed": lambda: remeshed(bundled("bust")),
    "box, radius 0.05": lambda: rounded_box(0.05),
    "box, radius 0.1": lambda: rounded_box(0.1),
    "box, radius 0.15": lambda: rounded_box(0.15),
    "box, radius 0.2": lambda: rounded_box(0.2),
    "box, radius 0.3": lambda: rounded_box(0.3),
    "box, radius 0.4": lambda: rounded_box(0.4),
    "dodecahedron": lambda: divided("dodecahedron", 4),
    "gabled house": lambda: divided("gabled house", 4),
    "gabled house, noise 0.1": lambda: divided("gabled house", 4, 0.1),
    "fan part": lambda: divided("fan part", 4),
    "fan part, noise 0.1": lambda: divided("fan part", 4, 0.1),
}


def points_on(mesh: Mesh) -> NDArray[np.float64]:
    """Points spread evenly over the surface, `(k,3)`."""
    random = np.random.default_rng(0)
    a, b, c = (mesh[0][mesh[1][:, i]] for i in range(3))
    areas = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    face = random.choice(len(areas), POINTS, p=areas / areas.sum())
    u, v = random.random((2, POINTS, 1))
    u, v = np.where(u + v > 1, 1 - u, u), np.where(u + v > 1, 1 - v, v)
    return a[face] + u * (b - a)[face] + v * (c - a)[face]


def row(name: str, meshes: list[Mesh]) -> list[str]:
    """What is found at each density, and how far that agrees."""
    import ridgeform  # noqa: PLC0415

    points = points_on(meshes[-1])
    counts, seen, itself, took = [], [], [], 0.0
    for vertices, faces in meshes:
        begin = time.process_time()
        found = ridgeform.segment(ridgeform.Mesh(vertices, faces), threads=1)
        took = time.process_time() - begin
        tree = BVHTree.FromPolygons(vertices.tolist(), faces.tolist())
        at = [tree.find_nearest(p)[2] for p in points.tolist()]
        seen.append(found.labels[at])
        counts.append(found.n_segments)
        shaken = ridgeform.Mesh(shapes.add_noise(vertices, faces, LITTLE, 1), faces)
        itself.append(adjusted_rand_index(seen[-1], ridgeform.segment(shaken, threads=1).labels[at]))
    n = len(meshes)
    agreement = {(i, j): adjusted_rand_index(seen[i], seen[j]) for i in range(n) for j in range(i + 1, n)}
    return [
        name,
        ", ".join(str(len(mesh[0])) for mesh in meshes),
        ", ".join(map(str, counts)),
        ", ".join(f"{agreement[i, i + 1]:.3f}" for i in range(n - 1)),
        f"{min(agreement.values()):.3f}",
        ", ".join(f"{index:.3f}" for index in itself),
        f"{took:.1f} s",
    ]


def main() -> None:
    """Measure, print, and keep the full run."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("meshes", nargs="*", type=Path)
    parser.add_argument("--only", metavar="WORDS", default="", help="shapes; keeps nothing")
    parser.add_argument("--site", type=Path, help="a folder with the package to be measured")
    given = parser.parse_args()
    if given.site is None:
        build_wheel()
    sys.path.insert(0, str(given.site or WHEEL_SITE))
    cases = {path.stem: partial(remeshed, load_obj(path)) for path in given.meshes} or CASES
    rows = []
    for name, make in cases.items():
        if given.only in name:
            rows.append(row(name, list(make())))
            print(grid([], rows[-1:]).splitlines()[-1], flush=True)
    if not given.meshes and not given.only:
        head = ["shape", "vertices", "segments", "agreement of neighbors", "least", "with itself", "time"]
        RESULTS.write_text(INTRODUCTION + grid(head, rows), encoding="utf-8")


INTRODUCTION = """# Segments of one shape at several densities

`make bench-densities` makes this page. Each shape is segmented at several densities, with one set of defaults
for all. *Agreement*: the adjusted Rand index of the segments of two densities at 20,000 points spread evenly
over the finest mesh; of each density with the next, and the least of all pairs. *With itself*: of each mesh
with the same one under noise of 0.003 of an edge; more cannot be expected of two densities. Boxes of 1.9
by 1.5 by 1.3 have rounded edges, which on a coarse mesh are chamfers of one or two rows of faces, each plane
for itself. The bust has 18,000 triangles, which its finest density sees one by one. Time: processor time at
the finest density. What can be expected is in [Segmentation](../docs/decisions/segmentation.md).

"""

if __name__ == "__main__":
    main()
