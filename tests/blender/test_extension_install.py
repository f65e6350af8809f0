"""The installed extension: enabled, used, disabled and enabled again, removed."""

import importlib
import importlib.metadata
import sys
from pathlib import Path

import bpy
import fast_simplification
import numpy as np
import pytest
import ridgeform
from bl_ext.user_default.ridgeform.framework import job
from blender_profile import EXTENSION
from known_shapes import shapes
from own_blender import run_in_blender


def test_enabled_from_the_profile(profile):
    assert EXTENSION in bpy.context.preferences.addons
    assert Path(sys.modules[EXTENSION].__file__).is_relative_to(profile)
    assert Path(ridgeform.__file__).is_relative_to(profile)


def test_wheel_is_of_the_manifests_version(extension_zip):
    assert ridgeform.__version__ in extension_zip.name
    assert importlib.metadata.version("ridgeform") == ridgeform.__build__
    number, _, build = ridgeform.__build__.partition("+")
    assert (number, len(build)) == (ridgeform.__version__, 12)


def test_bundled_simplification_runs():
    vertices, faces = shapes.icosphere(3)
    points, triangles = fast_simplification.simplify(
        vertices.astype(np.float64), faces.astype(np.int32), target_reduction=0.5
    )
    assert 0 < len(triangles) <= 0.55 * len(faces)
    assert np.isfinite(points).all()


def test_stylize_through_the_installed_operator(add_mesh):
    vertices, faces = shapes.cube(6)
    vertices = vertices + np.random.default_rng(0).normal(scale=0.03, size=vertices.shape)
    obj = add_mesh(vertices, faces, "Box")
    assert bpy.ops.ridgeform.stylize() == {"FINISHED"}
    (summary,) = job.last_summary()
    assert summary["name"] == "Box"
    assert summary["energy_after"] < 0.95 * summary["energy_before"]
    moved = np.array([vertex.co for vertex in obj.data.vertices])
    assert np.isfinite(moved).all()
    assert np.abs(moved - vertices).max() > 1e-3


@pytest.mark.usefixtures("empty_file")
def test_disable_and_enable_again():
    assert bpy.ops.preferences.addon_disable(module=EXTENSION) == {"FINISHED"}
    assert EXTENSION not in bpy.context.preferences.addons
    assert not hasattr(bpy.types, "RIDGEFORM_OT_stylize")
    assert bpy.ops.preferences.addon_enable(module=EXTENSION) == {"FINISHED"}
    assert EXTENSION in bpy.context.preferences.addons
    assert hasattr(bpy.types, "RIDGEFORM_OT_stylize")


LIFE = """
import sys
import bpy
name = "bl_ext.user_default.ridgeform"
install = bpy.ops.extensions.package_install_files
for turn in range(2):
    install(filepath=sys.argv[1], repo="user_default", enable_on_install=True)
    assert name in bpy.context.preferences.addons, f"not enabled in turn {turn}"
repos = bpy.context.preferences.extensions.repos
index = [repo.module for repo in repos].index("user_default")
bpy.ops.extensions.package_uninstall(repo_index=index, pkg_id="ridgeform")
assert name not in bpy.context.preferences.addons, "still enabled"
assert not hasattr(bpy.types, "RIDGEFORM_OT_stylize"), "still registered"
"""


def test_install_over_itself_and_remove(extension_zip, tmp_path):
    """In a Blender of its own, because a module that is loaded stays loaded."""
    run_in_blender(LIFE, tmp_path, extension_zip)
    assert not list(tmp_path.rglob("_native*")), "the wheel was left behind"


@pytest.mark.parametrize(("name", "call"), [("job", "last_summary"), ("check", "last"), ("batch", "main")])
def test_what_scripts_ask_is_found_by_import(name, call):
    module = importlib.import_module(f"{EXTENSION}.{name}")
    assert callable(getattr(module, call))
    assert getattr(sys.modules[EXTENSION], name) is module
