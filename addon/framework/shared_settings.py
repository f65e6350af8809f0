# SPDX-License-Identifier: GPL-3.0-or-later
"""The settings that several tools have: ridge paint, the paper's choices, the solver."""

import numpy as np

from .settings import Range, Setting, boolean, choice, choices, factor, integer, items, number, vertex_group

EXPERT = "Expert"
"""The subpanel of the paper's numbers and the solver's."""

RIDGE_PULL = 10.0
"""How much cheaper (or dearer) full paint makes ridges: a decade is visible and still solves well."""


def ridge_weights_of(painted: np.ndarray, triangles: np.ndarray, avoid: bool) -> np.ndarray:
    """Face weights (m,) of the energy from a painted vertex group (n,) of 0 to 1.

    Nothing painted is 1, so neutral. Painted 1 divides the cost of ridges by `RIDGE_PULL`, or multiplies it
    with `avoid`.
    """
    exponent = painted.astype(np.float64)[triangles].mean(axis=1)
    return RIDGE_PULL ** (exponent if avoid else -exponent)


def edge_weights_of(painted: np.ndarray, triangles: np.ndarray, avoid: bool) -> np.ndarray:
    """The same for the edges (m, 3) of the triangles, column i opposite corner i."""
    exponent = painted.astype(np.float64)[triangles]
    exponent = 0.5 * (exponent[:, [1, 2, 0]] + exponent[:, [2, 0, 1]])
    return RIDGE_PULL ** (exponent if avoid else -exponent)


RIDGE_GROUP = vertex_group(
    "Ridges", "Vertex group painted where ridges should form. Unpainted areas are neutral"
)
AVOID_RIDGES = boolean(
    "Avoid Ridges",
    "Keep ridges away from the painted vertices instead of drawing them there",
    active=lambda settings: bool(settings.ridge_group),
)
MARK_KINDS = items(
    SHARP="Mark ridges as sharp edges",
    CREASE="Give ridges a full subdivision crease",
    BEVEL="Give ridges a full bevel weight",
)
MARKS = choices(
    "Mark Ridges",
    "Mark the edges along the ridges. Existing marks are kept",
    MARK_KINDS,
    expand=True,
    flag="--mark",
)
COUPLINGS = items(
    joint="One norm over all components, so that the result does not depend on the axes",
    separate="Each component by itself, as in the paper",
)
COUPLING = choice(
    "Coupling",
    "How the coordinates, or the components of a vector or color, share ridges",
    COUPLINGS,
    default="joint",
    section=EXPERT,
)
DUALS = items(
    barycentric="Between centers of mass: works on every mesh",
    circumcentric="Between circumcenters: for well-shaped triangles",
)
DUAL = choice("Dual", "The dual edges of the Hessian", DUALS, default="barycentric", section=EXPERT)
DELAUNAY = boolean(
    "Intrinsic Delaunay",
    "Compute on the intrinsic Delaunay triangulation. Helps with long, thin triangles",
    section=EXPERT,
)
COARSE_TO_FINE = boolean("Coarse First", "", default=True, section=EXPERT)
SOLVERS = items(
    auto=("Automatic", "Chosen to suit the problem"),
    fast="The specialized first-order solver",
    clarabel="A general interior-point solver: slow and accurate",
)
SOLVER = choice("Solver", "Algorithm that solves the problem", SOLVERS, default="auto", section=EXPERT)
MAX_ITERATIONS = integer(
    "Iterations",
    "Maximum number of solver iterations",
    Range(1000, min=0, soft_min=1),
    section=EXPERT,
    otherwise="it is left to the solver",
)
USE_FIDELITY = boolean(
    "Set Fidelity", "Set the fidelity weight of the paper instead of the strength", section=EXPERT, flag=None
)


def fidelity(description: str, *, default: float, switched: bool = True, **more: object) -> Setting:
    """The fidelity weight; if `switched`, it counts only with `use_fidelity`, which its flag sets."""
    given = {"min": 1e-6, "max": 1e12, "soft_min": 1.0, "soft_max": 1e6, "precision": 1, "section": EXPERT}
    if switched:
        given |= {"active": uses_fidelity, "implies": {"use_fidelity": True}}
    return number("Fidelity", description, Range(default), **(given | more))


def uses_fidelity(settings: object) -> bool:
    """Whether the paper's fidelity weight counts."""
    return settings.use_fidelity


def has_strength(settings: object) -> bool:
    """Whether the strength counts."""
    return not settings.use_fidelity


def strength(description: str) -> Setting:
    """How strongly a tool acts, unless the fidelity weight is set; values up to 1.5 can be typed."""
    return factor("Strength", description, default=0.5, max=1.5, soft_max=1.0, active=has_strength)
