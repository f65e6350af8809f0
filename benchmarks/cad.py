"""Segment CAD parts, and compare with the faces that the CAD kernel has: `cad.md`.

    python scripts/setup_env.py benchmarks/cad.py [--only WORDS] [--kinds KIND ...] [--pictures FOLDER]
        [--site FOLDER]

`--only` takes the parts with these words in their name, `--kinds` some of the columns (`coarse`, `fine`, `0`,
`0.1`, `0.2`): these print and keep nothing. `--pictures` draws what is found where it is not right. `--site`
names a folder with the package `ridgeform`, instead of building the wheel. cadquery gets an environment of
its own.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
from build_wheel import build_wheel
from cells import duration, grid
from environments import python_of
from known_shapes.segment_shapes import Part, adjusted_rand_index
from numpy.typing import NDArray
from workspace import STATE, WHEEL_SITE, digest, is_current

ROOT = Path(__file__).resolve().parents[1]

RESULTS = ROOT / "benchmarks/cad.md"
REQUIREMENTS = ROOT / "benchmarks/requirements-cad.txt"
SOURCES = [ROOT / f"benchmarks/{name}.py" for name in ("cad_fillets", "cad_parts", "cad_meshes")]
MESHES = STATE / "bench-cad-meshes"
NOISES = (0.0, 0.1, 0.2)
KINDS = ("coarse", "fine", *(f"{noise:g}" for noise in NOISES))
SEED = 10
OPTIONS = ("apart", "joined")
CELLS = [*(("apart", kind) for kind in KINDS[2:]), *(("joined", kind) for kind in KINDS)]
"""The cells of the second table: raw tessellations are apart in the first."""


def make_meshes(site: Path) -> None:
    """The meshes of all parts, made anew where their sources have changed."""
    stamp = STATE / "bench-cad-meshes.stamp"
    wanted = digest([REQUIREMENTS, *SOURCES], sys.version)
    if is_current(stamp, wanted) and MESHES.is_dir():
        return
    python = python_of("bench-cad", REQUIREMENTS, "cadquery")
    print("== parts", flush=True)
    paths = os.pathsep.join([str(site), str(ROOT / "benchmarks")])
    script = [str(python), str(ROOT / "benchmarks/cad_meshes.py"), str(MESHES)]
    subprocess.run(script, check=True, env={**os.environ, "PYTHONPATH": paths})
    stamp.write_text(wanted, encoding="utf-8")


def meshes_of(k: int, kinds: list[str]) -> dict[str, Part]:
    """The meshes of the k-th part, turned, in single precision, as files have it, and with noise."""
    given = np.load(MESHES / f"{k}.npz")
    found = {}
    for kind in kinds:
        name = kind if kind in ("coarse", "fine") else "remeshed"
        part = Part(*(given[f"{name}_{field}"] for field in ("vertices", "faces", "truth"))).turned(k)
        if name == "remeshed":
            part = part.noisy(float(kind), SEED)
        found[kind] = Part(part.vertices.astype(np.float32).astype(float), part.faces, part.truth)
    return found


def fillets_of(k: int, kind: str) -> NDArray[np.bool_]:
    """Which faces of the k-th part are fillets or chamfers."""
    name = kind if kind in ("coarse", "fine") else "remeshed"
    return np.load(MESHES / f"{k}.npz")[f"{name}_fillets"]


def passes(kind: str, agreement: float) -> bool:
    """Whether the faces are right: exactly as tessellated, nearly all under noise."""
    if kind in ("coarse", "fine"):
        return agreement == 1.0
    return agreement >= (0.98 if float(kind) <= 0.1 else 0.92)


def judge(
    k: int, name: str, kinds: list[str], pictures: Path | None
) -> tuple[list[str], dict[str, bool], dict]:
    """A row of the table, which of its cells are right, and their adjusted Rand indices."""
    import ridgeform  # noqa: PLC0415

    row, right, agreements = [name], {}, {}
    begin = time.process_time()
    parts = meshes_of(k, kinds)
    for kind, part in parts.items():
        labels = ridgeform.segment(ridgeform.Mesh(part.vertices, part.faces), threads=1).labels
        agreements[kind] = adjusted_rand_index(labels, part.truth)
        right[kind] = passes(kind, agreements[kind])
        count = len(np.unique(labels[labels >= 0]))
        words = f"{agreements[kind]:.3f}, {count} / {part.n_parts}"
        row.append(f"**{words}**" if right[kind] else words)
        if pictures and not right[kind]:
            draw(pictures / f"{k:02}_{kind}.png", f"{name}, {kind}: {words}", part, labels)
    sizes = [str(len(parts[kind].faces)) for kind in kinds if kind in ("coarse", "fine")]
    return [*row, " ".join(sizes), duration(time.process_time() - begin)], right, agreements


def judge_fillets(k: int, name: str, kinds: list[str], pictures: Path | None) -> tuple[list[str], dict, dict]:
    """The same for fillets apart and joined, from one run: keys are pairs of the option and the kind."""
    import ridgeform  # noqa: PLC0415

    cells, right, agreements = {}, {}, {}
    begin = time.process_time()
    for kind, part in meshes_of(k, kinds).items():
        mesh = ridgeform.Mesh(part.vertices, part.faces)
        found = ridgeform.segment(mesh, fillets="joined", threads=1)
        is_fillet = fillets_of(k, kind)
        on_side = ~is_fillet[part.truth]
        for option in OPTIONS:
            labels = found.labels if option == "joined" else found.labels_at(found.range[1])
            taken = on_side if option == "joined" else np.ones_like(on_side)
            wanted = int((~is_fillet).sum()) if option == "joined" else part.n_parts
            agreement = adjusted_rand_index(labels[taken], part.truth[taken])
            agreements[option, kind] = agreement
            right[option, kind] = passes(kind, agreement)
            words = f"{agreement:.3f}, {len(np.unique(labels))} / {wanted}"
            cells[option, kind] = f"**{words}**" if right[option, kind] else words
            if pictures:
                draw(pictures / f"{k:02}_{kind}_{option}.png", f"{name}, {kind}, {option}", part, labels)
    row = [cells[option, kind] for option in OPTIONS for kind in kinds if (option, kind) in CELLS]
    return [name, *row, duration(time.process_time() - begin)], right, agreements


def draw(path: Path, title: str, part: Part, labels: NDArray[np.int64]) -> None:
    """The truth and the labels side by side, from two sides; by the environment of cadquery."""
    path.parent.mkdir(parents=True, exist_ok=True)
    arrays = {"vertices": part.vertices, "faces": part.faces, "truth": part.truth, "labels": labels}
    np.savez(path.with_suffix(".npz"), **arrays)
    script = ROOT / "benchmarks/cad_picture.py"
    subprocess.run(
        [str(python_of("bench-cad", REQUIREMENTS, "cadquery")), str(script), str(path), title], check=True
    )
    path.with_suffix(".npz").unlink()


def main() -> None:
    """Measure, print, and keep the full run."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--only", metavar="WORDS", default="", help="parts; keeps nothing")
    parser.add_argument("--kinds", nargs="+", choices=KINDS, default=list(KINDS), help="columns")
    parser.add_argument("--pictures", type=Path, help="a folder for pictures of what is not right")
    parser.add_argument("--site", type=Path, help="a folder with the package to be measured")
    given = parser.parse_args()
    if given.site is None:
        build_wheel()
    site = given.site or WHEEL_SITE
    sys.path.insert(0, str(site))
    make_meshes(site)
    names = (MESHES / "names.txt").read_text(encoding="utf-8").splitlines()
    parts = [(k, name) for k, name in enumerate(names) if given.only in name]
    tables = []
    for judging, cells in ((judge, given.kinds), (judge_fillets, CELLS)):
        rows, rights, agreements = [], [], []
        for k, name in parts:
            row, right, agreement = judging(k, name, given.kinds, given.pictures)
            rows.append(row)
            rights.append(right)
            agreements.append(agreement)
            print(grid([], [row]).splitlines()[-1], flush=True)
        columns = [cell for cell in cells if cell in given.kinds or cell[1] in given.kinds]
        totals = ["**right**"] + [f"{sum(r[cell] for r in rights)} of {len(rights)}" for cell in columns]
        means = ["**mean**"] + [f"{np.mean([a[cell] for a in agreements]):.3f}" for cell in columns]
        rest = [""] * (len(rows[0]) - len(means)) if rows else []
        rows += [[*means, *rest], [*totals, *rest]]
        print(grid([], rows[-2:]).partition("\n")[2].partition("\n")[2], flush=True)
        tables.append(rows)
    if given.only or given.kinds != list(KINDS):
        return
    head = ["part", *(HEADS.get(kind, f"noise {kind}") for kind in KINDS), "triangles", "time"]
    head_of_fillets = ["part", *(f"{option}, {HEADS.get(kind, kind)}" for option, kind in CELLS), "time"]
    page = INTRODUCTION + grid(head, tables[0]) + FILLETS + grid(head_of_fillets, tables[1])
    RESULTS.write_text(page, encoding="utf-8")


