"""Batches in several processes that crash, hang, or are ended: nothing is lost, nothing is done twice."""

import base64
import json
import os
import re
import runpy
import shutil
import signal
import subprocess
import sys

import addon_kit as kit
import batch_kit
import bpy
import numpy as np
import pytest
from bl_ext.user_default.ridgeform.framework import batch, files
from bl_ext.user_default.ridgeform.overnight import helper, journal, locks, pool, thumbnails
from known_shapes import shapes

by_signals = pytest.mark.skipif(os.name == "nt", reason="Windows has no such signals")


def entries(out):
    """The states of the journal beside an output."""
    # What begins with a dot is being written: pathlib finds it, too, and it may be gone when it is read.
    paths = out.with_name(out.name + ".ridgeform").glob("[!.]*.json")
    found = (json.loads(path.read_text()) for path in paths)
    return {entry["record"]["file"]: entry["state"] for entry in found}


def is_alive(process):
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    return True


@by_signals
def test_a_process_that_crashes_or_hangs_costs_its_file_only(tmp_path, capfd, monkeypatch):
    sources, out = batch_kit.boxes(tmp_path / "in", 5), tmp_path / "out"
    look, ended = pool.Pool._look, {}

    def disturbed(self):
        for one in list(self._helpers):
            if one.index is not None and len(ended) < 2 and one.process.pid not in ended:
                kind = signal.SIGSTOP if ended else signal.SIGKILL
                os.kill(one.process.pid, kind)
                ended[one.process.pid] = sources[one.index].name
                if kind == signal.SIGSTOP:
                    # As if it had hung for so long.
                    one.begun -= 1000.0
        yield from look(self)

    monkeypatch.setattr(pool.Pool, "_look", disturbed)
    monkeypatch.setattr(helper.Helper.end, "__defaults__", (0.2,))
    page = tmp_path / "page.html"
    options = (*batch_kit.STEPS, "--jobs", 2, "--timeout", 500, "--report", page)
    options += ("--report", tmp_path / "all.json", "--report", tmp_path / "short.txt")
    code, records = batch_kit.run(capfd, "stylize", *sources, "-o", out, *options)
    assert code == 1
    assert len(records) == 5
    assert not any(map(is_alive, ended))
    killed, hung = ended.values()
    assert "killed (signal 9)" in records[killed]["error"]
    assert "took longer than 500 s" in records[hung]["error"]
    done = {name for name, record in records.items() if record["error"] is None}
    assert done == {path.name for path in sources} - {killed, hung}
    before = batch_kit.state_of(out)
    assert set(before) == done
    assert len(re.findall("data:image/png;base64", page.read_text())) == 6
    assert not re.search(r"(src|href)=.(?!data:)", page.read_text())
    assert json.loads((tmp_path / "all.json").read_text())["failed"] == 2
    assert (tmp_path / "short.txt").read_text().startswith("3 of 5 files done, 2 failed\n")

    code, again = batch_kit.run(capfd, "stylize", *sources, "-o", out, *batch_kit.STEPS, "--resume")
    assert code == 0
    assert {name for name, record in again.items() if record["resumed"]} == done
    after = batch_kit.state_of(out)
    assert set(after) == {path.name for path in sources}
    assert {name: after[name] for name in done} == before
    # One after the other gives the same bits.
    code, _ = batch_kit.run(capfd, "stylize", *sources, "-o", tmp_path / "alone", *batch_kit.STEPS)
    assert code == 0
    assert all((tmp_path / "alone" / name).read_bytes() == (out / name).read_bytes() for name in after)


def test_resume_after_the_process_of_all_was_killed(tmp_path, capfd):
    sources, out = batch_kit.boxes(tmp_path / "in", 12), tmp_path / "out"
    command = ("stylize", *sources, "-o", out, *batch_kit.STEPS)
    parent = batch_kit.start(*command, "--jobs", 2)
    batch_kit.until(lambda: "done" in entries(out).values())
    parent.kill()
    parent.communicate()
    code, records = batch_kit.run(capfd, *command, "--resume")
    assert code == 0
    finished = batch_kit.state_of(out)
    assert set(finished) == {path.name for path in sources}
    resumed = {name for name, record in records.items() if record["resumed"]}
    assert resumed
    assert set(entries(out).values()) == {"done"}
    # Those of the second process are not done again by the third, and all that is needed is told of them.
    code, records = batch_kit.run(capfd, *command, "--resume")
    assert all(record["resumed"] and record["energy_after"] for record in records.values())
    assert batch_kit.state_of(out) == finished


