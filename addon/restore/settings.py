# SPDX-License-Identifier: GPL-3.0-or-later
"""The settings of restoring: how exact surfaces are, how far vertices move, what else is made."""

import numpy as np

from ..framework import shared_settings as shared
from ..framework.settings import Range, Settings, angle, boolean, choices, chosen, items, number, vertex_group

OUTPUTS = items(
    ATTRIBUTES=(
        'Store the surface of each face in the face attributes "ridgeform_surface" (its number) and '
        '"ridgeform_surface_kind" (0 free, 1 plane, 2 sphere, 3 cylinder, 4 cone, 5 torus)'
    ),
    EMPTIES=(
        "Add an empty for each surface, with its Z axis along the normal or the axis. Those of an earlier "
        "run are replaced"
    ),
)


class RestoreSettings(Settings):
    """The settings of restoring."""

    regularize: angle(
        "Regularize",
        "Make surfaces exactly parallel or orthogonal if they are so within this angle, and radii equal if "
        "they differ as little",
        Range(np.radians(3.0), min=0.0, max=np.radians(30.0)),
        otherwise="surfaces stay as they were fitted",
    )
    free: boolean(
        "Denoise Free Pieces",
        "Denoise pieces that do not lie on a surface of a known kind. Otherwise they stay as they are",
        default=True,
    )
    strength_group: vertex_group(
        "Mask", "Vertex group that determines where to restore. Vertices outside of it do not move"
    )
    outputs: choices(
        "Make",
        "What to create from the surfaces, besides moving the vertices",
        OUTPUTS,
        default={"ATTRIBUTES"},
        flag="--make",
    )
    marks: shared.MARKS.but(
        description="Mark the edges where surfaces meet in a crease. Existing marks are kept",
        default={"SHARP"},
    )
    max_move: number(
        "Maximum Distance",
        "How far a vertex may move, in the units of the mesh",
        Range(0.01, min=0.0, soft_max=10.0, precision=4),
        otherwise="it is four times the noise and half the length of an edge",
    )
    noise: number(
        "Noise",
        "Standard deviation of the noise along the normal, in the units of the mesh",
        Range(0.001, min=0.0, soft_max=10.0, precision=5),
        otherwise="it is found in the mesh",
    )


PRESETS = {
    "Scan": {"use_regularize": False},
    "Machined Part": {"use_regularize": True, "regularize": float(np.radians(3.0))},
}
"""Shipped presets: surfaces as fitted; parallel, orthogonal, and equal where they nearly are."""


def restore_options(settings: object) -> dict[str, object]:
    """The keyword arguments of `ridgeform.restore` that the settings stand for, the same for every mesh."""
    angle = chosen(settings, "regularize")
    return {
        "regularize": None if angle is None else min(float(np.degrees(angle)), 30.0),
        "free": settings.free,
        "max_move": chosen(settings, "max_move"),
        "noise": chosen(settings, "noise"),
    }
