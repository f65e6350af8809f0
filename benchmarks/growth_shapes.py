"""Meshes with many of one thing that a file can have many of: vertices `(n,3)`, faces `(m,3)` for a count."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

Shape = tuple[np.ndarray, np.ndarray]


def grid(side_x: int, side_y: int | None = None, seed: int = 0) -> Shape:
    """A grid of so many squares a side, with noise."""
    side_y = side_y or side_x
    x, y = np.meshgrid(np.arange(side_x + 1.0), np.arange(side_y + 1.0), indexing="ij")
    vertices = np.column_stack([x.ravel(), y.ravel(), np.zeros(x.size)])
    vertices += np.random.default_rng(seed).normal(scale=0.05, size=vertices.shape)
    corner = (np.arange(side_x)[:, None] * (side_y + 1) + np.arange(side_y)).ravel()
    step = side_y + 1
    faces = np.concatenate(
        [
            np.column_stack([corner, corner + step, corner + step + 1]),
            np.column_stack([corner, corner + step + 1, corner + 1]),
        ]
    )
    return vertices, faces.astype(np.int32)


def loose_vertices(count: int) -> Shape:
    """A small grid, and so many vertices without faces."""
    vertices, faces = grid(10)
    return np.vstack([vertices, 20 + np.random.default_rng(1).normal(size=(count, 3))]), faces


def components(count: int) -> Shape:
    """So many single triangles."""
    random = np.random.default_rng(2)
    corners = random.normal(size=(count, 3, 3)) * 0.3 + random.normal(size=(count, 1, 3)) * count ** (1 / 3)
    return corners.reshape(-1, 3), np.arange(3 * count, dtype=np.int32).reshape(-1, 3)


def valence(count: int) -> Shape:
    """A fan of so many faces around one vertex, closed."""
    angles = 2 * np.pi * np.arange(count) / count
    rim = np.column_stack([np.cos(angles), np.sin(angles), 0.05 * np.sin(5 * angles)])
    corner = np.arange(count)
    faces = np.column_stack([0 * corner, 1 + corner, 1 + (corner + 1) % count])
    return np.vstack([[[0.0, 0.0, 0.3]], rim]), faces.astype(np.int32)


def boundary_loops(count: int) -> Shape:
    """A grid with so many square holes of two faces."""
    side = int(np.ceil(np.sqrt(count)))
    vertices, faces = grid(3 * side + 1)
    n_squares = (3 * side + 1) ** 2
    square = np.arange(n_squares)
    row, column = square // (3 * side + 1), square % (3 * side + 1)
    holes = np.flatnonzero((row % 3 == 1) & (column % 3 == 1))[:count]
    kept = np.ones(n_squares, bool)
    kept[holes] = False
    return vertices, faces[np.concatenate([kept, kept])]


def long_loop(count: int) -> Shape:
    """A ring around one round hole of so many edges."""
    angles = 2 * np.pi * np.arange(count) / count
    rings = [
        np.column_stack(
            [(1 + 0.1 * k) * np.cos(angles), (1 + 0.1 * k) * np.sin(angles), 0 * angles + 0.05 * k * k]
        )
        for k in range(3)
    ]
    here = np.arange(count)
    after = (here + 1) % count
    faces = [
        part
        for k in range(2)
        for part in (
            np.column_stack([k * count + here, (k + 1) * count + here, (k + 1) * count + after]),
            np.column_stack([k * count + here, (k + 1) * count + after, k * count + after]),
        )
    ]
    return np.concatenate(rings), np.concatenate(faces).astype(np.int32)


def islands(count: int) -> Shape:
    """So many small open sheets above one another."""
    vertices, faces = grid(2)
    step = np.arange(count)[:, None, None] * np.array([0.0, 0.0, 3.0])
    return (vertices + step).reshape(-1, 3), (
        faces + len(vertices) * np.arange(count)[:, None, None]
    ).reshape(-1, 3)


def duplicate_faces(count: int) -> Shape:
    """A small grid, one of its faces so many times."""
    vertices, faces = grid(10)
    return vertices, np.vstack([faces, np.repeat(faces[50:51], count, axis=0)])


def nonmanifold_edges(count: int) -> Shape:
    """A grid with so many fins, each on an edge of its own."""
    vertices, faces = grid(int(np.ceil(np.sqrt(count))))
    edges = faces[:count, :2]
    fins = np.column_stack([edges, len(vertices) + np.arange(len(edges))])
    tips = vertices[edges].mean(1)
    tips[:, 2] += 1.0
    return np.vstack([vertices, tips]), np.vstack([faces, fins]).astype(np.int32)


def book(count: int) -> Shape:
    """So many faces on one edge."""
    angles = 2 * np.pi * np.arange(count) / count
    tips = np.column_stack([np.cos(angles), np.sin(angles), np.full(count, 0.5)])
    faces = np.column_stack([np.zeros(count), np.ones(count), 2 + np.arange(count)])
    return np.vstack([[[0.0, 0.0, 0.0], [0.0, 0.0, 1.0]], tips]), faces.astype(np.int32)


def coincident_vertices(count: int) -> Shape:
    """So many vertices of a grid in one place."""
    vertices, faces = grid(int(np.ceil(np.sqrt(2 * count))))
    vertices[:count] = vertices[0]
    return vertices, faces


def strip(count: int) -> Shape:
    """A strip of so many squares, one wide."""
    return grid(count, 1)


def plain(count: int) -> Shape:
    """A grid of about so many vertices: how the call grows with the mesh alone."""
    return grid(int(np.sqrt(count)))


SHAPES: dict[str, Callable[[int], Shape]] = {
    "vertices": plain,
    "loose vertices": loose_vertices,
    "components": components,
    "valence": valence,
    "boundary loops": boundary_loops,
    "edges of one loop": long_loop,
    "open sheets": islands,
    "duplicate faces": duplicate_faces,
    "non-manifold edges": nonmanifold_edges,
    "faces on one edge": book,
    "coincident vertices": coincident_vertices,
    "strip": strip,
}
"""What there are many of → the mesh."""
