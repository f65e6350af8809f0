# SPDX-License-Identifier: GPL-3.0-or-later
"""What the settings of all tools share: ridge paint, the paper's choices, the solver, plain defaults."""

import inspect
from types import SimpleNamespace

import numpy as np
from bpy.props import BoolProperty, EnumProperty, IntProperty, StringProperty

RIDGE_PULL = 10.0
"""How much cheaper (or dearer) full paint makes ridges: a decade is visible and still solves well."""


def ridge_weights_of(painted: np.ndarray, triangles: np.ndarray, avoid: bool) -> np.ndarray:
    """Face weights (m,) of the energy from a painted vertex group (n,) of 0 to 1.

    Nothing painted is 1, so neutral. Painted 1 divides the cost of ridges by `RIDGE_PULL`, or multiplies it
    with `avoid`.
    """
    exponent = painted.astype(np.float64)[triangles].mean(axis=1)
    return RIDGE_PULL ** (exponent if avoid else -exponent)


class RidgeSettings:
    """Where ridges are wanted."""

    ridge_group: StringProperty(
        name="Ridges",
        description="Vertex group painted where ridges should form. What is not painted is neutral",
    )
    avoid_ridges: BoolProperty(
        name="Avoid Ridges",
        description="Keep ridges away from the painted vertices instead of drawing them there",
        default=False,
    )


class SolverChoice:
    """What solves, and for how long at most."""

    solver: EnumProperty(
        name="Solver",
        description="What solves the problem",
        items=(
            ("auto", "Automatic", "Chosen by the problem"),
            ("fast", "Fast", "The specialised first-order solver"),
            ("clarabel", "Clarabel", "The general interior-point solver: slow and accurate"),
        ),
        default="auto",
    )
    max_iterations: IntProperty(
        name="Iterations",
        description="The most iterations of the solver. 0 leaves it to the solver",
        default=0,
        min=0,
    )


class SolverSettings(SolverChoice):
    """The choices of the paper that rarely change, and the solver."""

    coupling: EnumProperty(
        name="Coupling",
        description="How the coordinates, or the components of a vector or a colour, share ridges",
        items=(
            (
                "joint",
                "Joint",
                "One norm over all components: the result does not depend on the axes",
            ),
            ("separate", "Separate", "Each component by itself, as in the paper"),
        ),
        default="joint",
    )
    dual: EnumProperty(
        name="Dual",
        description="The dual edges of the Hessian",
        items=(
            ("barycentric", "Barycentric", "Between centers of mass: safe on every mesh"),
            ("circumcentric", "Circumcentric", "Between circumcenters: for well-shaped triangles"),
        ),
        default="barycentric",
    )
    delaunay: BoolProperty(
        name="Intrinsic Delaunay",
        description="Compute on the intrinsic Delaunay triangulation. Helps with long, thin triangles",
        default=False,
    )


def _annotations(settings: type) -> dict[str, object]:
    found: dict[str, object] = {}
    for base in reversed(settings.__mro__):
        found |= inspect.get_annotations(base)
    return found


def setting_names(settings: type) -> tuple[str, ...]:
    """The names of all settings of a class of settings, its bases first."""
    return tuple(_annotations(settings))


def defaults_of(settings: type, **changes: object) -> SimpleNamespace:
    """The settings of a class as a plain object with Blender's defaults, for use without an operator.

    Raises `TypeError` for a name that is not a setting.
    """
    found = _annotations(settings)
    unknown = sorted(set(changes) - set(found))
    if unknown:
        raise TypeError(f"There is no setting {', '.join(unknown)}.")
    # A set of flags must not be shared between two such objects.
    values = {name: _default(annotation) for name, annotation in found.items()}
    return SimpleNamespace(**(values | changes))


def _default(annotation: object) -> object:
    value = annotation.keywords.get("default", "")
    return set(value) if isinstance(value, set) else value
