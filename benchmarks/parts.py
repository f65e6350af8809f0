"""Divide shapes whose parts people have named, and write the table: `parts.md`.

    python scripts/setup_env.py benchmarks/parts.py FOLDER [--only WORDS] [--every K] [--site FOLDER]
    python scripts/setup_env.py benchmarks/parts.py --invariance [--site FOLDER]

The folder holds the shapes as `CATEGORY_NUMBER.npz`: `vertices` (n,3), `faces` (m,3), and `labels` (h,m), one
row for each person, a part for each face, say of the Princeton Segmentation Benchmark (Chen, Golovinskiy and
Funkhouser 2009). They are not part of the project. `--only` takes the shapes with these words in their name,
`--every` one of so many: these print and keep nothing. The best and the worst shapes are drawn beside what a
person made of them: `out/parts.png`. `--invariance` compares one shape in several meshes instead:
`parts_invariance.py`. `--site` names a folder with the package `ridgeform`, instead of building the wheel.
"""

from __future__ import annotations

import argparse
import itertools
import sys
import time
from pathlib import Path

import numpy as np
import parts_invariance
from build_wheel import build_wheel
from cells import grid
from numpy.typing import NDArray
from workspace import WHEEL_SITE

ROOT = Path(__file__).resolve().parents[1]
RESULTS = ROOT / "benchmarks/parts.md"
PICTURE = ROOT / "out/parts.png"
"""Best and worst shapes: not for the project, as the shapes are not."""
USUAL = {
    **{"human": 6, "cup": 2, "glasses": 4, "airplane": 6, "ant": 11, "chair": 8, "octopus": 9, "table": 5},
    **{"teddy": 8, "hand": 6, "plier": 5, "fish": 8, "bird": 5, "armadillo": 18, "bust": 8, "mech": 2},
    **{"bearing": 3, "vase": 4, "fourleg": 10},
}
"""The number of parts that people usually give the shapes of a category."""
SHOWN = 6
"""Best, and worst, shapes in the picture."""
WANTED = """Name the folder with the shapes: make bench-parts DATA=folder
It holds CATEGORY_NUMBER.npz with vertices (n,3), faces (m,3), and labels (h,m): a part for each face, one row
for each person, as made from the Princeton Segmentation Benchmark. They are not part of the project."""

Indices = NDArray[np.int64]


def rand_error(first: Indices, second: Indices) -> float:
    """The share of pairs of faces that one labeling joins and the other parts: 1 minus the Rand index."""
    _, a = np.unique(first, return_inverse=True)
    _, b = np.unique(second, return_inverse=True)
    table = np.zeros((a.max() + 1, b.max() + 1))
    np.add.at(table, (a, b), 1)

    def pairs(counts: NDArray[np.float64]) -> float:
        return float((counts * (counts - 1) / 2).sum())

    n = len(a)
    return (pairs(table.sum(axis=1)) + pairs(table.sum(axis=0)) - 2 * pairs(table)) / (n * (n - 1) / 2)


def judged(labels: Indices, people: Indices) -> float:
    """The mean error against all people, in hundredths."""
    return 100 * float(np.mean([rand_error(labels, person) for person in people]))


def among_people(people: Indices) -> NDArray[np.float64]:
    """The mean error of every person against all others, in hundredths; nothing where there is one."""
    h = len(people)
    errors = np.zeros((h, h))
    for i, j in itertools.combinations(range(h), 2):
        errors[i, j] = errors[j, i] = rand_error(people[i], people[j])
    return 100 * errors.sum(axis=1) / (h - 1) if h > 1 else np.empty(0)


Record = dict[str, "float | str | NDArray[np.float64]"]


def measure(path: Path) -> Record:
    """What one shape gives: the errors as found, at the usual count and among people, the count, the time."""
    import ridgeform  # noqa: PLC0415

    with np.load(path) as data:
        vertices, faces, people = data["vertices"], data["faces"].astype(np.int64), data["labels"]
    category = path.stem.rpartition("_")[0]
    begin = time.process_time()
    found = ridgeform.parts(ridgeform.Mesh(vertices, faces), threads=1)
    seconds = time.process_time() - begin
    return {
        "name": path.stem,
        "category": category,
        "faces": len(faces),
        "parts": found.n_parts,
        "found": judged(found.labels, people),
        "given": judged(found.labels_at(USUAL.get(category, found.n_parts)), people),
        "people": float(among_people(people).mean()) if len(people) > 1 else float("nan"),
        "found by person": np.array([judged(found.labels, person[None]) for person in people]),
        "people by person": among_people(people),
        "seconds": seconds,
    }


