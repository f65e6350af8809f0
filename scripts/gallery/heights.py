"""Figure 2: noise on a ramp, a cone and a cathedral, taken away with every energy at its best fidelity."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import ridgeform
from numpy.typing import NDArray

from . import domains, functions
from .measures import NAMES, Fit, bending_in_tenth, best_fit, rms, table

Array = NDArray[np.float64]

SIDE = 80
NOISE = 0.02
"""Standard deviation of the noise on heights of 0.4."""
TRUTHS: dict[str, Callable[[Array], Array]] = {
    "ramp": functions.ramp,
    "cone": functions.cone,
    "cathedral": functions.cathedral,
}
SHARPNESSES = (0.5, 1.0)
SEEDS = 5
"""Meshes and noises; the fidelity is searched on the first and kept for the others."""
STRETCH = 3.0
"""How many times too long the triangles of the mesh are on which the L1 energies are compared again."""
SHOWN = (
    *("truth", "L2 Hessian", "L2 Laplacian", "L1 edge Laplacian"),
    *("noise", "L1 Hessian, Stein 2018", "L1 Hessian (ours)", "ours, sharpness 0.5"),
)
"""Left out: the curved L2 Hessian, which on the plane looks as the flat one, and the second sharpness."""
VIEW = (-0.55, -1.0, 1.15)


@dataclass(frozen=True)
class Problem:
    """A height field under noise."""

    vertices: Array
    faces: NDArray[np.int64]
    truth: Array
    noisy: Array

    @staticmethod
    def make(name: str, side: int = SIDE, seed: int = 0, stretch: float = 1.0) -> Problem:
        """The truth `name` on about `side²` vertices, noise and mesh from `seed`, triangles long in x."""
        vertices, faces = domains.stretched_square(side, stretch, seed)
        truth = TRUTHS[name](vertices)
        noise = np.random.default_rng(seed + 1).normal(scale=NOISE, size=len(truth))
        return Problem(vertices, faces, truth, truth + noise)

    @property
    def mesh(self) -> ridgeform.Mesh:
        """The flat mesh on which the heights are a function."""
        return ridgeform.Mesh(self.vertices, self.faces)

    def error(self, values: Array) -> float:
        """Distance to the truth (RMS), as a share of that of the noise."""
        return rms(self.mesh, values - self.truth) / rms(self.mesh, self.noisy - self.truth)

    def denoised(self, fidelity: float, energy: str, sharpness: float) -> ridgeform.Solution:
        """The heights without noise."""
        return ridgeform.denoise(self.mesh, self.noisy, fidelity=fidelity, energy=energy, sharpness=sharpness)

    def best(self, energy: str, sharpness: float = 0.0) -> Fit:
        """The denoised heights of least error."""
        return best_fit(lambda fidelity: self.denoised(fidelity, energy, sharpness), self.error, energy)


@dataclass(frozen=True)
class Result:
    """The best fit of an energy on the first problem, and its errors `(SEEDS,)` on all, at that fidelity."""

    fit: Fit
    errors: Array

    @property
    def error(self) -> float:
        """Mean error over the seeds."""
        return float(self.errors.mean())


CHOICES = {words: (energy, 0.0) for energy, words in NAMES.items()}
CHOICES |= {f"ours, sharpness {sharpness:g}": ("l1_hessian", sharpness) for sharpness in SHARPNESSES}
"""Energy and sharpness, by the words of the tables."""


def results(name: str, among: Iterable[str] = CHOICES, stretch: float = 1.0) -> dict[str, Result]:
    """What `CHOICES` leave of the noise on a height field, by their words."""
    problems = [Problem.make(name, seed=seed, stretch=stretch) for seed in range(SEEDS)]
    found = {}
    for words in among:
        choice = CHOICES[words]
        fit = problems[0].best(*choice)
        others = [problem.error(problem.denoised(fit.fidelity, *choice).values) for problem in problems[1:]]
        found[words] = Result(fit, np.array([fit.error, *others]))
        print(f"   {name}, {words}: {found[words].error:.3f} at {fit.fidelity:.3g}", flush=True)
    return found


def draw(folder: Path) -> dict[str, str]:
    """One picture per height field, and the table of errors."""
    from . import panels  # noqa: PLC0415

    errors: dict[str, list[str]] = {}
    details: dict[str, list[str]] = {}
    for name in TRUTHS:
        problem = Problem.make(name)
        found = results(name)
        frame = np.column_stack([problem.vertices[:, :2], problem.truth])
        look = {"view": VIEW, "size": (260, 205), "frame": frame, "margin": 0.03}
        shown = {"truth": problem.truth, "noise": problem.noisy}
        shown |= {words: result.fit.solution.values for words, result in found.items()}
        row = []
        for words in SHOWN:
            caption = f"{words}: {found[words].fit.error:.1%}" if words in found else words
            row.append((caption, panels.height_field(problem.vertices, problem.faces, shown[words], **look)))
        panels.page(folder / f"heights_{name}.png", row, 4)
        least = min(result.error for words, result in found.items() if "sharpness" not in words)
        for words, result in found.items():
            text = f"{result.error:.1%}"
            text = f"**{text}**" if result.error == least else text
            errors.setdefault(words, []).append(f"{text} ± {result.errors.std(ddof=1):.1%}")
            bent = bending_in_tenth(problem.mesh, result.fit.solution.values)
            gap = f"{result.fit.solution.gap:.0e}" if result.fit.solution.solver != "cholesky" else "exact"
            details.setdefault(words, []).extend([f"{result.fit.fidelity:.3g}", f"{bent:.0%}", gap])
    long = results("ramp", (words for words in CHOICES if "L1" in words), STRETCH)
    of_long = [
        [words, *(f"{error:.1%}" for error in result.errors), f"{result.error:.1%}"]
        for words, result in long.items()
    ]
    header = ["energy"]
    for name in TRUTHS:
        header += [f"{name}: fidelity", "bending in a tenth", "gap"]
    return {
        "heights": table(["noise left", *TRUTHS], [[words, *row] for words, row in errors.items()]),
        "heights long": table(["noise left", *(f"seed {k}" for k in range(SEEDS)), "mean"], of_long),
        "heights details": table(header, [[words, *row] for words, row in details.items()]),
    }
