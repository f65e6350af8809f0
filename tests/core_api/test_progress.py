"""Running calls: watched, cancelled, finished and interrupted from another thread."""

import functools
import signal
import threading
import time

import numpy as np
import pytest
import ridgeform
from known_shapes import shapes

# One inner iteration or factorization here takes up to half a second; the rest is for busy machines.
PATIENCE = 5.0


@functools.cache
def sphere(levels):
    """A sphere with noise, 10 · 4^levels vertices: a problem that is not solved at a glance."""
    vertices, faces = shapes.icosphere(levels)
    return ridgeform.Mesh(shapes.add_noise(vertices, faces, 0.1), faces)


def flow(progress, **keywords):
    """A flow that goes on for much longer than the tests wait."""
    return ridgeform.stylize(
        sphere(5), **{"iterations": 100_000, "fidelity": 1e6, **keywords}, progress=progress
    )


# Calls that take much longer than the tests wait.
CALLS = {
    "stylize": flow,
    "stylize with Clarabel": lambda progress: ridgeform.stylize(
        sphere(3), solver="clarabel", progress=progress
    ),
    "denoise": lambda progress: ridgeform.denoise(
        sphere(6), sphere(6).vertices, fidelity=1e4, tolerance=1e-12, progress=progress
    ),
    "interpolate": lambda progress: ridgeform.interpolate(
        sphere(6), range(20), sphere(6).vertices[:20], tolerance=1e-12, progress=progress
    ),
}


class Running:
    """A call on a thread of its own, its outcome, and when it ended."""

    def __init__(self, call):
        """Start the call."""
        self.progress = ridgeform.Progress()
        self.result = self.error = self.ended = None
        self._thread = threading.Thread(target=self._run, args=(call,), daemon=True)
        self._thread.start()

    def _run(self, call):
        try:
            self.result = call(self.progress)
        except ridgeform.RidgeformError as error:
            self.error = error
        self.ended = time.perf_counter()

    def until(self, condition):
        """Wait until the progress fulfils a condition."""
        deadline = time.perf_counter() + 60
        while not condition(self.progress):
            assert time.perf_counter() < deadline, "the call never got there"
            assert self._thread.is_alive(), f"the call ended before: {self.error or self.result}"
            time.sleep(0.002)

    def end(self):
        """Wait for the end; the seconds since now."""
        start = time.perf_counter()
        self._thread.join(60)
        assert not self._thread.is_alive()
        return self.ended - start


@pytest.fixture(autouse=True)
def _meshes():
    """Make the meshes before the clock starts."""
    for levels in (3, 5, 6):
        sphere(levels)


@pytest.mark.parametrize("call", CALLS.values(), ids=CALLS)
def test_cancel_raises_within_one_inner_iteration(call):
    running = Running(call)
    time.sleep(0.4)
    running.progress.cancel()
    assert running.end() < PATIENCE
    assert isinstance(running.error, ridgeform.Cancelled)
    assert running.result is None


@pytest.mark.parametrize("name", ["denoise", "interpolate"])
def test_finish_returns_the_values_reached(name):
    running = Running(CALLS[name])
    running.until(lambda progress: progress.iteration > 0)
    assert running.progress.stage
    assert running.progress.energy > 0
    assert running.progress.gap > 0
    running.progress.finish()
    assert running.end() < PATIENCE
    assert running.error is None
    assert running.result.status == "stopped"
    assert np.isfinite(running.result.values).all()
    assert np.abs(running.result.values - sphere(6).vertices).max() > 0
    assert running.result.gap > 1e-12


def test_finish_returns_the_steps_done():
    running = Running(flow)
    running.until(lambda progress: progress.iteration > 2)
    running.progress.finish()
    assert running.end() < PATIENCE
    assert running.error is None
    result = running.result
    assert result.status == "stopped"
    assert result.iterations > 2
    assert result.energy.shape == (result.iterations + 1,)
    assert result.gap.shape == result.solver_iterations.shape == (result.iterations,)
    np.testing.assert_array_equal(running.progress.snapshot(), result.vertices)


