"""A ball with four limbs, whose parts are known at any density."""

import numpy as np
from numpy.typing import NDArray

from . import shapes

DIRECTIONS = np.array([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]]) / np.sqrt(3.0)
"""Where the limbs point: every one is a mirror image of every other."""
BODY = 4
"""The true part of the ball itself; the limbs are 0 to 3."""
RADIUS, REACH = 0.35, 2.5
"""Of the limbs: they are cylinders from the unit ball out to this distance from its center."""


def ball_with_limbs(levels: int = 4) -> tuple[NDArray[np.float64], NDArray[np.int64], NDArray[np.int64]]:
    """Vertices (n,3), faces (20 · 4^levels, 3), and the true part (m,) of each face: from 4 levels on it has
    several rings of faces on each limb.
    """
    vertices, faces = shapes.icosphere(levels)
    vertices = vertices / np.linalg.norm(vertices, axis=1, keepdims=True)
    cosine = (vertices @ DIRECTIONS.T).max(axis=1)
    sine = np.sqrt(np.maximum(1.0 - cosine**2, 1e-18))
    reach = np.where(cosine > 0, np.minimum(RADIUS / sine, REACH), 0.0)
    vertices = vertices * np.maximum(reach, 1.0)[:, None]
    middle = vertices[faces].mean(axis=1)
    limb = (middle @ DIRECTIONS.T).argmax(axis=1)
    truth = np.where(np.linalg.norm(middle, axis=1) > 1.02, limb, BODY)
    return vertices, faces, truth
