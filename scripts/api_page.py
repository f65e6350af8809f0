"""The API page of the documentation: docstrings of the wheel, signatures of the stubs, and examples."""

import ast
import inspect
import re
import sys

from workspace import ROOT, WHEEL_SITE

EXAMPLES = ROOT / "examples/api.py"
GROUPS = {
    "Meshes": (
        "Mesh", "MeshReport", "find_holes", "Hole", "boundary_loops", "weld", "orient", "remesh", "Remeshed",
        "coarsen", "Coarsened",
    ),
    "Shapes": (
        "stylize", "Stylized", "fill_holes", "Filled", "FilledHole", "segment", "Segmentation",
        "parts", "Parts", "facet", "Faceted", "restore", "Restored",
    ),
    "Functions on surfaces": ("denoise", "interpolate", "vibration_modes", "Solution"),
    "Diffusion curves": (
        "diffusion_curves", "DiffusionCurves", "redraw", "Redrawn", "smooth_curves", "trace_curves",
    ),
    "Operators": (
        "hessian", "hessian_norm", "energy", "voronoi_mass", "cotangent_laplacian", "intrinsic_delaunay",
        "SparseMatrix",
    ),
    "Long calls": ("Progress",),
}  # fmt: skip
"""The headings of the page, and what stands below them; what is in no group comes under "More"."""

SECTION = re.compile(r"^(\w[\w ]*)\n-{3,}$", re.MULTILINE)


def example_cells() -> dict[str, str]:
    """The cells of examples/api.py by the name that they are about."""
    parts = re.split(r"^# %% (\w+)\n", EXAMPLES.read_text(encoding="utf-8"), flags=re.MULTILINE)
    return {name: code.strip() for name, code in zip(parts[1::2], parts[2::2], strict=True)}


def markdown_of(docstring: str) -> str:
    """A docstring in NumPy's style as Markdown: sections in bold, parameters as a list."""
    text = docstring.replace("|", "\\|")
    pieces = SECTION.split(text)
    out = [pieces[0].strip()]
    for title, body in zip(pieces[1::2], pieces[2::2], strict=True):
        entries = re.split(r"\n(?=\S)", body.strip())
        if all(" : " in entry for entry in entries):
            lines = (re.sub(r"\s*\n\s*", " ", entry).split(" : ", 1) for entry in entries)
            entries = [f"- `{name}`: {meaning}" for name, meaning in lines]
        out.append(f"**{title}**\n\n" + "\n".join(entries))
    return "\n\n".join(out)


def entry_of(name: str, node: ast.stmt, thing: object, cells: dict[str, str]) -> str:
    """One entry of the page: heading, signature, documentation, example."""
    parts = [f"### {name}"]
    if isinstance(node, ast.FunctionDef):
        parts.append(f"```python\n{ast.unparse(node).removesuffix(' ...').removesuffix(':')}\n```")
    parts.append(markdown_of(inspect.getdoc(thing) or ""))
    if isinstance(node, ast.ClassDef):
        members = []
        for member in node.body:
            if isinstance(member, ast.AnnAssign):
                called, shown = ast.unparse(member.target), ast.unparse(member.target)
            elif isinstance(member, ast.FunctionDef):
                called = member.name
                shown = f"{called}({', '.join(a.arg for a in member.args.args[1:])})"
            else:
                continue
            if not called.startswith("_"):
                about = (inspect.getdoc(getattr(thing, called)) or "").replace("\n", " ").replace("|", "\\|")
                members.append(f"| `{shown}` | {about} |")
        if members:
            parts.append("\n".join(["| member | |", "|---|---|", *members]))
    if name in cells:
        parts.append(f"```python\n{cells[name]}\n```")
    return "\n\n".join(parts)


def api_page() -> str:
    """The whole page; needs the wheel to be built."""
    if str(WHEEL_SITE) not in sys.path:
        sys.path.insert(0, str(WHEEL_SITE))
    import ridgeform  # noqa: PLC0415

    stubs = [path.read_text(encoding="utf-8") for path in sorted((WHEEL_SITE / "ridgeform").glob("*.pyi"))]
    declared = [node for stub in stubs for node in ast.parse(stub).body]
    nodes = {node.name: node for node in declared if isinstance(node, ast.FunctionDef | ast.ClassDef)}
    cells = example_cells()
    grouped = {name for names in GROUPS.values() for name in names}
    groups = {**GROUPS, "More": tuple(name for name in nodes if name not in grouped)}
    parts = [
        "# Python API",
        (inspect.getdoc(ridgeform) or "").split("\n\nSource:")[0],
        "The examples below run one after the other; this is what they begin with:",
        f"```python\n{cells['prelude']}\n```",
    ]
    for title, names in groups.items():
        if names := [name for name in names if name in nodes]:
            parts.append(f"## {title}")
            parts += [entry_of(name, nodes[name], getattr(ridgeform, name), cells) for name in names]
    errors = ("RidgeformError", "ArgumentError", "MeshError", "SolveError", "Cancelled")
    parts.append("## Errors\n\n| error | |\n|---|---|")
    rows = (
        f"| `{name}` | {' '.join((inspect.getdoc(getattr(ridgeform, name)) or '').split())} |"
        for name in errors
    )
    return "\n\n".join(parts) + "\n" + "\n".join(rows) + "\n"
