"""The pictures of the manual's page on filling holes: edges brought back, a checker through patches."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import bpy
import numpy as np
import pictures
from known_shapes import holed_shapes, shapes
from numpy.typing import NDArray
from picture_geometry import Lines

from addon.blender import mesh_io
from addon.framework.settings import defaults_of
from addon.holes.extension import PATCH_NAME
from addon.holes.settings import HoleSettings
from addon.holes.tool import HoleFilling

Array = NDArray[np.float64]
Indices = NDArray[np.int64]
Map = Callable[[Array, Array], Array]
"""UVs (m, 3, 2) of corners (m, 3, 3) of triangles with normals (m, 3)."""

PATCH = (0.75, 0.36, 0.1)
"""Linear RGB of the patches."""
BORDER = (0.75, 0.2, 0.02)
SQUARES = 4.0
"""Squares of the checker in one unit of the UV map."""
CUTS = 10
"""Every triangle is drawn as so many squared: the edges of the checker's squares are that exact."""
LIGHT, DARK = (0.62, 0.62, 0.6), (0.1, 0.17, 0.28)
BOX_VIEW = (0.9, -0.75, 0.75)
RING_VIEW = (0.25, -0.8, 0.75)
OTHER_MATERIAL = (0.45, 0.65, 1.0)
"""Factor on the color of faces with the second material."""
BRIGHTNESS = 1.35
"""Factor on painted colors under the lights, which are set for a light clay."""


def box(path: Path) -> None:
    """A box with a hole across an edge and one at a corner: before, after, and the edges of the patches."""
    places = [((1.0, 0.15, 1.0), 0.5), ((1.0, -1.0, 0.95), 0.45)]
    solid = holed_shapes.irregular(holed_shapes.cube(16), 2)
    obj = _object(holed_shapes.cut(solid, places))
    look = {"view": BOX_VIEW, "size": 330, "frame": _triangles(obj)[0]}
    row = [pictures.render(*_triangles(obj), **look)]
    _fill(obj)
    vertices, faces = _triangles(obj)
    color = np.where(_is_patch(obj)[:, None], PATCH, pictures.CLAY)
    edges = np.unique(np.sort(faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1), axis=0)
    wires = [Lines(vertices[edges], pixels=0.8)]
    row.append(pictures.render(vertices, faces, color=color, **look))
    row.append(pictures.render(vertices, faces, color=color, marks=wires, **look))
    captions = ["before", "after", "with its edges"]
    pictures.sheet(path, [row], captions=[captions], text_pixels=15, shades=64)


def settings(path: Path) -> None:
    """What each setting does to a patch: a row for each, the open mesh first."""
    box = _cut(holed_shapes.irregular(holed_shapes.cube(16), 2), (1.0, 0.1, 1.0), 0.6)
    corner = _cut(holed_shapes.irregular(holed_shapes.cube(16), 2), (1.0, -1.0, 1.0), 0.7)
    ball = _cut(holed_shapes.sphere(24), (0.7, -0.6, 0.5), 0.75)
    pipe = holed_shapes.cylinder(14)
    is_lid = (pipe.vertices[pipe.faces][..., 2] > 1.0 - 1e-6).all(axis=1)
    tube = pipe.vertices, pipe.faces[~is_lid]
    rows = [
        (box, "Shape", "shape", {"Automatic": "AUTO", "Sharp": "SHARP", "Smooth": "SMOOTH"}),
        (tube, "Shape", "shape", {"Automatic": "AUTO", "Sharp": "SHARP", "Smooth": "SMOOTH"}),
        (ball, "Shape", "shape", {"Automatic": "AUTO", "Flat": "FLAT", "Sharp": "SHARP"}),
        (corner, "Sharp, Sharpness", "sharpness", {"0": 0.0, "0.5": 0.5, "1": 1.0}),
        (box, "Edge Length", "edge_length", {"off": 0.0, "0.06": 0.06, "0.3": 0.3}),
        (box, "Material", "material", {"Continue": "CONTINUE", "One": "MAJORITY"}),
        (box, "Mark Ridges", "marks", {"none": set(), "Sharp": {"SHARP"}}),
    ]
    made, captions = [], []
    for mesh, label, name, values in rows:
        more = {"shape": "SHARP"} if name == "sharpness" else {}
        made.append([_drawn(_made(*mesh), name)])
        made[-1] += [_drawn(_patched(mesh, name, {name: value, **more}), name) for value in values.values()]
        captions.append(["open", *(f"{label}: {value}" for value in values)])
    made[-2:], captions[-2:] = [made[-2] + made[-1][2:]], [captions[-2] + captions[-1][2:]]
    pictures.sheet(path, made, captions=captions, text_pixels=13, shades=64)


