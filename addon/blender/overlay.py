# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces drawn over the 3D views while a tool runs, without touching any mesh."""

import traceback
from collections.abc import Sequence

import bpy
import gpu
import numpy as np
from gpu_extras.batch import batch_for_shader
from mathutils import Matrix

FRONT = np.array([1.0, 0.55, 0.15])
"""The color of a surface that faces the light: an orange that is no theme's mesh color."""
LIGHT = np.array([0.36, -0.48, 0.8])
SHADE = 0.35
"""How bright a surface is that faces away from the light."""
Surface = tuple[Matrix, np.ndarray, np.ndarray]
"""Where an object is, vertices (n, 3) and triangles (m, 3)."""


class Overlay:
    """Some surfaces, drawn in every 3D view until they are removed."""

    def __init__(self) -> None:
        """Begin without surfaces."""
        self._handle: object | None = None
        self._batch: object | None = None
        self._corners = np.empty((0, 3), np.float32)
        self._colors = np.empty((0, 4), np.float32)

    @property
    def n_triangles(self) -> int:
        """How many triangles are shown."""
        return len(self._corners) // 3

    def show(self, surfaces: Sequence[Surface]) -> bool:
        """Show these surfaces instead of those before; whether anything is different."""
        drawn = [_triangles(*surface) for surface in surfaces]
        corners = np.concatenate(drawn).reshape(-1, 3) if drawn else np.empty((0, 3), np.float32)
        if np.array_equal(corners, self._corners):
            return False
        self._corners, self._colors, self._batch = corners, _shaded(corners), None
        if self._handle is None:
            self._handle = bpy.types.SpaceView3D.draw_handler_add(self._draw, (), "WINDOW", "POST_VIEW")
        _redraw()
        return True

    def remove(self) -> None:
        """Take the surfaces away; a second call does nothing."""
        if self._handle is not None:
            bpy.types.SpaceView3D.draw_handler_remove(self._handle, "WINDOW")
            self._handle = None
            self._corners = self._corners[:0]
            _redraw()

    def _draw(self) -> None:
        try:
            self._draw_batch()
        except Exception:
            # Once, and not for every redraw: nothing is shown from now on.
            traceback.print_exc()
            self._draw_batch = lambda: None

    def _draw_batch(self) -> None:
        # Made here, since only while drawing is there surely a graphics context.
        shader = gpu.shader.from_builtin("FLAT_COLOR")
        if self._batch is None:
            self._batch = batch_for_shader(shader, "TRIS", {"pos": self._corners, "color": self._colors})
        gpu.state.depth_test_set("LESS_EQUAL")
        self._batch.draw(shader)
        gpu.state.depth_test_set("NONE")


def _triangles(matrix: Matrix, vertices: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """The corners (m, 3, 3) float32 of triangles in the world."""
    transform = np.array(matrix)
    return (vertices @ transform[:3, :3].T + transform[:3, 3])[faces].astype(np.float32)


def _shaded(corners: np.ndarray) -> np.ndarray:
    """A color (3 m, 4) float32 for each corner (3 m, 3), the same for a whole triangle."""
    a, b, c = (corners[i::3].astype(np.float64) for i in range(3))
    normal = np.cross(b - a, c - a)
    length = np.linalg.norm(normal, axis=1)
    lit = np.abs(normal @ LIGHT) / np.where(length > 0, length, 1.0)
    color = FRONT * (SHADE + (1.0 - SHADE) * lit)[:, None]
    return np.repeat(np.column_stack([color, np.ones(len(color))]), 3, axis=0).astype(np.float32)


def _redraw() -> None:
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                area.tag_redraw()
