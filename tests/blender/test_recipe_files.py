"""Recipes do what the commands do one after the other; errors name file, line, tool, and key."""

import math
import textwrap
from types import SimpleNamespace

import addon_kit as kit
import batch_kit
import bpy
import hole_kit
import numpy as np
import pytest
from bl_ext.user_default.ridgeform import registry
from bl_ext.user_default.ridgeform.framework import batch, files, flags
from bl_ext.user_default.ridgeform.framework.settings import defaults_of
from bl_ext.user_default.ridgeform.overnight import recipe
from optional_kit import every_optional_number

COMMANDS = {tool.command: tool for tool in registry.TOOLS}
every_tool = pytest.mark.parametrize("tool", registry.TOOLS, ids=list(COMMANDS))

EXAMPLE = textwrap.dedent(recipe.__doc__.split("\n\n", 1)[1].rsplit("\n\n", 1)[0])
"""The recipe that the module shows."""
RECIPE = f"# A comment.\n{EXAMPLE}\nsteps = 2\nmark-angle = 25\n"


def test_a_recipe_does_what_the_commands_do_one_after_the_other(tmp_path, capfd):
    kit.empty_scene()
    hole_kit.box(name="Open")
    kit.bumpy_box("Closed")
    source, text = tmp_path / "in.blend", tmp_path / "recipe.toml"
    files.write_file(source)
    text.write_text(RECIPE)
    outs = [tmp_path / f"{name}.blend" for name in ("filled", "flat", "both")]
    code, _ = batch_kit.run(capfd, "fill-holes", source, "-o", outs[0], "--max-edges", 40)
    assert code == 0
    options = ("--steps", 2, "--strength", 0.6, "--mark", "sharp", "--mark", "bevel", "--mark-angle", 25)
    code, _ = batch_kit.run(capfd, "stylize", outs[0], "-o", outs[1], *options)
    assert code == 0
    code, records = batch_kit.run(capfd, "run", text, source, "-o", outs[2])
    record = records["in.blend"]
    assert code == 0, record
    assert [entry["tool"] for entry in record["meshes"]] == ["fill_holes", "stylize", "stylize"]
    assert (record["energy_before"], record["energy_after"]) == (None, None)
    found = []
    for out in outs[1:]:
        objects = {obj.name: obj for obj in files.read_file(out)}
        marks = [[item.value for item in obj.data.attributes["sharp_edge"].data] for obj in objects.values()]
        found.append(({name: kit.coordinates(obj) for name, obj in objects.items()}, marks))
    assert all(kit.same_bits(found[0][0][name], found[1][0][name]) for name in ("Open", "Closed"))
    assert found[0][1] == found[1][1]


def test_a_step_with_nothing_to_do_is_passed_over(tmp_path, capfd):
    (source,) = batch_kit.boxes(tmp_path / "in", 1)
    text, out = tmp_path / "recipe.toml", tmp_path / "out.ply"
    text.write_text(RECIPE)
    code, records = batch_kit.run(capfd, "run", text, source, "-o", out)
    assert code == 0
    assert any("fill-holes had nothing to do" in note for note in records["box0.ply"]["warnings"])
    batch.flush_output()
    capfd.readouterr()
    assert batch.main(["run", str(text), str(source), "-o", str(out)]) == 0
    assert "vertices" in capfd.readouterr().out
    text.write_text('[[step]]\ntool = "fill-holes"\n')
    code, records = batch_kit.run(capfd, "run", text, source, "-o", out)
    assert code == 1
    assert "has no holes" in records["box0.ply"]["error"]


def test_a_changed_recipe_is_another_run(tmp_path, capfd):
    (source,) = batch_kit.boxes(tmp_path / "in", 1)
    text, out = tmp_path / "recipe.toml", tmp_path / "out"
    for steps, resumed in (("1", False), ("1 # the same", True), ("2", False)):
        text.write_text(f'[[step]]\ntool = "stylize"\nsteps = {steps}\n')
        code, records = batch_kit.run(capfd, "run", text, source, "-o", out, "--resume")
        assert code == 0
        assert records["box0.ply"]["resumed"] == resumed


STYLIZE = '[[step]]\ntool = "stylize"\n'


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "r.toml has no step"),
        ("[[step]\n", "r.toml is no TOML: "),
        ("[step]\ntool = 'stylize'\n", "write each step as a table that begins with [[step]]"),
        ("steps = 3\n" + STYLIZE, 'line 1: "steps" stands outside of a step'),
        ("[[step]]\nsteps = 3\n", "line 1: a step names its tool: tool = "),
        ('\n[[step]]\ntool = "stylise"\n', 'line 3: there is no tool "stylise", but there is "stylize"'),
        (
            STYLIZE + STYLIZE + "strenght = 1\n",
            'line 5: stylize: there is no setting "strenght", but there is "strength"',
        ),
        (STYLIZE + "mark_angle = 1\n", 'no setting "mark_angle", but there is "mark-angle"'),
        (
            STYLIZE + "steps = 1\n" + STYLIZE + "steps = 0\n",
            "line 6: stylize: steps: 0 is out of range: 1 to",
        ),
        (STYLIZE + "steps = 1.5\n", 'line 3: stylize: steps: "1.5" is not a whole number'),
        (STYLIZE + "strength = nan\n", "line 3: stylize: strength: nan is out of range"),
        (STYLIZE + 'strength = "much"\n', 'line 3: stylize: strength is "much": write a number'),
        (STYLIZE + "delaunay = 1\n", "line 3: stylize: delaunay is 1: write true or false"),
        (STYLIZE + 'mark = "sharp"\n', 'line 3: stylize: mark is "sharp": write a list of texts'),
        (STYLIZE + 'mark = ["blunt"]\n', 'line 3: stylize: mark: "blunt" is not one of sharp, crease, bevel'),
        (STYLIZE + "finish = 2030-01-01\n", "line 3: stylize: finish is "),
    ],
)
def test_what_is_wrong_is_said_with_its_line(text, message):
    with pytest.raises(recipe.RecipeError) as caught:
        recipe.parse(text, "r.toml", COMMANDS)
    assert message in str(caught.value)


