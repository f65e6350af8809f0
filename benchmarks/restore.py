"""Restore shapes of known parts from noise, beside guided normal filtering: `restore.md`.

    python scripts/setup_env.py benchmarks/restore.py [--only WORDS] [--levels N ...] [--site FOLDER]

`--only` takes the shapes with these words in their name, `--levels` some densities: these print and keep
nothing. `--site` names a folder with the package `ridgeform`, instead of building the wheel.
"""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path

import numpy as np
from build_wheel import build_wheel
from cells import duration, grid
from guided_normals import filtered, unit_normals
from known_shapes import segment_shapes, shapes
from known_shapes.segment_shapes import SHAPES
from workspace import WHEEL_SITE

ROOT = Path(__file__).resolve().parents[1]
RESULTS = ROOT / "benchmarks/restore.md"
NOISES = (0.1, 0.2, 0.3)
LEVELS = (0, 1)
SEED = 10
GUIDED = ((0.2, 20, 10), (0.35, 20, 10), (0.35, 40, 20), (0.5, 60, 20))
"""Spreads of normals, rounds of normals and of vertices; the table has the best of them, chosen with the
truth."""


def mean_angle(vertices: np.ndarray, truth: np.ndarray, faces: np.ndarray) -> float:
    """The mean angle in degrees of the faces to the true ones."""
    cosines = (unit_normals(vertices, faces) * unit_normals(truth, faces)).sum(axis=1)
    return float(np.degrees(np.arccos(np.clip(cosines, -1.0, 1.0))).mean())


def kinds_of(found: object) -> str:
    """How many surfaces of which kind."""
    names = [surface["kind"] for surface in found.surfaces]
    return ", ".join(f"{names.count(kind)} {kind}" for kind in dict.fromkeys(sorted(names)))


def judge(name: str, level: int, noise: float) -> tuple[list[str], bool]:
    """A row of the table, and whether the angle is a third of the filter's."""
    import ridgeform  # noqa: PLC0415

    part = SHAPES[name](level).turned(SEED)
    noisy = part.noisy(noise, SEED).vertices
    begin = time.process_time()
    found = ridgeform.restore(ridgeform.Mesh(noisy, part.faces))
    took = time.process_time() - begin
    ours = mean_angle(found.vertices, part.vertices, part.faces)
    guided = min(
        mean_angle(filtered(noisy, part.faces, *numbers), part.vertices, part.faces) for numbers in GUIDED
    )
    passed = ours <= guided / 3.0
    words = f"{ours:.2f}°"
    before = mean_angle(noisy, part.vertices, part.faces)
    row = [name, str(len(noisy)), f"{noise:g}", f"{before:.1f}°", f"{guided:.2f}°"]
    row += [f"**{words}**" if passed else words, str(part.n_parts), kinds_of(found)]
    return [*row, str(found.n_folded), duration(took)], passed


def cubes() -> str:
    """The cube of 16 edges a side, as fitted and regularized: means of five noises."""
    import ridgeform  # noqa: PLC0415

    truth, faces = shapes.cube(16, 2.0)
    rows = []
    for noise in (0.15, 0.3):
        for regularize in (None, 3.0):
            found = []
            for seed in range(5):
                noisy = shapes.add_noise(truth, faces, noise, seed, edge=2.0 / 16)
                result = ridgeform.restore(ridgeform.Mesh(noisy, faces), regularize=regularize)
                off = shapes.root_mean_square(shapes.distance_to_cube(result.vertices))
                corners = np.linalg.norm(
                    (result.vertices - truth)[(np.abs(truth) == 1.0).all(axis=1)], axis=1
                )
                found.append(
                    (
                        off,
                        mean_angle(result.vertices, truth, faces),
                        corners.max() / (noise * 2 / 16),
                        len(result.surfaces),
                    )
                )
            off, angle, corner, count = np.mean(found, axis=0)
            how = "as fitted" if regularize is None else "regularized"
            rows.append([f"{noise:g}", how, f"{count:g}", f"{off:.4f}", f"{angle:.2f}°", f"{corner:.2f}"])
    head = ["noise", "surfaces", "how many", "RMS", "mean angle", "farthest corner, in noises"]
    return grid(head, rows)


def main() -> None:
    """Measure, print, and keep the full run."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--only", metavar="WORDS", default="", help="shapes; keeps nothing")
    parser.add_argument("--levels", nargs="+", type=int, default=list(LEVELS), help="densities")
    parser.add_argument("--site", type=Path, help="a folder with the package to be measured")
    given = parser.parse_args()
    if given.site is None:
        build_wheel()
    sys.path.insert(0, str(given.site or WHEEL_SITE))
    rows, passes = [], []
    cases = [(name, level) for level in given.levels for name in SHAPES if given.only in name]
    for name, level in cases:
        for noise in NOISES:
            row, passed = judge(name, level, noise)
            rows.append(row)
            passes.append(passed)
            print(grid([], [row]).splitlines()[-1], flush=True)
    total = f"{sum(passes)} of {len(passes)}"
    print(total, flush=True)
    if given.only or given.levels != list(LEVELS):
        return
    head = ["shape", "vertices", "noise", "input", "guided normals", "restore", "parts", "surfaces"]
    head += ["folded", "time"]
    assert len(segment_shapes.SHAPES) == len(SHAPES)
    words = INTRODUCTION.format(total=total)
    RESULTS.write_text(words + grid(head, rows) + CUBES + cubes(), encoding="utf-8")


INTRODUCTION = """# Restoring against known truth

`make bench-restore` makes this page. Shapes with known parts
([segment_shapes.py](../tests/known_shapes/segment_shapes.py)) at random rotations, Gaussian noise in every
coordinate of the given share of the mean edge. Mean angle of the faces to the true ones; *guided normals*:
Zhang et al. 2015 ([guided_normals.py](guided_normals.py)), the best of four settings, chosen with the truth.
Bold: at most a third of that ({total}). Time: processor time of `restore`.

"""

CUBES = """
## The noisy cube

16 edges a side, side 2, means of five noises. RMS distance of the vertices to the true cube, mean angle, and
the farthest corner. Planes fitted to 289 vertices each are known to 0.0019 at noise of 0.15, at right angles
to 0.0014.

"""

if __name__ == "__main__":
    main()
