"""How soon every tool hears a wish to stop: a table in docs/reliability.md.

    make bench-latency    (ARGS="--vertices 10000 --tools remesh segment")
    make bench-latency ARGS="--large 140000 560000"    Stylize on large meshes: the second table

A call asks whether to stop between pieces of its work, and counts how often (`Progress.asked`). The longest
time between two questions, in any stage, is the longest that anybody waits. Each call is canceled and
finished at a few moments. All times are processor time of one thread, which does not depend on what else the
machine does.
"""

import argparse
import contextlib
import threading
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import ridgeform
from known_shapes import shapes
from scale_run import HALF
from scale_shapes import NOISE, ring

PAGE = Path(__file__).resolve().parents[1] / "docs/reliability.md"
BEGIN, END = "<!-- latency:begin -->", "<!-- latency:end -->"
LARGE_BEGIN, LARGE_END = "<!-- latency-large:begin -->", "<!-- latency-large:end -->"
MOMENTS = (0.05, 0.3, 0.55, 0.8)
LARGE_MOMENTS = tuple((k + 0.5) / 12 for k in range(12))
PAUSE = 5e-4

Call = Callable[[ridgeform.Progress], object]


def grid_with_holes(n_vertices: int) -> ridgeform.Mesh:
    """A hilly sheet of about `n_vertices`, with a round hole of a third of its width."""
    side = int(np.sqrt(n_vertices * 1.1))
    vertices, faces = shapes.grid(side, side)
    x, y = vertices[:, 0] / side, vertices[:, 1] / side
    vertices[:, 2] = side * 0.1 * np.abs(np.sin(5 * x) + np.cos(4 * y))
    vertices = shapes.add_noise(vertices, faces, 0.05)
    center = vertices[faces].mean(axis=1)[:, :2] / side - 0.5
    return ridgeform.Mesh(vertices, faces[np.hypot(*center.T) > 1 / 6])


def calls(n_vertices: int) -> dict[str, Call]:
    """Every tool with its heavier options, on one thread where it can be told."""
    mesh = grid_with_holes(n_vertices)
    rng = np.random.default_rng(0)
    noisy = mesh.vertices[:, 2] + rng.normal(size=mesh.n_vertices)
    many = np.repeat(noisy[:, None], 200, axis=1)
    known = rng.choice(np.unique(mesh.faces), 40, replace=False)
    paint = np.floor(mesh.vertices / np.ptp(mesh.vertices, axis=0).max() * 6) % 2
    paint += rng.normal(scale=0.02, size=paint.shape)
    few = ridgeform.diffusion_curves(mesh, paint)
    on_one = {"threads": 1}
    r = ridgeform
    return {
        "stylize": lambda p: r.stylize(mesh, iterations=8, progress=p, **on_one),
        "stylize, Clarabel": lambda p: r.stylize(mesh, iterations=2, solver="clarabel", progress=p, **on_one),
        "denoise": lambda p: r.denoise(mesh, noisy, fidelity=0.1, tolerance=1e-6, progress=p, **on_one),
        "denoise, Clarabel": lambda p: r.denoise(
            mesh, noisy, fidelity=0.1, solver="clarabel", progress=p, **on_one
        ),
        "denoise, 200 columns": lambda p: r.denoise(
            mesh, many, fidelity=0.1, coupling="separate", progress=p, **on_one
        ),
        "denoise, 200 columns, quadratic": lambda p: r.denoise(
            mesh, many, fidelity=0.1, energy="l2_laplacian", progress=p, **on_one
        ),
        "interpolate": lambda p: r.interpolate(
            mesh, known, noisy[known], tolerance=1e-6, progress=p, **on_one
        ),
        "interpolate, Clarabel": lambda p: r.interpolate(
            mesh, known, noisy[known], solver="clarabel", progress=p, **on_one
        ),
        "vibration modes": lambda p: r.vibration_modes(mesh, 6, progress=p, **on_one),
        "segment": lambda p: r.segment(mesh, progress=p, **on_one),
        "segment a signal": lambda p: r.segment(mesh, values=paint, progress=p, **on_one),
        "parts": lambda p: r.parts(mesh, progress=p, **on_one),
        "facet": lambda p: r.facet(mesh, progress=p),
        "facet, by distance": lambda p: r.facet(mesh, error=0.3, progress=p),
        "restore": lambda p: r.restore(mesh, progress=p, **on_one),
        "fill holes": lambda p: r.fill_holes(mesh, sharpness=0.5, outer=True, progress=p, **on_one),
        "remesh": lambda p: r.remesh(mesh, iterations=6, progress=p),
        "remesh, finer": lambda p: r.remesh(mesh, edge_length=0.4, iterations=3, progress=p),
        "diffusion curves": lambda p: r.diffusion_curves(mesh, paint, progress=p),
        "redraw": lambda p: r.redraw(mesh, few.edges, few.left, few.right, sides=few.sides, progress=p),
    }


