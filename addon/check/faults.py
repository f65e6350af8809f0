# SPDX-License-Identifier: GPL-3.0-or-later
"""The faults of a mesh as arrays of elements: those that the wheel sees, and those of Blender's meshes.

What the wheel says of triangles is said of the faces that they are parts of. No loop over elements.
"""

import numpy as np
import ridgeform

from ..framework.far_origin import step_of
from .arrays import MeshArrays

NOT_PLANAR = np.radians(5.0)
"""From this angle between the triangles of a face on Blender's Split Non-Planar Faces cuts it."""


def loose_vertices(mesh: MeshArrays) -> np.ndarray:
    """Vertices that no edge has."""
    return np.flatnonzero(np.bincount(mesh.edges.ravel(), minlength=len(mesh.places)) == 0)


def loose_edges(mesh: MeshArrays) -> np.ndarray:
    """Edges that no face has."""
    return np.flatnonzero(mesh.faces_at_edges == 0)


def nonmanifold_edges(mesh: MeshArrays) -> np.ndarray:
    """Edges that more than two faces have."""
    return np.flatnonzero(mesh.faces_at_edges > 2)


def sound(mesh: MeshArrays) -> MeshArrays:
    """The mesh with only those triangles whose vertices all have a place; the others are at the origin."""
    if mesh.is_finite.all():
        return mesh
    kept = mesh.is_finite[mesh.triangles].all(axis=1)
    places = np.where(mesh.is_finite[:, None], mesh.places, np.float32(0.0))
    return MeshArrays(
        places,
        mesh.edges,
        mesh.starts,
        mesh.corner_vertices,
        mesh.corner_edges,
        mesh.triangles[kept],
        mesh.triangle_faces[kept],
    )


def welded(mesh: MeshArrays) -> np.ndarray:
    """The vertex (n,) that each is one with, itself the lowest of those: what the tools weld."""
    _, _, index = ridgeform.weld(mesh.places, mesh.triangles)
    first = np.empty(int(index.max(initial=-1)) + 1, np.int64)
    first[index[::-1]] = np.arange(len(index))[::-1]
    return first[index]


def weldable(mesh: MeshArrays, target: np.ndarray) -> np.ndarray:
    """Those of the welds (n,) that leave a clean surface; where surfaces would touch, vertices stay apart.

    Otherwise what was split to be clean would be found, and welded, again.
    """
    target = target.copy()
    own = np.arange(len(target))
    while True:
        joined = np.zeros(len(target), bool)
        joined[target[target != own]] = True
        if not joined.any():
            return target
        touched = target[mesh.triangles]
        touched = touched[joined[touched].any(axis=1)]
        used, local = np.unique(touched, return_inverse=True)
        report = ridgeform.Mesh(mesh.places[used], local.reshape(-1, 3)).report
        # Edges with two faces that disagree are a matter of turning them.
        agreeing = _rows_not_in(report.nonmanifold_edges, report.inconsistent_edges, len(used))
        bad = np.zeros(len(target), bool)
        bad[used[report.nonmanifold_vertices]] = True
        bad[used[agreeing.ravel()]] = True
        apart = (target != own) & bad[target]
        if not apart.any():
            return target
        target[apart] = own[apart]


def _rows_not_in(rows: np.ndarray, others: np.ndarray, n: int) -> np.ndarray:
    keys, without = (pairs.reshape(-1, 2).astype(np.int64) @ [n, 1] for pairs in (rows, others))
    return rows.reshape(-1, 2)[~np.isin(keys, without)]


def in_groups(target: np.ndarray) -> np.ndarray:
    """The vertices that are one with others, these too, of a weld (n,)."""
    return np.flatnonzero(np.bincount(target, minlength=len(target))[target] > 1)


