"""The job type for Flamenco: what its tasks say, and what running their commands does.

The manager's side is a stub with what its documentation offers. The commands run as they are issued, by a
program that takes Blender's place.
"""

import json
import os
import shutil
import stat
import subprocess
import sys
from pathlib import Path

import batch_kit
import bpy
import pytest
from bl_ext.user_default.ridgeform.overnight import worker
from test_overnight import entries

SCRIPT = Path(__file__).parents[2] / "farms/flamenco/ridgeform.js"
STUB = Path(__file__).with_name("flamenco_stub.js")

pytestmark = pytest.mark.skipif(shutil.which("node") is None, reason="needs node")


def compiled(**settings):
    """The job type and the tasks of a job."""
    command = ["node", str(STUB), str(SCRIPT), json.dumps(settings)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        raise ValueError(done.stderr)
    made = json.loads(done.stdout)
    return made["type"], made["tasks"]


def job(folder, arguments="stylize", **more):
    """A job as it is submitted, with what the add-on evaluates."""
    found = sorted(map(str, (folder / "in").iterdir())) if (folder / "in").is_dir() else ["a.ply"]
    given = {
        "input_folder": "//in/",
        "pattern": "*.ply",
        "output_folder": "//out/",
        "output": str(folder / "out"),
    }
    return compiled(**given | {"arguments": arguments, "chunk_size": 2, "files": json.dumps(found)} | more)


def test_the_settings_are_those_that_flamenco_knows(tmp_path):
    kind, _ = job(tmp_path)
    assert set(kind) == {"label", "settings"}
    for setting in kind["settings"]:
        assert setting["type"] in {"string", "int32", "float", "bool"}
        assert setting.get("subtype", "dir_path") in {"file_path", "dir_path", "hashed_file_path"}
        assert setting.get("visible", "visible") in {"visible", "hidden", "submission", "web"}
        known = {"key", "type", "subtype", "choices", "propargs", "description", "label", "default", "eval"}
        assert set(setting) <= known | {"evalInfo", "visible", "required", "editable"}


def test_the_files_are_found_when_a_job_is_submitted(tmp_path):
    batch_kit.boxes(tmp_path / "in", 3)
    (tmp_path / "in/other.txt").touch()
    kind, _ = job(tmp_path)
    files, output = (setting["eval"] for setting in kind["settings"] if "eval" in setting)
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "scene.blend"))
    # Folders as Blender's file browser gives them, and the names that Flamenco's add-on evaluates with.
    given = {"input_folder": "//in/", "pattern": "*.ply", "output_folder": "//out.v2/"}
    names = {
        "settings": type("Settings", (), given),
        "bpy": bpy,
        "C": bpy.context,
        "Path": Path,
        "jobname": "Job",
    }
    names["abspath"] = lambda path: Path(bpy.path.abspath(str(path)))
    found = json.loads(eval(files, {}, names))
    assert found == [(tmp_path / f"in/box{number}.ply").as_posix() for number in range(3)]
    assert eval(output, {}, names) == (tmp_path / "out.v2").as_posix()


@pytest.mark.parametrize(
    ("arguments", "names", "message"),
    [
        ("", ["a.ply"], "write a tool"),
        ("stylize --jobs 2", ["a.ply"], "leave --jobs to this job type"),
        ("stylize --report=x.html", ["a.ply"], "leave --report to this job type"),
        ("stylize", [], "There is no file"),
        ("stylize --format .ply", ["/in/a.obj", "/in/A.stl"], "a.obj and A.stl would have the same output"),
    ],
)
def test_what_is_wrong_is_said_when_a_job_is_submitted(tmp_path, arguments, names, message):
    with pytest.raises(ValueError, match=message):
        job(tmp_path, arguments, files=json.dumps(names))


@pytest.mark.skipif(os.name == "nt", reason="a script takes Blender's place")
def test_the_commands_do_all_files_once_also_when_a_task_is_tried_again(tmp_path):
    sources = batch_kit.boxes(tmp_path / "in", 3)
    blender = tmp_path / "blender"
    code = worker.MODULE.format(paths=sys.path, name=worker.PACKAGE)
    blender.write_text(
        f"#!{sys.executable}\nimport sys\nassert sys.argv.pop(1) == '--command'\n"
        f"assert sys.argv.pop(1) == 'ridgeform'\n{code}\n"
    )
    blender.chmod(blender.stat().st_mode | stat.S_IXUSR)
    # A name that could be that of a file.
    out = tmp_path / "out.ply"
    _, tasks = job(tmp_path, "stylize --steps 1", output=str(out))
    assert [task["name"] for task in tasks] == ["files-1-2", "files-3-3", "summary"]
    assert tasks[-1]["dependencies"] == ["files-1-2", "files-3-3"]
    assert {task["type"] for task in tasks} == {"blender"}

    def run(task):
        for command in task["commands"]:
            given = command["parameters"]
            exe = given["exe"].replace("{blender}", str(blender))
            subprocess.run([exe, *given["args"]], check=True, capture_output=True, cwd="/")

    # The task with one file first: nothing is there that says that the output is a folder.
    for task in reversed(tasks[:-1]):
        run(task)
    before = batch_kit.state_of(out)
    assert set(before) == {path.name for path in sources}
    run(tasks[0])
    run(tasks[-1])
    assert batch_kit.state_of(out) == before
    assert set(entries(out).values()) == {"done"}
    page = (tmp_path / "out.ply.html").read_text()
    assert "3 of 3 files done, 3 of them before" in page
    assert page.count("data:image/png") == 6
