"""A zip over that of the version before: presets and scenes load, tools run, and the console stays clean."""

import json
import os
import zipfile
from pathlib import Path

import ridgeform
from own_blender import run_in_blender

FORMER = "0.0.1"

SHARED = """
import json, os, sys
from pathlib import Path
import bpy

ZIP, FOLDER = sys.argv[1], Path(sys.argv[2])
NAME = "bl_ext.user_default.ridgeform"
bpy.ops.extensions.package_install_files(filepath=ZIP, repo="user_default", enable_on_install=True)
assert NAME in bpy.context.preferences.addons
registry = sys.modules[NAME + ".registry"]

def panel_of(tool):
    return getattr(bpy.context.scene, tool.scene_property)

def plain(value):
    return sorted(value) if isinstance(value, set) else round(value, 5) if isinstance(value, float) else value

def other_than(setting):
    default = setting.default
    if setting.items:
        last = setting.items[-1][0]
        return {last} if isinstance(default, set) else last
    if isinstance(default, (bool, str)):
        return not default if isinstance(default, bool) else "Mine"
    high = setting.keywords.get("max", setting.keywords.get("soft_max", 3))
    return min(2 * default, high) if default else min(3, high)

def values_of(tool, names):
    return {name: plain(getattr(panel_of(tool), name)) for name in names}

def changed(tool, was):
    # Of the settings that there still are: values before and now.
    now = values_of(tool, [name for name in was if name in tool.settings.declared])
    return {name: (was[name], value) for name, value in now.items() if value != was[name]}

"""

BEFORE = """
from importlib import import_module
presets = import_module(NAME + ".framework.presets")
saved = {}
for tool in registry.TOOLS:
    for name, setting in tool.settings.declared.items():
        setattr(panel_of(tool), name, other_than(setting))
    stored = presets.stored_names(tool) if tool.presets is not None else []
    saved[tool.scene_property] = {"scene": values_of(tool, tool.settings.declared), "preset": None}
    if stored:
        assert getattr(bpy.ops.ridgeform, f"{tool.key}_preset_add")(name="Mine") == {"FINISHED"}
        saved[tool.scene_property]["preset"] = values_of(tool, stored)
bpy.ops.mesh.primitive_uv_sphere_add(segments=12, ring_count=8)
bpy.ops.wm.save_as_mainfile(filepath=str(FOLDER / "scene.blend"))
(FOLDER / "saved.json").write_text(json.dumps(saved))
sys.stdout.flush()
# How the version before ends is no matter here.
os._exit(0)
"""

AFTER = """
import ridgeform
from ridgeform import __version__
from bl_ext.user_default.ridgeform.framework.wheel import misfit
assert misfit() is None
saved = json.loads((FOLDER / "saved.json").read_text())
bpy.ops.wm.open_mainfile(filepath=str(FOLDER / "scene.blend"))
tools = {tool.scene_property: tool for tool in registry.TOOLS}
gone = sorted(set(saved) - set(tools))
assert not gone, gone
compared, differing = 0, {}
for key, was in saved.items():
    tool = tools[key]
    gone += [f"{key}.{name}" for name in was["scene"] if name not in tool.settings.declared]
    differing |= {f"scene {key}.{name}": pair for name, pair in changed(tool, was["scene"]).items()}
    compared += len(was["scene"])
    if was["preset"] is not None:
        for name in tool.settings.declared:
            panel_of(tool).property_unset(name)
        folder = Path(bpy.utils.user_resource("SCRIPTS", path=f"presets/ridgeform/{tool.key}"))
        path = str(folder / "Mine.py")
        menu = f"RIDGEFORM_MT_{tool.key}_presets"
        assert bpy.ops.script.execute_preset(filepath=path, menu_idname=menu) == {"FINISHED"}
        differing |= {f"preset {key}.{name}": pair for name, pair in changed(tool, was["preset"]).items()}
        compared += len(was["preset"])
    for name in tool.settings.declared:
        panel_of(tool).property_unset(name)
obj = bpy.context.object
assert bpy.ops.ridgeform.stylize(steps=1) == {"FINISHED"}
assert bpy.ops.ridgeform.facet(mode="COUNT", facets=12) == {"FINISHED"}
assert len(obj.data.polygons) == 12
repos = bpy.context.preferences.extensions.repos
index = [repo.module for repo in repos].index("user_default")
bpy.ops.extensions.package_uninstall(repo_index=index, pkg_id="ridgeform")
(FOLDER / "compared.json").write_text(json.dumps([compared, differing, gone]))
"""


