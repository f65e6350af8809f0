"""Named triangle meshes with known answers, for tests and fixtures (NumPy only).

Every shape is a pair `(vertices, faces)`: `(n, 3)` float64 coordinates and `(m, 3)` int64 vertex indices,
counter-clockwise seen from outside (from +z for flat shapes). Nothing is random without a seed.
"""

from __future__ import annotations

from itertools import combinations

import numpy as np
from numpy.typing import ArrayLike, NDArray

Vertices = NDArray[np.float64]
Faces = NDArray[np.int64]
Shape = tuple[Vertices, Faces]


def _shape(vertices: ArrayLike, faces: ArrayLike) -> Shape:
    return np.ascontiguousarray(vertices, dtype=np.float64), np.ascontiguousarray(faces, dtype=np.int64)


def _triangulate_quads(quads: NDArray[np.int64]) -> Faces:
    """Split `(k, 4)` quads along the diagonal from corner 0 to corner 2."""
    return np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])


def _grid_quads(ids: NDArray[np.int64]) -> NDArray[np.int64]:
    """Quads of a rectangular array of vertex indices, counter-clockwise: x along axis 0, y along axis 1."""
    return np.stack([ids[:-1, :-1], ids[1:, :-1], ids[1:, 1:], ids[:-1, 1:]], axis=-1).reshape(-1, 4)


