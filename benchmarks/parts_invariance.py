"""Parts of one shape at other densities, turned, under noise, and seen in a mirror: a table of `parts.md`.

    python scripts/setup_env.py benchmarks/parts.py --invariance
    python scripts/setup_env.py benchmarks/parts_invariance.py MESH.obj ... [--site FOLDER]

Without meshes the bundled ones and a ball with limbs are taken, and the page is written; with meshes it is
printed only. `--site` names a folder with the package `ridgeform`, instead of building the wheel.
"""

from __future__ import annotations

import argparse
import itertools
import sys
import time
from pathlib import Path

import numpy as np
from build_wheel import build_wheel
from cells import grid
from known_shapes import limbs, shapes
from known_shapes.segment_shapes import adjusted_rand_index
from numpy.typing import NDArray
from problems import load_obj
from scipy.spatial import cKDTree
from workspace import WHEEL_SITE

ROOT = Path(__file__).resolve().parents[1]
RESULTS = ROOT / "benchmarks/parts.md"
TITLE = "## The same shape in other meshes"
SOURCES = ROOT / "blend_fixtures/sources"
FACES = (2_000, 8_000, 32_000, 128_000)
"""Densities: new meshes with edges of one length, that know nothing of each other."""
MIDDLE = FACES[1]
TURNS = 10
NOISE = 0.1
"""Of the mean edge."""
NEAR = 12
"""So many faces with the nearest centers are asked for the one on which a point lies."""
MIRRORS = {"Spot": [-1, 1, 1], "ball with limbs": None}
"""Shapes that are their own mirror images: signs of the axes, or x and y change places."""
INTRODUCTION = """
`make bench-parts ARGS=--invariance` makes this section. Every shape is meshed anew with edges of one
length, with about {faces} faces. Adjusted Rand index (1: the same parts) over pairs of results, the
mean and in brackets the least, of the parts found and, after a semicolon, where all are asked for as
many as are found at {middle:,} faces. *Densities*: of all pairs of the four. *Turned*: ten rotations,
against the shape as it is. *Noise*: ten noises of {noise} of the mean edge, against none. *Mirror*: the
parts against their mirror image, at all densities. A face of one mesh is compared with the face of the
other on which its center lies, so borders that follow other edges count. *There and back*: the parts of
{fine:,} faces, put onto the mesh of {middle:,} and back, against themselves. Time: processor time, one
thread.

"""

Mesh = tuple[NDArray[np.float64], NDArray[np.int64]]
Indices = NDArray[np.int64]


def bundled() -> dict[str, Mesh]:
    """The meshes of the page."""
    meshes: dict[str, Mesh] = {"ball with limbs": limbs.ball_with_limbs(5)[:2]}
    for title, name in (("Spot", "spot"), ("bust", "bust")):
        with np.load(SOURCES / f"{name}.npz") as data:
            meshes[title] = data["vertices"].astype(float), data["faces"].astype(np.int64)
    return meshes


def meshed(vertices: NDArray[np.float64], faces: Indices, count: int) -> Mesh:
    """The shape in about so many equilateral triangles."""
    import ridgeform  # noqa: PLC0415

    a, b, c = (vertices[faces[:, i]] for i in range(3))
    area = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1).sum()
    made = ridgeform.remesh(
        ridgeform.Mesh(vertices, faces), edge_length=float(np.sqrt(4 * area / 3**0.5 / count))
    )
    return made.vertices, made.faces


def on_which(points: NDArray[np.float64], mesh: Mesh) -> Indices:
    """The face `(p,)` on which each point lies, of those whose centers are nearest."""
    vertices, faces = mesh
    corners = vertices[faces]
    near = cKDTree(corners.mean(axis=1)).query(points, min(NEAR, len(faces)))[1]
    best, face = np.full(len(points), np.inf), near[:, 0].copy()
    for candidate in near.T:
        # Distances to 15 points on a triangle tell which one is meant.
        spread = np.array([[i, j, 4 - i - j] for i in range(5) for j in range(5 - i)]) / 4
        places = np.einsum("sk,pkx->psx", spread, corners[candidate])
        away = ((places - points[:, None]) ** 2).sum(axis=2).min(axis=1)
        closer = away < best
        best[closer], face[closer] = away[closer], candidate[closer]
    return face