def _cut(
    solid: holed_shapes.Solid, place: tuple[float, float, float], radius: float
) -> tuple[Array, Indices]:
    holed = holed_shapes.cut(solid, [(place, radius)])
    return holed.vertices, holed.faces


def _patched(mesh: tuple[Array, Indices], name: str, chosen: dict[str, object]) -> bpy.types.Object:
    obj = _made(*mesh)
    if name == "material":
        obj.data.materials.append(None)
        obj.data.materials.append(None)
        above = np.array([face.normal.z > face.normal.x for face in obj.data.polygons], np.int32)
        obj.data.polygons.foreach_set("material_index", above)
    _fill(obj, **chosen)
    return obj


def _drawn(obj: bpy.types.Object, name: str) -> pictures.Pixels:
    """The mesh with patches in their color; what the setting of this name is about can be seen."""
    vertices, faces = _triangles(obj)
    color = np.tile(pictures.CLAY, (len(faces), 1))
    if PATCH_NAME in obj.data.attributes:
        color[_is_patch(obj)] = PATCH
    index = np.array([face.material_index for face in obj.data.polygons])
    color[(index == 1)[mesh_io.triangle_faces(obj.data)]] *= OTHER_MATERIAL
    edges = mesh_io.edges(obj.data)
    sharp = np.array([edge.use_edge_sharp for edge in obj.data.edges])
    marks = [Lines(vertices[edges[sharp]], BORDER, 3.0)] if sharp.any() else []
    if name == "edge_length":
        marks.append(Lines(vertices[edges], pixels=0.8))
    return pictures.render(vertices, faces, color=color, marks=marks, view=BOX_VIEW, size=215, frame=vertices)


def checker(path: Path) -> None:
    """A checker on a box whose sides are islands, and on a ring with a seam through its hole."""
    rows = [
        _textured(holed_shapes.cut(holed_shapes.cube(16), [((1.0, 0.1, 1.0), 0.6)]), _by_side, BOX_VIEW),
        _textured(_ring(), _by_angles, RING_VIEW),
    ]
    captions = [["a box, each side an island", "its patch"], ["a ring, a seam through the hole", "its patch"]]
    flat = [[picture for row in rows for picture in row]]
    pictures.sheet(path, flat, captions=[captions[0] + captions[1]], text_pixels=13, shades=64)


def _ring() -> holed_shapes.Holed:
    vertices, faces = shapes.torus(72, 36)
    solid = holed_shapes.Solid(
        vertices, faces, np.empty((0, 3)), lambda points: points, lambda points: points
    )
    return holed_shapes.cut(solid, [((0.0, -1.2, 0.35), 0.42)])


def _by_side(corners: Array, normals: Array) -> Array:
    axis = np.abs(normals).argmax(axis=1)
    kept = np.array([[1, 2], [2, 0], [0, 1]])[axis]
    turned = np.take_along_axis(corners, np.repeat(kept[:, None], 3, axis=1), axis=2)
    return 0.5 * turned + 3.0 * axis[:, None, None] + 0.1


def _by_angles(corners: Array, normals: Array) -> Array:
    x, y, z = np.moveaxis(corners, 2, 0)
    around = np.arctan2(x, -y) / (2 * np.pi)
    tube = np.arctan2(z, np.hypot(x, y) - 1.0) / (2 * np.pi)
    # No triangle may reach around: those that would belong to the other side of the seam.
    around = np.where(corners.mean(axis=1, keepdims=True)[..., 0] < 0, -np.abs(around), np.abs(around))
    tube += (np.ptp(tube, axis=1, keepdims=True) > 0.5) & (tube < 0)
    # The seam is where the ring is nearest: the map jumps there by a part of a square.
    shift = np.where(corners.mean(axis=1, keepdims=True)[..., 0] < 0, 0.13, 0.0)
    return np.stack([4.0 * (around + shift), 1.5 * tube], axis=2)


