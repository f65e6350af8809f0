"""Facets of meshes beside quadric reduction to as many triangles: `facets.md`.

    python scripts/setup_env.py benchmarks/facets.py [MESH.obj ...] [--site FOLDER]

Without meshes the bundled ones are taken, and the table is written; with meshes it is printed only. `--site`
names a folder with the package `ridgeform`, instead of building the wheel.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
import time
import zipfile
from collections import Counter
from pathlib import Path

import numpy as np
from build_extension import PLATFORMS, bundled_wheels
from build_wheel import build_wheel
from cells import grid
from known_shapes import shapes
from known_shapes.fill_measures import mean_and_rms, point_distances, samples
from numpy.typing import NDArray
from problems import load_obj
from workspace import WHEEL_SITE

ROOT = Path(__file__).resolve().parents[1]
RESULTS = ROOT / "benchmarks/facets.md"
SOURCES = ROOT / "blend_fixtures/sources"
COUNTS = (30, 100, 300)
MOST_POINTS = 20_000

Mesh = tuple[NDArray[np.float64], NDArray[np.int64]]


def bundled(name: str) -> Mesh:
    """A mesh that comes with the project."""
    with np.load(SOURCES / f"{name}.npz") as data:
        return data["vertices"].astype(float), data["faces"].astype(np.int64)


def distances(mesh: Mesh, other: Mesh) -> tuple[float, float]:
    """Root mean square and largest distance of both surfaces from each other, in percent of the diagonal."""
    size = np.linalg.norm(np.ptp(mesh[0], axis=0)) / 100
    rms, largest = 0.0, 0.0
    for first, second in ((mesh, other), (other, mesh)):
        triangles = subdivided(first)
        points, areas = samples(*triangles)
        chosen = np.random.default_rng(0).permutation(len(points))[:MOST_POINTS]
        off = point_distances(points[chosen], *second)
        corners = point_distances(first[0], *second)
        rms = max(rms, mean_and_rms(off, areas[chosen])[1] / size)
        largest = max(largest, max(off.max(), corners.max()) / size)
    return rms, largest


def subdivided(mesh: Mesh) -> Mesh:
    """Triangles cut in four until there are some thousands: points on large ones lie densely then."""
    vertices, faces = mesh
    while len(faces) < 4000:
        corners = vertices[faces]
        middles = 0.5 * (corners + corners[:, [1, 2, 0]])
        a, b, c = (corners[:, i] for i in range(3))
        ab, bc, ca = (middles[:, i] for i in range(3))
        parts = [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
        vertices = np.concatenate([np.stack(part, axis=1) for part in parts]).reshape(-1, 3)
        faces = np.arange(len(vertices)).reshape(-1, 3)
    return vertices, faces


def is_kept_closed(mesh: Mesh, found: object) -> str:
    """Whether a surface without a border still has none, and every side belongs to two polygons."""

    def borders(rings: list[list[int]]) -> int:
        sides = Counter(side for ring in rings for side in zip(ring, ring[1:] + ring[:1], strict=True))
        return sum(count > 1 or (b, a) not in sides for (a, b), count in sides.items())

    rings = np.split(found.polygon_vertices, found.polygon_starts[1:-1])
    before, after = borders(mesh[1].tolist()), borders([ring.tolist() for ring in rings])
    return "open before" if before else "closed" if after == 0 else f"{after} open sides"


def row(name: str, mesh: Mesh, count: int) -> list[str]:
    """A row of the table."""
    import ridgeform  # noqa: PLC0415

    begin = time.process_time()
    found = ridgeform.facet(ridgeform.Mesh(*mesh), facets=count, threads=1)
    took = time.process_time() - begin
    planes = found.planes[found.face_facets]
    heights = (planes[:, None, :3] * found.vertices[found.faces]).sum(axis=2) - planes[:, None, 3]
    off = np.abs(heights).max() / np.linalg.norm(np.ptp(mesh[0], axis=0))
    ours = distances(mesh, (found.vertices, found.faces))
    import fast_simplification  # noqa: PLC0415

    reduced = fast_simplification.simplify(
        mesh[0].astype(np.float32), mesh[1].astype(np.int32), target_count=count
    )
    theirs = distances(mesh, (reduced[0].astype(float), reduced[1].astype(np.int64)))
    return [
        name,
        f"{count}",
        f"{found.n_facets}",
        f"{ours[0]:.2f}, {ours[1]:.1f}",
        f"{theirs[0]:.2f}, {theirs[1]:.1f}",
        f"{off:.0e}",
        is_kept_closed(mesh, found),
        f"{found.n_crossings}",
        f"{took:.1f} s",
    ]


HEAD = [
    "mesh",
    "asked",
    "facets",
    "facets: RMS, largest",
    "reduction: RMS, largest",
    "off plane",
    "surface",
    "cross",
    "time",
]
PAGE = """# Facets

`make bench-facets` makes this page. Each mesh with as many facets as asked for, beside a reduction to as many
triangles by quadrics (fast-simplification). Distances are those of both surfaces from each other, the larger
of the two, in percent of the diagonal of the bounding box: root mean square over the area, and largest. *Off
plane*: the largest distance of a corner from the plane of its facet, in diagonals. *Cross*: pairs of facets
that pass through each other. Time: processor time of `facet`, of the first call.

{table}
"""


def main() -> None:
    """Measure, and write or print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("meshes", type=Path, nargs="*")
    parser.add_argument("--site", type=Path)
    options = parser.parse_args()
    if options.site is None:
        build_wheel()
    sys.path.insert(0, str(options.site or WHEEL_SITE))
    tag = f"cp{sys.version_info.major}{sys.version_info.minor}"
    scratch = tempfile.mkdtemp()
    for wheel in bundled_wheels(next(target for target in PLATFORMS if "linux" in target)):
        if tag in wheel.name or wheel.name.endswith("none-any.whl"):
            zipfile.ZipFile(wheel).extractall(scratch)
    sys.path.insert(0, scratch)
    meshes = {path.stem: load_obj(path) for path in options.meshes}
    if not meshes:
        meshes = {name: bundled(name) for name in ("bust", "spot", "spot_low_resolution")}
        meshes["uv_sphere"] = shapes.uv_sphere(64, 32)
    rows = [row(name, mesh, count) for name, mesh in meshes.items() for count in COUNTS]
    table = grid(HEAD, rows)
    if options.meshes:
        print(table)
    else:
        RESULTS.write_text(PAGE.format(table=table), encoding="utf-8")


if __name__ == "__main__":
    main()
