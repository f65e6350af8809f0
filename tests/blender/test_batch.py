"""The batch command: many formats, one record each, bad files among good ones.

In a process of its own: Blender 4.2's glTF exporter sets the scene of the window, and after an undo that
crashes now and then.
"""

import json

import addon_kit as kit
import bpy
import hole_kit
import numpy as np
import pytest
from batch_kit import records
from bl_ext.user_default.ridgeform.blender import mesh_io
from bl_ext.user_default.ridgeform.framework import batch, files
from known_shapes import limbs

STEPS = ("--steps", "2")


def run(capfd, *arguments):
    """Exit code and records of Stylize."""
    return records(capfd, "stylize", *arguments, *STEPS)


def saved(folder, *suffixes):
    """A box with noise, saved in some formats."""
    kit.empty_scene()
    kit.bumpy_box()
    paths = [folder / f"box{suffix}" for suffix in suffixes]
    for path in paths:
        files.write_file(path)
    return paths


@pytest.mark.parametrize("suffix", list(files.FORMATS))
def test_every_format_is_read_and_written(tmp_path, capfd, suffix):
    (source,) = saved(tmp_path, suffix)
    target = tmp_path / "made" / f"flat{suffix}"
    # glTF splits vertices at sharp edges.
    code, (record,) = run(capfd, source, "-o", target, "--mark", "none")
    assert code == 0, record
    assert record["error"] is None
    assert record["output"] == str(target)
    assert record["energy_after"] < record["energy_before"]
    assert record["vertices"] >= 152
    (obj,) = files.read_file(target)
    assert len(obj.data.vertices) == record["vertices"]


def test_one_bad_file_does_not_stop_the_others(tmp_path, capfd):
    good = saved(tmp_path, ".obj", ".ply")
    bad = tmp_path / "bad.obj"
    bad.write_text("this is no mesh\n")
    gone, odd = tmp_path / "gone.stl", tmp_path / "odd.txt"
    odd.write_text("odd")
    code, records = run(capfd, bad, good[0], gone, odd, good[1], "-o", tmp_path / "out")
    assert code == 1
    assert [record["file"] for record in records] == list(map(str, (bad, good[0], gone, odd, good[1])))
    errors = [record["error"] for record in records]
    assert errors[1] is errors[4] is None
    assert "holds no mesh" in errors[0]
    assert "does not exist" in errors[2]
    assert "cannot be read" in errors[3]
    assert sorted(path.name for path in (tmp_path / "out").glob("box.*")) == ["box.mtl", "box.obj", "box.ply"]


def test_all_meshes_of_a_file_are_stylized(tmp_path, capfd):
    first, second = kit.bumpy_box("A", 1), kit.bumpy_box("B", 2)
    kit.link(bpy.data.objects.new("C", first.data))
    kit.add_object("Points", [[0, 0, 0]], [])
    old = {obj.name: kit.coordinates(obj) for obj in (first, second)}
    source, target = tmp_path / "scene.blend", tmp_path / "flat.blend"
    files.write_file(source)
    code, (record,) = run(capfd, source, "-o", target)
    assert code == 0
    assert [entry["name"] for entry in record["meshes"]] == ["A", "B"]
    assert record["warnings"][-1] == '"Points" has no faces'
    files.read_file(target)
    for name, before in old.items():
        assert (kit.coordinates(bpy.data.objects[name]) != before).any()


def test_options_reach_the_tool(tmp_path, capfd):
    (source,) = saved(tmp_path, ".blend")
    target = tmp_path / "flat.blend"
    options = ("--shape-key", "--keep-volume", "--mark", "sharp", "--mark-angle", "30", "--fidelity", "700")
    code, (record,) = run(capfd, source, "-o", target, *options)
    assert code == 0, record
    (obj,) = files.read_file(target)
    assert list(obj.data.shape_keys.key_blocks.keys()) == ["Basis", "Stylized"]
    assert any(item.value for item in obj.data.attributes["sharp_edge"].data)


