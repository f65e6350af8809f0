# SPDX-License-Identifier: GPL-3.0-or-later
"""The settings of the tools on attributes, and how a modeler's sliders become the paper's numbers."""

from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, StringProperty

from ..blender.attribute_names import search_names
from ..framework.shared_settings import RidgeSettings, SolverSettings


class DisplaySettings:
    """How a result is shown."""

    display: EnumProperty(
        name="Show",
        description="How the result is shown. Colours are always shown as they are",
        items=(
            ("NONE", "Nothing", "Leave the view and the materials as they are"),
            (
                "VIEWPORT",
                "Viewport Colors",
                'Show the values as colours in Solid shading, stored in the attribute "ridgeform_shown"',
            ),
            (
                "MATERIAL",
                "Material",
                "Give the mesh a material that turns the values into colours, also for rendering",
            ),
        ),
        default="VIEWPORT",
    )
    bands: IntProperty(
        name="Bands",
        description="Bands of one colour each in the material: their borders are isolines. 0 is smooth",
        default=0,
        min=0,
        max=32,
    )


ENERGIES = (
    ("l1_hessian", "Sharp (L1 Hessian)", "Flat slopes that meet in sharp creases (Rowe et al. 2024)"),
    ("l2_hessian", "Smooth (L2 Hessian)", "Smooth, also along borders (Stein et al. 2018)"),
    (
        "l2_curved_hessian",
        "Smooth, Curved (L2 Hessian)",
        "Smooth, also along borders, and true to the curvature of the surface (Stein et al. 2020)",
    ),
    ("l2_laplacian", "Smooth, Flat Borders (L2 Laplacian)", "Smooth, but level towards borders"),
    (
        "l1_hessian_stein2018",
        "Sharp along Axes (L1 Hessian in space)",
        "Sharp creases that depend on how the object is turned (Stein et al. 2018)",
    ),
    (
        "l1_edge_laplacian",
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
    "l2_hessian": (9.25, 6.0),
    "l2_curved_hessian": (9.25, 6.0),
    "l2_laplacian": (9.25, 6.0),
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


class EnergySettings:
    """What is minimised, and how exactly."""

    energy: EnumProperty(
        name="Energy",
        description="What kind of values is looked for",
        items=ENERGIES,
        default=OURS,
    )
    tolerance: FloatProperty(
        name="Tolerance",
        description="Certified relative duality gap that the result must reach",
        default=0.001,
        min=1e-8,
        max=1.0,
        precision=6,
    )


class AttributeSettings(DisplaySettings, RidgeSettings, EnergySettings, SolverSettings):
    """The settings that denoising and interpolating share."""

    attribute: StringProperty(
        name="Attribute",
        description="Attribute or vertex group to work on. Empty: the active one",
        search=search_names,
    )
    output: EnumProperty(
        name="Result",
        description="Where the result goes",
        items=(
            ("NEW", "New Attribute", "Leave the values as they are and put the result into a new attribute"),
            ("IN_PLACE", "In Place", "Write over the values"),
        ),
        default="NEW",
    )
    sharpness: FloatProperty(
        name="Sharpness",
        description="How much further ridges are sharpened: 0 is the energy of the paper, 1 prefers few and "
        "hard ridges",
        default=0.0,
        min=0.0,
        max=1.0,
        subtype="FACTOR",
    )


class DenoiseSettings(AttributeSettings):
    """The settings of denoising, shared by the operator, the panel, presets and the batch command."""

    strength: FloatProperty(
        name="Strength",
        description="How much is smoothed away: 0 keeps the values, 1 leaves only the broadest slopes. The "
        "same for every size and density of the mesh and every unit of the values",
        default=0.5,
        min=0.0,
        max=1.5,
        soft_max=1.0,
        subtype="FACTOR",
    )
    use_fidelity: BoolProperty(
        name="Set Fidelity",
        description="Set the fidelity weight of the paper instead of the strength",
        default=False,
    )
    fidelity: FloatProperty(
        name="Fidelity",
        description="Fidelity weight (Rowe et al. 2024, eq. 23), in the mesh's own units: larger stays "
        "closer to the values",
        default=1000.0,
        min=1e-9,
        max=1e15,
        soft_min=1e-3,
        soft_max=1e8,
        precision=3,
    )


class InterpolateSettings(AttributeSettings):
    """The settings of interpolating, shared by the operator, the panel, presets and the batch command."""

    known: EnumProperty(
        name="Known",
        description="Which values are kept. All others are computed",
        items=(
            ("SELECTED", "Selected Vertices", "Spread the values of the selected vertices over the mesh"),
            ("UNSELECTED", "Fill the Selection", "Compute the selected vertices from the others"),
            ("GROUP", "Vertex Group", "Spread the values of the vertices in a group over the mesh"),
        ),
        default="SELECTED",
    )
    known_group: StringProperty(
        name="Known In",
        description="Vertex group of the vertices whose values are known. Empty: the vertex group worked on",
    )


class ModesSettings(DisplaySettings, EnergySettings, SolverSettings):
    """The settings of vibration modes, shared by the operator and the panel."""

    count: IntProperty(
        name="Modes",
        description="How many modes are computed, those of least energy first",
        default=8,
        min=1,
        max=1000,
        soft_max=32,
    )
    shown: IntProperty(
        name="Shown Mode",
        description="The mode that is shown. On a closed surface mode 0 is the same everywhere",
        default=1,
        min=0,
        max=999,
    )


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
        "max_iterations": settings.max_iterations or None,
    }
