"""What the gallery stylizes with: the paper's flow, ours, facets, and the cubes of Liu and Jacobson 2019."""

from __future__ import annotations

import subprocess
import tempfile
from pathlib import Path

import numpy as np
import ridgeform
from environments import python_of
from numpy.typing import NDArray
from workspace import ROOT

Array = NDArray[np.float64]
Indices = NDArray[np.int64]
Shape = tuple[Array, Indices]

PEER = Path(__file__).with_name("cubic_peer.py")
REQUIREMENTS = ROOT / "scripts/requirements-gallery.txt"


def of_paper(shape: Shape, iterations: int, fidelity: float) -> Shape:
    """The flow as the paper has it: equal steps, one norm for each coordinate, no sharpness."""
    options = {"iterations": iterations, "fidelity": fidelity, "sharpness": 0.0, "coupling": "separate"}
    return ridgeform.stylize(ridgeform.Mesh(*shape), **options).vertices, shape[1]


def with_sharpness(shape: Shape, iterations: int, fidelity: float) -> Shape:
    """The same steps with the defaults of `stylize`: one norm for all coordinates, a sharpness of 0.5."""
    found = ridgeform.stylize(ridgeform.Mesh(*shape), iterations=iterations, fidelity=fidelity)
    return found.vertices, shape[1]


def in_facets(shape: Shape, count: int) -> Shape:
    """So many planar facets, as triangles."""
    found = ridgeform.facet(ridgeform.Mesh(*shape), facets=count)
    return found.vertices, found.faces.astype(np.int64)


def in_cubes(shape: Shape, cubeness: float) -> Shape:
    """Cubic stylization as MeshLab has it, in an environment of its own."""
    python = python_of("gallery", REQUIREMENTS, "MeshLab's cubic stylization")
    with tempfile.TemporaryDirectory() as folder:
        given, made = Path(folder, "given.npz"), Path(folder, "made.npz")
        np.savez(given, vertices=shape[0], faces=shape[1])
        subprocess.run([python, PEER, given, made, str(cubeness)], check=True)
        with np.load(made) as data:
            return data["vertices"], data["faces"].astype(np.int64)
