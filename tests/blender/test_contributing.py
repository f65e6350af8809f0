"""The worked example of CONTRIBUTING.md: a copy of the add-on with it has the button, presets and command."""

import re
import shutil
import subprocess
import sys
from pathlib import Path

import ridgeform

ROOT = Path(__file__).parents[2]
BLOCK = re.compile(r"^`([\w/.]+)`:\n\n```python\n(.*?)^```", re.MULTILINE | re.DOTALL)

TRY = """
import sys, types
import bpy
import numpy as np
import ridgeform

def scale_mesh(vertices, factor):
    vertices = np.asarray(vertices, float)
    middle = 0.5 * (vertices.min(axis=0) + vertices.max(axis=0))
    return middle + factor * (vertices - middle)

# In the place of the binding: the wheel that is tested does not have the example's.
ridgeform.scale_mesh = scale_mesh

bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
import addon
addon.register()
from addon.framework import batch, flags

test = {}
exec(open(sys.argv[1]).read(), test)
(check,) = [value for name, value in test.items() if name.startswith("test_")]
check()

settings = bpy.context.scene.ridgeform_scale
assert bpy.ops.ridgeform.shipped_preset(tool="scale", preset="Half") == {"FINISHED"}
assert settings.factor == 0.5
obj = bpy.context.object
coordinates = test["kit"].coordinates
before = coordinates(obj)
assert bpy.ops.ridgeform.scale("INVOKE_DEFAULT", from_panel=True) == {"FINISHED"}
assert np.allclose(coordinates(obj), scale_mesh(before, 0.5), atol=1e-6)
assert issubclass(bpy.types.RIDGEFORM_PT_scale, bpy.types.Panel)
assert hasattr(bpy.types, "RIDGEFORM_OT_scale_preset_add")

options = batch.parser().parse_args(["scale", "in.obj", "-o", "out.obj", "--factor", "5"])
assert flags.settings_from(options, addon.registry.TOOLS[-1].settings).factor == 5.0
addon.unregister()
assert not hasattr(bpy.types, "RIDGEFORM_OT_scale")
"""


def test_the_example_is_a_tool_with_all_that_comes_with_it(tmp_path):
    page = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
    blocks = dict(BLOCK.findall(page))
    feature = {name for name in blocks if name.startswith("addon/scale/")}
    assert feature == {f"addon/scale/{name}.py" for name in ("__init__", "settings", "tool")}
    shutil.copytree(ROOT / "addon", tmp_path / "addon", ignore=shutil.ignore_patterns("__pycache__"))
    for name, text in blocks.items():
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
    registry = tmp_path / "addon/registry.py"
    text = registry.read_text(encoding="utf-8")
    (line,) = re.findall(r"one line: `(.+?)`", page)
    registry.write_text(
        text.replace('    "diffusion",\n', f'    "diffusion",\n    {line}\n'), encoding="utf-8"
    )
    places = [str(tmp_path), str(Path(ridgeform.__file__).parents[1]), str(ROOT / "tests/blender")]
    done = subprocess.run(
        [sys.executable, "-c", TRY, str(tmp_path / "tests/blender/test_scale.py")],
        cwd=tmp_path,
        env={"PYTHONPATH": ":".join(places), "BLENDER_USER_RESOURCES": str(tmp_path), "HOME": str(tmp_path)},
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