def as_version(path: Path, version: str, folder: Path) -> Path:
    """The same extension as another version, add-on and wheel."""
    made = folder / "former.zip"
    with zipfile.ZipFile(path) as old, zipfile.ZipFile(made, "w") as new:
        (wheel,) = [name for name in old.namelist() if name.startswith("wheels/ridgeform-")]
        is_of = wheel.split("-")[1]
        renamed = wheel.replace(f"-{is_of}-", f"-{version}-")
        for name in old.namelist():
            data = old.read(name)
            if name == "blender_manifest.toml":
                text = data.decode().replace(wheel, renamed)
                number, new_number = is_of.partition("+")[0], version.partition("+")[0]
                data = text.replace(f'version = "{number}"', f'version = "{new_number}"', 1).encode()
            if name == wheel:
                data = _wheel_as(data, is_of, version, folder)
            new.writestr(renamed if name == wheel else name, data)
    return made


def _wheel_as(data: bytes, is_of: str, version: str, folder: Path) -> bytes:
    given, made = folder / "given.whl", folder / "made.whl"
    given.write_bytes(data)
    with zipfile.ZipFile(given) as old, zipfile.ZipFile(made, "w") as new:
        for name in old.namelist():
            part = old.read(name)
            if name == "ridgeform/__init__.py":
                part += f'\n__version__ = "{version.partition("+")[0]}"\nIS_FORMER = True\n'.encode()
            if name.endswith(("METADATA", "RECORD")):
                part = part.decode().replace(is_of, version).encode()
            new.writestr(name.replace(f"ridgeform-{is_of}", f"ridgeform-{version}"), part)
    return made.read_bytes()


def test_a_zip_over_the_version_before(extension_zip, tmp_path):
    """`RIDGEFORM_FORMER_EXTENSION` names a zip of a version before; else it is this one by another number."""
    former = Path(os.environ.get("RIDGEFORM_FORMER_EXTENSION", extension_zip))
    run_in_blender(SHARED + BEFORE, tmp_path, as_version(former, FORMER, tmp_path), tmp_path)
    said, complained = run_in_blender(SHARED + AFTER, tmp_path, extension_zip, tmp_path)
    assert complained == ""
    assert not [line for line in said.splitlines() if any(w in line for w in ("rror", "arning", "raceback"))]
    compared, differing, gone = json.loads((tmp_path / "compared.json").read_text(encoding="utf-8"))
    assert compared > 150
    assert differing == {}
    assert former != extension_zip or gone == []


OVER = """
import sys
import bpy
former, this = sys.argv[1:]
NAME = "bl_ext.user_default.ridgeform"
def installed(path):
    bpy.ops.extensions.package_install_files(filepath=path, repo="user_default", enable_on_install=True)
    assert NAME in bpy.context.preferences.addons
if former:
    installed(former)
    import ridgeform
    assert ridgeform.IS_FORMER and hasattr(bpy.types, "RIDGEFORM_OT_stylize")
installed(this)
assert hasattr(bpy.types, "RIDGEFORM_PT_restart") == bool(former)
assert hasattr(bpy.types, "RIDGEFORM_OT_stylize") != bool(former)
import ridgeform
assert hasattr(ridgeform, "IS_FORMER") == bool(former), ridgeform.__build__
"""


def test_a_zip_over_another_build_of_its_version(extension_zip, tmp_path):
    """Blender keeps a wheel of the same version, so that every build has one of its own.

    In the session in which it is installed the former one stays loaded, and a panel says to start again.
    """
    former = as_version(extension_zip, f"{ridgeform.__version__}+0", tmp_path)
    said, _ = run_in_blender(OVER, tmp_path, former, extension_zip)
    assert "Restart Blender" in said
    run_in_blender(OVER, tmp_path, "", extension_zip)