def test_progress_tells_where_a_flow_stands():
    fresh = ridgeform.Progress()
    assert (fresh.fraction, fresh.stage, fresh.iteration, fresh.energy, fresh.gap) == (0.0, "", 0, None, None)
    assert fresh.snapshot() is None
    assert "not started" in repr(fresh)
    progress = ridgeform.Progress()
    result = flow(progress, iterations=3)
    assert progress.fraction == 1.0
    assert progress.iteration == 3
    assert progress.stage
    assert progress.stage in repr(progress)
    assert progress.energy == result.energy[-1]
    assert progress.gap == result.gap[-1]
    np.testing.assert_array_equal(progress.snapshot(), result.vertices)


def test_snapshots_follow_the_flow():
    running = Running(flow)
    running.until(lambda progress: progress.snapshot() is not None)
    first = running.progress.snapshot()
    assert first.shape == (sphere(5).n_vertices, 3)
    assert np.isfinite(first).all()
    assert np.abs(first - sphere(5).vertices).max() > 0
    seen = running.progress.iteration
    running.until(lambda progress: progress.iteration > seen + 1)
    assert np.abs(running.progress.snapshot() - first).max() > 0
    first[:] = 0
    running.progress.finish()
    running.end()
    assert np.abs(running.result.vertices).max() > 0.5


def test_snapshots_are_numbered():
    assert ridgeform.Progress().numbered_snapshot() is None
    running = Running(lambda progress: flow(progress, iterations=4))
    seen = {}
    while running._thread.is_alive():
        snapshot = running.progress.numbered_snapshot()
        if snapshot is not None:
            seen.setdefault(*snapshot)
    running.end()
    number, last = running.progress.numbered_snapshot()
    assert number == 4
    np.testing.assert_array_equal(last, running.result.vertices)
    for steps, vertices in seen.items():
        np.testing.assert_array_equal(vertices, flow(ridgeform.Progress(), iterations=steps).vertices)


def test_the_fraction_only_grows():
    fractions = []
    running = Running(lambda progress: flow(progress, iterations=6))
    while running.ended is None:
        fractions.append(running.progress.fraction)
        time.sleep(0.005)
    assert fractions == sorted(fractions)
    assert 0 <= fractions[0] <= fractions[-1] <= 1
    assert len(set(fractions)) > 2


def test_the_interpreter_lock_is_released():
    running = Running(flow)
    running.until(lambda progress: progress.iteration > 0)
    turns, end = 0, time.perf_counter() + 0.5
    while time.perf_counter() < end:
        turns += 1
    running.progress.cancel()
    running.end()
    assert isinstance(running.error, ridgeform.Cancelled)
    # Without the lock not one turn would fit in; with it, hundreds of thousands do.
    assert turns > 1000


def test_two_calls_run_at_once():
    runs = [Running(flow) for _ in range(2)]
    for running in runs:
        running.until(lambda progress: progress.iteration > 1)
    for running in runs:
        running.progress.cancel()
    for running in runs:
        running.end()
        assert isinstance(running.error, ridgeform.Cancelled)


@pytest.fixture
def hears_ctrl_c():
    """Hand Ctrl-C to Python, also where a shell runs the tests in the background and ignores it for them."""
    previous = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, previous)


@pytest.mark.usefixtures("hears_ctrl_c")
@pytest.mark.parametrize("call", CALLS.values(), ids=CALLS)
def test_ctrl_c_interrupts(call):
    sent = []

    def interrupt():
        sent.append(time.perf_counter())
        signal.raise_signal(signal.SIGINT)

    timer = threading.Timer(0.4, interrupt)
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        call(None)
    assert time.perf_counter() - sent[0] < PATIENCE
    timer.join()


def test_other_signal_handlers_run_and_the_call_goes_on():
    seen = []
    previous = signal.signal(signal.SIGINT, lambda number, frame: seen.append(number))
    try:
        timer = threading.Timer(0.1, signal.raise_signal, [signal.SIGINT])
        timer.start()
        result = flow(None, iterations=4)
        timer.join()
    finally:
        signal.signal(signal.SIGINT, previous)
    assert seen == [signal.SIGINT]
    assert result.iterations == 4


def test_a_cancelled_handle_stays_cancelled(cancelled):
    for call in CALLS.values():
        with pytest.raises(ridgeform.Cancelled):
            call(cancelled)


def test_a_flow_finished_before_it_began_is_the_input():
    progress = ridgeform.Progress()
    progress.finish()
    result = flow(progress)
    assert (result.status, result.iterations) == ("stopped", 0)
    np.testing.assert_array_equal(result.vertices, sphere(5).vertices)