class Run:
    """A call on a thread of its own."""

    def __init__(self, call: Call):
        """Start it."""
        self.progress = ridgeform.Progress()
        self.begin = time.process_time()
        self.thread = threading.Thread(target=self._run, args=(call,))
        self.thread.start()

    def _run(self, call: Call) -> None:
        with contextlib.suppress(ridgeform.Cancelled):
            call(self.progress)

    def silences(self) -> tuple[float, dict[str, float]]:
        """Watch until it ends: its time, and the longest time between two questions in every stage."""
        longest: dict[str, float] = {}
        asked, stage, since = -1, "", self.begin
        while self.thread.is_alive():
            time.sleep(PAUSE)
            now, count = time.process_time(), self.progress.asked
            longest[stage] = max(longest.get(stage, 0.0), now - since)
            if count != asked:
                asked, since = count, now
            stage = self.progress.stage
        return time.process_time() - self.begin, longest

    def stopped(self, after: float, wish: str) -> float:
        """Wish to stop after so much of its work: the time until it has."""
        while self.thread.is_alive() and time.process_time() - self.begin < after:
            time.sleep(PAUSE)
        begin = time.process_time()
        getattr(self.progress, wish)()
        self.thread.join()
        return time.process_time() - begin


def row(name: str, call: Call) -> str:
    """A line of the table."""
    took, longest = Run(call).silences()
    stage, silence = max(longest.items(), key=lambda item: item[1])
    ends = {
        wish: max(Run(call).stopped(took * part, wish) for part in MOMENTS) for wish in ("cancel", "finish")
    }
    cells = [
        name,
        f"{took:.2f}",
        f"{silence:.3f}",
        stage or "start",
        f"{ends['cancel']:.3f}",
        f"{ends['finish']:.3f}",
    ]
    print(" | ".join(cells), flush=True)
    return f"| {' | '.join(cells)} |"


def large_row(size: int) -> str:
    """A line of the table of large meshes: at twelve moments a wish, to cancel and to finish in turns."""
    mesh = ridgeform.Mesh(*ring(size, NOISE))

    def call(progress: ridgeform.Progress) -> object:
        return ridgeform.stylize(mesh, threads=1, progress=progress, **HALF)

    took, longest = Run(call).silences()
    ends: dict[str, list[float]] = {"cancel": [], "finish": []}
    for k, part in enumerate(LARGE_MOMENTS):
        wish = ("cancel", "finish")[k % 2]
        ends[wish].append(Run(call).stopped(took * part, wish))
        print(size, wish, f"{took * part:.2f}", f"{ends[wish][-1]:.3f}", flush=True)
    cells = [f"{mesh.n_vertices:,}", f"{took:.1f}", f"{max(longest.values()):.2f}"]
    cells += [f"{np.median(times):.2f}, {max(times):.2f}" for times in ends.values()]
    return f"| {' | '.join(cells)} |"


def large(sizes: list[int]) -> None:
    """Measure Stylize on large meshes, and put the table where it belongs."""
    heads = ["vertices", "takes", "longest silence", "until canceled", "until finished"]
    lines = [f"| {' | '.join(heads)} |", "| ---: | ---: | ---: | ---: | ---: |"]
    lines += [large_row(size) for size in sizes]
    text = PAGE.read_text(encoding="utf-8")
    head, _, rest = text.partition(LARGE_BEGIN)
    after = rest.partition(LARGE_END)[2]
    PAGE.write_text(head + "\n".join([LARGE_BEGIN, *lines, LARGE_END]) + after, encoding="utf-8")


def main() -> None:
    """Measure, print, and put the table where it belongs."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--vertices", type=int, default=10_000)
    parser.add_argument("--tools", nargs="*", help="only those whose names begin so")
    parser.add_argument("--large", nargs="*", type=int, help="Stylize alone, on so many vertices")
    given = parser.parse_args()
    if given.large:
        large(given.large)
        return
    chosen = {
        name: call
        for name, call in calls(given.vertices).items()
        if not given.tools or name.startswith(tuple(given.tools))
    }
    heads = ["call", "takes", "longest silence", "in its stage", "until canceled", "until finished"]
    lines = [f"| {' | '.join(heads)} |", "| --- | ---: | ---: | --- | ---: | ---: |"]
    lines += [row(name, call) for name, call in chosen.items()]
    text = PAGE.read_text(encoding="utf-8")
    head, _, rest = text.partition(BEGIN)
    before, _, rest = rest.partition(END)
    if given.tools:
        measured = {name_of(line): line for line in lines}
        lines = [measured.get(name_of(line), line) for line in before.strip().splitlines()]
    PAGE.write_text(head + "\n".join([BEGIN, *lines, END]) + rest, encoding="utf-8")


def name_of(line: str) -> str:
    """The call that a line of the table is about."""
    return line.split("|")[1].strip()


if __name__ == "__main__":
    main()