def orientation(mesh: MeshArrays, target: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Faces that the tools turn over, and edges at which faces disagree even then.

    That is once vertices are welded to their targets (n,).
    """
    triangles = target[mesh.triangles]
    a, b, c = triangles.T
    kept = (a != b) & (b != c) & (c != a)
    turned, flipped = ridgeform.orient(triangles[kept])
    faces = np.unique(mesh.triangle_faces[kept][flipped])
    are_welded = (target != np.arange(len(target))).any()
    if len(faces) == 0 and not are_welded and len(mesh.report.inconsistent_edges) == 0:
        return faces, np.empty(0, np.int64)
    pairs = ridgeform.Mesh(mesh.places, turned).report.inconsistent_edges.reshape(-1, 2)
    of_edges = np.sort(target[mesh.edges], axis=1).astype(np.int64) @ [len(target), 1]
    return faces, np.flatnonzero(np.isin(of_edges, pairs.astype(np.int64) @ [len(target), 1]))


def of_triangles(mesh: MeshArrays, target: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Vertices whose faces form several fans, and faces without area, as the wheel says.

    Fans count that are still several once vertices are welded (n,), and that no edge with more than two faces
    makes. A face has no area if none of its triangles has.
    """
    if len(mesh.triangles) == 0:
        return np.empty(0, np.int64), np.empty(0, np.int64)
    report = mesh.report
    fans = report.nonmanifold_vertices.astype(np.int64)
    fans = fans[~np.isin(fans, mesh.edges[nonmanifold_edges(mesh)])]
    if len(fans) and (target != np.arange(len(target))).any():
        joined = ridgeform.Mesh(mesh.places, target[mesh.triangles]).report
        fans = fans[np.isin(target[fans], joined.nonmanifold_vertices)]
    flat = np.bincount(mesh.triangle_faces[report.degenerate_faces], minlength=len(mesh.starts))
    counted = np.bincount(mesh.triangle_faces, minlength=len(mesh.starts))
    return fans, np.flatnonzero((flat > 0) & (flat == counted))


def duplicate_faces(mesh: MeshArrays, target: np.ndarray) -> np.ndarray:
    """Faces with the corners of an earlier one, in any order, once vertices are welded (n,)."""
    if len(mesh.starts) == 0:
        return np.empty(0, np.int64)
    vertices = target[mesh.corner_vertices]
    # Faces with equal corners have equal sums of random numbers; others hardly ever, and are looked at.
    numbers = np.random.default_rng(0).integers(0, 2**63, len(mesh.places), np.uint64)
    sums = np.add.reduceat(numbers[vertices], mesh.starts)
    order = np.argsort(sums, kind="stable")
    same = np.diff(sums[order]) == 0
    suspects = np.zeros(len(sums), bool)
    suspects[order[1:][same]] = suspects[order[:-1][same]] = True
    found = []
    for size in np.unique(mesh.sizes[suspects]):
        faces = np.flatnonzero(suspects & (mesh.sizes == size))
        corners = np.sort(vertices[mesh.starts[faces][:, None] + np.arange(size)], axis=1)
        _, first = np.unique(corners, axis=0, return_index=True)
        found.append(np.delete(faces, first))
    return np.sort(np.concatenate(found)) if found else np.empty(0, np.int64)


def doubled_faces(mesh: MeshArrays, target: np.ndarray, duplicates: np.ndarray) -> np.ndarray:
    """Faces that lie on another one from a common edge on, with other corners, as a second lid does.

    That is once vertices are welded (n,) and without the duplicates, which are named as such.
    """
    if len(duplicates) == 0 and (target == np.arange(len(target))).all():
        return np.unique(mesh.triangle_faces[mesh.report.doubled_faces])
    triangles = target[mesh.triangles]
    a, b, c = triangles.T
    kept = ~np.isin(mesh.triangle_faces, duplicates) & (a != b) & (b != c) & (c != a)
    report = ridgeform.Mesh(mesh.places, triangles[kept]).report
    return np.unique(mesh.triangle_faces[kept][report.doubled_faces])


def uneven_ngons(mesh: MeshArrays) -> np.ndarray:
    """Faces of five corners and more whose triangles are turned against each other."""
    large = mesh.sizes > 4
    if not large.any():
        return np.empty(0, np.int64)
    rows = np.flatnonzero(large[mesh.triangle_faces])
    faces = mesh.triangle_faces[rows]
    corners = mesh.places[mesh.triangles[rows]].astype(np.float64)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    means = np.stack([np.bincount(faces, normals[:, k], len(large)) for k in range(3)], axis=1)
    lengths = np.linalg.norm(normals, axis=1) * np.linalg.norm(means, axis=1)[faces]
    along = (normals * means[faces]).sum(axis=1)
    # The mean of two triangles is half the angle from either. Where single precision, which moves a corner
    # against the edge across from it by up to √3 steps, can turn a sliver as far, its normal says nothing.
    longest = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1)
    least = np.sqrt(3.0) * step_of(mesh.places) / np.sin(0.5 * NOT_PLANAR)
    certain = np.linalg.norm(normals, axis=1) > least * longest
    turned = certain & (along < np.cos(0.5 * NOT_PLANAR) * lengths)
    return np.unique(faces[turned])
