"""What the documentation says to type works: the Python of the recipes, and every command line."""

import re
import shlex
from pathlib import Path

import bpy
import numpy as np
import pytest
import ridgeform
from addon_kit import coordinates, set_coordinates
from bl_ext.user_default.ridgeform.framework import batch
from hole_kit import box
from known_shapes import shapes

DOCS = Path(__file__).parents[2] / "docs"
PAGES = [DOCS.parent / "README.md", *sorted(DOCS.glob("*.md"))]
SECTIONS = re.findall(
    r"^## ([^\n]+)\n(.*?)(?=^## |\Z)",
    (DOCS / "recipes.md").read_text(encoding="utf-8"),
    re.MULTILINE | re.DOTALL,
)
RECIPES = [
    (title, code)
    for title, section in SECTIONS
    for code in re.findall(r"^```python\n(.*?)^```", section, re.MULTILINE | re.DOTALL)
]
"""Every Python block, with the recipe that it is in."""


def painted_box_with_a_hole():
    """A box of quads with a hole at an edge, colors in two halves, and a vertex group of a few weights."""
    obj = box(n=8, radius=0.3)
    bumps = np.random.default_rng(0).normal(scale=0.004, size=coordinates(obj).shape)
    set_coordinates(obj, coordinates(obj) + bumps)
    colors = obj.data.color_attributes.new("Paint", "FLOAT_COLOR", "POINT")
    above = np.array([vertex.co.z > 0 for vertex in obj.data.vertices])
    colors.data.foreach_set("color", np.where(above[:, None], [1, 1, 1, 1], [0.1, 0.2, 0.8, 1]).ravel())
    group = obj.vertex_groups.new(name="Weights")
    for vertex in obj.data.vertices:
        if vertex.index % 10 == 0:
            group.add([vertex.index], float(vertex.co.z > 0), "REPLACE")
    return obj


@pytest.mark.parametrize(("title", "code"), RECIPES, ids=[title for title, _ in RECIPES])
def test_the_python_of_a_recipe_runs(title, code):
    obj = painted_box_with_a_hole()
    if title.startswith("Weights"):
        obj.data.color_attributes.remove(obj.data.color_attributes[0])
    exec(code, {"bpy": bpy})
    assert obj.mode == "OBJECT"
    if "fill_holes" in code:
        edges = np.array([edge for face in obj.data.polygons for edge in face.edge_keys])
        assert (np.unique(edges, axis=0, return_counts=True)[1] == 2).all()
    if "SEAMS" in code:
        assert sum(edge.use_seam for edge in obj.data.edges) > 50
        assert obj.data.uv_layers
    if "VERTEX_GROUPS" in code:
        assert len([group for group in obj.vertex_groups if group.name.startswith("ridgeform_segment")]) > 3
    if "diffusion" in code:
        assert any(child.type == "CURVES" for child in obj.children)
    if "FACETS" in code or ".facet(" in code:
        assert len(obj.data.polygons) < 100
    if ".restore(" in code:
        assert all(max(map(abs, face.normal)) > 0.9999 for face in obj.data.polygons)
        assert [child.type for child in obj.children] == ["EMPTY"] * 6


def test_all_recipes_with_python_are_found():
    assert len(RECIPES) >= 11


def python_of(page):
    """The Python blocks of a page."""
    text = (DOCS / page).read_text(encoding="utf-8")
    return re.findall(r"^```python\n(.*?)^```", text, re.MULTILINE | re.DOTALL)


def test_the_python_of_the_manual_runs(tmp_path):
    box(n=8)
    (code,) = python_of("manual.md")
    bpy.context.scene.ridgeform_stylize.steps = 7
    exec(code.replace("/tmp/", tmp_path.as_posix() + "/"), {"bpy": bpy})
    assert "steps = 7" in (tmp_path / "recipe.toml").read_text(encoding="utf-8")


def test_the_python_on_diffusion_curves_runs():
    vertices, faces = shapes.subdivide(*shapes.cube(4))
    colors = np.where(vertices[:, 2:] > 0.3, [1.0, 0.2, 0.1], [0.1, 0.2, 0.9])
    names = {"ridgeform": ridgeform, "mesh": ridgeform.Mesh(vertices, faces), "colors": colors}
    angle = np.linspace(0.0, 2.0, 30)
    names["points"] = np.column_stack([np.cos(angle), np.sin(angle), np.full_like(angle, 0.3)])
    for code in python_of("manual_diffusion_curves.md"):
        exec(code, names)
    assert len(names["found"].edges) > 10
    assert len(names["vertices"]) > 1


def test_no_page_has_python_that_is_not_run():
    """README and CONTRIBUTING have tests of their own, and so has the page on tiles: it needs no Blender."""
    pages = {page.name for page in PAGES if "```python" in page.read_text(encoding="utf-8")}
    assert pages == {"README.md", "manual.md", "manual_diffusion_curves.md", "manual_tiles.md", "recipes.md"}


def command_lines():
    """Every call of the batch command in the documentation, on a line or within one, with its page."""
    call = re.compile(r"^(?:blender --command ridgeform|PYTHONPATH=\S+ \S+ -m addon) (.+)$", re.M)
    within = re.compile(r"`blender --command ridgeform ([^`]+)`")
    for page in PAGES:
        text = page.read_text(encoding="utf-8")
        for line in call.findall(text) + [" ".join(line.split()) for line in within.findall(text)]:
            yield page.name, line


@pytest.mark.parametrize(("page", "line"), sorted(set(command_lines())))
def test_the_command_understands_every_command_line(page, line):
    words = shlex.split(line.replace("[options]", ""))
    options = batch.parser().parse_args(words)
    assert options.files