@by_signals
def test_ctrl_c_ends_all_processes_and_leaves_what_resumes(tmp_path, capfd, monkeypatch):
    sources, out = batch_kit.boxes(tmp_path / "in", 6), tmp_path / "out"
    look, seen = pool.Pool._look, []

    def interrupted(self):
        seen[:] = [one.process.pid for one in self._helpers]
        if entries(out):
            os.kill(os.getpid(), signal.SIGINT)
        yield from look(self)

    monkeypatch.setattr(pool.Pool, "_look", interrupted)
    # As Blender, which has a handler of its own that only stops renders.
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    command = ("stylize", *sources, "-o", out, *batch_kit.STEPS)
    code, _ = batch_kit.run(capfd, *command, "--jobs", 1, "--report", tmp_path / "short.txt")
    assert signal.signal(signal.SIGINT, before) == signal.SIG_IGN
    assert code == batch.INTERRUPTED
    assert seen
    assert not any(map(is_alive, seen))
    assert "not begun" in (tmp_path / "short.txt").read_text()
    before = batch_kit.state_of(out)
    assert 0 < len(before) < 6
    code, _ = batch_kit.run(capfd, *command, "--resume")
    assert code == 0
    after = batch_kit.state_of(out)
    assert len(after) == 6
    assert {name: after[name] for name in before} == before


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="Linux keeps processes to a limit")
def test_memory_is_divided(tmp_path, capfd):
    kit.empty_scene()
    kit.bumpy_box(cuts=60)
    source = tmp_path / "box.ply"
    files.write_file(source)
    options = (*batch_kit.STEPS, "--jobs", 1, "--memory", 0.02)
    code, records = batch_kit.run(capfd, "stylize", source, "-o", tmp_path / "out", *options)
    assert code == 1
    assert re.search(r'"box" needs about .* of memory, .* are free', records["box.ply"]["error"])
    assert batch.main(["stylize", str(source), "-o", str(tmp_path / "x.ply"), "--memory", "1"]) == 2


def test_what_changed_is_done_again(tmp_path, capfd):
    sources, out = batch_kit.boxes(tmp_path / "in", 3), tmp_path / "out"
    command = ("stylize", *sources, "-o", out)

    def done_again(*options):
        code, records = batch_kit.run(capfd, *command, *options, "--resume")
        assert code == 0, records
        return {name for name, record in records.items() if not record["resumed"]}

    assert done_again("--steps", "1") == {"box0.ply", "box1.ply", "box2.ply"}
    assert done_again("--steps", "1") == set()
    shutil.copy(sources[0], sources[1])
    (out / "box2.ply").unlink()
    assert done_again("--steps", "1") == {"box1.ply", "box2.ply"}
    assert done_again("--steps", "2") == {"box0.ply", "box1.ply", "box2.ply"}
    # What somebody has made of a result since is not lost.
    (out / "box0.ply").write_bytes(b"mine")
    assert done_again("--steps", "2") == set()
    assert (out / "box0.ply").read_bytes() == b"mine"
    # Without --resume, as before.
    _, records = batch_kit.run(capfd, *command, "--steps", "2")
    assert not any(record["resumed"] for record in records.values())


@pytest.mark.parametrize("installed", [True, False])
def test_a_process_that_ends_while_a_result_is_put_in_place(tmp_path, capfd, monkeypatch, installed):
    (source,) = batch_kit.boxes(tmp_path / "in", 1)
    out = tmp_path / "out.ply"
    claim = journal.Claim
    put = batch.driver.do_file.__globals__["files"].write_file

    def ended(path, protected=None, moved=None):
        """Like a process that ends just before or just after."""
        with monkeypatch.context() as patch:
            patch.setattr("os.replace", lambda a, b: real(a, b) if installed or ".json" in str(b) else None)
            put(path, protected, moved)
        raise KeyboardInterrupt

    real = os.replace
    with monkeypatch.context() as patch:
        patch.setattr(files, "write_file", ended)
        patch.setattr(claim, "finish", lambda self: None)
        code, _ = batch_kit.run(capfd, "stylize", source, "-o", out, *batch_kit.STEPS, "--resume")
    assert code == batch.INTERRUPTED
    assert list(entries(out).values()) == ["ready"]
    assert out.exists() == installed
    code, records = batch_kit.run(capfd, "stylize", source, "-o", out, *batch_kit.STEPS, "--resume")
    assert code == 0
    assert records["box0.ply"]["resumed"] == installed
    assert list(entries(out).values()) == ["done"]
    assert out.exists()


def test_where_no_journal_can_be_written_a_plain_run_goes_on(tmp_path, capfd, monkeypatch):
    sources = batch_kit.boxes(tmp_path / "in", 2)

    def refuse(*_arguments):
        raise OSError(37, "No locks available")

    monkeypatch.setattr(locks, "_try_lock", refuse)
    command = ["stylize", *map(str, sources), "-o", str(tmp_path / "out"), *batch_kit.STEPS]
    assert batch.main(command) == 0
    assert "No locks available, so that this run cannot be resumed" in capfd.readouterr().err
    assert len(batch_kit.state_of(tmp_path / "out")) == 2
    for option in ("--resume", "--jobs=2", "--timeout=9", f"--report={tmp_path / 'page.html'}"):
        assert batch.main([*command, option]) == 2
        assert "No locks available; choose an OUT" in capfd.readouterr().err


