"""The holes of the table: shapes, sizes, densities and orientations, all seeded."""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from known_shapes import holed_shapes
from known_shapes.holed_shapes import Holed, Solid
from numpy.typing import NDArray

DENSITIES = (12, 24)
"""Edges per side of length 2."""
SIZES = (0.3, 0.6)
"""Radii of the holes."""
SHIFT = 0.25
"""The hole is moved by up to this along its ridge."""


@dataclass(frozen=True)
class Kind:
    """One row of the table."""

    solid: Callable[[int], Solid]
    center: NDArray[np.float64]
    along: NDArray[np.float64]
    """Where the hole may move, as a direction."""
    smooth: bool = False
    """Whether there is no ridge: then the filling itself is measured against the true surface."""


def _kind(solid: Callable, center: tuple, along: tuple, smooth: bool = False) -> Kind:
    return Kind(solid, np.array(center, float), np.array(along, float), smooth)


KINDS = {
    "cube, edge": _kind(holed_shapes.cube, (1, 0, 1), (0, 1, 0)),
    "cube, corner": _kind(holed_shapes.cube, (1, 1, 1), (0.2, 0.2, 0.2)),
    "concave edge": _kind(holed_shapes.step, (1, 0.5, 1), (0, 0.4, 0)),
    "roof, bends by 53°": _kind(holed_shapes.roof, (0, 0, 1.5), (0, 1, 0)),
    "cylinder, rim": _kind(holed_shapes.cylinder, (0.6, 0.8, 1), (0, 0, 0.3)),
    "cylinder, side": _kind(holed_shapes.cylinder, (0.8, -0.6, 0), (0, 0, 1), smooth=True),
    "sphere": _kind(holed_shapes.sphere, (0.48, 0.6, 0.64), (0.2, -0.2, 0), smooth=True),
}
"""The rows by name."""


@dataclass(frozen=True)
class Case:
    """One hole."""

    kind: str
    density: int
    radius: float
    irregular: bool
    seed: int

    @property
    def name(self) -> str:
        """A name that is a file's as well."""
        words = (self.kind, self.density, self.radius, "irregular" if self.irregular else "regular")
        return " ".join(str(word) for word in words).replace(",", "").replace("°", "")


def cases(words: str = "") -> list[Case]:
    """All holes, or those of the kinds whose name contains the words; seeds do not depend on the choice."""
    found = []
    for kind in KINDS:
        for density in DENSITIES:
            for radius in SIZES:
                for irregular in (False, True):
                    case = Case(kind, density, radius, irregular, 1 + len(found))
                    found.append(case)
    return [case for case in found if words in case.kind]


@functools.cache
def _solid(kind: str, density: int, irregular: bool) -> Solid:
    solid = KINDS[kind].solid(density)
    return holed_shapes.irregular(solid, density) if irregular else solid


def holed(case: Case) -> Holed:
    """The mesh with its hole, turned at random."""
    kind = KINDS[case.kind]
    shift = SHIFT * np.random.default_rng(case.seed).uniform(-1, 1)
    solid = _solid(case.kind, case.density, case.irregular)
    return holed_shapes.cut(solid, [(kind.center + shift * kind.along, case.radius)], case.seed)
