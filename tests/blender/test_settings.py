"""A setting is declared once: its property, row, preset entry, flag and the manual's words agree."""

import argparse
import itertools
import json
import math
import os
import re
import shutil
from pathlib import Path
from types import SimpleNamespace

import bpy
import layout_kit
import pytest
from american_words import british_words
from bl_ext.user_default.ridgeform import registry
from bl_ext.user_default.ridgeform.framework import batch, flags, former, presets, rows
from bl_ext.user_default.ridgeform.framework.settings import defaults_of, setting_names

ROOT = Path(__file__).parents[2]
BEFORE = Path(__file__).with_name("version_0_1_0")
TOOLS = {tool.name: tool for tool in registry.TOOLS}
BY_COMMAND = {tool.command: tool for tool in registry.TOOLS}
BEFORE_PRESETS = sorted((BEFORE / "presets").glob("*.preset"))
WITH_PRESETS = [tool for tool in registry.TOOLS if tool.presets is not None]
every_tool = pytest.mark.parametrize("tool", registry.TOOLS, ids=list(TOOLS))


def settings_of(*arguments):
    options = batch.parser().parse_args([arguments[0], "in.obj", "-o", "out.obj", *arguments[1:]])
    return vars(flags.settings_from(options, BY_COMMAND[arguments[0]].settings))


def plain(value):
    if isinstance(value, set):
        return sorted(value)
    return pytest.approx(value) if isinstance(value, float) else value


def panel_of(tool):
    return getattr(bpy.context.scene, tool.scene_property)


def make_shown(settings, setting, tool):
    """Rows that depend on choices are there for some of their items: choose these; whether there are any."""
    made = {name: made for name, made in tool.settings.declared.items() if isinstance(made.default, str)}
    choices = {name: [identifier for identifier, *_ in one.items] for name, one in made.items() if one.items}
    for chosen_items in itertools.product(*choices.values()):
        vars(settings).update(zip(choices, chosen_items, strict=True))
        if setting.shown(settings):
            return True
    return False


@every_tool
def test_every_setting_has_a_row_in_its_section_once(tool, add_mesh):
    obj = add_mesh([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)])
    settings = defaults_of(tool.settings)
    for name, setting in tool.settings.declared.items():
        number = tool.settings.declared.get(name.removeprefix("use_"))
        row = number if number is not None and number.optional else setting
        if row.shown is not None:
            assert make_shown(settings, row, tool)
        drawn = layout_kit.Layout()
        rows.draw_section(drawn, settings, tool.settings, setting.section, obj)
        assert drawn.rows.count(name) == 1


@every_tool
def test_the_panels_have_the_sections(tool):
    panel = getattr(bpy.types, f"RIDGEFORM_PT_{tool.key}")
    parts = {cls.bl_label for cls in registry.CLASSES if getattr(cls, "bl_parent_id", "") == panel.__name__}
    assert parts == set(rows.sections_of(tool.settings))


def given(word, setting):
    """What to write after a flag, and what that sets: not the default, unless that is 1."""
    if word in setting.switches:
        return [], setting.switches[word]
    if setting.items:
        identifier = setting.items[-1][0]
        words = identifier if identifier.islower() else identifier.lower().replace("_", "-")
        return [words], {identifier} if isinstance(setting.default, set) else identifier
    if isinstance(setting.default, bool):
        return [], not setting.default
    if isinstance(setting.default, str):
        return ["Mine"], "Mine"
    is_angle = setting.keywords.get("subtype") == "ANGLE"
    return ["1"], pytest.approx(math.radians(1.0) if is_angle else 1)


@every_tool
def test_every_value_of_a_setting_can_be_given_on_the_command_line(tool):
    """But those that only say what a window shows."""
    silent = {
        "show",
        "use_fidelity",
        "use_jumps",
        "mode",
        "source",
        "display",
        "output",
        "material",
    }
    for name, setting in tool.settings.declared.items():
        words = flags.flags_of(name, setting)
        assert words or name in silent or name in tool.settings.follows, name
        assert settings_of(tool.command)[name] == setting.default
        for word in words:
            value, expected = given(word, setting)
            got = settings_of(tool.command, word, *value)
            assert got[name] == expected
            for other, implied in setting.implies.items():
                assert got[other] == implied


