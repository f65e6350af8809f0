# SPDX-License-Identifier: GPL-3.0-or-later
"""The command line of the batch command: its tools, their options, and the settings that these stand for."""

import argparse
import math
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from ..attributes.denoise import Denoising
from ..attributes.interpolate import Interpolation
from ..attributes.settings import ENERGIES, DenoiseSettings, InterpolateSettings
from ..diffusion.settings import DiffusionSettings
from ..diffusion.tool import DiffusionCurves
from ..holes.settings import HoleSettings
from ..holes.tool import HoleFilling
from ..segments.settings import OUTPUTS, SegmentSettings
from ..segments.tool import Segmenting
from ..stylize.settings import StylizeSettings
from ..stylize.tool import Stylization
from . import files
from .run import Run
from .shared_settings import defaults_of, setting_names


@dataclass
class BatchTool:
    """A tool of the batch command."""

    run: type[Run]
    settings: type
    help: str
    add_options: Callable[[argparse.ArgumentParser, object], None]


def settings_from(options: argparse.Namespace) -> object:
    """The settings of the tool that the options stand for."""
    settings = TOOLS[options.tool].settings
    given = {
        name: value
        for name, value in vars(options).items()
        if value is not None and name in setting_names(settings) and name != "output"
    }
    if options.fidelity is not None and "use_fidelity" in setting_names(settings):
        given["use_fidelity"] = True
    return defaults_of(settings, **(given | _translated(options)))


_FLAGS = {
    "shape_key": ("output", "SHAPE_KEY"),
    "in_place": ("output", "IN_PLACE"),
    "material": ("display", "MATERIAL"),
    "one_material": ("material", "MAJORITY"),
    "image": ("source", "IMAGE"),
}
"""Options that stand for one value of a setting of another name."""


def _translated(options: argparse.Namespace) -> dict[str, object]:
    """The settings of those options that are not a setting by themselves."""
    words = vars(options)
    given: dict[str, object] = {}
    if words.get("reduce") is not None:
        given |= {"reduce": True, "reduce_ratio": options.reduce}
    for word, (name, value) in _FLAGS.items():
        if words.get(word):
            given[name] = value
    for name in ("known", "regions", "shape"):
        if words.get(name) is not None:
            given[name] = words[name].upper()
    if words.get("mark"):
        given["marks"] = {kind.upper() for kind in options.mark}
    if words.get("mark_angle") is not None:
        given["mark_angle"] = math.radians(options.mark_angle)
    if words.get("segments") is not None:
        given |= {"use_count": True, "count": options.segments}
    if words.get("make"):
        given["outputs"] = {_output_word(word) for word in options.make}
    if options.tool == "segment" and options.attribute is not None:
        given["source"] = "ATTRIBUTE"
    return given


def _output_word(word: str) -> str:
    return word.upper().replace("-", "_")


def _suffix(text: str) -> str:
    return "." + text.lower().lstrip(".")


def parser() -> argparse.ArgumentParser:
    """The parser of the whole command line."""
    made = argparse.ArgumentParser(prog="ridgeform", description="Ridgeform without a window.")
    tools = made.add_subparsers(dest="tool", required=True, metavar="TOOL")
    for name, tool in TOOLS.items():
        child = tools.add_parser(name, help=tool.help, description=tool.help)
        _add_files(child)
        tool.add_options(child, defaults_of(tool.settings))
    return made


def _add_files(child: argparse.ArgumentParser) -> None:
    add = child.add_argument
    add("files", nargs="+", type=Path, metavar="FILE", help=f"what to read: {' '.join(files.FORMATS)}")
    add(
        "-o", "--output", type=Path, required=True, metavar="OUT", help="the file, or the folder, to write to"
    )
    add(
        "--format", type=_suffix, choices=list(files.FORMATS), help="write into the folder OUT in this format"
    )
    add("--json", action="store_true", help="print one JSON record per file on standard output")


