"""What is done to one block, in whichever process: it reads files of the level and writes one of its own."""

from pathlib import Path
from typing import Any

import numpy as np

from .. import _native
from ._cut import depths, rings
from ._store import Array, block_file, get, get_if, read, write


def areas(vertices: Array, faces: Array) -> Array:
    """The area of every face."""
    a, b, c = (vertices[faces[:, i]] for i in range(3))
    found: Array = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)
    return found


def surround(folder: str, block: int, count: int) -> int:
    """Finds what belongs to a block and the rings around it, and how far inside each vertex is."""
    level = Path(folder)
    starts, incident, faces = get(level, "starts"), get(level, "incident"), get(level, "faces")
    owned = np.flatnonzero(get(level, "owner") == block).astype(np.int32)
    all_faces, vertices, is_rim = rings(starts, incident, faces, owned, count)
    # Neighbors agree on what is outside, as far as the block reaches.
    corners = _native.orient(np.searchsorted(vertices, faces[all_faces]))[0]
    found = {
        "vertices": vertices.astype(np.int32),
        "faces": all_faces.astype(np.int32),
        "corners": corners,
        "owned": np.isin(all_faces, owned, assume_unique=True),
        "depth": depths(corners, is_rim, 2 * count),
    }
    write(block_file(level, "block", block), found)
    return len(owned)


def coarsen(folder: str, block: int, part: float) -> tuple[int, int]:
    """A coarser mesh of a block's own faces, with what it shares with others kept.

    Returns how many of its vertices are not shared, and how many faces it has.
    """
    level = Path(folder)
    found = read(block_file(level, "block", block))
    own = found["corners"][found["owned"]]
    local = np.unique(own)
    vertices = found["vertices"][local]
    faces = np.searchsorted(local, own)
    kept = np.asarray(get(level, "shared")[vertices])
    held = get_if(level, "held")
    mesh = _native.Mesh(get(level, "vertices")[vertices], faces)
    made = _native.coarsen(
        mesh,
        max(4, round(part * len(vertices))),
        kept=kept,
        held=None if held is None else np.asarray(held[vertices]),
    )
    is_kept = np.zeros(len(made.vertices), bool)
    is_kept[made.parents[kept & (made.parents >= 0)]] = True
    arrays = {
        "fine": vertices,
        "fine_faces": found["faces"][found["owned"]],
        "fine_corners": faces,
        "vertices": made.vertices,
        "faces": made.faces,
        "parents": made.parents,
        "places": made.places,
        "weights": made.weights,
        "is_kept": is_kept,
    }
    write(block_file(level, "coarse", block), arrays)
    return int((~is_kept).sum()), len(made.faces)


def bend(folder: str, block: int, state: int, dual: str, coupling: str) -> tuple[float, float, int]:
    """The norms of the Hessian of a block's own faces, times their areas: how much each bends.

    Returns their sum, that of the densities `norm / √area`, and of how many faces.
    """
    level = Path(folder)
    found = read(block_file(level, "block", block))
    points = np.asarray(get(level, f"points_{state}")[found["vertices"]])
    mesh = _native.Mesh(points, found["corners"])
    columns = [points] if coupling == "joint" else list(points.T)
    norms = sum(_native.hessian_norm(mesh, column, dual=dual) for column in columns)[found["owned"]]
    size = areas(points, found["corners"][found["owned"]])
    density = norms * np.sqrt(size)
    write(block_file(level, f"bend_{state}", block), {"norms": norms * size, "density": density})
    return float((norms * size).sum()), float(density.sum()), len(density)


def step(folder: str, block: int, state: int, options: dict[str, Any]) -> tuple[str, float]:
    """One step of the flow of a block, its outermost ring held. Returns its status and gap."""
    level = Path(folder)
    found = read(block_file(level, "block", block))
    vertices = found["vertices"]
    points = np.asarray(get(level, f"points_{state}")[vertices])
    held, strength = get_if(level, "held"), get_if(level, "strength")
    fixed = found["depth"] == 0
    if held is not None:
        fixed |= held[vertices]
    result = _native.stylize(
        _native.Mesh(points, found["corners"]),
        iterations=1,
        sharpness=0.0,
        fixed=fixed,
        strength=None if strength is None else np.asarray(strength[vertices]),
        ridge_weights=np.asarray(get(level, f"weights_{state}")[found["faces"]]),
        coarse_to_fine=False,
        **options,
    )
    write(block_file(level, f"step_{state}", block), {"moves": result.vertices - points})
    return result.status, float(result.gap.max(initial=0.0))


