# SPDX-License-Identifier: GPL-3.0-or-later
"""The settings of the tools on attributes, and how a modeler's sliders become the paper's numbers."""

from ..blender.attribute_names import search_names
from ..framework import shared_settings as shared
from ..framework.settings import (
    Range,
    Settings,
    boolean,
    choice,
    chosen,
    data_name,
    factor,
    integer,
    items,
    number,
    vertex_group,
)

ENERGIES = items(
    l1_hessian=("Sharp (L1 Hessian)", "Flat slopes that meet in sharp creases (Rowe et al. 2024)"),
    l2_hessian=("Smooth (L2 Hessian)", "Smooth, also along borders (Stein et al. 2018)"),
    l2_curved_hessian=(
        "Smooth, Curved (L2 Hessian)",
        "Smooth, also along borders, and true to the curvature of the surface (Stein et al. 2020)",
    ),
    l2_laplacian=("Smooth, Flat Borders (L2 Laplacian)", "Smooth, but level toward borders"),
    l1_hessian_stein2018=(
        "Sharp along Axes (L1 Hessian in Space)",
        "Sharp creases that depend on how the object is turned (Stein et al. 2018)",
    ),
    l1_edge_laplacian=(
        "Sharp along Edges (L1 Edge Laplacian)",
        "Sharp creases along the edges of the mesh (He and Schaefer 2013)",
    ),
)
"""The energies of the package, for a modeler."""
OURS = "l1_hessian"
"""The one that has dual edges and sharpness."""
QUADRATIC = {"l2_hessian", "l2_curved_hessian", "l2_laplacian"}
"""Those that are sums of squares."""
EXTRINSIC = {"l2_hessian", "l1_hessian_stein2018"}
"""Those that see the mesh in space, and so no flipped edges."""


STRENGTHS = {
    "l1_hessian": (6.0, 4.0),
    "l1_hessian_stein2018": (6.0, 4.0),
    "l1_edge_laplacian": (5.5, 4.0),
    **dict.fromkeys(QUADRATIC, (9.25, 6.0)),
}
"""The power of ten of the fidelity weight at strength 0, and by how much it falls up to strength 1.

Chosen so that each energy has its least error at about the same strength: 0.35 for noise of 5 % of the
spread, 0.5 for 20 %, 0.6 for 50 % (five meshes of 642 to 11 533 vertices, a creased and a smooth function).
"""


def denoise_fidelity_of(strength: float, spread: float, area: float, energy: str = OURS) -> float:
    """The fidelity weight of eq. (23) that a strength from 0 to 1 stands for.

    An L1 energy has the unit of the values, a sum of squares that of values² by area, the fidelity term that
    of values² times area. So the weight is measured against the spread of the values (their standard
    deviation) and the area of the surface. Then a strength means the same for every size and density of the
    mesh and every unit of the values.
    """
    start, fall = STRENGTHS[energy]
    unit = area**2 if energy in QUADRATIC else spread * area
    return 10.0 ** (start - fall * strength) / unit


def _is_ours(settings: object) -> bool:
    return settings.energy == OURS


class AttributeName(Settings):
    """What is worked on."""

    attribute: data_name(
        "Attribute", "Attribute or vertex group to work on. Empty: the active one", search=search_names
    )


class EnergyChoice(Settings):
    """What is minimized."""

    energy: choice("Energy", "How the result should vary across the surface", ENERGIES, default=OURS)


PLACES = items(
    NEW=("New Attribute", "Leave the values as they are and put the result into a new attribute"),
    IN_PLACE="Overwrite the values",
)


class ResultSettings(EnergyChoice):
    """What denoising and interpolating share: the energy, where ridges are, where the result goes."""

    sharpness: factor(
        "Sharpness",
        "How much ridges are sharpened further: 0 is the energy of the paper, 1 prefers few and hard ridges",
        default=0.0,
        active=_is_ours,
    )
    ridge_group: shared.RIDGE_GROUP
    avoid_ridges: shared.AVOID_RIDGES
    output: choice(
        "Result",
        "Where to put the result",
        PLACES,
        default="NEW",
        flag=None,
        switches={"--in-place": "IN_PLACE"},
    )


DISPLAYS = items(
    NONE=("Nothing", "Leave the view and the materials as they are"),
    VIEWPORT=(
        "Viewport Colors",
        'Show the values as colors in Solid shading, stored in the attribute "ridgeform_shown"',
    ),
    MATERIAL="Give the mesh a material that turns the values into colors, also for rendering",
)


class DisplaySettings(Settings):
    """How a result is shown."""

    display: choice(
        "Show",
        "How to show the result. Colors are always shown as they are",
        DISPLAYS,
        default="VIEWPORT",
        flag=None,
        switches={"--material": "MATERIAL"},
    )
    bands: integer(
        "Bands",
        "Number of bands of one color each in the material, with isolines as their borders. 0 is smooth",
        Range(0, min=0, max=32),
        active=lambda settings: settings.display == "MATERIAL",
    )


class ExpertSettings(Settings):
    """The choices of the paper that rarely change, and the solver."""

    dual: shared.DUAL.but(active=_is_ours)
    delaunay: shared.DELAUNAY.but(active=lambda settings: settings.energy not in EXTRINSIC)
    solver: shared.SOLVER.but(active=lambda settings: settings.energy not in QUADRATIC)
    tolerance: number(
        "Tolerance",
        "Certified relative duality gap that the result must reach",
        Range(0.001, min=1e-8, max=1.0, precision=6),
        section=shared.EXPERT,
    )
    max_iterations: shared.MAX_ITERATIONS


