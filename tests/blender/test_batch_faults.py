"""Files when writing fails: what was there stays as it was, and the record says what happened."""

import contextlib
import json
import os
import resource
import shutil
import subprocess
import tempfile
from pathlib import Path

import addon_kit as kit
import bpy
import numpy as np
import pytest
from bl_ext.user_default.ridgeform.framework import batch, completeness, files, targets, writing
from bl_ext.user_default.ridgeform.framework.completeness_blend import IncompleteError

OLD = b"what was there before"
SMALL = 48 << 10
"""Bytes: less than any format needs for the scene."""
CUTS = np.unique(np.geomspace(1, 1e7, 60).astype(int))


def scene(name="Box"):
    """A box with noise, a loose edge, a material with an image that is in the file."""
    kit.empty_scene()
    obj = kit.bumpy_box(name, cuts=16)
    mesh = obj.data
    mesh.vertices.add(2)
    mesh.edges.add(1)
    mesh.edges[-1].vertices = (len(mesh.vertices) - 2, len(mesh.vertices) - 1)
    mesh.uv_layers.new(name="UVMap")
    image = bpy.data.images.new("wood", 4, 4)
    image.generated_type = "UV_GRID"
    image.pack()
    material = bpy.data.materials.new("Wood")
    material.use_nodes = True
    nodes = material.node_tree
    texture = nodes.nodes.new("ShaderNodeTexImage")
    texture.image = image
    shader = next(node for node in nodes.nodes if node.type == "BSDF_PRINCIPLED")
    nodes.links.new(texture.outputs["Color"], shader.inputs["Base Color"])
    mesh.materials.append(material)
    return obj


@contextlib.contextmanager
def full_disk(folder):
    """A folder on a disk without room for the scene; as root a real one."""
    with contextlib.ExitStack() as stack:
        if os.geteuid() == 0:
            stack.enter_context(mounted(folder, f"size={SMALL}"))
        else:
            stack.enter_context(limited_files())
        yield folder


@contextlib.contextmanager
def mounted(folder, options):
    subprocess.run(["mount", "-t", "tmpfs", "-o", options, "tmpfs", folder], check=True)
    try:
        yield
    finally:
        subprocess.run(["umount", "-l", folder], check=True)


