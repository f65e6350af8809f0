"""A night's batch of many small files, disturbed: `overnight.md`.

    python scripts/setup_env.py benchmarks/overnight.py [--files 1000] [--only NAME ...]

The files go through a recipe three times: in two processes; in two processes the first of which is ended by
`kill -9` when a third is done, and resumed; and on a Dask cluster of two workers one of which is ended like
that. Counted is what is done, lost, and done twice, and outputs are compared with those of the first run.
"""

import argparse
import json
import os
import resource
import signal
import subprocess
import sys
import tempfile
import threading
import time
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from build_wheel import build_wheel
from known_shapes import shapes
from setup_env import environment_python, environments, fill_environment
from workspace import ROOT, WHEEL_SITE, python_path, run

PAGE = ROOT / "benchmarks/overnight.md"
BEGIN, END = "<!-- overnight:begin -->\n", "<!-- overnight:end -->"
RECIPE = '[[step]]\ntool = "fill-holes"\n\n[[step]]\ntool = "stylize"\nsteps = 2\n'
BROKEN_EVERY = 100
"""One of so many files is cut off in the middle."""
TIMEOUT = 300
MOST_SECONDS = 7200.0
GRACE_SECONDS = 10.0
SHAPES = (
    lambda: shapes.cube(6),
    lambda: shapes.l_shape(2),
    lambda: shapes.house(2),
    lambda: shapes.icosphere(2),
    lambda: shapes.cylinder(16, 4, 2),
    lambda: shapes.staircase(3, 2),
    lambda: shapes.torus(16, 8),
)