class CoupledSettings(Settings):
    """How the components of the values share ridges."""

    coupling: shared.COUPLING


class StrengthSettings(AttributeName):
    """What is denoised, and how strongly."""

    strength: shared.strength(
        "How much is smoothed away: 0 keeps the values, 1 leaves only the broadest slopes. Independent of "
        "the size and density of the mesh and the unit of the values"
    )
    use_fidelity: shared.USE_FIDELITY
    fidelity: shared.fidelity(
        "Fidelity weight (Rowe et al. 2024, eq. 23), in the units of the mesh: larger values stay closer to "
        "the original values",
        default=1000.0,
        min=1e-9,
        max=1e15,
        soft_min=1e-3,
        soft_max=1e8,
        precision=3,
    )


class JumpSettings(Settings):
    """Where values are kept apart."""

    use_jumps: boolean(
        "Keep Jumps",
        "Keep values apart where they jump from one vertex to the next, as colors do at the border of what "
        "was painted. Otherwise a jump is a steep slope like any other",
        flag=None,
    )
    jump: factor(
        "Jump",
        "Difference between neighboring vertices from which on values jump, as a part of their range",
        default=0.25,
        min=0.001,
        active=lambda settings: settings.use_jumps,
        implies={"use_jumps": True},
    )


class DenoiseSettings(
    StrengthSettings, JumpSettings, ResultSettings, DisplaySettings, CoupledSettings, ExpertSettings
):
    """The settings of denoising."""


KNOWN = items(
    SELECTED=("Selected Vertices", "Spread the values of the selected vertices over the mesh"),
    UNSELECTED=("Fill the Selection", "Compute the selected vertices from the others"),
    GROUP=("Vertex Group", "Spread the values of the vertices in a group over the mesh"),
)


class KnownSettings(AttributeName):
    """What is interpolated, and from where."""

    known: choice("Known", "Which values are kept. All others are computed", KNOWN, default="SELECTED")
    known_group: vertex_group(
        "Known In",
        "Vertex group of the vertices whose values are known. Empty: the vertex group to work on",
        shown=lambda settings: settings.known == "GROUP",
    )


class InterpolateSettings(
    KnownSettings, JumpSettings, ResultSettings, DisplaySettings, CoupledSettings, ExpertSettings
):
    """The settings of interpolating."""


class ModesCount(Settings):
    """How many modes."""

    count: integer(
        "Modes",
        "Number of modes to compute, those of least energy first",
        Range(8, min=1, max=1000, soft_max=32),
    )


class ModesSettings(ModesCount, EnergyChoice, DisplaySettings, ExpertSettings):
    """The settings of vibration modes."""

    shown: integer(
        "Shown Mode",
        "Mode to show. On a closed surface, mode 0 is the same everywhere",
        Range(1, min=0, max=999),
    )


class ShowSettings(AttributeName, DisplaySettings):
    """The settings of showing an attribute."""

    signed: boolean(
        "Zero in the Middle", "Show negative values in blue, positive ones in red, and zero in white"
    )


DENOISE_PRESETS = {
    "Creases": {"energy": OURS, "strength": 0.5, "sharpness": 0.0, "use_fidelity": False},
    "Hard Creases": {"strength": 0.6, "sharpness": 1.0},
    "Smooth": {"energy": "l2_curved_hessian"},
}
"""Shipped presets: noise away, creases kept; few and hard creases, against strong noise; all smooth."""

INTERPOLATE_PRESETS = {
    "Spread Sharp": {"energy": OURS, "sharpness": 0.0, "known": "SELECTED", "output": "NEW"},
    "Spread Smooth": {"energy": "l2_curved_hessian"},
    "Fill Sharp": {"sharpness": 0.5, "known": "UNSELECTED", "output": "IN_PLACE"},
    "Fill Smooth": {"energy": "l2_curved_hessian", "known": "UNSELECTED", "output": "IN_PLACE"},
}
"""Shipped presets: flat slopes between the selected vertices, or a smooth function through them; creases
continued into the selection, or smoothly."""


def solve_options(settings: object) -> dict[str, object]:
    """The keyword arguments of `ridgeform.denoise` and `ridgeform.interpolate`, the same for every mesh."""
    return energy_options(settings) | {
        "sharpness": settings.sharpness if settings.energy == OURS else 0.0,
        "coupling": settings.coupling,
    }


def energy_options(settings: object) -> dict[str, object]:
    """The keyword arguments for the energy and the solver, those of `ridgeform.vibration_modes` too.

    Only the L1 Hessian has dual edges to choose, quadratic energies have no choice of a solver, and those in
    space no intrinsic edges.
    """
    return {
        "energy": settings.energy,
        "dual": settings.dual if settings.energy == OURS else "barycentric",
        "delaunay": settings.delaunay and settings.energy not in EXTRINSIC,
        "solver": "auto" if settings.energy in QUADRATIC else settings.solver,
        "tolerance": settings.tolerance,
        "max_iterations": chosen(settings, "max_iterations"),
    }
