"""The flow by levels, in blocks: the whole flow on the coarsest, two short steps on each finer one.

What is large is found on a level that fits into memory, so that all blocks agree on it. The steps on finer
levels are short: they reach over a few edges, less than the rings around a block. Weights, unit and fidelity
are those of the whole mesh in every step, and after each step what blocks have in common is a blend.
"""

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from . import _tasks
from ._levels import Work, carried, carried_factors, chunks, coarser, cut
from ._run import on_blocks
from ._store import Array, block_file, get, get_if, put, read, room

FLOOR = 0.1
"""Curvature below this part of the mean counts as none, as in `ridgeform.stylize`."""

STEPS = 2
"""Steps on every level but the coarsest, as in `ridgeform.stylize`."""


@dataclass
class Account:
    """What the steps on all levels did."""

    energy: list[float] = field(default_factory=list)
    gap: list[float] = field(default_factory=list)
    level_vertices: list[int] = field(default_factory=list)
    n_blocks: list[int] = field(default_factory=list)
    iterations: int = 0
    status: str = "finished"


@dataclass
class Plan:
    """What a flow is asked."""

    iterations: int
    sharpness: float
    enough: int
    """Vertices of the coarsest level."""
    ends: dict[str, Any]
    """`fidelity`, `movement`, `flat_share`"""
    step: dict[str, Any]
    """What every step is told: unit, solver, coupling."""


def flow(work: Work, plan: Plan) -> Account:
    """Runs the flow of level 0; its result is `points` there."""
    account = Account()
    blocks: list[int] = []
    while True:
        depth = len(blocks)
        blocks.append(cut(work, depth))
        n = len(get(work.level(depth), "vertices"))
        if n <= plan.enough or not coarser(work, depth, blocks[-1], plan.enough):
            break
    account.n_blocks = blocks
    start(work.level(0))
    account.energy.append(weigh(work, 0, blocks[0], 0, plan)[1])
    top = len(blocks) - 1
    state = coarsest(work, top, blocks[top], plan, account)
    if state is None or top == 0:
        return account
    for depth in range(top - 1, -1, -1):
        state = refine(work, depth, blocks[depth], plan, state=state, account=account)
    return account


@dataclass
class State:
    """What a level leaves to the finer one."""

    moves: Array
    factors: Array
    """By how much curvature has changed the weight of each face."""
    fidelity: float
    n_steps: int


def start(level: Path) -> None:
    """Begins where the mesh is."""
    vertices = get(level, "vertices")
    points = room(level, "points_0", np.float64, vertices.shape)
    for rows in chunks(len(vertices)):
        points[rows] = vertices[rows]
    (level / "points_0.npy").replace(level / "points.npy")
    start_copy = room(level, "points_0", np.float64, vertices.shape)
    for rows in chunks(len(vertices)):
        start_copy[rows] = vertices[rows]


def coarsest(work: Work, top: int, n_blocks: int, plan: Plan, account: Account) -> State | None:
    """The whole flow of the coarsest level; nothing where nothing is to be done."""
    level = work.level(top)

    def run(iterations: int) -> tuple[dict[str, Any], Array]:
        call = (str(level), plan.step, plan.sharpness, {**plan.ends, "iterations": iterations})
        (found,) = on_blocks(_tasks.whole_flow, [call], work.executor, work.report, "the coarsest level")
        return found, read(level / "flow.npz")["points"]

    told, points = run(plan.iterations)
    n = told["iterations"]
    account.iterations, account.status = n, told["status"]
    account.energy += list(told["energy"][1:])
    account.gap += list(told["gap"])
    account.level_vertices += [len(points)] * n
    if n == 0:
        return None
    if top == 0:
        put(level, "points", points)
        return None
    put(level, "points_0", points)
    factors = weigh(work, top, n_blocks, 0, plan)[0]
    # As far back as the short steps on the finer levels take.
    times = told["fidelities"][0] / np.asarray(told["fidelities"])
    back = int((np.cumsum(times[::-1]) <= STEPS * (1.0 + 1e-9)).sum())
    if back:
        points = run(n - back)[1] if n > back else get(level, "vertices")
    return State(points - get(level, "vertices"), factors, float(told["fidelities"][0]), min(STEPS, n))


