"""Parts of a ball under a Mirror modifier, for the tests of these."""

import addon_kit as kit
import bpy
import numpy as np
from bl_ext.user_default.ridgeform.framework.job import last_summary


def ball(seed: int = 0, cuts: int = 8) -> bpy.types.Object:
    """A whole ball of quads with bumps that are mirror images across the three planes."""
    obj = kit.bumpy_box("Ball", cuts=2 * cuts + 1, noise=0.0)
    places = kit.coordinates(obj).astype(np.float64)
    places /= np.linalg.norm(places, axis=1, keepdims=True)
    bumps = 0.06 * np.cos(7.0 * places).prod(axis=1) + 0.03 * np.cos(5.0 * places[:, 2] + seed)
    kit.set_coordinates(obj, places * (1.0 + bumps)[:, None])
    return obj


def cut(obj: bpy.types.Object, axes: str, move: np.ndarray | None = None) -> np.ndarray:
    """Keep the part of a mesh where the axes named are not negative; returns its coordinates."""
    places = kit.coordinates(obj)
    places[np.abs(places) < 1e-5] = 0.0
    vertices = np.array([v for face in obj.data.polygons for v in face.vertices]).reshape(-1, 4)
    middle = places[vertices].mean(axis=1)
    faces = vertices[(middle[:, ["XYZ".index(axis) for axis in axes]] > 0).all(axis=1)]
    used, local = np.unique(faces, return_inverse=True)
    points = places[used] if move is None else places[used] @ move[:3, :3].T + move[:3, 3]
    obj.data.clear_geometry()
    obj.data.from_pydata(points.tolist(), [], local.reshape(-1, 4).tolist())
    return kit.coordinates(obj)


def mirror(obj: bpy.types.Object, axes: str, **settings: object) -> bpy.types.Modifier:
    """Give an object a Mirror modifier."""
    modifier = obj.modifiers.new("Mirror", "MIRROR")
    modifier.use_axis = [axis in axes for axis in "XYZ"]
    for name, value in settings.items():
        setattr(modifier, name, value)
    return modifier


def half_ball(axes: str = "X", **settings: object) -> tuple[bpy.types.Object, np.ndarray]:
    """A half, quarter or eighth of a ball under a Mirror modifier, and its coordinates."""
    obj = ball()
    before = cut(obj, axes)
    mirror(obj, axes, **settings)
    return obj, before


def open_edges(obj: bpy.types.Object) -> int:
    """The edges with one face of the mesh that the modifiers make."""
    evaluated = obj.evaluated_get(bpy.context.evaluated_depsgraph_get())
    mesh = evaluated.to_mesh()
    count = np.zeros(len(mesh.edges), int)
    corners = np.empty(len(mesh.loops), np.int32)
    mesh.loops.foreach_get("edge_index", corners)
    np.add.at(count, corners, 1)
    evaluated.to_mesh_clear()
    return int((count == 1).sum())


def warnings() -> str:
    """What the last run said of its first mesh."""
    return "; ".join(last_summary()[0]["warnings"])