def test_a_wrong_recipe_is_a_wrong_command_line(tmp_path, capfd):
    (tmp_path / "bad.toml").write_text(STYLIZE + "steps = 0\n")
    for name, message in (("bad.toml", "line 3: stylize: steps: 0"), ("gone.toml", "No such file")):
        assert batch.main(["run", str(tmp_path / name), "x.ply", "-o", str(tmp_path / "out")]) == 2
        assert message in capfd.readouterr().err
    assert not (tmp_path / "out.ridgeform").exists()


def other_value(setting):
    """A value that is not the default, as a panel has it."""
    default = setting.default
    if isinstance(default, set):
        rest = {identifier for identifier, *_ in setting.items} - default
        return rest if default else {setting.items[-1][0]}
    if setting.items:
        return next(identifier for identifier, *_ in reversed(setting.items) if identifier != default)
    if isinstance(default, bool):
        return not default
    if isinstance(default, str):
        return 'My "group" ä\\'
    if isinstance(default, int):
        return default + 3
    high = setting.keywords.get("max", math.inf)
    return default + 0.1 if default + 0.1 <= high else default - 0.1


def counts(tool, name):
    """Whether a setting can be given on the command line."""
    setting = tool.settings.declared[name]
    implied = {other for made in tool.settings.declared.values() for other in made.implies}
    return bool(flags.flags_of(name, setting)) and name not in implied


@every_tool
def test_every_setting_goes_into_a_recipe_and_comes_back(tool):
    for name, setting in tool.settings.declared.items():
        if not counts(tool, name):
            continue
        values = defaults_of(tool.settings, **{**setting.implies, name: other_value(setting)})
        if set(setting.switches.values()) and values.__dict__[name] not in setting.switches.values():
            continue
        text = recipe.step_text(tool, values)
        (step,) = recipe.parse(text, "r.toml", COMMANDS)
        assert step.tool is tool
        for other, value in vars(values).items():
            got = getattr(step.settings, other)
            assert got == (pytest.approx(value, rel=1e-6) if isinstance(value, float) else value), (
                text,
                other,
            )


def test_panels_save_and_load_recipes(tmp_path):
    path = tmp_path / "recipe.toml"
    scene = bpy.context.scene
    scene.ridgeform_holes.max_edges = 40
    scene.ridgeform_stylize.strength = 0.4
    scene.ridgeform_stylize.marks = {"SHARP", "CREASE"}
    scene.ridgeform_stylize.strength_group = "Mask"
    save, load = bpy.ops.ridgeform.save_recipe, bpy.ops.ridgeform.load_recipe
    assert save(filepath=str(path), tool="fill-holes") == {"FINISHED"}
    assert save(filepath=str(path), tool="stylize", append=True) == {"FINISHED"}
    steps = recipe.read(path, COMMANDS)
    assert [step.tool.command for step in steps] == ["fill-holes", "stylize"]
    assert "strength = 0.4\n" in path.read_text()
    kit.empty_scene()
    scene = bpy.context.scene
    scene.ridgeform_stylize.steps = 3
    assert load(filepath=str(path)) == {"FINISHED"}
    assert scene.ridgeform_holes.max_edges == 40
    panel = scene.ridgeform_stylize
    assert (panel.steps, panel.strength_group, panel.marks) == (20, "Mask", {"SHARP", "CREASE"})
    assert panel.strength == np.float32(0.4)
    # A file that is no recipe is neither appended to nor read.
    path.write_text("[[step]]\ntool = 'melt'\n")
    for operator, arguments in ((save, {"tool": "stylize", "append": True}), (load, {})):
        with pytest.raises(RuntimeError, match='there is no tool "melt"'):
            operator(filepath=str(path), **arguments)
    assert path.read_text() == "[[step]]\ntool = 'melt'\n"


def test_a_panel_with_all_values_is_saved_as_it_is(tmp_path):
    for tool in registry.TOOLS:
        panel = getattr(bpy.context.scene, tool.scene_property)
        text = recipe.step_text(tool, panel)
        assert text == f'[[step]]\ntool = "{tool.command}"\n', text
        (step,) = recipe.parse(text, "r.toml", COMMANDS)
        assert vars(step.settings) == vars(defaults_of(tool.settings))
    assert isinstance(step.settings, SimpleNamespace)


@every_optional_number
@pytest.mark.parametrize("counts", [True, False])
@pytest.mark.parametrize("same", [True, False])
def test_an_optional_number_goes_into_a_recipe_with_its_check_box(tool, name, counts, same):
    setting = tool.settings.declared[name]
    given = setting.default if same else other_value(setting)
    values = defaults_of(tool.settings, **setting.implies, **{name: given, f"use_{name}": counts})
    (step,) = recipe.parse(recipe.step_text(tool, values), "r.toml", COMMANDS)
    got = vars(step.settings)
    assert got[f"use_{name}"] is counts
    assert not counts or got[name] == pytest.approx(given, rel=1e-6)


def test_an_angle_that_was_left_alone_stays_so_in_a_recipe():
    tool = next(tool for tool in registry.TOOLS if tool.name == "segment")
    values = defaults_of(tool.settings, length_weight=2.0, angle=0.4)
    (step,) = recipe.parse(recipe.step_text(tool, values), "r.toml", COMMANDS)
    assert (step.settings.length_weight, step.settings.angle) == (2.0, pytest.approx(0.4, rel=1e-6))