def test_outputs_of_other_processes_are_not_overwritten(tmp_path):
    (tmp_path / "a.obj").write_text("v 0 0 0\n")
    (tmp_path / "b.obj").write_text("v 0 0 0\n")
    found, ledger = batch.driver.assign([tmp_path / "a.obj", tmp_path / "b.obj"], tmp_path / "out", None)
    (tmp_path / "out").mkdir()
    image = tmp_path / "out/wood.png"
    image.write_bytes(b"a's")
    one, other = (journal.Journal(tmp_path / "out", "key") for _ in range(2))
    one.open(keep=False)
    with one.claim(found[0], ledger) as claim:
        claim.add_output(image)
        claim.add_inputs([tmp_path / "paint.png"])
    (tmp_path / "paint.png").touch()
    with other.claim(found[1], ledger.__class__([])) as claim:
        other.catch_up()
        assert "already the output of another" in claim.reason_against(image)
        assert "used by an input" in claim.reason_against(tmp_path / "paint.png")
    with other.claim(found[0], ledger.__class__([])) as claim:
        assert claim.reason_against(image) is None


def test_a_lock_is_held_among_processes_and_freed_when_one_is_killed(tmp_path):
    (tmp_path / "lock").touch()
    code = (
        f"import runpy, time, pathlib; locked = runpy.run_path({locks.__file__!r})['locked']\n"
        f"with locked(pathlib.Path({str(tmp_path / 'lock')!r}), 'a'):\n"
        "    print('held', flush=True)\n"
        "    time.sleep(99)"
    )
    process = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE)
    assert process.stdout.readline() == b"held\n"
    with locks.locked(tmp_path / "lock", "b"):
        pass
    held = runpy.run_path(locks.__file__)
    handle = held["_handle"](tmp_path / "lock")
    place = int.from_bytes(locks.hashlib.sha256(b"a").digest()[:8], "little") % locks.PLACES
    assert not held["_try_lock"](handle, place)
    process.kill()
    process.communicate()
    with locks.locked(tmp_path / "lock", "a"):
        pass


def pixels(picture, folder):
    """A picture as Blender reads it: rows from the top (height, width, 3), 0 to 255."""
    path = folder / "picture.png"
    path.write_bytes(base64.b64decode(picture))
    image = bpy.data.images.load(str(path))
    image.colorspace_settings.name = "Non-Color"
    values = np.empty(4 * thumbnails.SIZE**2, np.float32)
    image.pixels.foreach_get(values)
    return np.round(255 * values.reshape(thumbnails.SIZE, thumbnails.SIZE, 4)[::-1, :, :3])


def test_pictures_show_what_is_in_front(tmp_path, add_mesh):
    vertices, faces = shapes.cube(2)
    cube = add_mesh(np.asarray(vertices), faces, "Cube")
    red, green = bpy.data.materials.new("Red"), bpy.data.materials.new("Green")
    red.diffuse_color, green.diffuse_color = (1, 0, 0, 1), (0, 1, 0, 1)
    cube.data.materials.append(green)
    camera = thumbnails.Camera([cube])
    shown = pixels(camera.picture([cube]), tmp_path)
    middle = thumbnails.SIZE // 2
    assert (shown[0, 0] == 255).all()
    assert shown[middle, middle, 1] > 60
    assert (shown[middle, middle, [0, 2]] == 0).all()
    # Three sides are seen, each of one shade.
    _, counts = np.unique(shown.reshape(-1, 3), axis=0, return_counts=True)
    assert (counts > 500).sum() == 3 + 1
    # A sheet behind the cube is hidden, one before it hides it.
    size = float(np.abs(vertices).max())
    sheet = np.array([[-1, 0, -1], [1, 0, -1], [1, 0, 1], [-1, 0, 1]]) * 0.2 * size
    obj = add_mesh(sheet, [(0, 1, 2, 3)], "Sheet")
    obj.data.materials.append(red)
    for side, expected in ((1.0, 0), (-1.0, 255)):
        obj.location = -side * 5.0 * size * thumbnails.TOWARD
        seen = pixels(camera.picture([cube, obj]), tmp_path)[middle, middle]
        assert (seen[0] > 60) == (expected == 255)
        assert (seen[1] > 60) == (expected == 0)


def test_a_picture_of_more_colors_than_a_palette_has(tmp_path):
    size = thumbnails.SIZE
    image = np.random.default_rng(0).integers(0, 256, (size, size, 3), np.uint8)
    for made in (image, image // 200 * 200):
        picture = base64.b64encode(thumbnails.png(made))
        assert (pixels(picture, tmp_path) == made).all()


def test_a_picture_of_nothing_and_of_broken_coordinates(tmp_path, add_mesh):
    assert (pixels(thumbnails.Camera([]).picture([]), tmp_path) == 255).all()
    broken = add_mesh([(0, 0, 0), (1, 0, 0), (0, 1, 0), (9, 9, 9)], [(0, 1, 2)], "Broken")
    broken.data.vertices[3].co = (float("nan"), 0, 0)
    assert (pixels(thumbnails.Camera([broken]).picture([broken]), tmp_path) < 255).any()