def _textured(
    holed: holed_shapes.Holed, uv_map: Map, view: tuple[float, float, float]
) -> list[pictures.Pixels]:
    obj = _object(holed)
    vertices, faces = _triangles(obj)
    corners = vertices[faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    layer = obj.data.uv_layers.new(name="UVMap")
    layer.data.foreach_set("uv", uv_map(corners, normals).astype(np.float32).ravel())
    look = {"view": view, "size": 270, "frame": vertices}
    row = [_painted(obj, **look)]
    rim = _border_edges(faces)
    _fill(obj)
    row.append(_painted(obj, marks=[Lines(vertices[rim], BORDER, 2.0)], **look))
    return row


def _painted(obj: bpy.types.Object, **look: object) -> pictures.Pixels:
    """A checker by the UV map, each triangle cut into small ones of one color."""
    vertices, faces = _triangles(obj)
    uv = np.empty(2 * len(obj.data.loops), np.float32)
    obj.data.uv_layers[0].data.foreach_get("uv", uv)
    uv = uv.reshape(-1, 2)[mesh_io.triangle_corners(obj.data)]
    shares, small = _cut_triangle(CUTS)
    points = np.einsum("kc,mcx->mkx", shares, vertices[faces])
    places = np.einsum("kc,mcx->mkx", shares, uv)
    pieces = small[None] + len(shares) * np.arange(len(faces))[:, None, None]
    middle = places[:, small].mean(axis=2)
    dark = np.floor(SQUARES * middle).astype(int).sum(axis=2) % 2 == 1
    color = BRIGHTNESS * np.where(dark.reshape(-1, 1), DARK, LIGHT)
    return pictures.render(points.reshape(-1, 3), pieces.reshape(-1, 3), color=color, **look)


def _cut_triangle(n: int) -> tuple[Array, Indices]:
    """Barycentric coordinates (k, 3) of a triangle cut into n² small ones, and these (n², 3)."""
    at = {}
    for i in range(n + 1):
        for j in range(n + 1 - i):
            at[i, j] = len(at)
    upward = [(at[i, j], at[i + 1, j], at[i, j + 1]) for i, j in at if i + j < n]
    downward = [(at[i + 1, j], at[i + 1, j + 1], at[i, j + 1]) for i, j in at if i + j < n - 1]
    shares = np.array([(n - i - j, i, j) for i, j in at]) / n
    return shares, np.array(upward + downward)


def _object(holed: holed_shapes.Holed) -> bpy.types.Object:
    return _made(holed.vertices, holed.faces)


def _made(vertices: Array, faces: Indices) -> bpy.types.Object:
    mesh = bpy.data.meshes.new("open")
    mesh.from_pydata(vertices.tolist(), [], faces.tolist())
    obj = bpy.data.objects.new("open", mesh)
    bpy.context.collection.objects.link(obj)
    return obj


def _fill(obj: bpy.types.Object, **chosen: object) -> None:
    run = HoleFilling([obj], defaults_of(HoleSettings, **chosen))
    run.job.run()
    run.apply()
    print(f"   {run.report()}", flush=True)


def _triangles(obj: bpy.types.Object) -> tuple[Array, Indices]:
    vertices = np.array([vertex.co[:] for vertex in obj.data.vertices])
    return vertices, mesh_io.triangles(obj.data).astype(np.int64)


def _is_patch(obj: bpy.types.Object) -> NDArray[np.bool_]:
    numbers = np.array([item.value for item in obj.data.attributes[PATCH_NAME].data])
    return numbers[mesh_io.triangle_faces(obj.data)] > 0


def _border_edges(faces: Indices) -> Indices:
    edges = np.sort(faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    edges, count = np.unique(edges, axis=0, return_counts=True)
    return edges[count == 1]
