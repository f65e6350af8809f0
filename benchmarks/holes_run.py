"""Let every tool fill every hole, each tool in a process of its own, and measure what comes back."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
from driver import Record
from environments import python_with
from known_shapes.fill_measures import (
    mean_and_rms,
    new_faces,
    nonmanifold_edges,
    point_distances,
    qualities,
    samples,
)
from known_shapes.holed_shapes import Holed
from workspace import ROOT, WHEEL_SITE, python_path

PEER = ROOT / "benchmarks/holes_peer.py"
REQUIREMENTS = ROOT / "benchmarks/requirements-holes.txt"
OURS = "ridgeform"
LIMIT = 120.0
"""Seconds for one hole."""
PATIENCE = 3600.0
"""Seconds for one of the measurements of ours alone."""
SAME = 1e-4
"""A face whose center moved by less, in edge lengths, is an old one: some tools store single precision."""


def peers_python() -> tuple[Path, dict[str, str]]:
    """The interpreter of the environment that holds the peers, and what pip said of those it lacks."""
    return python_with("bench-holes", REQUIREMENTS, "the peers")


def fill(tool: str, folder: Path, site: Path = WHEEL_SITE) -> None:
    """Let a tool fill all meshes of a folder; where it crashes is noted, and it goes on after that."""
    if tool == OURS:
        python, environment = sys.executable, {"PYTHONPATH": python_path(site)}
    else:
        python, environment = str(peers_python()[0]), {}
    while open_cases(folder):
        process = subprocess.Popen(
            [python, str(PEER), tool, str(folder)],
            env={**os.environ, **environment},
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            text=True,
        )
        ended = _watch(process, folder)
        if not open_cases(folder):
            return
        at = folder / "at"
        if ended is None or not at.exists():
            said = process.stderr.read().strip().splitlines() if process.stderr else []
            for name in open_cases(folder):
                _refuse(folder, name, said[-1] if said else "did not start")
            return
        _refuse(folder, at.read_text(encoding="utf-8"), ended)


def limit(kind: str, site: Path, *words: str) -> Record:
    """What `holes_limits.py` says of ours, or why it says nothing."""
    command = [sys.executable, str(ROOT / "benchmarks/holes_limits.py"), kind, *words]
    environment = {**os.environ, "PYTHONPATH": python_path(site)}
    try:
        done = subprocess.run(
            command, env=environment, capture_output=True, text=True, timeout=PATIENCE, check=False
        )
    except subprocess.TimeoutExpired:
        return {"error": f"took more than {PATIENCE:.0f} s"}
    if done.returncode:
        said = done.stderr.strip().splitlines()
        return {"error": said[-1] if said else f"crashed with exit code {done.returncode}"}
    return {"found": json.loads(done.stdout)}


def open_cases(folder: Path) -> list[str]:
    """The meshes of a folder that have no answer yet."""
    names = (path.name.removesuffix(".in.npz") for path in sorted(folder.glob("*.in.npz")))
    return [
        name
        for name in names
        if not ((folder / f"{name}.out.npz").exists() or (folder / f"{name}.error").exists())
    ]


def _refuse(folder: Path, name: str, why: str) -> None:
    (folder / f"{name}.error").write_text(why, encoding="utf-8")


def _watch(process: subprocess.Popen, folder: Path) -> str | None:
    """Wait for the end; says how it ended a mesh, `None` if it never came to one."""
    at, since = "", time.monotonic()
    while process.poll() is None:
        time.sleep(0.1)
        now = (folder / "at").read_text(encoding="utf-8") if (folder / "at").exists() else ""
        if now != at:
            at, since = now, time.monotonic()
        elif time.monotonic() - since > LIMIT:
            process.kill()
            process.wait()
            return f"took more than {LIMIT:.0f} s"
    return f"crashed with exit code {process.returncode}" if at else None


def measured(holed: Holed, folder: Path, name: str) -> Record:
    """What a tool made of a hole, or its error."""
    error = folder / f"{name}.error"
    if error.exists():
        return {"error": error.read_text(encoding="utf-8")}
    with np.load(folder / f"{name}.out.npz") as data:
        vertices, faces = data["vertices"].astype(float), data["faces"].astype(np.int64)
        seconds = float(data["seconds"])
    if not np.isfinite(vertices).all():
        return {"error": "coordinates that are not finite"}
    made = new_faces((holed.vertices, holed.faces), (vertices, faces), SAME * holed.edge)
    if not made.any():
        return {"error": "nothing was filled"}
    return {
        **_against_truth(holed, vertices, faces, faces[made]),
        "faces": int(made.sum()),
        "worst_quality": float(qualities(vertices, faces[made]).min()),
        "open_edges": _open_edges(faces),
        "nonmanifold_edges": nonmanifold_edges(faces),
        "seconds": seconds,
    }


def _open_edges(faces: np.ndarray) -> int:
    """Edges with one face; which way the faces are turned does not matter."""
    edges = np.sort(faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    return int((np.unique(edges, axis=0, return_counts=True)[1] == 1).sum())


def _against_truth(holed: Holed, vertices: np.ndarray, faces: np.ndarray, filling: np.ndarray) -> Record:
    mean, rms = mean_and_rms(*_to_truth(holed, vertices, filling))
    record: Record = {"fill_mean": mean, "fill_rms": rms}
    if len(holed.ridge):
        record["ridge_mean"], record["ridge_rms"] = mean_and_rms(
            point_distances(holed.ridge, vertices, faces)
        )
    return record


def _to_truth(holed: Holed, vertices: np.ndarray, filling: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    points, areas = samples(vertices, filling)
    return holed.distance(points), areas


def before(holed: Holed) -> Record:
    """The same of the mesh that nothing was taken from: what its density allows."""
    vertices, faces = holed.before
    gone = new_faces((holed.vertices, holed.faces), (vertices, faces), SAME * holed.edge)
    return _against_truth(holed, vertices, faces, faces[gone])