def refine(work: Work, depth: int, n_blocks: int, plan: Plan, *, state: State, account: Account) -> State:
    """The short steps of one level, from where the coarser one has it."""
    level, n_steps = work.level(depth), state.n_steps
    carried(level, state.moves, "points_0")
    given: Array | None = carried_factors(level, state.factors)
    for i in range(n_steps):
        energy = weigh(work, depth, n_blocks, i, plan, given=given)[1]
        if i:
            account.energy.append(energy)
        given = None
        take_step(work, depth, n_blocks, i, {**plan.step, "fidelity": state.fidelity}, account=account)
        account.level_vertices.append(len(get(level, "vertices")))
    factors, energy = weigh(work, depth, n_blocks, n_steps, plan)
    account.energy.append(energy)
    if depth == 0:
        (level / f"points_{n_steps}.npy").replace(level / "points.npy")
        return state
    moves = get(level, f"points_{n_steps - 1}") - get(level, "vertices")
    return State(moves, factors, state.fidelity, n_steps)


def weigh(
    work: Work, depth: int, n_blocks: int, state: int, plan: Plan, *, given: Array | None = None
) -> tuple[Array, float]:
    """Writes the weights of all faces for the next step, with the mean curvature of the whole mesh, and
    returns by which factors they differ from those asked for, and the energy.

    As `ridgeform.stylize` has them (Candes et al. 2008): `base (a / mean a + 0.1)^(-sharpness)`, scaled so
    that the energy is what it was; with what the coarser level has `given`, the geometric mean of both.
    """
    level = work.level(depth)
    dual, coupling = plan.step["dual"], plan.step["coupling"]
    calls = [(str(level), block, state, dual, coupling) for block in range(n_blocks)]
    sums = on_blocks(_tasks.bend, calls, work.executor, work.report, f"weighing level {depth}")
    energy, density, count = (sum(column) for column in zip(*sums, strict=True))
    mean = density / max(count, 1)
    ridges = get_if(level, "ridges")
    factors = np.ones(len(get(level, "faces")))
    before = after = 0.0
    for block in range(n_blocks):
        file = block_file(level, f"bend_{state}", block)
        bent = read(file)
        file.unlink()
        if plan.sharpness == 0.0 or not mean > 0.0:
            continue
        found = read(block_file(level, "block", block))
        own = found["faces"][found["owned"]]
        factor = (bent["density"] / mean + FLOOR) ** -plan.sharpness
        base = 1.0 if ridges is None else ridges[own]
        before += float((base * bent["norms"]).sum())
        after += float((base * factor * bent["norms"]).sum())
        factors[own] = factor
    if after > 0.0:
        factors *= before / after
    weights = factors if given is None else np.sqrt(factors * given)
    put(level, f"weights_{state}", weights if ridges is None else weights * ridges)
    return factors, energy


def take_step(
    work: Work, depth: int, n_blocks: int, state: int, options: dict[str, Any], *, account: Account
) -> None:
    """One step of all blocks, joined: a vertex that several have is moved by the mean of their moves, each
    with a weight that grows from none some way inside of the block's rim."""
    level = work.level(depth)
    calls = [(str(level), block, state, options) for block in range(n_blocks)]
    told = on_blocks(_tasks.step, calls, work.executor, work.report, f"moving level {depth}")
    for status, gap in told:
        account.gap.append(gap)
        if status in {"diverged", "collapsed", "inaccurate"}:
            account.status = status
    points = get(level, f"points_{state}")
    moves = room(level, "moves", np.float64, points.shape)
    total = room(level, "total", np.float64, (len(points),))
    for block in range(n_blocks):
        found = read(block_file(level, "block", block))
        file = block_file(level, f"step_{state}", block)
        weight = np.maximum(found["depth"] - work.rings // 4, 0).astype(float)
        moves[found["vertices"]] += weight[:, None] * read(file)["moves"]
        total[found["vertices"]] += weight
        file.unlink()
    joined = room(level, f"points_{state + 1}", np.float64, points.shape)
    for rows in chunks(len(points)):
        joined[rows] = points[rows] + moves[rows] / np.maximum(total[rows], 1.0)[:, None]
    for name in ("moves", "total"):
        (level / f"{name}.npy").unlink()
