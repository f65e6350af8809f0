# SPDX-License-Identifier: GPL-3.0-or-later
"""Flows that were computed, with their steps: fewer steps, or another finish, are there without computing.

A step does not depend on how many follow. What counts is all that goes into a flow, bit by bit; so whoever
asks for the same one gets it, in the panel and in the redo panel.
"""

from dataclasses import dataclass, field
from types import SimpleNamespace

import numpy as np
import ridgeform

KEPT_BYTES = 256_000_000
"""What all that is kept may take: twenty steps of half a million vertices, or many of smaller meshes."""
ENDED = {"reached", "settled", "converged", "collapsed", "diverged"}
"""How a flow ends that more steps would not take further."""


@dataclass
class Flow:
    """A flow: its welded vertices (l, 3) float64 and triangles, its options, its result and its steps."""

    vertices: np.ndarray
    triangles: np.ndarray
    options: dict[str, object]
    """The arguments of `ridgeform.stylize` but for the number of steps."""
    result: ridgeform.Stylized | None = None
    steps: dict[int, np.ndarray] = field(default_factory=dict)
    """The vertices after the steps that were seen."""

    def same_as(self, other: "Flow") -> bool:
        """Whether the same goes in."""
        return (
            np.array_equal(self.vertices, other.vertices)
            and np.array_equal(self.triangles, other.triangles)
            and self.options.keys() == other.options.keys()
            and all(np.array_equal(value, other.options[name]) for name, value in self.options.items())
        )

    def watch(self, progress: ridgeform.Progress) -> None:
        """Take down the step that a running flow has finished last."""
        if progress.iteration in self.steps:
            return
        seen = progress.numbered_snapshot()
        if seen is not None:
            self.steps.setdefault(*seen)

    def after(self, steps: int) -> ridgeform.Stylized | SimpleNamespace | None:
        """What a run of at most so many steps gives; `None` if it is not known."""
        result = self.result
        if steps == result.iterations and result.status != "stopped":
            return result
        if steps > result.iterations:
            return result if result.status in ENDED else None
        vertices = self.steps.get(steps)
        # Where steps were done on coarser meshes, fewer would have ended on the mesh itself, too.
        if vertices is None or len(result.gap) > result.iterations:
            return None
        # A flow without a step says how flat a shape is.
        shape = ridgeform.stylize(ridgeform.Mesh(vertices, self.triangles), iterations=0)
        return SimpleNamespace(
            vertices=vertices,
            energy=result.energy[: steps + 1],
            gap=result.gap[:steps],
            flat_share=np.array([result.flat_share[0], shape.flat_share[-1]]),
            n_facets=shape.n_facets,
            iterations=steps,
            status="finished",
        )

    @property
    def n_bytes(self) -> int:
        """What is kept."""
        return self.vertices.nbytes * (2 + len(self.steps)) + self.triangles.nbytes


_kept: list[Flow] = []


def known(flow: Flow) -> Flow | None:
    """A flow that the same went into."""
    return next((other for other in _kept if other.same_as(flow)), None)


def keep(flow: Flow) -> None:
    """Keep a flow that has ended; the oldest ones go."""
    kept = [flow, *(other for other in _kept if not other.same_as(flow))]
    while kept and sum(other.n_bytes for other in kept) > KEPT_BYTES:
        kept.pop()
    _kept[:] = kept


def forget() -> None:
    """Let go of all."""
    _kept.clear()