def test_another_format_into_a_folder(tmp_path, capfd):
    sources = saved(tmp_path, ".obj", ".ply")
    code, records = run(capfd, sources[0], "-o", tmp_path / "out", "--format", "stl")
    assert code == 0
    assert records[0]["output"] == str(tmp_path / "out" / "box.stl")
    code, records = run(capfd, *sources, "-o", tmp_path / "out", "--format", "stl")
    assert code == 1
    assert "already the output of another file" in records[1]["error"]


def test_the_input_is_never_overwritten(tmp_path, capfd):
    (source,) = saved(tmp_path, ".obj")
    content = source.read_bytes()
    code, (record,) = run(capfd, source, "-o", tmp_path)
    assert code == 1
    assert "would be overwritten" in record["error"]
    assert source.read_bytes() == content


def test_plain_output_and_wrong_command_line(tmp_path, capfd):
    (source,) = saved(tmp_path, ".obj")
    batch.flush_output()
    capfd.readouterr()
    assert batch.main(["stylize", str(source), "-o", str(tmp_path / "flat.obj"), *STEPS]) == 0
    assert "152 vertices, energy" in capfd.readouterr().out
    assert batch.main(["stylize", str(source)]) == 2
    assert batch.main(["melt", str(source)]) == 2
    assert batch.main(["--help"]) == 0


def warmed(folder):
    """A box with an attribute whose selected vertices are known, saved."""
    kit.empty_scene()
    obj = kit.bumpy_box()
    n = len(obj.data.vertices)
    values = np.random.default_rng(0).random(n).astype(np.float32)
    obj.data.attributes.new("heat", "FLOAT", "POINT").data.foreach_set("value", values)
    kit.select_only(obj, np.arange(n) % 3 == 0)
    bpy.ops.object.mode_set(mode="OBJECT")
    path = folder / "warm.blend"
    files.write_file(path)
    return path


@pytest.mark.parametrize(
    ("command", "options", "name"),
    [
        ("denoise-attribute", ("--strength", "0.7", "--energy", "l2_curved_hessian"), "heat_denoised"),
        ("denoise-attribute", ("--fidelity", "20", "--in-place"), "heat"),
        (
            "interpolate-attribute",
            ("--known", "unselected", "--material", "--bands", "5"),
            "heat_interpolated",
        ),
    ],
)
def test_attributes_of_files(tmp_path, capfd, command, options, name):
    source, target = warmed(tmp_path), tmp_path / "out.blend"
    code, (record,) = records(capfd, command, source, "-o", target, "--attribute", "heat", *options)
    assert code == 0, record
    (entry,) = record["meshes"]
    assert (entry["attribute"], entry["result"]) == ("heat", name)
    assert record["gap"] <= 1e-3
    assert (record["energy_before"] is None) == (command == "interpolate-attribute")
    (obj,) = files.read_file(target)
    assert name in obj.data.attributes
    assert len(obj.data.materials) == ("--material" in options)


def test_segments_of_files(tmp_path, capfd):
    kit.empty_scene()
    kit.bumpy_box(cuts=6, noise=0.01)
    source, target = tmp_path / "box.blend", tmp_path / "out.blend"
    files.write_file(source)
    options = ("--make", "materials", "--make", "seams", "--length-weight", "0.6")
    code, (record,) = records(capfd, "segment", source, "-o", target, *options)
    assert code == 0, record
    assert (record["energy_after"], record["gap"]) == (None, None)
    (entry,) = record["meshes"]
    assert entry["segments"] == 6
    assert entry["possible"][0] <= 6 <= entry["possible"][1]
    (obj,) = files.read_file(target)
    assert len(obj.data.materials) == 6
    assert sum(edge.use_seam for edge in obj.data.edges) == 12 * 7
    code, (record,) = records(
        capfd, "segment", source, "-o", target, "--segments", "3", "--make", "face-sets"
    )
    assert record["meshes"][0]["segments"] == 3
    (obj,) = files.read_file(target)
    assert len(obj.data.materials) == 0
    batch.flush_output()
    capfd.readouterr()
    assert batch.main(["segment", str(source), "-o", str(target)]) == 0
    assert "vertices, 6 segments, " in capfd.readouterr().out


