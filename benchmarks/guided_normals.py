"""Guided normal filtering of meshes, in NumPy (Zhang, Deng, Zhang, Bouaziz and Liu 2015).

Normals are averaged over faces nearby, the more the nearer they are and the more alike their guidance; the
guidance of a face is the mean normal of the most consistent patch that holds it. Vertices then follow the
normals (Sun et al. 2007).
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Indices = NDArray[np.int64]


def unit_normals(vertices: Array, faces: Indices) -> Array:
    """Unit normals (m, 3); zero where a face has no area."""
    normals = _area_vectors(vertices, faces)
    return normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)


def _area_vectors(vertices: Array, faces: Indices) -> Array:
    a, b, c = (vertices[faces[:, i]] for i in range(3))
    return 0.5 * np.cross(b - a, c - a)


def _pairs_by_vertex(faces: Indices, n: int) -> tuple[Indices, Indices]:
    """All pairs of faces that share a vertex, a face with itself too: (k,) each, each pair once."""
    order = np.argsort(faces.ravel(), kind="stable")
    owner = order // 3
    starts = np.searchsorted(faces.ravel()[order], np.arange(n + 1))
    first, second = [], []
    for low, high in pairwise(starts):
        around = owner[low:high]
        first.append(np.repeat(around, len(around)))
        second.append(np.tile(around, len(around)))
    keys = np.unique(np.concatenate(first) * len(faces) + np.concatenate(second))
    return keys // len(faces), keys % len(faces)


def _edge_pairs(faces: Indices) -> tuple[Indices, Indices]:
    edges = np.sort(faces[:, [[1, 2], [2, 0], [0, 1]]], axis=2).reshape(-1, 2)
    order = np.lexsort((edges[:, 1], edges[:, 0]))
    same = (edges[order[1:]] == edges[order[:-1]]).all(axis=1)
    return order[:-1][same] // 3, order[1:][same] // 3


def _sum(n: int, index: Indices, values: Array) -> Array:
    return np.stack([np.bincount(index, values[:, c], n) for c in range(values.shape[1])], axis=1)


def _guidance(normals: Array, areas: Array, patch: tuple[Indices, Indices], edges: tuple[Indices, Indices]):
    """The mean normal of the most consistent patch around each face."""
    center, member = patch
    m = len(normals)
    mean = _sum(m, center, areas[member, None] * normals[member])
    mean /= np.maximum(np.linalg.norm(mean, axis=1, keepdims=True), 1e-300)
    # The largest difference of normals within a patch, from its mean: half of that between two at least.
    spread = np.zeros(m)
    np.maximum.at(spread, center, np.linalg.norm(normals[member] - normals[center], axis=1))
    # Saliency: the largest jump over an edge in the patch, over the sum of jumps.
    first, second = edges
    jump = np.linalg.norm(normals[first] - normals[second], axis=1)
    of_face, largest = np.zeros(m), np.zeros(m)
    np.add.at(of_face, first, jump)
    np.add.at(of_face, second, jump)
    np.maximum.at(largest, first, jump)
    np.maximum.at(largest, second, jump)
    total = np.bincount(center, of_face[member], m)
    most = np.zeros(m)
    np.maximum.at(most, center, largest[member])
    measure = spread * most / (1e-9 + total)
    # Each face takes the patch with the least measure of those that hold it.
    order = np.lexsort((measure[center], member))
    firsts = np.searchsorted(member[order], np.arange(m))
    return mean[center[order][firsts]]


def filtered(
    vertices: Array, faces: Indices, spread: float, rounds: int = 20, vertex_rounds: int = 10
) -> Array:
    """The vertices (n, 3) after filtering with normals that differ by about `spread`."""
    m, n = len(faces), len(vertices)
    patch, edges = _pairs_by_vertex(faces, n), _edge_pairs(faces)
    center, member = patch
    points = vertices.copy()
    middles = points[faces].mean(axis=1)
    across = np.linalg.norm(middles[edges[0]] - middles[edges[1]], axis=1)
    reach = 2.0 * across.mean()
    closeness = np.exp(-((middles[center] - middles[member]) ** 2).sum(axis=1) / (2.0 * reach**2))
    normals = unit_normals(points, faces)
    areas = np.linalg.norm(_area_vectors(points, faces), axis=1)
    for _ in range(rounds):
        guide = _guidance(normals, areas, patch, edges)
        alike = np.exp(-((guide[center] - guide[member]) ** 2).sum(axis=1) / (2.0 * spread**2))
        total = _sum(m, center, (areas[member] * closeness * alike)[:, None] * normals[member])
        normals = total / np.maximum(np.linalg.norm(total, axis=1, keepdims=True), 1e-300)
    count = np.maximum(np.bincount(faces.ravel(), minlength=n), 1)
    for _ in range(vertex_rounds):
        middles = points[faces].mean(axis=1)
        moved = np.zeros_like(points)
        for corner in range(3):
            height = ((middles - points[faces[:, corner]]) * normals).sum(axis=1)
            moved += _sum(n, faces[:, corner], height[:, None] * normals)
        points += moved / count[:, None]
    return points
