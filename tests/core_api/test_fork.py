"""After a fork: every call works in the child, whatever the parent has computed before or computes just then.

Linux forks for `multiprocessing` by default until Python 3.14; a pool of threads does not come along.
"""

import multiprocessing
import signal
import sys
import threading
import warnings

import numpy as np
import pytest
import ridgeform
from known_shapes import shapes

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="no fork there")
warnings.filterwarnings("ignore", "This process .* is multi-threaded", DeprecationWarning)

# A hang lasts forever; the longest call takes a second on a busy machine.
PATIENCE = 60


def mesh(levels=3):
    """A sphere with noise and a hole."""
    vertices, faces = shapes.icosphere(levels)
    return ridgeform.Mesh(shapes.add_noise(vertices, faces, 0.1), faces[6:])


def paint():
    """Two colors."""
    return (mesh().vertices[:, 2] > 0.1).astype(float)


# One number of each tool, and of calls with threads of their own.
CALLS = {
    "report": lambda: mesh().report.n_boundary_loops,
    "hessian_norm": lambda: ridgeform.hessian_norm(mesh(), mesh().vertices).sum(),
    "stylize": lambda: ridgeform.stylize(mesh(), iterations=2).energy[-1],
    "stylize on two threads": lambda: ridgeform.stylize(mesh(), iterations=2, threads=2).energy[-1],
    "denoise": lambda: ridgeform.denoise(mesh(5), mesh(5).vertices, fidelity=1e3).objective,
    "interpolate by Clarabel": lambda: (
        ridgeform.interpolate(mesh(2), [0, 40], [0.0, 1.0], solver="clarabel").objective
    ),
    "vibration_modes": lambda: ridgeform.vibration_modes(mesh(), 2, energy="l2_laplacian")[0, 0],
    "segment": lambda: ridgeform.segment(mesh()).n_segments,
    "fill_holes": lambda: len(ridgeform.fill_holes(mesh()).new_faces),
    "remesh": lambda: len(ridgeform.remesh(mesh(), iterations=2).faces),
    "diffusion_curves": lambda: ridgeform.diffusion_curves(mesh(), paint()).error,
}


def call(name):
    """The number of a call; in a pool, functions go by name."""
    return name, float(CALLS[name]())


def in_child(work):
    """What `work` returns in a forked child, or the exception that it raised."""
    receive, send = multiprocessing.get_context("fork").Pipe(duplex=False)

    def run():
        try:
            send.send(work())
        except BaseException as error:  # whatever it is, the parent has to hear of it
            send.send(error)

    process = multiprocessing.get_context("fork").Process(target=run)
    process.start()
    answered = receive.poll(PATIENCE)
    if not answered:
        process.kill()
    process.join()
    assert answered, "the call hangs in the child"
    return receive.recv()


@pytest.fixture(scope="module")
def expected():
    """The numbers in the parent, whose threads run from here on."""
    return dict(map(call, CALLS))


def test_a_pool_of_forked_processes_computes_what_the_parent_does(expected):
    with multiprocessing.get_context("fork").Pool(2) as pool:
        found = dict(pool.map_async(call, CALLS).get(PATIENCE))
    assert found == expected


def test_a_child_of_a_child_computes_too(expected):
    assert in_child(lambda: in_child(lambda: call("denoise"))) == ("denoise", expected["denoise"])


def test_a_fork_while_a_call_runs_leaves_neither_waiting(expected):
    progress, running = ridgeform.Progress(), mesh(5)
    long = threading.Thread(target=lambda: finishes(running, progress))
    long.start()
    try:
        for _ in range(5):
            child = in_child(lambda: (progress.fraction, progress.snapshot() is None, call("denoise")[1]))
            assert child[2] == expected["denoise"]
    finally:
        progress.finish()
        long.join(PATIENCE)
    assert not long.is_alive()


def finishes(running, progress):
    """A long call, until somebody finishes it."""
    ridgeform.stylize(running, iterations=100_000, fidelity=1e6, progress=progress)


def test_a_call_in_the_child_hears_ctrl_c(expected):
    def interrupted():
        signal.signal(signal.SIGINT, signal.default_int_handler)
        timer = threading.Timer(0.3, signal.raise_signal, [signal.SIGINT])
        timer.start()
        try:
            finishes(mesh(5), None)
        except KeyboardInterrupt:
            return "interrupted"

    assert in_child(interrupted) == "interrupted"


def test_a_million_threads_are_as_many_as_there_are(expected):
    assert ridgeform.stylize(mesh(), iterations=2, threads=10**6).energy[-1] == expected["stylize"]
    assert ridgeform.stylize(mesh(), iterations=2, threads=2**62).energy[-1] == expected["stylize"]
    with pytest.raises(ridgeform.ArgumentError, match="threads"):
        ridgeform.stylize(mesh(), threads=0)
    with pytest.raises(ridgeform.ArgumentError, match=r"^threads: the number is too large"):
        ridgeform.stylize(mesh(), threads=2**200)


def test_values_come_back_alike_from_a_child():
    values = in_child(lambda: ridgeform.denoise(mesh(), paint(), fidelity=10.0).values)
    np.testing.assert_array_equal(values, ridgeform.denoise(mesh(), paint(), fidelity=10.0).values)