def write_files(folder: Path, count: int) -> tuple[list[Path], set[str]]:
    """Small meshes with noise, every second one with a hole, as OBJ and PLY; and those that are cut off."""
    folder.mkdir()
    paths, broken = [], set()
    for number in range(count):
        vertices, faces = SHAPES[number % len(SHAPES)]()
        vertices = shapes.add_noise(vertices, faces, 0.1, seed=number)
        if number % 2:
            middle = vertices[faces].mean(axis=1)
            near = np.linalg.norm(middle - middle[number % len(faces)], axis=1)
            faces = faces[near > np.sort(near)[5]]
        suffix = (".ply", ".obj")[number % 2]
        kind = "ply\nformat ascii 1.0\n" if suffix == ".ply" else ""
        if kind:
            kind += f"element vertex {len(vertices)}\nproperty float x\nproperty float y\nproperty float z\n"
            kind += f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n"
        at, corner, first = ("v ", "f ", 1) if suffix == ".obj" else ("", "3 ", 0)
        text = kind + "".join(f"{at}{x:.7f} {y:.7f} {z:.7f}\n" for x, y, z in vertices)
        text += "".join(f"{corner}{a} {b} {c}\n" for a, b, c in faces + first)
        path = folder / f"mesh{number:04d}{suffix}"
        if number % BROKEN_EVERY == BROKEN_EVERY - 1:
            broken.add(path.name)
            text = kind + text[len(kind) : len(text) // 2] if kind else "this is no mesh\n"
        path.write_text(text, encoding="utf-8")
        paths.append(path)
    return paths, broken


@dataclass
class Batch:
    """A batch in a folder: its command, and what is there of it."""

    python: Path
    folder: Path
    files: list[Path]
    broken: set[str]
    name: str
    records: dict[str, dict[str, object]] = field(default_factory=dict)

    @property
    def out(self) -> Path:
        """Where outputs go."""
        return self.folder / self.name

    def start(self, *options: str) -> subprocess.Popen[bytes]:
        """Give the command."""
        recipe = self.folder / "recipe.toml"
        recipe.write_text(RECIPE, encoding="utf-8")
        names = [path.relative_to(self.folder) for path in self.files]
        page = self.out.with_suffix(".html")
        command = [self.python, "-m", "addon", "run", recipe, *names, "-o", self.out, "--report", page]
        command += ["--timeout", TIMEOUT, "--json", *options]
        environment = os.environ | {"PYTHONPATH": f"{WHEEL_SITE}{os.pathsep}{ROOT}"}
        said = (self.folder / f"{self.name}.{kind}" for kind in ("out", "log"))
        with next(said).open("wb") as out, next(said).open("ab") as log:
            return subprocess.Popen(
                list(map(str, command)), cwd=self.folder, env=environment, stdout=out, stderr=log
            )

    def finish(self, process: subprocess.Popen[bytes]) -> None:
        """Wait for it, and take its records."""
        process.wait(timeout=MOST_SECONDS)
        lines = self.out.with_suffix(".out").read_text(encoding="utf-8").splitlines()
        found = [json.loads(line) for line in lines]
        self.records = {Path(record["file"]).name: record for record in found}
        if len(self.records) != len(found):
            sys.exit(f"{self.name}: a file has two records")

    def until_done(self, count: int) -> None:
        """Wait until so many files are done."""
        end = time.monotonic() + MOST_SECONDS
        while len(list(self.out.with_name(f"{self.name}.ridgeform").glob("*.json"))) < count:
            if time.monotonic() > end:
                sys.exit(f"{self.name}: {count} files were never done, see {self.name}.log")
            time.sleep(0.2)

    def states(self) -> dict[str, tuple[int, int]]:
        """What tells whether an output was written again."""
        found = (self.out / path.name for path in self.files)
        stats = {path.name: path.stat() for path in found if path.exists()}
        return {name: (stat.st_ino, stat.st_mtime_ns) for name, stat in stats.items()}

    def row(self, what: str, before: dict[str, tuple[int, int]], first: "Batch") -> list[str]:
        """The row of the table."""
        after = self.states()
        good = {name for name, record in self.records.items() if record["error"] is None}
        wanted = {path.name for path in self.files} - self.broken
        lost = wanted - (good & set(after))
        said = (
            (self.out.with_name(f"{self.name}.ridgeform") / "used").read_text(encoding="utf-8").splitlines()
        )
        outputs = [json.loads(line)[1] for line in said if json.loads(line)[0] == "output"]
        rewritten = {name for name, state in before.items() if after.get(name) != state}
        twice = len(rewritten) + len(outputs) - len(set(outputs))
        other = sum((self.out / name).read_bytes() != (first.out / name).read_bytes() for name in after)
        pictures = self.out.with_suffix(".html").read_text(encoding="utf-8").count("data:image/png")
        resumed = sum(bool(record["resumed"]) for record in self.records.values())
        odd = set(self.records) - good - self.broken | good & self.broken
        if odd:
            print(f"{self.name}: not as expected: {', '.join(sorted(odd))}", flush=True)
        cells = [what, len(self.records), len(good), len(self.records) - len(good), resumed]
        return [str(cell) for cell in (*cells, pictures, len(lost), twice, other)]


def kill(process: int) -> None:
    """End a process as `kill -9` does."""
    os.kill(process, signal.SIGKILL)


def in_processes(batch: Batch) -> tuple[list[str], float]:
    """In two processes, left alone; and the processor time of all."""
    begin = resource.getrusage(resource.RUSAGE_CHILDREN)
    batch.finish(batch.start("--jobs", "2"))
    end = resource.getrusage(resource.RUSAGE_CHILDREN)
    seconds = end.ru_utime + end.ru_stime - begin.ru_utime - begin.ru_stime
    return batch.row("two processes", {}, batch), seconds


def killed(batch: Batch, first: Batch) -> list[str]:
    """Ended when a third is done, and resumed."""
    process = batch.start("--jobs", "2")
    batch.until_done(len(batch.files) // 3)
    kill(process.pid)
    process.wait()
    # The processes that worked for it notice, and end when they have done what they were at.
    time.sleep(GRACE_SECONDS)
    before = batch.states()
    batch.finish(batch.start("--jobs", "2", "--resume"))
    return batch.row(f"ended by `kill -9` with {len(before)} written, resumed", before, first)


def on_dask(batch: Batch, first: Batch) -> list[str]:
    """On a cluster of two workers, one of which is ended when a third is done."""
    from distributed import Client, LocalCluster  # noqa: PLC0415

    before: dict[str, tuple[int, int]] = {}
    with (
        LocalCluster(
            n_workers=2, threads_per_worker=1, processes=True, memory_limit=None, dashboard_address=None
        ) as cluster,
        Client(cluster, set_as_default=False) as client,
    ):
        workers = client.run(os.getpid)

        def end_one() -> None:
            batch.until_done(len(batch.files) // 3)
            before.update(batch.states())
            kill(next(iter(workers.values())))

        ending = threading.Thread(target=end_one)
        ending.start()
        batch.finish(batch.start("--dask", cluster.scheduler_address))
        ending.join()
        if client.run(os.getpid) == workers:
            sys.exit("no worker was ended")
    return batch.row(f"Dask, a worker of two ended with {len(before)} written", before, first)


def table(rows: list[list[str]], seconds: float, count: int) -> str:
    """The page's table, and what a file took."""
    head = ["run", "records", "done", "failed", "taken over", "pictures", "lost", "done twice", "other bits"]
    lines = ["| " + " | ".join(cells) + " |" for cells in (head, ["---"] * len(head), *rows)]
    said = f"The first run took {seconds:.0f} s of processor time, {1000 * seconds / count:.0f} ms a file."
    return "\n".join([*lines, "", said, ""])


def measure(options: argparse.Namespace) -> None:
    """Do all runs, and write the page."""
    rows = []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        files, broken = write_files(folder / "in", options.files)

        def batch(called: str) -> Batch:
            return Batch(Path(sys.executable), folder, files, broken, called)

        first = batch("processes")
        row, seconds = in_processes(first)
        rows.append(row)
        for what in (killed, on_dask):
            print(rows[-1], flush=True)
            rows.append(what(batch(what.__name__), first))
    text = table(rows, seconds, options.files)
    print(text)
    if options.files == FILES:
        before, rest = PAGE.read_text(encoding="utf-8").split(BEGIN)
        PAGE.write_text(before + BEGIN + text + END + rest.split(END)[1], encoding="utf-8")
    if any(int(cell) for row in rows for cell in row[-3:]):
        sys.exit("something was lost, done twice, or came out different")


FILES = 1000


def main() -> None:
    """Start again in the environment with Dask, and measure there."""
    parser = argparse.ArgumentParser(description="A batch of many files, disturbed.")
    parser.add_argument("--files", type=int, default=FILES, help="how many; the page is for 1000")
    parser.add_argument("--here", action="store_true", help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.here:
        measure(options)
        return
    build_wheel()
    version = next(iter(environments()))
    name = environment_python(version).parents[1].name
    python = fill_environment("dask", sys.executable, [name, "test", "dask"], "distributed")
    arguments = [python, __file__, "--here", "--files", str(options.files)]
    run(arguments, "batches", {"PYTHONPATH": python_path()})


if __name__ == "__main__":
    main()