def by_person(records: list[Record], column: str) -> float:
    """The mean of the categories where every labeling of one counts as much."""
    categories = sorted({str(record["category"]) for record in records})
    parted = [[record[column] for record in records if record["category"] == name] for name in categories]
    return float(np.mean([np.concatenate(columns).mean() for columns in parted]))


def table_of(records: list[Record]) -> str:
    """Means by category, and the mean of these."""
    columns = ("found", "given", "people", "parts", "seconds")
    categories = sorted({str(record["category"]) for record in records})
    means = np.array(
        [
            [np.nanmean([record[c] for record in records if record["category"] == name]) for c in columns]
            for name in categories
        ]
    )
    rows = [
        [
            name,
            f"{found:.1f}",
            f"{given:.1f}",
            f"{people:.1f}",
            f"{count:.1f}",
            USUAL.get(name, "-"),
            f"{time_:.1f}",
        ]
        for name, (found, given, people, count, time_) in zip(
            [*categories, "**mean**"], [*means, means.mean(axis=0)], strict=True
        )
    ]
    head = ["category", "count found", "count given", "people", "parts found", "usual parts", "seconds"]
    return grid(head, rows)


def draw(records: list[Record], folder: Path, path: Path) -> None:
    """The shapes with the least and the largest error, as found, each above what the person made of it who
    agrees with most others.
    """
    import ridgeform  # noqa: PLC0415
    from gallery import panels, segments  # noqa: PLC0415

    by_error = sorted(records, key=lambda record: record["found"])
    pictures = []
    for shown in (by_error[:SHOWN], by_error[-SHOWN:]):
        ours, theirs = [], []
        for record in shown:
            with np.load(folder / f"{record['name']}.npz") as data:
                vertices, faces = data["vertices"].astype(float), data["faces"].astype(np.int64)
                person = data["labels"][np.argmin(record["people by person"])]
            labels = ridgeform.parts(ridgeform.Mesh(vertices, faces)).labels
            look = {"size": 270, "view": (0.8, -1.0, 0.5)}
            ours.append(
                (f"{record['name']}: {record['found']:.1f}", segments.shown(vertices, faces, labels, **look))
            )
            named = np.unique(person, return_inverse=True)[1].reshape(-1)
            theirs.append(("a person", segments.shown(vertices, faces, named, **look)))
        pictures += [*ours, *theirs]
    path.parent.mkdir(exist_ok=True)
    panels.page(path, pictures, SHOWN)


def main() -> None:
    """Measure, print, and keep the full run."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("folder", type=Path, nargs="?", help="the shapes")
    parser.add_argument("--only", metavar="WORDS", default="", help="shapes; keeps nothing")
    parser.add_argument("--every", metavar="K", type=int, default=1, help="one of so many; keeps nothing")
    parser.add_argument("--invariance", action="store_true", help="one shape in other meshes instead")
    parser.add_argument("--site", type=Path, help="a folder with the package to be measured")
    given = parser.parse_args()
    if given.invariance:
        parts_invariance.measured(given.site)
        return
    shapes = sorted(given.folder.glob("*_*.npz")) if given.folder is not None else []
    if not shapes:
        sys.exit(WANTED if given.folder is None else f"{given.folder} holds no such shapes.\n{WANTED}")
    if given.site is None:
        build_wheel()
    sys.path[:0] = [str(given.site or WHEEL_SITE), str(ROOT)]
    records = []
    for path in [path for path in shapes if given.only in path.stem][:: given.every]:
        record = measure(path)
        records.append(record)
        print(
            "{name}: {found:.1f} with {parts} parts, {given:.1f}, {seconds:.1f} s".format(**record),
            flush=True,
        )
    page = table_of(records)
    print(page)
    people = by_person(records, "people by person")
    said = WEIGHTS.format(found=by_person(records, "found by person"), people=people)
    print(said)
    draw(records, given.folder, PICTURE)
    if not given.only and given.every == 1:
        parts_invariance.write(first=INTRODUCTION.format(shapes=len(records)) + page + said)


INTRODUCTION = """# Parts against what people named

`make bench-parts DATA=folder` makes this page, from {shapes} shapes of the Princeton Segmentation Benchmark
(Chen, Golovinskiy and Funkhouser 2009), which are not part of the project. Rand error in hundredths: the
share of pairs of faces that one labeling joins and the other parts, every face counting once, the mean over
people, then over shapes, then over categories. *Count found*: the defaults. *Count given*: the usual count of
the category. *People*: two people against each other. Time: processor time, one thread.

"""
WEIGHTS = """
Where every labeling of a category counts as much, so that shapes with more people weigh more, the mean
is {found:.1f} for the count found and {people:.1f} between people.
"""

if __name__ == "__main__":
    main()
