"""One run of `scale.py`: VERTICES NOISE THREADS FULL; prints what it measured as JSON."""

import json
import resource
import sys
import threading
import time

import numpy as np
import ridgeform
from scale_shapes import ring

HALF = {"movement": 0.007, "flat_share": 0.5, "fidelity": 10**6.55, "scale": "area", "sharpness": 0.75}
"""The settings of the add-on at half strength."""


def flow(
    mesh: ridgeform.Mesh, threads: int, levels: bool | None
) -> tuple[ridgeform.Stylized, dict[str, float]]:
    """The result, and when the first preview and the end were there."""
    progress, first = ridgeform.Progress(), []
    begun = time.perf_counter(), time.process_time()

    def watch() -> None:
        while not first:
            if progress.snapshot() is not None:
                first.extend((time.perf_counter() - begun[0], time.process_time() - begun[1]))
            time.sleep(0.01)

    watcher = threading.Thread(target=watch, daemon=True)
    watcher.start()
    result = ridgeform.stylize(mesh, threads=threads, coarse_to_fine=levels, progress=progress, **HALF)
    end = time.perf_counter() - begun[0], time.process_time() - begun[1]
    watcher.join(1.0)
    elapsed, processor = first or end
    return result, {
        "preview_elapsed": elapsed,
        "preview": processor,
        "elapsed": end[0],
        "processor": end[1],
    }


def main(size: int, noise: float, threads: int, has_full: bool) -> dict[str, float]:
    """The flow as it is by default, and where asked for the full one."""
    vertices, faces = ring(size, noise)
    mesh = ridgeform.Mesh(vertices, faces)
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    result, told = flow(mesh, threads, None)
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    told |= {
        "vertices": len(vertices),
        "noise": noise,
        "threads": threads,
        "bytes": 1024.0 * (peak - before) / len(vertices),
        "energy": float(result.energy[-1]),
        "flat": float(result.flat_share[1]),
        "steps": len(result.gap),
        "own_steps": int((result.level_vertices == len(vertices)).sum()),
    }
    if has_full:
        full, times = flow(mesh, threads, False)
        moved = np.linalg.norm(full.vertices - vertices, axis=1)
        apart = np.linalg.norm(full.vertices - result.vertices, axis=1)
        told |= {
            "full_processor": times["processor"],
            "full_energy": float(full.energy[-1]),
            "full_flat": float(full.flat_share[1]),
            "distance": float(np.sqrt((apart**2).mean() / max((moved**2).mean(), 1e-300))),
        }
    return told


if __name__ == "__main__":
    size, noise, threads, has_full = sys.argv[1:]
    print(json.dumps(main(int(size), float(noise), int(threads), has_full == "1")))