class Divided:
    """A mesh with its parts as found, and in a given number."""

    def __init__(self, mesh: Mesh, count: int | None = None) -> None:
        """Divide it; asked for so many parts, or as many as are found."""
        import ridgeform  # noqa: PLC0415

        self.mesh = mesh
        begin = time.process_time()
        found = ridgeform.parts(ridgeform.Mesh(*mesh), threads=1)
        self.seconds = time.process_time() - begin
        self.n_parts = found.n_parts
        self.labels = (found.labels, found.labels_at(count or found.n_parts))
        self.centers = mesh[0][mesh[1]].mean(axis=1)

    def against(self, other: Divided, faces: Indices | None = None) -> tuple[float, ...]:
        """How far both agree, face by face, or where the faces of `other` lie in this one."""
        return tuple(
            adjusted_rand_index(mine if faces is None else mine[faces], theirs)
            for mine, theirs in zip(self.labels, other.labels, strict=True)
        )


def cell(pairs: list[tuple[float, ...]]) -> str:
    """Mean and least, as found and at the given number."""
    columns = np.array(pairs).T
    return "; ".join(f"{column.mean():.3f} ({column.min():.3f})" for column in columns)


def mirrored(points: NDArray[np.float64], name: str) -> NDArray[np.float64]:
    """The points in the mirror of a shape."""
    signs = MIRRORS[name]
    return points[:, [1, 0, 2]] if signs is None else points * signs


def row(name: str, mesh: Mesh) -> list[str]:
    """All that is measured on one shape."""
    plain = Divided(meshed(*mesh, MIDDLE))
    others = {count: Divided(meshed(*mesh, count), plain.n_parts) for count in FACES if count != MIDDLE}
    made = dict(sorted({MIDDLE: plain, **others}.items()))
    densities = []
    for coarse, fine in itertools.combinations(made.values(), 2):
        densities.append(coarse.against(fine, on_which(fine.centers, coarse.mesh)))
    (vertices, faces), n = plain.mesh, plain.n_parts
    turned = [
        plain.against(Divided((vertices @ shapes.random_rotation(k).T, faces), n)) for k in range(TURNS)
    ]
    noises = [Divided((shapes.add_noise(vertices, faces, NOISE, k), faces), n) for k in range(TURNS)]
    fine = made[FACES[2]]
    there, back = on_which(plain.centers, fine.mesh), on_which(fine.centers, plain.mesh)
    limit = adjusted_rand_index(fine.labels[0][there][back], fine.labels[0])
    noisy = [plain.against(divided) for divided in noises]
    mirror = "-"
    if name in MIRRORS:
        images = [d.against(d, on_which(mirrored(d.centers, name), d.mesh)) for d in made.values()]
        mirror = cell(images)
    counts = " ".join(str(divided.n_parts) for divided in made.values())
    most = max(divided.n_parts for divided in noises)
    least = min(divided.n_parts for divided in noises)
    times = " ".join(f"{divided.seconds:.1f}" for divided in made.values())
    found = f"{least} to {most}"
    return [name, counts, cell(densities), cell(turned), found, cell(noisy), mirror, f"{limit:.3f}", times]


def write(first: str | None = None, second: str | None = None) -> None:
    """The page with these in place of what it had before and from the title of this section on."""
    before, _, after = RESULTS.read_text(encoding="utf-8").partition(f"{TITLE}\n")
    before, after = first or before, second or after
    RESULTS.write_text(before.rstrip("\n") + f"\n\n{TITLE}\n" + after, encoding="utf-8")


def measured(site: Path | None, paths: list[Path] | None = None) -> None:
    """Measure, print, and keep what was measured on the bundled meshes."""
    if site is None:
        build_wheel()
    sys.path[:0] = [str(site or WHEEL_SITE), str(ROOT)]
    rows = []
    for name, mesh in ({path.stem: load_obj(path) for path in paths} if paths else bundled()).items():
        rows.append(row(name, mesh))
        print(" | ".join(rows[-1]), flush=True)
    head = [
        "shape",
        "parts found",
        "densities",
        "turned",
        "parts, noise",
        "noise",
        "mirror",
        "there and back",
    ]
    head.append("seconds")
    counts = ", ".join(f"{count:,}" for count in FACES)
    words = {"faces": counts, "middle": MIDDLE, "fine": FACES[2], "noise": NOISE}
    section = INTRODUCTION.format(**words) + grid(head, rows)
    print(section)
    if not paths:
        write(second=section)


def main() -> None:
    """Measure the shapes that are named."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument(
        "meshes", nargs="*", type=Path, metavar="MESH.obj", help="other meshes; keeps nothing"
    )
    parser.add_argument("--site", type=Path, help="a folder with the package to be measured")
    given = parser.parse_args()
    measured(given.site, given.meshes)


if __name__ == "__main__":
    main()