def renamed(values, tool):
    """Settings of the version before by the names that they have now."""
    followed = {
        name: of(values[other]) for name, (other, of) in tool.settings.follows.items() if other in values
    }
    now = followed | values
    if "use_count" in tool.settings.former and "use_count" in now:
        now["mode"] = "COUNT" if now.pop("use_count") else "AUTO"
    if "reduce" in now:
        # The default of the ratio was another one.
        now |= {"finish": "LOW_POLY" if now["reduce"] else "KEEP"} | {"reduce_ratio": 0.25} | now
        del now["reduce"]
    return now


def test_flags_of_the_version_before_mean_what_they_meant():
    cases = json.loads((BEFORE / "flags.json").read_text(encoding="utf-8"))
    assert len(cases) > 100
    for case in cases:
        arguments = case["arguments"]
        expected = {name: made.default for name, made in BY_COMMAND[arguments[0]].settings.declared.items()}
        expected |= renamed(case["settings"], BY_COMMAND[arguments[0]])
        got = settings_of(*arguments)
        assert {name: plain(value) for name, value in got.items()} == {
            name: plain(value) for name, value in expected.items()
        }, arguments


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("stylize", "--strength", "7"), "argument --strength: 7 is out of range: 0 to 1.5"),
        (("stylize", "--steps", "0"), "argument --steps: 0 is out of range: 1 to 1000"),
        (("stylize", "--steps", "many"), 'argument --steps: "many" is not a whole number'),
        (("stylize", "--fidelity", "nan"), "argument --fidelity: nan is out of range"),
        (("stylize", "--mark-angle", "200"), "argument --mark-angle: 200 is out of range: 0 to 180"),
        (("stylize", "--mark", "blunt"), 'argument --mark: "blunt" is not one of sharp, crease, bevel, none'),
        (("fill-holes", "--edge-length", "-1"), "argument --edge-length: -1 is out of range: at least 0"),
    ],
)
def test_a_value_that_no_slider_takes_is_refused(capsys, arguments, message):
    with pytest.raises(SystemExit):
        settings_of(*arguments)
    assert message in capsys.readouterr().err


def test_repeated_flags_add_up():
    assert settings_of("stylize", "--mark", "sharp", "--mark", "bevel")["marks"] == {"SHARP", "BEVEL"}


@every_tool
def test_help_names_every_flag_with_the_words_of_the_tooltip(tool, capsys):
    with pytest.raises(SystemExit):
        batch.parser().parse_args([tool.command, "--help"])
    text = re.sub(r"-\s+", "-", " ".join(capsys.readouterr().out.split()))
    for name, setting in tool.settings.declared.items():
        word = flags.flag_of(name, setting)
        if word is not None:
            assert word in text
            assert re.sub(r"-\s+", "-", setting.keywords["description"]) in text


def test_a_scene_of_the_version_before_keeps_its_settings():
    bpy.ops.wm.open_mainfile(filepath=str(BEFORE / "scene.blend"))
    saved = json.loads((BEFORE / "settings.json").read_text(encoding="utf-8"))
    by_scene = {tool.scene_property.removeprefix("ridgeform_"): tool for tool in registry.TOOLS}
    assert set(saved) <= set(by_scene)
    # It had no row and no effect.
    del saved["modes"]["coupling"]
    for key, values in saved.items():
        panel = panel_of(by_scene[key])
        for name, value in renamed(values, by_scene[key]).items():
            assert plain(getattr(panel, name)) == value, (key, name)


