"""Coarser meshes of one that is larger than memory: each block is coarsened with what it shares with others
kept, and the next level, cut elsewhere, coarsens what was shared."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from . import _cut, _tasks
from ._run import Executor, Report, on_blocks
from ._store import Array, block_file, get, get_if, has, put, read, room

PART = 0.25
"""A level has about this part of the vertices of the finer one, as in `ridgeform.stylize`."""

WORTHWHILE = 0.6
"""A mesh with more than this part of the finer one's vertices is no level."""


@dataclass
class Work:
    """How blocks are made and worked on."""

    folder: Path
    max_vertices: int
    rings: int
    executor: Executor | None
    report: Report | None

    def level(self, depth: int) -> Path:
        """The folder of a level, 0 for the mesh itself."""
        return self.folder / f"level_{depth}"


def cut(work: Work, depth: int) -> int:
    """Divides a level into blocks; returns how many."""
    level = work.level(depth)
    vertices, faces = get(level, "vertices"), get(level, "faces")
    n_blocks = -(-len(vertices) // work.max_vertices)
    labels = _cut.bisect(vertices, n_blocks, depth)
    owner = room(level, "owner", np.int32, (len(faces),))
    # The part that most of the corners are in, or the middle one of three.
    for rows in chunks(len(faces)):
        owner[rows] = np.median(labels[faces[rows]], axis=1)
    starts, incident = _cut.incidence(faces, len(vertices))
    put(level, "starts", starts)
    put(level, "incident", incident)
    put(level, "shared", shared(starts, incident, owner))
    calls = [(str(level), block, work.rings) for block in range(n_blocks)]
    on_blocks(_tasks.surround, calls, work.executor, work.report, f"cutting level {depth}")
    return n_blocks


def shared(starts: Array, incident: Array, owner: Array) -> Array:
    """Which vertices have faces of several blocks."""
    used = np.flatnonzero(np.diff(starts))
    is_shared = np.zeros(len(starts) - 1, bool)
    if len(used):
        owners = owner[incident]
        low = np.minimum.reduceat(owners, starts[used])
        is_shared[used] = low != np.maximum.reduceat(owners, starts[used])
    return is_shared


def chunks(n: int, size: int = 1 << 18) -> list[slice]:
    """Rows in portions that need little memory."""
    return [slice(first, min(first + size, n)) for first in range(0, n, size)]


def coarser(work: Work, depth: int, n_blocks: int, enough: int) -> bool:
    """Makes the level above one that is cut, on the way to one of `enough` vertices; False where it would not
    be much coarser."""
    level, above = work.level(depth), work.level(depth + 1)
    # All levels of one ratio, so that the last is not needlessly small.
    ratio = enough / len(get(level, "vertices"))
    part = ratio ** (1.0 / np.ceil(np.log(ratio) / np.log(PART)))
    calls = [(str(level), block, part) for block in range(n_blocks)]
    counts = on_blocks(_tasks.coarsen, calls, work.executor, work.report, f"coarsening level {depth}")
    vertices, is_shared = get(level, "vertices"), get(level, "shared")
    kept = np.flatnonzero(is_shared)
    n_coarse = len(kept) + sum(count for count, _ in counts)
    if n_coarse > WORTHWHILE * len(vertices):
        return False
    above.mkdir(exist_ok=True)
    points = room(above, "vertices", np.float64, (n_coarse, 3))
    faces = room(above, "faces", np.int32, (sum(count for _, count in counts), 3))
    points[: len(kept)] = vertices[kept]
    names = []
    next_vertex, next_face = len(kept), 0
    for block in range(n_blocks):
        made = read(block_file(level, "coarse", block))
        name = np.empty(len(made["vertices"]), np.int32)
        is_kept, parents = made["is_kept"], made["parents"]
        local = np.flatnonzero(is_shared[made["fine"]] & (parents >= 0))
        name[parents[local]] = np.searchsorted(kept, made["fine"][local])
        fresh = np.arange(next_vertex, next_vertex + int((~is_kept).sum()))
        name[~is_kept] = fresh
        points[fresh] = made["vertices"][~is_kept]
        faces[next_face : next_face + len(made["faces"])] = name[made["faces"]]
        next_vertex, next_face = next_vertex + len(fresh), next_face + len(made["faces"])
        names.append(name)
    np.savez(level / "names.npz", *names)
    carry_settings(level, above, n_coarse, len(faces))
    return True


def carry_settings(level: Path, above: Path, n: int, m: int) -> None:
    """Gives the coarser level what vertices and faces were asked for, as means."""
    counts = np.zeros(n)
    sums = {name: np.zeros(n) for name in ("held", "strength") if has(level, name)}
    ridges = get_if(level, "ridges")
    of_faces = None if ridges is None else room(above, "ridges", np.float64, (m,))
    if not sums and of_faces is None:
        return
    first = 0
    for block, name in enumerate(names_of(level)):
        made = read(block_file(level, "coarse", block))
        local = np.flatnonzero(made["parents"] >= 0)
        parents = name[made["parents"][local]]
        np.add.at(counts, parents, 1.0)
        for kind, total in sums.items():
            np.add.at(total, parents, get(level, kind)[made["fine"][local]])
        if ridges is not None and of_faces is not None:
            at_fine = mean_at(made["fine_corners"], ridges[made["fine_faces"]], len(made["fine"]))
            at_coarse = mean_at(made["parents"][local][:, None], at_fine[local], len(name))
            of_faces[first : first + len(made["faces"])] = at_coarse[made["faces"]].mean(axis=1)
            first += len(made["faces"])
    means = {kind: total / np.maximum(counts, 1.0) for kind, total in sums.items()}
    if "held" in means:
        put(above, "held", means["held"] > 0.5)
    if "strength" in means:
        put(above, "strength", means["strength"])


def mean_at(rows: Array, values: Array, n: int) -> Array:
    """The mean at each of `n` vertices of the values of the rows that name it."""
    count = np.bincount(rows.ravel(), minlength=n)
    total = np.bincount(rows.ravel(), np.repeat(values, rows.shape[1]), minlength=n)
    return total / np.maximum(count, 1)


def names_of(level: Path) -> list[Array]:
    """For every block the vertices of the coarser level that those of its coarser mesh are."""
    with np.load(level / "names.npz") as found:
        return [found[f"arr_{block}"] for block in range(len(found.files))]


def carried(level: Path, moves: Array, name: str) -> None:
    """Writes the positions of a level's vertices, moved as those of the coarser level are."""
    vertices, is_shared, held = get(level, "vertices"), get(level, "shared"), get_if(level, "held")
    points = room(level, name, np.float64, vertices.shape)
    for rows in chunks(len(vertices)):
        points[rows] = vertices[rows]
    for block, names in enumerate(names_of(level)):
        made = read(block_file(level, "coarse", block))
        fine, places = made["fine"], made["places"]
        here = names[made["faces"][places]]
        by = np.einsum("ij,ijk->ik", made["weights"], moves[here])
        # What is shared is there on the coarser level as well, once for all blocks.
        same = is_shared[fine] & (made["parents"] >= 0)
        by[same] = moves[names[made["parents"][same]]]
        stays = (places < 0) & ~same
        if held is not None:
            stays |= held[fine]
        by[stays] = 0.0
        points[fine] = vertices[fine] + by


def carried_factors(level: Path, factors: Array) -> Array:
    """For every face the geometric mean of what the coarser faces have that its corners lie on."""
    found = np.ones(len(get(level, "faces")))
    first = 0
    for block in range(len(names_of(level))):
        made = read(block_file(level, "coarse", block))
        count = len(made["faces"])
        logs = np.log(factors[first : first + count])
        first += count
        at = np.where(made["places"] >= 0, logs[made["places"]], np.nan)[made["fine_corners"]]
        known = ~np.isnan(at)
        total = np.where(known, at, 0.0).sum(axis=1)
        found[made["fine_faces"]] = np.exp(total / np.maximum(known.sum(axis=1), 1))
    return found