@contextlib.contextmanager
def limited_files():
    """No file may be longer than `SMALL`."""
    old = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (SMALL, old[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, old)


@contextlib.contextmanager
def read_only(folder):
    """A folder in which nothing can be written: root may write wherever the disk lets it."""
    if os.geteuid() == 0:
        subprocess.run(["mount", "-o", "bind", folder, folder], check=True)
        try:
            subprocess.run(["mount", "-o", "remount,bind,ro", folder], check=True)
            yield
        finally:
            subprocess.run(["umount", "-l", folder], check=True)
        return
    folder.chmod(0o555)
    try:
        yield
    finally:
        folder.chmod(0o755)


def contents(folder):
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


@pytest.mark.parametrize("limit", [full_disk, lambda folder: limited_files()], ids=["disk", "file size"])
@pytest.mark.parametrize("suffix", list(files.FORMATS))
def test_a_full_disk_leaves_what_was_there(tmp_path, suffix, limit):
    scene()
    target = tmp_path / f"box{suffix}"
    with limit(tmp_path):
        target.write_bytes(OLD)
        (tmp_path / "box.mtl").write_bytes(OLD)
        (tmp_path / "box.bin").write_bytes(OLD)
        before = contents(tmp_path)
        with pytest.raises(files.FileError, match=f"box{suffix}"):
            files.write_file(target)
        assert contents(tmp_path) == before
        assert sorted(path.name for path in tmp_path.iterdir()) == sorted(before)


@pytest.mark.parametrize("suffix", list(files.FORMATS))
def test_every_file_that_is_cut_is_noticed(tmp_path, suffix):
    scene()
    path = tmp_path / f"box{suffix}"
    files.write_file(path)
    completeness.check_whole(path)
    whole = path.read_bytes()
    for kept in [n for n in CUTS if n < len(whole)] + [len(whole) - n for n in CUTS if n < len(whole)]:
        if suffix in {".gltf", ".usda"} and not whole[kept:].strip():
            continue
        path.write_bytes(whole[:kept])
        with pytest.raises(IncompleteError):
            completeness.check_whole(path)


@pytest.mark.parametrize("compress", [False, True])
def test_blend_files_that_are_cut_are_noticed(tmp_path, compress):
    scene()
    path = tmp_path / "box.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path), copy=True, compress=compress)
    completeness.check_whole(path)
    whole = path.read_bytes()
    for kept in range(len(whole) - 1, 0, -len(whole) // 300):
        path.write_bytes(whole[:kept])
        with pytest.raises(IncompleteError):
            completeness.check_whole(path)


@pytest.mark.parametrize("suffix", list(files.FORMATS))
def test_a_read_only_folder_stays_as_it_was(tmp_path, suffix):
    scene()
    target = tmp_path / f"box{suffix}"
    target.write_bytes(OLD)
    with read_only(tmp_path), pytest.raises(files.FileError, match=r"was not written: .*(Read-only|denied)"):
        files.write_file(target)
    assert contents(tmp_path) == {target.name: OLD}


@pytest.mark.parametrize("suffix", list(files.FORMATS))
def test_a_folder_that_vanishes_while_writing(tmp_path, suffix, monkeypatch):
    scene()
    out = tmp_path / "out"
    kind = files.FORMATS[suffix]

    def write(path):
        shutil.rmtree(out)
        return kind.write(path)

    monkeypatch.setitem(files.FORMATS, suffix, files.Format(kind.read, write, kind.several))
    # Some exporters make the folder again: then the file is there, whole.
    try:
        files.write_file(out / f"box{suffix}")
    except files.FileError:
        assert not out.exists() or contents(out) == {}
    else:
        completeness.check_whole(out / f"box{suffix}")


def test_a_file_where_the_folder_should_be(tmp_path):
    scene()
    (tmp_path / "out").write_bytes(OLD)
    with pytest.raises(files.FileError, match=r"box\.obj was not written"):
        files.write_file(tmp_path / "out" / "box.obj")
    assert contents(tmp_path) == {"out": OLD}


@pytest.mark.parametrize("suffix", [".obj", ".gltf", ".usdc"])
def test_files_that_go_along_are_written_with_it_and_again(tmp_path, suffix):
    scene()
    path = tmp_path / f"box{suffix}"
    files.write_file(path)
    first = contents(tmp_path)
    assert len(first) > 1
    files.write_file(path)
    assert contents(tmp_path).keys() == first.keys()
    (obj,) = files.read_file(path)
    assert obj.data.materials[0].name.startswith("Wood")


@pytest.mark.parametrize("suffix", [".obj", ".gltf", ".usdc"])
def test_if_the_last_file_cannot_be_put_in_place_the_others_are_as_before(tmp_path, suffix, monkeypatch):
    scene()
    path = tmp_path / f"box{suffix}"
    files.write_file(path)
    before = contents(tmp_path)
    bpy.data.meshes["Box"].vertices[0].co.x += 1.0
    bpy.data.materials["Wood"].name = "Stone"
    replace = os.replace

    def failing(source, target):
        if target == path:
            raise OSError(28, "No space left on device")
        replace(source, target)

    monkeypatch.setattr(writing.os, "replace", failing)
    with pytest.raises(files.FileError, match="No space left"):
        files.write_file(path)
    assert contents(tmp_path) == before


def test_an_image_of_another_name_is_not_destroyed(tmp_path):
    scene()
    (tmp_path / "wood.png").write_bytes(OLD)
    with pytest.raises(files.FileError, match=r"wood\.png is there and is something else"):
        files.write_file(tmp_path / "box.gltf")
    assert contents(tmp_path) == {"wood.png": OLD}


def command(capfd, *arguments):
    """Exit code and errors of a command."""
    batch.flush_output()
    capfd.readouterr()
    code = batch.main([*map(str, arguments), "--steps", "1", "--json"])
    return code, [json.loads(line)["error"] for line in capfd.readouterr().out.splitlines()]


def sources(folder, *names):
    for name in names:
        scene()
        files.write_file(folder / name)
    return [folder / name for name in names]


def test_no_input_is_overwritten_whatever_it_is_called(tmp_path, capfd):
    a, b = sources(tmp_path, "a.obj", "b.ply")
    out = tmp_path / "out"
    out.mkdir()
    os.link(a, out / "hard.obj")
    (out / "soft.obj").symlink_to(a)
    before = contents(tmp_path)
    for target in (a, out / "hard.obj", out / "soft.obj", out / ".." / "a.obj"):
        code, (error,) = command(capfd, "stylize", a, "-o", target)
        assert code == 1
        assert "is an input and would be overwritten" in error
    # The second file is an input of the same call, not yet read when the first is written.
    code, errors = command(
        capfd, "stylize", sources(tmp_path, "b.obj")[0], b, "-o", tmp_path, "--format", "ply"
    )
    assert code == 1
    assert all("b.ply is an input" in error for error in errors)
    # Materials of an input, of which the output would have some of the same name.
    code, (error,) = command(capfd, "stylize", b, "-o", tmp_path / "a.mtl")
    assert "cannot be read and written" in error or "cannot be read or written" in error
    shutil.copy(a, tmp_path / "c.obj")
    code, (error,) = command(capfd, "stylize", tmp_path / "c.obj", "-o", out / "a.obj")
    assert code == 0, error
    assert {name: content for name, content in contents(tmp_path).items() if name in before} == before


def test_the_materials_of_an_input_are_inputs(tmp_path, capfd):
    (a,) = sources(tmp_path, "a.obj")
    renamed = tmp_path / "c.obj"
    a.rename(renamed)
    before = contents(tmp_path)
    code, (error,) = command(capfd, "stylize", renamed, "-o", tmp_path / "a.obj")
    if code == 0:
        # The same materials, to the bit.
        assert {name: contents(tmp_path)[name] for name in before} == before
    else:
        assert "a.mtl is an input" in error
        assert contents(tmp_path) == before


def test_letter_case_counts_where_the_disk_says_so(tmp_path, monkeypatch):
    upper, lower = tmp_path / "A.obj", tmp_path / "a.obj"
    found, _ = targets.assign([upper, tmp_path / "x" / "a.stl"], tmp_path / "out", ".obj")
    assert [target.error for target in found] == [None, None]
    monkeypatch.setattr(targets, "_folds_case", lambda folder: True)
    found, _ = targets.assign([upper, tmp_path / "x" / "a.stl"], tmp_path / "out", ".obj")
    assert found[0].error is None
    assert "already the output" in found[1].error
    found, _ = targets.assign([upper], lower, None)
    assert "is an input" in found[0].error


SCRIPT = "import pathlib; pathlib.Path({!r}).write_text('ran')"


def test_scripts_of_files_do_not_run(tmp_path, capfd):
    kit.empty_scene()
    obj = kit.bumpy_box()
    ran = tmp_path / "ran"
    text = bpy.data.texts.new("script.py")
    text.write(SCRIPT.format(str(ran)))
    text.use_module = True
    driver = obj.driver_add("location", 0).driver
    driver.expression = f"__import__('pathlib').Path({str(ran)!r}).write_text('ran')"
    source = tmp_path / "scripted.blend"
    files.write_file(source)
    preferences = bpy.context.preferences.filepaths
    preferences.use_scripts_auto_execute = True
    try:
        ran.unlink(missing_ok=True)
        bpy.ops.wm.open_mainfile(filepath=str(source), use_scripts=True)
        assert ran.exists(), "the file would do no harm"
        ran.unlink()
        code, (error,) = command(capfd, "stylize", source, "-o", tmp_path / "out.blend")
        assert code == 0, error
        assert not ran.exists()
    finally:
        preferences.use_scripts_auto_execute = False


ABSOLUTE = Path(tempfile.gettempdir()) / "ridgeform-evil"
NAMES = ["../../evil", str(ABSOLUTE), "a\\..\\evil", "CON", "..", "x\ny", "%s{0}", "C:evil", "名" * 20]


@pytest.mark.parametrize(
    ("suffix", "name", "path"),
    [
        *((".gltf", name, path) for name in NAMES for path in ("", "//..")),
        *(
            (suffix, name, "//../../evil.png")
            for name in NAMES[:3]
            for suffix in (".obj", ".gltf", ".usda", ".fbx")
        ),
        *((".usda", name, path) for name in NAMES[:2] for path in ("", f"{ABSOLUTE}.png")),
    ],
)
def test_names_lead_nowhere(tmp_path, suffix, name, path):
    """Nothing is written outside the folder, whatever objects, materials and images are called."""
    scene(name)
    for data in (*bpy.data.meshes, *bpy.data.materials, *bpy.data.images):
        data.name = name
    names = [data.name for data in (*bpy.data.meshes, *bpy.data.materials, *bpy.data.images)]
    (image,) = bpy.data.images
    image.filepath_raw = path
    out = tmp_path / "a" / "b" / "out"
    files.write_file(out / f"box{suffix}")
    assert all(path.startswith("a/b/out/") for path in contents(tmp_path))
    assert [file for file in ABSOLUTE.parent.glob(f"{ABSOLUTE.name}*") if not file.unlink()] == []
    assert names == [data.name for data in (*bpy.data.meshes, *bpy.data.materials, *bpy.data.images)]