def _add_shared(child: argparse.ArgumentParser, defaults: object) -> None:
    add = child.add_argument
    add("--sharpness", type=float, help=f"0 to 1 ({defaults.sharpness})")
    add("--ridge-group", metavar="NAME", help="vertex group painted where ridges should form")
    add("--avoid-ridges", action="store_true", default=None, help="keep ridges away from what is painted")
    add("--coupling", choices=("joint", "separate"), help="norm over the components (joint)")
    add(
        "--delaunay",
        action="store_true",
        default=None,
        help="compute on the intrinsic Delaunay triangulation",
    )
    add("--dual", choices=("barycentric", "circumcentric"), help="dual edges (barycentric)")
    add("--solver", choices=("auto", "fast", "clarabel"), help="solver (auto)")
    add("--tolerance", type=float, help=f"certified relative gap to be reached ({defaults.tolerance:g})")
    add("--max-iterations", type=int, help="most solver iterations; 0: left to the solver")


def _add_stylize(child: argparse.ArgumentParser, defaults: object) -> None:
    add = child.add_argument
    add("--steps", type=int, help=f"flow steps ({defaults.steps})")
    add("--strength", type=float, help=f"0 to 1 ({defaults.strength})")
    add("--strength-group", metavar="NAME", help="vertex group that masks the strength")
    add("--shape-key", action="store_true", help="put the result into a new shape key")
    add("--keep-volume", action="store_true", default=None, help="scale closed meshes to their old volume")
    add("--mark", action="append", choices=("sharp", "crease", "bevel"), help="mark ridges; may be repeated")
    add("--mark-angle", type=float, metavar="DEGREES", help="least angle between the faces at a ridge (20)")
    add("--reduce", type=float, metavar="RATIO", help="keep this share of the triangles")
    add("--fidelity", type=float, help="fidelity weight of the paper instead of --strength")
    add("--scale", choices=("max_edge", "bounding_box", "area"), help="unit of --fidelity (max_edge)")
    _add_shared(child, defaults)


def _add_attribute(child: argparse.ArgumentParser, defaults: object) -> None:
    add = child.add_argument
    add("--attribute", metavar="NAME", help="attribute or vertex group (the active one)")
    add("--in-place", action="store_true", help="write over the values instead of making a new attribute")
    add("--energy", choices=[name for name, *_ in ENERGIES], help=f"what to minimise ({defaults.energy})")
    add("--material", action="store_true", help="show the result by a material")
    add("--bands", type=int, help="bands of one colour each in the material (0: smooth)")
    _add_shared(child, defaults)


def _add_denoise(child: argparse.ArgumentParser, defaults: object) -> None:
    child.add_argument("--strength", type=float, help=f"0 to 1 ({defaults.strength})")
    child.add_argument("--fidelity", type=float, help="fidelity weight of the paper instead of --strength")
    _add_attribute(child, defaults)


def _add_interpolate(child: argparse.ArgumentParser, defaults: object) -> None:
    words = ("selected", "unselected", "group")
    child.add_argument("--known", choices=words, help=f"whose values are known ({defaults.known.lower()})")
    child.add_argument("--known-group", metavar="NAME", help="vertex group of the known vertices")
    child.set_defaults(fidelity=None)
    _add_attribute(child, defaults)


def _add_segment(child: argparse.ArgumentParser, defaults: object) -> None:
    add = child.add_argument
    words = [name.lower().replace("_", "-") for name, *_ in OUTPUTS]
    add("--segments", type=int, metavar="N", help="how many segments there shall be")
    add("--length-weight", type=float, help=f"what a border costs for its length ({defaults.length_weight})")
    add("--attribute", metavar="NAME", help="segment this attribute, colour or vertex group, not the shape")
    add(
        "--make", action="append", choices=words, help="what is made of segments; may be repeated (materials)"
    )
    add("--min-faces", type=int, help="join segments of fewer triangles (0: by the noise)")
    add("--method", choices=("fitted", "paper"), help=f"how borders are found ({defaults.method})")
    add("--cut-threshold", type=float, help=f"with --method paper, 0 to 1 ({defaults.cut_threshold})")
    add("--fidelity", type=float, help="fidelity weight of the paper (from the noise of the mesh)")
    add("--epsilon-start", type=float, help=f"first width of borders ({defaults.epsilon_start})")
    add("--epsilon-end", type=float, help=f"last width of borders ({defaults.epsilon_end})")
    scales = ("extent", "bounding_box", "area", "max_edge")
    add("--scale", choices=scales, help=f"unit of the widths ({defaults.scale})")
    add("--ridge-group", metavar="NAME", help="vertex group painted where borders should be")
    add("--avoid-ridges", action="store_true", default=None, help="keep borders away from what is painted")
    add("--solver", choices=("auto", "fast", "clarabel"), help="solver (auto)")
    add("--max-iterations", type=int, help="most solver iterations; 0: left to the solver")