def whole_flow(
    folder: str, options: dict[str, Any], sharpness: float, flow: dict[str, Any]
) -> dict[str, Any]:
    """The whole flow of the coarsest level. Writes where it ended as `points_0`, and says how it went."""
    level = Path(folder)
    mesh = _native.Mesh(get(level, "vertices"), get(level, "faces"))
    keywords = {**options, **flow, "sharpness": sharpness, "coarse_to_fine": False}
    for ours, theirs in (("held", "fixed"), ("strength", "strength"), ("ridges", "ridge_weights")):
        keywords[theirs] = get_if(level, ours)
    result = _native.stylize(mesh, **keywords)
    write(level / "flow.npz", {"points": result.vertices})
    return {
        "status": result.status,
        "energy": result.energy,
        "fidelities": result.fidelities,
        "gap": result.gap,
        "iterations": result.iterations,
    }


def noise(folder: str, block: int, count: int) -> tuple[Array, int]:
    """How far a block's own faces are from going on into each other: quantiles of the noise along the normal
    that each edge would need, and of how many edges."""
    level = Path(folder)
    found = read(block_file(level, "block", block))
    points = np.asarray(get(level, "vertices")[found["vertices"]])
    ratios = hinge_noise(points, found["corners"][found["owned"]])
    if len(ratios) == 0:
        return np.zeros(count), 0
    return np.quantile(ratios, np.linspace(0.0, 1.0, count)), len(ratios)


def hinge_noise(points: Array, corners: Array) -> Array:
    """For every edge of two faces the jump of the gradient of the positions across it, over the norm of the
    jump's four coefficients."""
    tails, heads = corners[:, [1, 2, 0]].ravel(), corners[:, [2, 0, 1]].ravel()
    key = np.minimum(tails, heads).astype(np.int64) * len(points) + np.maximum(tails, heads)
    order = np.argsort(key, kind="stable")
    ordered = key[order]
    first = np.flatnonzero(ordered[1:] == ordered[:-1])
    one, other = order[first], order[first + 1]
    a, b = points[tails[one]], points[heads[one]]
    along = b - a
    length = np.maximum(np.linalg.norm(along, axis=1), np.finfo(float).tiny)
    sides = []
    for halfedges in (one, other):
        tip = points[corners.ravel()[halfedges]]
        part = np.einsum("ij,ij->i", tip - a, along) / length**2
        height = np.linalg.norm(tip - a - part[:, None] * along, axis=1)
        sides.append((tip, part, height))
    is_sound = (sides[0][2] > 0) & (sides[1][2] > 0)
    jump = np.zeros_like(a)
    squared = np.zeros(len(a))
    head = np.zeros(len(a))
    tail = np.zeros(len(a))
    for tip, part, height in sides:
        with np.errstate(divide="ignore", invalid="ignore"):
            slope = 1.0 / height
            jump += slope[:, None] * tip
            squared += slope**2
            head += part * slope
            tail += (1.0 - part) * slope
    with np.errstate(invalid="ignore", divide="ignore"):
        jump -= head[:, None] * b + tail[:, None] * a
        ratios: Array = np.linalg.norm(jump, axis=1) / np.sqrt(squared + head**2 + tail**2)
    return ratios[is_sound & np.isfinite(ratios)]


def segment(folder: str, block: int, options: dict[str, Any]) -> int:
    """The segments of a block and the rings around it. Returns how many."""
    level = Path(folder)
    found = read(block_file(level, "block", block))
    mesh = _native.Mesh(get(level, "vertices")[found["vertices"]], found["corners"])
    given = get_if(level, "ridges")
    weights = None if given is None else np.asarray(given[found["faces"]])
    result = _native.segment(mesh, face_weights=weights, **options)
    write(block_file(level, "segments", block), {"labels": result.labels})
    return result.n_segments
