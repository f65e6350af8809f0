"""Turn a public-domain scan into a fixture's source: upright, unit-sized, reduced to well-shaped triangles.

    python blend_fixtures/prepare_source.py SCAN.obj blend_fixtures/sources/bust.npz --vertices 9000

Needs bpy and fast-simplification. The sources beside this script were made so; it is kept to say how.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import bpy  # first: it makes bmesh and mathutils importable

# isort: split
import bmesh
import fast_simplification
import numpy as np
from mathutils import Vector
from mathutils.bvhtree import BVHTree
from numpy.typing import NDArray

AGGRESSION = 4
"""Of fast-simplification (default 7): at 5 and above, non-manifold edges were left on the Nefertiti scan."""
ROUNDS = 30
STEP = 0.5
CREASE_DEGREES = 40.0
"""Edges that bend by more are not flipped: a flip across a crease cuts it off."""


def load_obj(path: Path) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Vertices `(n, 3)` and triangles `(m, 3)` of an OBJ file, axes as written in the file."""
    vertices, faces = [], []
    for line in path.read_text().splitlines():
        word, *rest = line.split() or [""]
        if word == "v":
            vertices.append([float(x) for x in rest[:3]])
        elif word == "f":
            corners = [int(corner.split("/")[0]) - 1 for corner in rest]
            faces += [[corners[0], corners[i], corners[i + 1]] for i in range(1, len(corners) - 1)]
    return np.array(vertices), np.array(faces)


def upright(vertices: NDArray[np.float64], faces_minus_z: bool) -> NDArray[np.float64]:
    """Turn a y-up scan to Blender's z-up, facing -y; center it, feet on z = 0, height 2."""
    turned = vertices[:, [0, 2, 1]] * ([-1, 1, 1] if faces_minus_z else [1, -1, 1])
    low, high = turned.min(axis=0), turned.max(axis=0)
    center = 0.5 * (low + high)
    return (turned - [center[0], center[1], low[2]]) * (2.0 / (high[2] - low[2]))


def flip_to_delaunay(mesh: bmesh.types.BMesh) -> int:
    """Flip edges whose opposite angles add up to more than 180 degrees, except creases; number of flips."""
    flips = 0
    for edge in list(mesh.edges):
        if len(edge.link_loops) != 2 or edge.calc_face_angle() > np.radians(CREASE_DEGREES):
            continue
        opposite = [loop.link_loop_prev for loop in edge.link_loops]
        if sum(loop.calc_angle() for loop in opposite) <= np.pi + 1e-6:
            continue
        degrees = [len(vertex.link_edges) for vertex in edge.verts]
        joined = mesh.edges.get([loop.vert for loop in opposite])
        # The mesh would stop being manifold: a vertex of degree 2, or two edges between the same vertices.
        if min(degrees) <= 3 or joined is not None:
            continue
        flips += bmesh.utils.edge_rotate(edge, True) is not None
    return flips


def relax(mesh: bmesh.types.BMesh, surface: BVHTree) -> None:
    """Move vertices toward the area-weighted centroid of their faces, and back onto the surface."""
    mesh.normal_update()
    targets = []
    for vertex in mesh.verts:
        weights = [face.calc_area() for face in vertex.link_faces]
        centers = [face.calc_center_median() for face in vertex.link_faces]
        centroid = sum((w * c for w, c in zip(weights, centers, strict=True)), Vector()) / sum(weights)
        move = centroid - vertex.co
        targets.append(vertex.co + STEP * (move - move.dot(vertex.normal) * vertex.normal))
    for vertex, target in zip(mesh.verts, targets, strict=True):
        vertex.co = surface.find_nearest(target)[0]


def reduce(
    vertices: NDArray[np.float64], faces: NDArray[np.int64], n_vertices: int
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Quadric simplification, then rounds of Delaunay flips and of tangential relaxation on the surface."""
    surface = BVHTree.FromPolygons(vertices.tolist(), faces.tolist())
    reduced, reduced_faces = fast_simplification.simplify(
        vertices, faces, target_count=2 * n_vertices, agg=AGGRESSION
    )
    data = bpy.data.meshes.new("reduced")
    data.from_pydata(reduced.tolist(), [], reduced_faces.tolist())
    mesh = bmesh.new()
    mesh.from_mesh(data)
    for _ in range(ROUNDS):
        flip_to_delaunay(mesh)
        relax(mesh, surface)
    flip_to_delaunay(mesh)
    if not all(edge.is_manifold for edge in mesh.edges) or not all(
        vertex.is_manifold for vertex in mesh.verts
    ):
        raise SystemExit("The reduced mesh is not manifold: try another number of vertices.")
    mesh.verts.index_update()
    out = np.array([vertex.co for vertex in mesh.verts])
    out_faces = np.array([[vertex.index for vertex in face.verts] for face in mesh.faces])
    mesh.free()
    return out, out_faces


def main() -> None:
    """Write one OBJ file as a compressed NumPy file of `vertices` (float32) and `faces` (uint16)."""
    parser = argparse.ArgumentParser(description=main.__doc__)
    parser.add_argument("scan", type=Path)
    parser.add_argument("output", type=Path)
    parser.add_argument("--vertices", type=int, help="reduce to so many (default: as they are)")
    parser.add_argument("--faces-minus-z", action="store_true", help="the scan looks along -z, not +z")
    options = parser.parse_args()
    vertices, faces = load_obj(options.scan)
    vertices = upright(vertices, options.faces_minus_z)
    if options.vertices:
        vertices, faces = reduce(vertices, faces, options.vertices)
    np.savez_compressed(options.output, vertices=vertices.astype(np.float32), faces=faces.astype(np.uint16))
    print(f"{options.output}: {len(vertices)} vertices, {len(faces)} faces")


if __name__ == "__main__":
    main()