def _circle(segments: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Cosines and sines of `segments` equal steps around the circle."""
    angle = 2 * np.pi * np.arange(segments) / segments
    return np.cos(angle), np.sin(angle)


# Flat shapes


def grid(n_x: int = 8, n_y: int = 8) -> Shape:
    """Unit-spaced square grid of `n_x` by `n_y` quads in the plane z = 0, each split along one diagonal."""
    x, y = np.meshgrid(np.arange(n_x + 1), np.arange(n_y + 1), indexing="ij")
    ids = np.arange(x.size).reshape(x.shape)
    vertices = np.stack([x.ravel(), y.ravel(), np.zeros(x.size)], axis=1)
    return _shape(vertices, _triangulate_quads(_grid_quads(ids)))


def flat_lattice(n_x: int = 8, n_y: int = 8) -> Shape:
    """Parallelogram of `2 n_x n_y` equilateral triangles of edge length 1 in the plane z = 0."""
    vertices, _ = grid(n_x, n_y)
    vertices[:, 0] += 0.5 * vertices[:, 1]
    vertices[:, 1] *= np.sqrt(0.75)
    quads = _grid_quads(np.arange(len(vertices)).reshape(n_x + 1, n_y + 1))
    return _shape(vertices, np.concatenate([quads[:, [0, 1, 3]], quads[:, [1, 2, 3]]]))


def random_delaunay(n: int = 40, seed: int = 0) -> Shape:
    """Delaunay triangulation of `n` uniform random points of the unit square, in the plane z = 0.

    By brute force over all triples (the empty circumcircle property itself), so keep `n` at 80 or below.
    """
    points = np.random.default_rng(seed).random((n, 2))
    triples = np.array(list(combinations(range(n), 3)))
    # Lifted to z = x² + y², the points inside a circumcircle are those below the plane of its three corners.
    lifted = np.column_stack([points, (points**2).sum(axis=1)])
    a, b, c = (lifted[triples[:, i]] for i in range(3))
    normal = np.cross(b - a, c - a)
    clockwise = normal[:, 2] < 0
    normal[clockwise] *= -1
    triples[clockwise] = triples[clockwise][:, [0, 2, 1]]
    height = normal @ lifted.T - (normal * a).sum(axis=1)[:, None]
    np.put_along_axis(height, triples, 0.0, axis=1)
    faces = triples[(height >= 0).all(axis=1)]
    return _shape(np.column_stack([points, np.zeros(n)]), faces)


# Polyhedra: known planar regions, creases at known places


def subdivide(vertices: ArrayLike, faces: ArrayLike, levels: int = 1) -> Shape:
    """Split every triangle into four at its edge midpoints, `levels` times; the surface stays the same."""
    vertices, faces = _shape(vertices, faces)
    for _ in range(levels):
        opposite = np.sort(faces[:, [[1, 2], [2, 0], [0, 1]]], axis=2).reshape(-1, 2)
        edges, edge_of = np.unique(opposite, axis=0, return_inverse=True)
        mid = edge_of.reshape(-1, 3) + len(vertices)
        vertices = np.concatenate([vertices, vertices[edges].mean(axis=1)])
        corners = [np.stack([faces[:, i], mid[:, i - 1], mid[:, i - 2]], axis=1) for i in range(3)]
        faces = np.concatenate([*corners, mid])
    return vertices, faces


def voxels(cells: list[tuple[int, int, int]], n: int = 4, side: float = 1.0) -> Shape:
    """Boundary of a union of cubic cells, `n` by `n` triangulated quads on every exposed cell side, welded.

    Cell `(i, j, k)` fills the unit cube with lowest corner `(i, j, k)`, scaled by `side`.
    """
    u, v = np.meshgrid(np.arange(n + 1), np.arange(n + 1), indexing="ij")
    quads_of_side = _grid_quads(np.arange(u.size).reshape(u.shape))
    quads = []
    for cell in cells:
        for axis in range(3):
            for step in (0, 1):
                beside = np.array(cell)
                beside[axis] += 2 * step - 1
                if tuple(beside.tolist()) in cells:
                    continue
                lattice = np.empty((n + 1, n + 1, 3), dtype=np.int64)
                lattice[..., axis] = step * n
                # (axis + 1, axis + 2, axis) is right-handed: seen from outside on the far side only.
                lattice[..., (axis + 1) % 3], lattice[..., (axis + 2) % 3] = (u, v) if step else (v, u)
                quads.append((lattice + n * np.array(cell)).reshape(-1, 3)[quads_of_side])
    corners, index = np.unique(np.concatenate(quads).reshape(-1, 3), axis=0, return_inverse=True)
    return _shape(corners * (side / n), _triangulate_quads(index.reshape(-1, 4)))


def cube(n: int = 16, side: float = 2.0) -> Shape:
    """Cube about the origin, `n` by `n` triangulated quads a side: `6 n² + 2` vertices (1538 for n = 16)."""
    vertices, faces = voxels([(0, 0, 0)], n, side)
    return vertices - 0.5 * side, faces


def rounded_box(n: int, radius: float, sides: ArrayLike = (1.9, 1.5, 1.3)) -> Shape:
    """Box about the origin, `n` by `n` quads a side as on a cube, edges rounded by `radius`."""
    vertices, faces = cube(n, 1.0)
    outside = vertices * np.asarray(sides)
    core = 0.5 * np.asarray(sides) - radius
    inside = np.clip(outside, -core, core)
    away = outside - inside
    return inside + radius * away / np.maximum(np.linalg.norm(away, axis=1, keepdims=True), 1e-12), faces


def l_shape(n: int = 4) -> Shape:
    """Three unit cells in an L, `n` by `n` quads a cell side: one concave edge."""
    return voxels([(0, 0, 0), (1, 0, 0), (0, 0, 1)], n)


def staircase(steps: int = 3, n: int = 4) -> Shape:
    """Solid staircase of unit steps rising in x, `n` by `n` quads a cell side."""
    return voxels([(i, 0, k) for i in range(steps) for k in range(i + 1)], n)


def house(levels: int = 3) -> Shape:
    """Gabled house: a box of 2 by 3 by 1.5 under a 45 degree roof, ridge along y; seven planar sides."""
    profile = np.array([[-1, 0], [1, 0], [1, 1.5], [0, 2.5], [-1, 1.5]])
    front = np.column_stack([profile[:, 0], np.full(5, -1.5), profile[:, 1]])
    vertices = np.concatenate([front, front * [1, -1, 1]])
    sides = np.array([[i, i + 5, (i + 1) % 5 + 5, (i + 1) % 5] for i in range(5)])
    gable = np.array([[0, 1, 2], [0, 2, 4], [2, 3, 4]])
    faces = np.concatenate([_triangulate_quads(sides), gable, gable[:, ::-1] + 5])
    return subdivide(vertices, faces, levels)


def dodecahedron(levels: int = 2) -> Shape:
    """Regular dodecahedron of circumradius 1, each pentagon a fan around its center, then subdivided."""
    axes, triangles = icosphere(0)
    corners = axes[triangles].mean(axis=1)
    corners /= np.linalg.norm(corners, axis=1, keepdims=True)
    centers, faces = [], []
    for i, axis in enumerate(axes):
        around = np.flatnonzero((triangles == i).any(axis=1))
        x = corners[around[0]] - (corners[around[0]] @ axis) * axis
        angles = np.arctan2(corners[around] @ np.cross(axis, x), corners[around] @ x)
        ring = around[np.argsort(angles)]
        faces += [[len(corners) + i, ring[k], ring[(k + 1) % 5]] for k in range(5)]
        centers.append(corners[ring].mean(axis=0))
    return subdivide(np.concatenate([corners, centers]), faces, levels)


def tetrahedron() -> Shape:
    """Regular tetrahedron with corners at alternate corners of the cube [-1, 1]³ (edge length √8)."""
    vertices = [[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]]
    return _shape(vertices, [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]])


# Curved shapes


def octahedron(levels: int = 3) -> Shape:
    """Octahedron with corners at distance 1 on the axes, its sides each cut in four so many times."""
    corners = np.array([(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)], float)
    sides = [(a, b, c) for a in (0, 1) for b in (2, 3) for c in (4, 5)]
    faces = [side if np.linalg.det(corners[list(side)]) > 0 else side[::-1] for side in sides]
    return subdivide(corners, faces, levels)


def icosphere(levels: int = 3) -> Shape:
    """Unit sphere from the icosahedron, subdivided `levels` times: `10 · 4^levels + 2` vertices."""
    golden = (1 + np.sqrt(5)) / 2
    rectangle = np.array([[-1, golden, 0], [1, golden, 0], [-1, -golden, 0], [1, -golden, 0]])
    vertices = np.concatenate([np.roll(rectangle, k, axis=1) for k in range(3)]) / np.hypot(1, golden)
    distance = np.linalg.norm(vertices[:, None] - vertices[None], axis=2)
    adjacent = distance < 1.2  # the edge is 1.0515, the next distance 1.7013
    triples = combinations(range(12), 3)
    faces = np.array([t for t in triples if all(adjacent[i, j] for i, j in combinations(t, 2))])
    inward = np.linalg.det(vertices[faces]) < 0
    faces[inward] = faces[inward][:, [0, 2, 1]]
    for _ in range(levels):
        vertices, faces = subdivide(vertices, faces)
        vertices /= np.linalg.norm(vertices, axis=1, keepdims=True)
    return _shape(vertices, faces)


def _revolved(radius: NDArray[np.float64], z: NDArray[np.float64], segments: int) -> Shape:
    """Turn the profile `(radius, z)` about the z axis; it starts and ends on the axis, lowest point first."""
    cos, sin = _circle(segments)
    height = np.broadcast_to(z[1:-1, None], (len(z) - 2, segments))
    tube = np.stack([radius[1:-1, None] * cos, radius[1:-1, None] * sin, height], axis=-1).reshape(-1, 3)
    vertices = np.concatenate([tube, [[0, 0, z[0]], [0, 0, z[-1]]]])
    ids = np.pad(np.arange(len(tube)).reshape(-1, segments), ((0, 0), (0, 1)), mode="wrap")
    low, high = np.full(segments, len(tube)), np.full(segments, len(tube) + 1)
    bottom = np.stack([low, ids[0, 1:], ids[0, :-1]], axis=1)
    top = np.stack([high, ids[-1, :-1], ids[-1, 1:]], axis=1)
    return _shape(vertices, np.concatenate([_triangulate_quads(_grid_quads(ids.T)), bottom, top]))


def uv_sphere(segments: int = 32, rings: int = 16) -> Shape:
    """Unit sphere of `rings` bands of `segments` quads (triangulated), poles on the z axis."""
    polar = np.pi * np.arange(rings + 1) / rings
    return _revolved(np.sin(polar), -np.cos(polar), segments)


def cylinder(segments: int = 32, bands: int = 8, cap_rings: int = 4) -> Shape:
    """Closed cylinder of radius 1, height 2 along z; caps of `cap_rings` rings around a center vertex."""
    cap = np.arange(cap_rings) / cap_rings
    radius = np.concatenate([cap, np.ones(bands + 1), cap[::-1]])
    z = np.concatenate([-np.ones(cap_rings), np.linspace(-1, 1, bands + 1), np.ones(cap_rings)])
    return _revolved(radius, z, segments)


def torus(segments: int = 32, rings: int = 16, radius: float = 1.0, tube: float = 0.4) -> Shape:
    """Torus around the z axis: `segments` by `rings` vertices, Euler characteristic 0."""
    (cos_u, sin_u), (cos_v, sin_v) = _circle(segments), _circle(rings)
    r = radius + tube * cos_v
    height = np.tile(tube * sin_v, (segments, 1))
    vertices = np.stack([np.outer(cos_u, r), np.outer(sin_u, r), height], axis=-1)
    ids = np.pad(np.arange(segments * rings).reshape(segments, rings), ((0, 1), (0, 1)), mode="wrap")
    return _shape(vertices.reshape(-1, 3), _triangulate_quads(_grid_quads(ids)))


# Shapes that break assumptions


def open_cone(segments: int = 8, height: float = 1.0) -> Shape:
    """Fan of triangles from the apex (vertex 0) to a unit circle: one interior vertex, one boundary loop."""
    cos, sin = _circle(segments)
    vertices = np.concatenate([[[0, 0, height]], np.stack([cos, sin, np.zeros(segments)], axis=1)])
    return _shape(vertices, [[0, 1 + k, 1 + (k + 1) % segments] for k in range(segments)])


def bow_tie() -> Shape:
    """Two triangles that share vertex 0 and no edge: a non-manifold vertex."""
    vertices = [[0, 0, 0], [1, -0.5, 0], [1, 0.5, 0], [-1, 0.5, 0], [-1, -0.5, 0]]
    return _shape(vertices, [[0, 1, 2], [0, 3, 4]])


def moebius_strip(segments: int = 24, width: float = 0.5) -> Shape:
    """Möbius strip of radius 1: one boundary loop, orientation inconsistent across exactly one edge."""
    cos, sin = _circle(segments)
    half_turn = np.pi * np.arange(segments) / segments
    across = np.array([[-0.5], [0.5]]) * width
    r = 1 + across * np.cos(half_turn)
    vertices = np.stack([r * cos, r * sin, across * np.sin(half_turn)], axis=-1).reshape(-1, 3)
    ids = np.arange(2 * segments).reshape(2, segments)
    ids = np.concatenate([ids, ids[::-1, :1]], axis=1)
    return _shape(vertices, _triangulate_quads(_grid_quads(ids.T)))


def three_faces_on_an_edge() -> Shape:
    """Three triangles sharing the edge from vertex 0 to vertex 1: a non-manifold edge."""
    vertices = [[0, 0, 0], [0, 0, 1], [1, 0, 0.5], [-0.5, 0.8, 0.5], [-0.5, -0.8, 0.5]]
    return _shape(vertices, [[0, 1, 2], [0, 1, 3], [0, 1, 4]])


# Noise, motions and measures


def vertex_normals(vertices: Vertices, faces: Faces) -> NDArray[np.float64]:
    """Area-weighted unit vertex normals, `(n, 3)`; zero where a vertex has no face with area."""
    a, b, c = (vertices[faces[:, i]] for i in range(3))
    normals = np.zeros_like(vertices)
    for i in range(3):
        np.add.at(normals, faces[:, i], np.cross(b - a, c - a))
    length = np.linalg.norm(normals, axis=1, keepdims=True)
    return np.divide(normals, length, out=np.zeros_like(normals), where=length > 0)


def mean_edge_length(vertices: Vertices, faces: Faces) -> float:
    """Mean length of the edges, each counted once."""
    edges = np.unique(np.sort(faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1), axis=0)
    return float(np.linalg.norm(vertices[edges[:, 0]] - vertices[edges[:, 1]], axis=1).mean())


def add_noise(
    vertices: Vertices,
    faces: Faces,
    sigma_of_edge: float,
    seed: int = 0,
    *,
    edge: float | None = None,
    along_normals: bool = False,
) -> Vertices:
    """Vertices moved by Gaussian noise of standard deviation `sigma_of_edge · edge` (default: the mean edge).

    In each coordinate independently, or along the area-weighted vertex normals with `along_normals`.
    """
    sigma = sigma_of_edge * (mean_edge_length(vertices, faces) if edge is None else edge)
    rng = np.random.default_rng(seed)
    if along_normals:
        return vertices + sigma * rng.standard_normal((len(vertices), 1)) * vertex_normals(vertices, faces)
    return vertices + sigma * rng.standard_normal(vertices.shape)


def noisy_cube(seed: int = 0) -> Shape:
    """The benchmark of noise removal: `cube(16, 2.0)` with isotropic noise of 0.15 of its grid edge of 1/8.

    Its root mean square distance to the true cube is 0.0188 (mean over seeds; 0.0185 to 0.0193): see
    `distance_to_cube`.
    """
    vertices, faces = cube(16, 2.0)
    return add_noise(vertices, faces, 0.15, seed, edge=2.0 / 16), faces


def distance_to_cube(points: Vertices, side: float = 2.0) -> NDArray[np.float64]:
    """Unsigned distance of every point to the surface of the cube of `cube(side=side)`, `(n,)`."""
    q = np.abs(points) - 0.5 * side
    outside = np.linalg.norm(np.maximum(q, 0.0), axis=1)
    return outside - np.minimum(q.max(axis=1), 0.0)


def root_mean_square(values: ArrayLike) -> float:
    """Root of the mean of the squares."""
    return float(np.sqrt(np.mean(np.square(values))))


def random_rotation(seed: int = 0) -> NDArray[np.float64]:
    """Uniformly random rotation matrix, `(3, 3)`, determinant +1; apply as `vertices @ rotation.T`."""
    q, r = np.linalg.qr(np.random.default_rng(seed).standard_normal((3, 3)))
    q = q * np.sign(np.diag(r))
    return q if np.linalg.det(q) > 0 else -q
