"""Calls that do not fit into memory are refused before they start, with what they need and what would fit."""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import ridgeform
from known_shapes import shapes

ROOT = Path(__file__).parents[2]
PATHS = [str(ROOT / "benchmarks"), str(ROOT / "scripts")]

ON_LINUX = pytest.mark.skipif(sys.platform != "linux", reason="limits of processes are read on Linux only")

CAPPED = """
import json, resource, sys
sys.path[:0] = {paths!r}
import ridgeform
from tool_calls import CALLS, bumpy_grid

arrays = bumpy_grid(30_000)
with open("/proc/self/statm") as file:
    there = int(file.read().split()[0]) * resource.getpagesize()
resource.setrlimit(resource.RLIMIT_AS, (there + {room}, -1))
outcomes = {{}}
for call in {calls!r}:
    try:
        CALLS[call](ridgeform.Mesh(*arrays), {{}})
        outcomes[call] = "result"
    except ridgeform.RidgeformError as error:
        outcomes[call] = type(error).__name__
    except MemoryError:
        outcomes[call] = "MemoryError"
print(json.dumps(outcomes))
"""

CALLS = [
    "report",
    "hessian",
    "stylize",
    "denoise",
    "interpolate clarabel",
    "segment",
    "parts",
    "restore",
    "remesh",
    "trace_curves",
]


def in_a_process(code):
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr[-500:]
    return json.loads(done.stdout)


@ON_LINUX
@pytest.mark.parametrize("room", [20, 60, 110, 300, 2500])
def test_under_a_cap_every_call_ends_with_a_result_or_an_error(room):
    outcomes = in_a_process(CAPPED.format(paths=PATHS, room=room << 20, calls=CALLS))
    allowed = {"result"} if room == 2500 else {"result", "MemoryLimitError", "MemoryError"}
    assert set(outcomes) == set(CALLS)
    assert set(outcomes.values()) <= allowed, outcomes
    if room == 20:
        assert outcomes["stylize"] == "MemoryLimitError"


@ON_LINUX
def test_what_is_free_falls_with_the_limit_of_the_process():
    code = (
        "import json, resource, ridgeform\n"
        "before = ridgeform.memory_available()\n"
        "with open('/proc/self/statm') as file:\n"
        "    there = int(file.read().split()[0]) * resource.getpagesize()\n"
        "resource.setrlimit(resource.RLIMIT_AS, (there + 2**28, -1))\n"
        "print(json.dumps([before, ridgeform.memory_available()]))"
    )
    before, after = in_a_process(code)
    assert after <= min(before, 2**28)
    assert after > 2**27


@ON_LINUX
@pytest.mark.parametrize("call", ["stylize", "denoise 3 columns", "hessian"])
def test_estimates_are_within_a_quarter_of_what_is_taken(call):
    path = f"import sys; sys.path[:0] = {PATHS!r}"
    code = f"{path}; from peaks import peak; print(list(peak({call!r}, 40_000)))"
    taken, said = in_a_process(code)
    assert 0.75 * taken < said < 1.25 * taken


def test_a_refusal_says_what_is_needed_and_what_would_fit():
    mesh = ridgeform.Mesh(*shapes.grid())
    said = r"stylize: needs about .* limit of .*reduce .*memory_limit"
    with pytest.raises(ridgeform.MemoryLimitError, match=said) as caught:
        ridgeform.stylize(mesh, memory_limit=10_000)
    assert isinstance(caught.value, ridgeform.SolveError)
    assert isinstance(caught.value, MemoryError)


def test_a_refused_call_can_be_made_on_what_is_said_to_fit():
    need = ridgeform.memory_estimate("stylize", (1_000_000, 2_000_000), columns=3)
    assert 2e9 < need < 12e9
    assert ridgeform.memory_estimate("denoise", (1000, 2000), solver="clarabel") > ridgeform.memory_estimate(
        "denoise", (1000, 2000)
    )
    with pytest.raises(ridgeform.ArgumentError, match=r"tool: .*stylize"):
        ridgeform.memory_estimate("nothing", (1, 1))
    with pytest.raises(ridgeform.ArgumentError, match="mesh: expected a Mesh or its numbers"):
        ridgeform.memory_estimate("stylize", 7)


def test_a_long_hole_and_many_modes_take_more():
    mesh = ridgeform.Mesh(*shapes.grid())
    said = [ridgeform.memory_estimate("fill_holes", mesh, longest=n) for n in (4, 400)]
    assert said[1] > 100 * said[0]
    few, many = (ridgeform.memory_estimate("vibration_modes", mesh, columns=n) for n in (3, 300))
    assert many > 2 * few
    ridgeform.vibration_modes(mesh, 3, energy="l2_hessian", memory_limit=few)
    with pytest.raises(ridgeform.MemoryLimitError, match="vibration_modes: needs about"):
        ridgeform.vibration_modes(mesh, mesh.n_vertices, memory_limit=few)


@pytest.mark.parametrize("count", [2**40, 2**62])
def test_more_modes_than_vertices_are_an_error_at_once(count):
    with pytest.raises(ridgeform.ArgumentError, match=f"count: is {count}; ask for 1 to"):
        ridgeform.vibration_modes(ridgeform.Mesh(*shapes.grid()), count)


@pytest.mark.parametrize("n_vertices", [2**31, 2**40, 2**62])
def test_more_vertices_than_can_be_numbered_are_an_error_at_once(n_vertices):
    with pytest.raises(ridgeform.ArgumentError, match=rf"n_vertices: got {n_vertices}"):
        ridgeform.Mesh.from_edge_lengths([[0, 1, 2]], [[1.0, 1, 1]], n_vertices=n_vertices)


@pytest.mark.parametrize("index", [2**31 - 1, 2**31 - 2])
def test_an_index_that_no_array_reaches_is_an_error_at_once(index):
    with pytest.raises(ridgeform.MeshError):
        ridgeform.Mesh(np.eye(3), [[0, 1, index]])
    try:
        ridgeform.Mesh.from_edge_lengths([[0, 1, index]], [[1.0, 1, 1]])
    except ridgeform.RidgeformError as error:
        assert "needs about" in str(error) or "more than the 2147483647" in str(error)