HEADS = {"coarse": "coarse tessellation", "fine": "fine tessellation"}
INTRODUCTION = """# Segments of CAD parts

`make bench-cad` makes this page. Parts made with cadquery ([cad_parts.py](cad_parts.py)); the truth is the
kernel's faces. *Coarse* and *fine tessellation*: the kernel's triangles, off by at most 0.3 and 0.05 mm and
turning by at most 0.4 and 0.12 from one to the next. The others: remeshed with even triangles, about 12
thousand, Gaussian noise in every coordinate of the given share of the mean edge. All turned at random, in
single precision. Each cell: adjusted Rand index with the truth, segments found / faces; one set of defaults
for all. Bold: every face exactly as in the kernel where it is tessellated, at least 0.98 up to noise of 0.1,
at least 0.92 at 0.2. Triangles: of the two tessellations. Time: processor time of the row.

"""
FILLETS = """
## Fillets apart and joined

The same meshes with `fillets="apart"`: every face by the surface that it lies on; and with
`fillets="joined"`: fillets and chamfers with the larger side beside them. What is a fillet or a chamfer, the
generator knows ([cad_fillets.py](cad_fillets.py)); *joined* is judged on the faces of sides: adjusted Rand
index with these, segments found / sides.

"""

if __name__ == "__main__":
    main()