def test_parts_of_files_as_objects_that_are_closed(tmp_path, capfd):
    kit.empty_scene()
    vertices, faces, _ = limbs.ball_with_limbs(4)
    kit.add_object("Ball", vertices, faces.tolist())
    source, target = tmp_path / "ball.obj", tmp_path / "parts.blend"
    files.write_file(source)
    options = ["--kind", "parts", "--segments", "4", "--make", "objects", "--use-caps"]
    code, (record,) = records(capfd, "segment", source, "-o", target, *options)
    assert code == 0, record
    (entry,) = record["meshes"]
    assert entry["segments"] == 4
    assert entry["possible"][0] == 1
    meshes = [item.data for item in files.read_file(target) if item.type == "MESH"]
    assert len(meshes) == 4
    for mesh in meshes:
        faces_of_edges = np.bincount(mesh_io.corner_edges(mesh), minlength=len(mesh.edges))
        assert (faces_of_edges == 2).all()


def test_holes_of_files(tmp_path, capfd):
    kit.empty_scene()
    hole_kit.box(name="Open")
    hole_kit.sheet()
    kit.bumpy_box("Closed")
    source, target = tmp_path / "open.blend", tmp_path / "filled.blend"
    files.write_file(source)
    shape = ("--shape", "sharp", "--sharpness", "0.75", "--one-material", "--mark", "sharp")
    code, (record,) = records(capfd, "fill-holes", source, "-o", target, "--max-edges", "40", *shape)
    assert code == 0, record
    entries = {entry["name"]: entry for entry in record["meshes"]}
    assert set(entries) == {"Open", "Sheet"}
    assert [entries[name]["holes"] for name in ("Open", "Sheet")] == [1, 1]
    assert entries["Open"]["ridge_edges"] > 0
    assert record["faces"] == sum(entry["faces"] for entry in entries.values())
    assert '"Closed" has no holes' in record["warnings"]
    assert any("outer border" in warning for warning in record["warnings"])
    loaded = {obj.name: obj for obj in files.read_file(target)}
    assert len(loaded["Open"].data.polygons) == entries["Open"]["faces"]
    assert any(item.value for item in loaded["Open"].data.attributes["sharp_edge"].data)


def test_a_file_without_holes_is_an_error(tmp_path, capfd):
    (source,) = saved(tmp_path, ".ply")
    code, (record,) = records(capfd, "fill-holes", source, "-o", tmp_path / "out.ply")
    assert code == 1
    assert "has no holes" in record["error"]


def test_an_attribute_that_is_not_there_is_an_error_of_its_file(tmp_path, capfd):
    source = warmed(tmp_path)
    code, (record,) = records(
        capfd, "denoise-attribute", source, "-o", tmp_path / "out.blend", "--attribute", "cold"
    )
    assert code == 1
    assert record["error"] == '"Box" has no attribute or vertex group "cold"'
    assert not (tmp_path / "out.blend").exists()


def test_checking_files_says_what_is_wrong_and_writes_nothing(tmp_path, capfd):
    kit.empty_scene()
    kit.add_object("Fan", *kit.BAD_MESHES["three faces at an edge"])
    files.write_file(tmp_path / "fan.ply")
    (good,) = saved(tmp_path, ".blend")
    before = {path: path.read_bytes() for path in tmp_path.iterdir()}
    paths = [str(tmp_path / "fan.ply"), str(tmp_path / "gone.ply"), str(good)]
    batch.flush_output()
    capfd.readouterr()
    assert batch.main(["check", *paths, "--json"]) == 1
    fan, gone, box = (json.loads(line) for line in capfd.readouterr().out.splitlines())
    assert [found["kind"] for found in fan["meshes"][0]["findings"]] == ["nonmanifold_edges"]
    assert fan["meshes"][0]["findings"][0]["count"] == 1
    assert "gone.ply" in gone["error"]
    assert box["meshes"][0]["findings"] == []
    assert batch.main(["check", paths[0]]) == 0
    assert "1 edge with more than two faces (limits)" in capfd.readouterr().out
    assert batch.main(["check", paths[0], "--strict"]) == 1
    assert batch.main(["check", paths[2], "--strict"]) == 0
    assert batch.main(["check"]) == 2
    assert {path: path.read_bytes() for path in tmp_path.iterdir()} == before