def test_a_scene_of_the_version_before_keeps_the_ratio_that_it_left_alone(tmp_path):
    panel = bpy.context.scene.ridgeform_stylize
    panel.reduce = True
    for name in ("finish", "reduce_ratio"):
        panel.property_unset(name)
    path = str(tmp_path / "scene.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    panel = bpy.context.scene.ridgeform_stylize
    assert (panel.finish, panel.reduce_ratio) == ("LOW_POLY", 0.25)
    assert not panel.is_property_set("reduce")


@pytest.fixture
def user_presets():
    """The folder of the modeler's presets, empty before and after."""
    folder = Path(bpy.utils.user_resource("SCRIPTS", path="presets/ridgeform", create=True))
    yield folder
    shutil.rmtree(folder)


@pytest.mark.parametrize("path", BEFORE_PRESETS, ids=lambda path: path.stem)
def test_presets_of_the_version_before_load(path, user_presets):
    tool = next(tool for tool in WITH_PRESETS if tool.key == path.stem)
    text = path.read_text(encoding="utf-8")
    path = user_presets / tool.key / "Mine.py"
    path.parent.mkdir()
    path.write_text(text, encoding="utf-8")
    menu = f"RIDGEFORM_MT_{tool.key}_presets"
    assert bpy.ops.script.execute_preset(filepath=str(path), menu_idname=menu) == {"FINISHED"}
    panel = panel_of(tool)
    stored = dict(re.findall(r"^settings\.(\w+) = (.+)$", text, re.MULTILINE))
    read = {name: eval(value) for name, value in stored.items()}
    assert set(stored) <= set(presets.stored_names(tool)) | set(tool.settings.former)
    for name, value in stored.items():
        assert repr(getattr(panel, name)) == value or getattr(panel, name) == eval(value)
    if tool.key == "stylize":
        panel.finish = "KEEP"
        former.take_all()
        assert (panel.finish, panel.reduce_ratio) == ("LOW_POLY", 0.1875)
        assert not panel.is_property_set("reduce")
    former.take_all()
    for name, (other, of) in tool.settings.follows.items():
        if other in read and name not in read:
            assert plain(getattr(panel, name)) == of(read[other]), name


@pytest.mark.parametrize("tool", WITH_PRESETS, ids=[tool.key for tool in WITH_PRESETS])
def test_a_preset_is_saved_loaded_and_removed(tool, user_presets):
    panel = panel_of(tool)
    names = presets.stored_names(tool)
    add = getattr(bpy.ops.ridgeform, f"{tool.key}_preset_add")
    panel.sharpness = 0.125 if "sharpness" in names else None
    changed = {name: getattr(panel, name) for name in names}
    assert add(name="My Own") == {"FINISHED"}
    path = user_presets / tool.key / "My_Own.py"
    for name in names:
        panel.property_unset(name)
    bpy.ops.script.execute_preset(filepath=str(path), menu_idname=f"RIDGEFORM_MT_{tool.key}_presets")
    assert {name: getattr(panel, name) for name in names} == changed
    assert add(name="My Own", remove_name=True) == {"FINISHED"}
    assert not path.exists()


@pytest.mark.parametrize("tool", WITH_PRESETS, ids=[tool.key for tool in WITH_PRESETS])
def test_the_names_of_shipped_presets_are_taken(tool, user_presets):
    add = getattr(bpy.ops.ridgeform, f"{tool.key}_preset_add")
    for name in tool.presets:
        assert add(name=name) == {"CANCELLED"}
    assert not list(user_presets.rglob("*.py"))


@pytest.mark.parametrize("tool", WITH_PRESETS, ids=[tool.key for tool in WITH_PRESETS])
def test_shipped_and_own_presets_are_listed(tool, user_presets):
    def listed():
        layout, paths = layout_kit.Layout(), []
        popover = SimpleNamespace(layout=layout, tool=tool, path_menu=lambda *a, **k: paths.append((a, k)))
        presets._PresetList.draw(popover, bpy.context)
        (((folders, operator), more),) = paths
        assert operator == "script.execute_preset"
        files = [Path(name) for folder in folders for name in os.listdir(folder)]
        return layout.buttons, [path.name for path in files if more["filter_ext"](path.suffix)]

    shipped = [("ridgeform.shipped_preset", name) for name in tool.presets]
    assert listed() == ([*shipped, ("ridgeform.save_defaults", "")], [])
    assert getattr(bpy.ops.ridgeform, f"{tool.key}_preset_add")(name="Mine") == {"FINISHED"}
    assert listed()[1] == ["Mine.py"]


@pytest.mark.parametrize("tool", WITH_PRESETS, ids=[tool.key for tool in WITH_PRESETS])
def test_shipped_presets_are_whole(tool):
    panel = panel_of(tool)
    scope = {name for values in tool.presets.values() for name in values}
    for name in tool.presets:
        for setting in setting_names(tool.settings):
            panel.property_unset(setting)
        assert bpy.ops.ridgeform.shipped_preset(tool=tool.name, preset=name) == {"FINISHED"}
        wanted = tool.preset_values(name)
        assert set(wanted) == scope <= set(presets.stored_names(tool))
        for setting, value in wanted.items():
            assert plain(getattr(panel, setting)) == plain(value)


def pages():
    return {path.name: path.read_text(encoding="utf-8") for path in (ROOT / "docs").glob("manual*.md")}


def test_the_manual_names_every_setting_and_every_flag():
    manual = "".join(pages().values())
    options = {
        "--output",
        "--format",
        "--json",
        "--jobs",
        "--memory",
        "--timeout",
        "--resume",
        "--report",
        "--dask",
        "--pictures",
    }
    for tool in registry.TOOLS:
        for name, setting in tool.settings.declared.items():
            assert setting.label in manual, f"the setting {setting.label} is not in the manual"
            options |= set(flags.flags_of(name, setting))
    for command in registry.COMMANDS:
        parser = argparse.ArgumentParser(add_help=False)
        command.add_arguments(parser)
        options |= {word for word in parser._option_string_actions if word.startswith("--")}
    for option in options:
        assert f"`{option}" in manual, f"{option} is not in the manual"
    for option in re.findall(r"`(--[a-z][a-z-]*)", manual):
        assert option in options, f"the command has no {option}"


@every_tool
def test_the_words_are_blenders(tool):
    """American, and as Blender writes them: titles in title case, no full stop at the end of a tooltip."""
    texts = [tool.description]
    for setting in tool.settings.declared.values():
        assert setting.label == setting.label.title(), setting.label
        texts += [setting.label, setting.keywords["description"], *(text for *_, text in setting.items)]
    for text in texts:
        assert british_words(text) == []
        assert text[0].isupper(), text
        assert not text.endswith("."), text


MANUALS = {
    "manual.md": ["stylize"],
    "manual_holes.md": ["fill_holes"],
    "manual_segment.md": ["segment"],
    "manual_restore.md": ["restore"],
    "manual_attributes.md": ["denoise_attribute", "interpolate_attribute", "vibration_modes"],
    "manual_diffusion_curves.md": ["diffusion_curves"],
}


def words_of_default(setting):
    """The defaults as the manual may write them."""
    value = setting.default
    if isinstance(value, bool):
        return {"on" if value else "off"}
    if setting.optional and not setting.used:
        return {"off"}
    if setting.used:
        return {f"on, {flags.default_text(setting.but(implies={}))}"}
    if isinstance(value, set):
        return {", ".join(label for identifier, label, _ in setting.items if identifier in value)}
    if setting.items:
        return {label for identifier, label, _ in setting.items if identifier == value}
    return {flags.default_text(setting.but(implies={})) if value != "" else "the active one", str(value)}


def default_rows(page):
    """Labels and defaults in the tables of a page that have defaults."""
    counting = False
    for line in page.splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if not line.startswith("|"):
            counting = False
        elif cells[-1] == "default":
            counting = True
        elif counting and cells[-1] not in {"---", ""}:
            labels, defaults = cells[0].split(", "), cells[-1].split(", ")
            yield from zip(labels, defaults if len(labels) > 1 else [cells[-1]], strict=True)


@pytest.mark.parametrize("page", list(MANUALS))
def test_the_defaults_in_the_tables_of_the_manual_are_those_of_the_settings(page):
    declared = [made for name in MANUALS[page] for made in TOOLS[name].settings.declared.values()]
    found = 0
    for label, default in default_rows(pages()[page]):
        named = [made for made in declared if made.label == label]
        assert named, f"{page} has a row {label}, which is no setting"
        assert any(default in words_of_default(made) for made in named), (label, default)
        found += 1
    assert found > 2
