"""A city of tiles that adjoin, stylized and segmented by one process under a cap on its memory.

    python benchmarks/tiles.py [--lots 32] [--tiles 4] [--cap 2048] [--folder out/city]

Prints time, memory, differences on the borders of tiles, bends along the borders of blocks beside those
elsewhere, and how the segments agree with the planes that the city was made of.
"""

import argparse
import json
import resource
import shutil
import subprocess
import sys
import time
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))

import ridgeform
from known_shapes import tiled_city
from known_shapes.segment_shapes import adjusted_rand_index
from ridgeform import tiles

LEAST = 20
"""Faces of a segment: single faces that noise turned at the foot of a wall are none."""

FLOW = {"iterations": 6, "fidelity": 1e6, "sharpness": 0.75, "scale": 30.0}
"""Six short steps in the unit of a house: noise goes, and roofs keep their pitch."""


def capped(folder: Path, tool: str, max_vertices: int, threads: int) -> None:
    """One tool on the tiles of a folder, in this process; tells what it took."""
    city = tiles.read(folder / "in")
    begun, processor = time.perf_counter(), time.process_time()
    options = {"max_vertices": max_vertices, "folder": folder, "threads": threads}
    if tool == "stylize":
        result = tiles.stylize(city.vertices, city.faces, **FLOW, **options)
        told = {"n_blocks": result.n_blocks, "energy": result.energy.tolist(), "status": result.status}
        city.write(folder / "stylize", result.vertices)
    else:
        found = tiles.segment(city.vertices, city.faces, scale=FLOW["scale"], min_faces=LEAST, **options)
        told = {"n_blocks": [found.n_blocks], "n_segments": found.n_segments, "noise": found.noise}
        city.write(folder / "segment", city.vertices, found.labels)
    peaks = [line.split() for line in Path("/proc/self/status").read_text(encoding="ascii").splitlines()]
    kilobytes = {words[0]: int(words[1]) for words in peaks if words and words[0] in {"VmPeak:", "VmHWM:"}}
    told |= {
        "seconds": time.perf_counter() - begun,
        "processor": time.process_time() - processor,
        "virtual": kilobytes["VmPeak:"] / 1024,
        "resident": kilobytes["VmHWM:"] / 1024,
        "n_vertices": len(city.vertices),
    }
    (folder / f"{tool}.json").write_text(json.dumps(told), encoding="utf-8")


def run_capped(given: argparse.Namespace, tool: str) -> dict[str, object]:
    """The same in a process that may take so many megabytes of addresses."""
    folder, cap = given.folder, given.cap

    def limit() -> None:
        resource.setrlimit(resource.RLIMIT_AS, (cap << 20, cap << 20))

    shutil.rmtree(folder / tool, ignore_errors=True)
    command = [sys.executable, __file__, "--folder", str(folder), "--only", tool]
    command += ["--blocks", str(given.blocks), "--threads", str(given.threads)]
    subprocess.run(command, check=True, preexec_fn=limit)
    told: dict[str, object] = json.loads((folder / f"{tool}.json").read_text(encoding="utf-8"))
    return told


def largest_difference(folder: Path) -> float:
    """How far the places that two files have of one vertex are from each other, at most."""
    first, moved = tiles.read(folder / "in"), []
    for path in sorted((folder / "stylize").glob("*.npz")):
        with np.load(path) as found:
            moved.append(found["vertices"])
    low, high = np.full(first.vertices.shape, np.inf), np.full(first.vertices.shape, -np.inf)
    for place, points in zip(first.places, moved, strict=True):
        np.minimum.at(low, place, points)
        np.maximum.at(high, place, points)
    return float((high - low).max())


def seam_bends(folder: Path, n_blocks: int) -> tuple[float, float]:
    """The bend for an area, near the borders of blocks and elsewhere, on the ground: it is chance how many
    houses a border crosses."""
    made = tiles.read(folder / "stylize")
    before = tiles.read(folder / "in")
    truth = np.concatenate([np.load(path)["truth"] for path in before.paths])
    labels = tiles._cut.bisect(before.vertices, n_blocks)[before.faces]
    crossing = (labels != labels[:, :1]).any(axis=1)
    near = np.zeros(len(made.vertices), bool)
    near[made.faces[crossing]] = True
    at_seam = near[made.faces].any(axis=1)
    is_ground = truth == 0
    # Without the foot of the walls.
    foot = np.zeros(len(made.vertices), bool)
    foot[made.faces[~is_ground]] = True
    is_ground &= ~foot[made.faces].any(axis=1)
    areas = tiles._tasks.areas(made.vertices, made.faces)
    bend = areas * ridgeform.hessian_norm(ridgeform.Mesh(made.vertices, made.faces), made.vertices)
    parts = [is_ground & at_seam, is_ground & ~at_seam]
    return tuple(float(bend[part].sum() / areas[part].sum()) for part in parts)


def agreement(folder: Path) -> tuple[float, int, int]:
    """The adjusted Rand index with the planes that there are, how many, and how many were found."""
    truth, labels = [], []
    for path in sorted((folder / "segment").glob("*.npz")):
        with np.load(path) as found:
            truth.append(found["truth"])
            labels.append(found["labels"])
    real, given = np.concatenate(truth), np.concatenate(labels)
    return adjusted_rand_index(given, real), len(np.unique(real)), len(np.unique(given))


def main() -> None:
    """Make the city, run both tools, and print what came out."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--lots", type=int, default=32)
    parser.add_argument("--tiles", type=int, default=4)
    parser.add_argument("--cap", type=int, default=2048, help="megabytes of addresses")
    parser.add_argument("--blocks", type=int, default=20_000, help="vertices of a block")
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--folder", type=Path, default=Path("out/city"))
    parser.add_argument("--only", choices=("stylize", "segment"), help=argparse.SUPPRESS)
    given = parser.parse_args()
    if given.only:
        capped(given.folder, given.only, given.blocks, given.threads)
        return
    shutil.rmtree(given.folder / "in", ignore_errors=True)
    tiled_city.write_tiles(tiled_city.city(given.lots), given.folder / "in", given.tiles)
    for tool in ("stylize", "segment"):
        told = run_capped(given, tool)
        print(tool, json.dumps(told), flush=True)
        if tool == "stylize":
            print("largest difference on borders", largest_difference(given.folder))
            print("bend at seams, elsewhere", seam_bends(given.folder, told["n_blocks"][0]))
        else:
            print("adjusted Rand index, planes, found", agreement(given.folder), flush=True)


if __name__ == "__main__":
    main()
