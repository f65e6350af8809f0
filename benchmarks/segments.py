"""Segment shapes with known parts, and write the table: `segments.md`.

    python scripts/setup_env.py benchmarks/segments.py [--only WORDS] [--levels N ...] [--ours]
        [--site FOLDER]

`--only` takes the shapes with these words in their name, `--levels` some densities: these print and keep
nothing. `--ours` measures only ours, and keeps the other columns of the page. `--site` names a folder with
the package `ridgeform`, instead of building the wheel. trimesh gets an
environment of its own; Blender's linked-flat selection is written again in NumPy.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
from build_wheel import build_wheel
from cells import duration, grid
from environments import python_of
from known_shapes import segment_shapes, shapes
from known_shapes.segment_shapes import SHAPES, Part, adjusted_rand_index
from numpy.typing import NDArray
from workspace import WHEEL_SITE

ROOT = Path(__file__).resolve().parents[1]

RESULTS = ROOT / "benchmarks/segments.md"
REQUIREMENTS = ROOT / "benchmarks/requirements-segments.txt"
SEEDS = (0, 1)
"""Noises and rotations; the table has the worst of them."""
ANGLES = (1.0, 5.0, 10.0, 20.0, 30.0, 45.0)
"""Degrees for the linked-flat selection; the table has the best of them, chosen with the truth."""
PAPER = {"method": "paper", "fidelity": 1000.0, "epsilon_end": 0.02, "min_faces": 20}
"""The method of the paper, with its numbers for clean facets."""

Indices = NDArray[np.int64]
TITLES = ("ridgeform", "as the paper", "trimesh facets", "linked flat")


def facets(parts: list[Part]) -> list[Indices]:
    """The facets of trimesh, faces in none each by themselves."""
    with tempfile.TemporaryDirectory() as scratch:
        for k, part in enumerate(parts):
            np.savez(Path(scratch) / f"{k}.npz", vertices=part.vertices, faces=part.faces)
        script = ROOT / "benchmarks/segments_peer.py"
        subprocess.run(
            [str(python_of("bench-segments", REQUIREMENTS, "the peers")), str(script), scratch], check=True
        )
        return [np.load(Path(scratch) / f"{k}.labels.npy") for k in range(len(parts))]


def linked_flat(part: Part, degrees: float) -> Indices:
    """Pieces joined by edges flatter than an angle: Blender's Select Linked Flat Faces, from every face."""
    a, b, c = (part.vertices[part.faces[:, i]] for i in range(3))
    normals = np.cross(b - a, c - a)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    first, second, _ = segment_shapes.face_pairs(part.faces)
    flat = (normals[first] * normals[second]).sum(axis=1) > np.cos(np.radians(degrees))
    return segment_shapes.pieces(len(part.faces), first[flat], second[flat])


class Tally:
    """Counts of segments and agreement with the truth, over several seeds."""

    def __init__(self) -> None:
        """Nothing yet."""
        self.counts: list[int] = []
        self.agreement: list[float] = []

    def add(self, part: Part, labels: Indices) -> None:
        """Judge a labeling."""
        self.counts.append(int(labels.max()) + 1)
        self.agreement.append(adjusted_rand_index(labels, part.truth))

    def __str__(self) -> str:
        """The counts found, and the least agreement."""
        low, high = min(self.counts), max(self.counts)
        return f"{low}{f' to {high}' if high > low else ''}, {min(self.agreement):.3f}"

    def passes(self, part: Part, noise: float) -> bool:
        """Whether all seeds reach what is wanted: the parts up to noise of 0.1, and most faces beyond."""
        if noise > 0.1:
            return min(self.agreement) >= 0.92
        return min(self.agreement) >= 0.98 and set(self.counts) == {part.n_parts}


def kept_cells() -> dict[tuple[str, ...], list[str]]:
    """The columns of the others, as the page has them, by shape, vertices and noise."""
    lines = RESULTS.read_text(encoding="utf-8").partition("## Time")[0].splitlines()
    rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in lines if line.startswith("|")]
    return {tuple(row[:3]): row[5:8] for row in rows}


def judge(
    name: str, level: int, noise: float, kept: dict[tuple[str, ...], list[str]] | None
) -> tuple[list[str], bool]:
    """A row of the table, with others' columns measured or `kept`, and whether ours passes."""
    import ridgeform  # noqa: PLC0415

    parts = [SHAPES[name](level).noisy(noise, 10 + seed).turned(seed) for seed in SEEDS]
    tallies = {title: Tally() for title in TITLES}
    begin = time.process_time()
    for part in parts:
        result = ridgeform.segment(ridgeform.Mesh(part.vertices, part.faces))
        tallies["ridgeform"].add(part, result.labels)
    took = (time.process_time() - begin) / len(parts)
    row = [name, str(len(parts[0].vertices)), f"{noise:g}"]
    if kept is None:
        compare(parts, tallies)
    others = [str(tallies[t]) for t in TITLES[1:]] if kept is None else kept[tuple(row)]
    ours = tallies["ridgeform"]
    passed = ours.passes(parts[0], noise)
    first = f"**{ours}**" if passed else str(ours)
    return [*row, str(parts[0].n_parts), first, *others, duration(took)], passed


