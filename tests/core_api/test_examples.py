"""The examples that need no Blender run as they stand, and find what they claim to find."""

import inspect
import re
import runpy
import sys
from pathlib import Path

import numpy as np
import pytest
import ridgeform
from known_shapes import shapes

EXAMPLES = Path(__file__).parents[2] / "examples"
SPOT = EXAMPLES.parent / "blend_fixtures/sources/spot_low_resolution.npz"


@pytest.fixture
def run(capsys, monkeypatch):
    """Run an example with arguments as a user would; returns what it prints and the numbers in that."""

    def run(name, *arguments):
        monkeypatch.setattr(sys, "argv", [name, *map(str, arguments)])
        runpy.run_path(str(EXAMPLES / name), run_name="__main__")
        said = capsys.readouterr().out
        return said, [float(number) for number in re.findall(r"\d+\.?\d*(?:e[+-]\d+)?", said)]

    return run


def test_every_example_says_how_to_run_it_and_is_tested():
    tests = [Path(__file__), EXAMPLES.parent / "tests/blender/test_blender_examples.py"]
    tested = "".join(path.read_text(encoding="utf-8") for path in tests)
    examples = sorted(EXAMPLES.glob("*.py"))
    assert len(examples) >= 10
    for path in examples:
        assert f'"{path.name}"' in tested
        assert path.name in path.read_text(encoding="utf-8").split('"""')[1], f"{path.name} is not explained"


def test_stylize_obj(run, tmp_path):
    vertices, faces = shapes.icosphere(2)
    lines = [f"v {x} {y} {z}" for x, y, z in vertices] + [f"f {a}/1 {b}/1 {c}/1" for a, b, c in faces + 1]
    (tmp_path / "in.obj").write_text("\n".join(lines) + "\nf -4 -3 -2 -1\n", encoding="utf-8")
    said, (_, before, after) = run("stylize_obj.py", tmp_path / "in.obj", tmp_path / "out.obj", 0.6)[0:2]
    assert after < before, said
    written = (tmp_path / "out.obj").read_text(encoding="utf-8").splitlines()
    assert sum(line.startswith("v ") for line in written) == len(vertices)
    assert sum(line.startswith("f ") for line in written) == len(faces) + 2


def test_restore_noisy_part(run):
    _, (before, after) = run("restore_noisy_part.py")
    assert after < 0.25 * before


def test_fill_holes(run):
    said, numbers = run("fill_holes.py")
    assert "the outer border of 120 edges" in said
    assert "a hole of 36 edges" in said
    assert numbers[-1] < 1e-6


def test_segment_parts(run):
    said, numbers = run("segment_parts.py", SPOT)
    assert 4 <= numbers[0] <= 20
    assert "as 4 segments" in said


def test_denoise_values(run):
    said, _ = run("denoise_values.py")
    noise, sharp, smooth, gap = (float(number) for number in re.findall(r"\d+\.\d+", said))
    assert sharp < 0.8 * smooth < 0.3 * noise
    assert gap <= 0.1


def test_interpolate_values(run):
    said, numbers = run("interpolate_values.py", SPOT)
    assert numbers[2] < 30
    assert "solved" in said


def test_recolor_with_curves(run):
    _, numbers = run("recolor_with_curves.py", SPOT)
    assert numbers[1] < 0.2 * numbers[2]
    assert numbers[3] > 40
    vertices = np.load(SPOT)["vertices"]
    assert numbers[-1] == pytest.approx(0.5 * len(vertices), rel=0.05)


def test_hessian_matrix(run):
    pytest.importorskip("scipy")
    said, numbers = run("hessian_matrix.py")
    assert numbers[0] == 4 * 2 * 19**2
    assert numbers[3] < 1e-12
    by_hand, by_name = re.findall(r"(\d+\.\d{3})", said)
    assert by_hand == by_name


def test_watch_and_stop(run):
    said, numbers = run("watch_and_stop.py", SPOT)
    assert "stopped" in said
    assert 5 <= numbers[0] < 1000


def test_api_has_a_cell_for_every_function(run):
    said, numbers = run("api.py")
    assert "solved" in said
    assert numbers
    cells = set(re.findall(r"^# %% (\w+)$", (EXAMPLES / "api.py").read_text(encoding="utf-8"), re.M))
    functions = {name for name in ridgeform.__all__ if inspect.isroutine(getattr(ridgeform, name))}
    assert functions <= cells, f"no example of {', '.join(sorted(functions - cells))}"
    assert cells - {"prelude"} <= set(ridgeform.__all__)