# A call, and how often it asks at least whether to stop: once for each piece of work that takes time.
QUESTIONS = {
    "an edge of each round of remeshing": (
        lambda progress: ridgeform.remesh(sphere(3), iterations=3, progress=progress),
        3 * 1920,
    ),
    "a column": (
        lambda progress: ridgeform.denoise(
            sphere(2), np.eye(162, 50), fidelity=1.0, coupling="separate", progress=progress
        ),
        50,
    ),
    "a column of a quadratic energy": (
        lambda progress: ridgeform.denoise(
            sphere(2), np.eye(162, 50), fidelity=1.0, energy="l2_laplacian", progress=progress
        ),
        50,
    ),
    "an iteration of each step": (
        lambda progress: ridgeform.stylize(sphere(3), iterations=5, tolerance=1e-6, progress=progress),
        5 * 10,
    ),
    "an iteration of Clarabel": (
        lambda progress: ridgeform.denoise(
            sphere(3), sphere(3).vertices, fidelity=1e3, solver="clarabel", progress=progress
        ),
        5,
    ),
}


@pytest.mark.parametrize("piece", QUESTIONS)
def test_calls_ask_whether_to_stop_for(piece):
    call, least = QUESTIONS[piece]
    progress = ridgeform.Progress()
    assert progress.asked == 0
    call(progress)
    assert progress.asked >= least


def test_remeshing_finished_in_the_middle_is_a_mesh():
    running = Running(lambda progress: ridgeform.remesh(sphere(6), iterations=50, progress=progress))
    running.until(lambda progress: progress.asked > 50_000)
    running.progress.finish()
    assert running.end() < PATIENCE
    result = running.result
    assert result.status == "stopped"
    assert np.isfinite(result.vertices).all()
    assert ridgeform.Mesh(result.vertices, result.faces).report.nonmanifold_edges.size == 0


def test_clarabel_is_left_while_it_computes():
    """Neither wish waits for an iteration; one of these takes seconds."""
    mesh = sphere(6)
    for wish in ("cancel", "finish"):
        running = Running(
            lambda progress: ridgeform.stylize(mesh, solver="clarabel", iterations=1, progress=progress)
        )
        running.until(lambda progress: progress.asked > 2)
        asked = running.progress.asked
        getattr(running.progress, wish)()
        running.end()
        assert running.progress.asked <= asked + 6
        assert isinstance(running.error, ridgeform.Cancelled) == (wish == "cancel")
        if wish == "finish":
            np.testing.assert_array_equal(running.result.vertices, mesh.vertices)


def test_facet_that_finishes_while_it_merges_leaves_the_mesh_and_begins_anew_later():
    mesh = sphere(3)
    progress = ridgeform.Progress()
    progress.finish()
    stopped = ridgeform.facet(mesh, facets=20, progress=progress)
    assert stopped.status == "stopped" and stopped.n_facets == 0
    left = np.sort(stopped.origins[stopped.faces], axis=1)
    np.testing.assert_array_equal(left, np.sort(mesh.faces, axis=1))
    assert stopped.at(facets=20).n_facets == ridgeform.facet(mesh, facets=20).n_facets


def test_a_quadratic_energy_of_many_columns_leaves_those_that_were_not_begun():
    mesh = sphere(3)
    values = np.repeat(mesh.vertices, 20, axis=1)
    progress = ridgeform.Progress()
    progress.finish()
    found = ridgeform.denoise(mesh, values, fidelity=1.0, energy="l2_hessian", progress=progress)
    assert found.status == "stopped" and np.isfinite(found.gap)
    assert not np.array_equal(found.values[:, 0], values[:, 0])
    np.testing.assert_array_equal(found.values[:, 1:], values[:, 1:])
    whole = ridgeform.denoise(mesh, values, fidelity=1.0, energy="l2_hessian")
    assert found.objective - found.gap * found.objective <= whole.objective <= found.objective


def test_fill_holes_that_finishes_at_once_closes_the_holes():
    vertices, faces = shapes.icosphere(3)
    mesh = ridgeform.Mesh(vertices, faces[vertices[faces].mean(axis=1)[:, 2] < 0.8])
    progress = ridgeform.Progress()
    progress.finish()
    found = ridgeform.fill_holes(mesh, sharpness=0.5, outer=True, progress=progress)
    assert found.status == "stopped" and [hole.status for hole in found.holes] == ["stopped"]
    assert len(ridgeform.find_holes(ridgeform.Mesh(found.vertices, found.faces))) == 0