def compare(parts: list[Part], tallies: dict[str, Tally]) -> None:
    """Judge the method of the paper, trimesh and the linked-flat selection."""
    import ridgeform  # noqa: PLC0415

    for part, of_trimesh in zip(parts, facets(parts), strict=True):
        paper = ridgeform.segment(ridgeform.Mesh(part.vertices, part.faces), **PAPER)
        tallies["as the paper"].add(part, paper.labels)
        tallies["trimesh facets"].add(part, of_trimesh)
        choices = [linked_flat(part, angle) for angle in ANGLES]
        tallies["linked flat"].add(part, max(choices, key=lambda c: adjusted_rand_index(c, part.truth)))


def speed() -> str:
    """Times against the quadratic problem on the same mesh: one factorization and one solution."""
    import ridgeform  # noqa: PLC0415

    rows = []
    for words, (vertices, faces) in {
        "cube, 10 thousand": shapes.cube(41, 2.0),
        "cube, 100 thousand": shapes.cube(129, 2.0),
    }.items():
        noisy = shapes.add_noise(vertices, faces, 0.1)
        mesh = ridgeform.Mesh(noisy, faces)
        begin = time.process_time()
        ridgeform.denoise(mesh, noisy[:, 0], fidelity=1000.0, energy="l2_hessian", threads=1)
        unit = time.process_time() - begin
        begin = time.process_time()
        found = ridgeform.segment(mesh, threads=1)
        total = time.process_time() - begin
        per_level = total / len(found.epsilons) / unit
        rows.append(
            [
                words,
                str(found.n_segments),
                duration(total),
                str(len(found.epsilons)),
                f"{per_level:.1f}",
                duration(unit),
            ]
        )
    head = ["vertices", "segments", "time", "values of ε", "yardsticks for each", "yardstick"]
    return grid(head, rows)


def main() -> None:
    """Measure, print, and keep the full run."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--only", metavar="WORDS", default="", help="shapes; keeps nothing")
    parser.add_argument(
        "--levels", nargs="+", type=int, default=list(segment_shapes.LEVELS), help="densities"
    )
    parser.add_argument("--ours", action="store_true", help="keep the other columns of the page")
    parser.add_argument("--site", type=Path, help="a folder with the package to be measured")
    given = parser.parse_args()
    if given.site is None:
        build_wheel()
    sys.path.insert(0, str(given.site or WHEEL_SITE))
    kept = kept_cells() if given.ours else None
    rows, passes = [], []
    cases = [(name, level) for level in given.levels for name in SHAPES if given.only in name]
    for name, level in cases:
        for noise in segment_shapes.NOISES:
            row, passed = judge(name, level, noise, kept)
            rows.append(row)
            passes.append(passed)
            print(grid([], [row]).splitlines()[-1], flush=True)
    head = ["shape", "vertices", "noise", "parts", *TITLES, "time"]
    total = f"{sum(passes)} of {len(passes)}"
    print(total, flush=True)
    if given.only or given.levels != list(segment_shapes.LEVELS):
        return
    words = INTRODUCTION.format(total=total, angles=", ".join(f"{a:g}" for a in ANGLES))
    RESULTS.write_text(words + grid(head, rows) + SPEED + speed(), encoding="utf-8")


INTRODUCTION = """# Segments against known truth

`make bench-segments` makes this page. Shapes with known parts
([segment_shapes.py](../tests/known_shapes/segment_shapes.py)), three densities, Gaussian noise in every
coordinate of the given share of the mean edge, random rotations. Each cell: segments found, and the
adjusted Rand index with the truth, the least of two noises and rotations; one set of defaults for all.
Bold: the true count and at least 0.98 up to noise of 0.1, at least 0.92 at 0.2 ({total}). *As the paper*:
`method="paper"` with ε down to 0.02, cut at 0.6, pieces under 20 faces merged. *trimesh facets*: faces in
no facet count one by one. *Linked flat*: Blender's selection over edges flatter than an angle, the best of
{angles} degrees, chosen with the truth. Time: processor time of ours, mean.

"""

SPEED = """
## Time

One thread. The yardstick is the quadratic problem (one column, one factorization, one solution), same mesh.

"""

if __name__ == "__main__":
    main()