def _add_fill_holes(child: argparse.ArgumentParser, defaults: object) -> None:
    add = child.add_argument
    add("--max-edges", type=int, metavar="N", help="fill holes with at most N edges (0: of any size)")
    add("--outer", action="store_true", default=None, help="fill the outer border of open sheets as well")
    add(
        "--shape",
        choices=("auto", "sharp", "smooth"),
        help=f"what patches look like ({defaults.shape.lower()})",
    )
    add("--sharpness", type=float, help=f"0 to 1, with --shape sharp ({defaults.sharpness})")
    add("--edge-length", type=float, metavar="LENGTH", help="of edges in patches (that around the hole)")
    add("--one-material", action="store_true", help="one material for a patch: that of most of its border")
    add("--mark", action="append", choices=("sharp", "crease", "bevel"), help="mark ridges; may be repeated")
    add("--iterations", type=int, metavar="STEPS", help=f"most flow steps ({defaults.iterations})")
    add("--fidelity", type=float, help=f"fidelity weight of the paper ({defaults.fidelity:g})")
    add("--coupling", choices=("joint", "separate"), help="norm over the coordinates (joint)")


def _add_diffusion_curves(child: argparse.ArgumentParser, defaults: object) -> None:
    add = child.add_argument
    add("--attribute", metavar="NAME", help="color attribute (the active one)")
    add("--image", action="store_true", help="take the colors from the image of the active material")
    words = ("colors", "materials", "attribute")
    add("--regions", choices=words, help=f"what the regions are ({defaults.regions.lower()})")
    add(
        "--region-attribute",
        metavar="NAME",
        help="attribute of whole numbers on faces, for --regions attribute",
    )
    add("--count", type=int, help="number of regions; 0: as many as the colors call for")
    add("--least-faces", type=int, help=f"least triangles of a region ({defaults.least_faces})")
    add("--color-error", type=float, help=f"how much colors on curves may change ({defaults.color_error})")
    add("--rims", action="store_true", default=None, help="the borders of open meshes are curves too")
    add("--fidelity", type=float, help=f"fidelity weight of the paper ({defaults.fidelity:g})")


TOOLS = {
    "stylize": BatchTool(
        Stylization, StylizeSettings, "make meshes piecewise flat, with crisp ridges", _add_stylize
    ),
    "segment": BatchTool(
        Segmenting,
        SegmentSettings,
        "divide meshes into the parts that a person would name: material slots and more",
        _add_segment,
    ),
    "fill-holes": BatchTool(
        HoleFilling, HoleSettings, "fill holes and bring back the ridges that end there", _add_fill_holes
    ),
    "denoise-attribute": BatchTool(
        Denoising,
        DenoiseSettings,
        "smooth an attribute, colour or vertex group, and keep creases",
        _add_denoise,
    ),
    "interpolate-attribute": BatchTool(
        Interpolation,
        InterpolateSettings,
        "spread the known values of an attribute, colour or vertex group over the mesh",
        _add_interpolate,
    ),
    "diffusion-curves": BatchTool(
        DiffusionCurves,
        DiffusionSettings,
        "find the few curves, with a color on each side, that redraw painted meshes",
        _add_diffusion_curves,
    ),
}
"""The tools by the word on the command line."""
