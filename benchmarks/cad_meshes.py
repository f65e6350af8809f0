"""Mesh CAD parts, each face of the kernel a label; needs `requirements-cad.txt` and the wheel.

python benchmarks/cad_meshes.py FOLDER

Writes FOLDER/names.txt, and FOLDER/K.npz for the K-th part of `cad_parts.py`, with `KIND_vertices` (n,3),
`KIND_faces` (m,3), `KIND_truth` (m,), and which of the faces of the kernel are fillets or chamfers,
`KIND_fillets`, for each kind of mesh: `coarse` and `fine` as the kernel tessellates it, `remeshed` with even
triangles.
"""

from __future__ import annotations

import sys
from pathlib import Path

import cadquery as cq
import numpy as np
import ridgeform
from cad_fillets import Fillets
from cad_parts import PARTS
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

TOLERANCES = {"coarse": (0.3, 0.4), "fine": (0.05, 0.12), "source": (0.02, 0.1)}
"""How far a tessellation is off the part, in millimeters, and how far two of its faces turn, in radians."""
FACES = 12_000
"""About so many triangles has a remeshed part."""
SAME = 1e-5
"""Corners of faces are one vertex within this part of the size."""

FIELDS = ("vertices", "faces", "truth")

Mesh = tuple[np.ndarray, np.ndarray, np.ndarray]


def tessellated(part: cq.Workplane, linear: float, angular: float) -> tuple[Mesh, np.ndarray]:
    """The kernel's triangles, those of each of its faces with one label, corners that coincide as one, and
    which of its faces have triangles.
    """
    solid = part.val().copy()
    solid.mesh(linear, angular)
    points, triangles, truth, count = [], [], [], 0
    for label, face in enumerate(solid.Faces()):
        corners, faces = face.tessellate(linear, angular)
        points += [corner.toTuple() for corner in corners]
        triangles += [[index + count for index in triangle] for triangle in faces]
        truth += [label] * len(faces)
        count = len(points)
    vertices = np.array(points)
    vertices, corner = welded(vertices, SAME * np.ptp(vertices, axis=0).max())
    faces = corner[np.array(triangles)]
    whole = (faces != np.roll(faces, 1, axis=1)).all(axis=1)
    there, labels = np.unique(np.array(truth)[whole], return_inverse=True)
    return (vertices, faces[whole], labels), there


def welded(points: np.ndarray, distance: float) -> tuple[np.ndarray, np.ndarray]:
    """The points without those that are within a distance of another, and the new index of each."""
    pairs = cKDTree(points).query_pairs(distance, output_type="ndarray")
    links = coo_array((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(len(points), len(points)))
    labels = connected_components(links, directed=False)[1]
    return points[np.unique(labels, return_index=True)[1]], labels


def remeshed(source: Mesh) -> Mesh:
    """Even triangles, each with the label of what lies nearest to its center."""
    vertices, faces, truth = source
    corners = vertices[faces]
    areas = 0.5 * np.linalg.norm(
        np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1
    )
    edge = float(np.sqrt(areas.sum() / FACES / (np.sqrt(3) / 4)))
    found = ridgeform.remesh(ridgeform.Mesh(vertices, faces), edge_length=edge)
    centers = found.vertices[found.faces].mean(axis=1)
    points, owner = sampled(corners, edge / 8.0)
    return found.vertices, found.faces.astype(np.int64), truth[owner[cKDTree(points).query(centers)[1]]]


def sampled(corners: np.ndarray, spacing: float) -> tuple[np.ndarray, np.ndarray]:
    """Points inside triangles `(m,3,3)`, about a spacing apart, and the triangle of each."""
    longest = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).argmax(axis=1)
    order = (longest[:, None] + [2, 0, 1]) % 3
    a, b, c = np.moveaxis(np.take_along_axis(corners, order[:, :, None], axis=1), 1, 0)
    length = np.linalg.norm(b - a, axis=1)
    height = np.linalg.norm(np.cross(b - a, c - a), axis=1) / length
    counts = np.ceil(np.column_stack([length, height]) / spacing).astype(int).clip(1)
    points, owner = [], []
    for n, m in np.unique(counts, axis=0):
        chosen = np.flatnonzero((counts == (n, m)).all(axis=1))
        along, up = (g.ravel() for g in np.meshgrid((np.arange(n) + 0.5) / n, (np.arange(m) + 0.5) / m))
        shares = np.column_stack([(1 - along) * (1 - up), along * (1 - up), up])
        places = np.einsum("kc,ctx->tkx", shares, np.stack([a, b, c])[:, chosen])
        points.append(places.reshape(-1, 3))
        owner.append(np.repeat(chosen, len(shares)))
    return np.concatenate(points), np.concatenate(owner)


def main(folder: Path) -> None:
    """Write the meshes of all parts."""
    folder.mkdir(parents=True, exist_ok=True)
    for k, make in enumerate(PARTS.values()):
        with Fillets() as fillets:
            part = make()
        is_fillet = np.array([fillets.have(face) for face in part.val().Faces()])
        arrays = {}
        for kind, tolerance in TOLERANCES.items():
            mesh, there = tessellated(part, *tolerance)
            name = "remeshed" if kind == "source" else kind
            fields = zip(FIELDS, remeshed(mesh) if kind == "source" else mesh, strict=True)
            arrays |= {f"{name}_{field}": array for field, array in fields}
            arrays[f"{name}_fillets"] = is_fillet[there]
        np.savez(folder / f"{k}.npz", **arrays)
    (folder / "names.txt").write_text("\n".join(PARTS) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
