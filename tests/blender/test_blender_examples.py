"""The examples for Blender run on an open file as they stand, and save what they promise."""

import runpy
import sys
from pathlib import Path

import bpy
import pytest
from addon_kit import bumpy_box
from hole_kit import box

EXAMPLES = Path(__file__).parents[2] / "examples"


@pytest.fixture
def run(monkeypatch, tmp_path):
    """Run an example on the file that is open; returns the saved file, opened."""

    def run(name):
        target = tmp_path / "result.blend"
        monkeypatch.setattr(sys, "argv", ["blender", "--python", name, "--", str(target)])
        runpy.run_path(str(EXAMPLES / name), run_name="__main__")
        bpy.ops.wm.open_mainfile(filepath=str(target))

    return run


def test_stylize_file(run):
    obj = bumpy_box()
    before = [tuple(vertex.co) for vertex in obj.data.vertices]
    run("blender_stylize_file.py")
    after = [tuple(vertex.co) for vertex in bpy.data.objects["Box"].data.vertices]
    assert len(after) == len(before)
    assert after != before


def test_prepare_scan(run):
    faces = len(box(n=8, radius=0.4).data.polygons)
    run("blender_prepare_scan.py")
    obj = bpy.data.objects["Box"]
    assert len(obj.data.polygons) > faces
    assert len(obj.material_slots) == 6
    assert sum(edge.use_seam for edge in obj.data.edges) >= 12 * 7


def test_levels_of_detail(run):
    triangles = 2 * len(bumpy_box().data.polygons)
    run("blender_levels_of_detail.py")
    levels = [len(bpy.data.objects[f"Box_LOD{level}"].data.polygons) for level in (1, 2, 3)]
    for found, ratio in zip(levels, (0.5, 0.25, 0.1), strict=True):
        # The borders of the box's UV islands stay.
        assert 0.95 * ratio * triangles <= found <= 1.5 * ratio * triangles
