"""Meshes and readings that the tests of the add-on share."""

import contextlib
from collections.abc import Iterator

import bmesh
import bpy
import numpy as np


def empty_scene() -> None:
    """Start again from an empty file."""
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)


def add_object(name: str, vertices: object, faces: object) -> bpy.types.Object:
    """A selected, active object with a mesh of faces of any size."""
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(np.asarray(vertices, float).tolist(), [], [list(face) for face in faces])
    return link(bpy.data.objects.new(name, mesh))


def link(obj: bpy.types.Object) -> bpy.types.Object:
    """Put an object into the scene, selected and active."""
    bpy.context.collection.objects.link(obj)
    obj.select_set(True)
    bpy.context.view_layer.objects.active = obj
    return obj


def bumpy_box(name: str = "Box", seed: int = 0, cuts: int = 4, noise: float = 0.03) -> bpy.types.Object:
    """A closed box of quads with noise on its vertices, so that there is something to flatten."""
    bpy.ops.mesh.primitive_cube_add()
    obj = bpy.context.object
    obj.name = obj.data.name = name
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.subdivide(number_cuts=cuts)
    bpy.ops.object.mode_set(mode="OBJECT")
    bumps = np.random.default_rng(seed).normal(scale=noise, size=(len(obj.data.vertices), 3))
    set_coordinates(obj, coordinates(obj) + bumps)
    return obj


def ngon_prism(name: str = "Prism", sides: int = 9, rings: int = 5) -> bpy.types.Object:
    """A closed prism: quads around, an n-gon at either end, with some noise."""
    angle = 2 * np.pi * np.arange(sides) / sides
    ring = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    vertices = np.concatenate([np.c_[ring, np.full(sides, z)] for z in np.linspace(-1, 1, rings)])
    vertices += np.random.default_rng(1).normal(scale=0.02, size=vertices.shape)
    quads = [
        [r * sides + k, r * sides + (k + 1) % sides, (r + 1) * sides + (k + 1) % sides, (r + 1) * sides + k]
        for r in range(rings - 1)
        for k in range(sides)
    ]
    ends = [list(range(sides))[::-1], [(rings - 1) * sides + k for k in range(sides)]]
    return add_object(name, vertices, quads + ends)


def coordinates(obj: bpy.types.Object) -> np.ndarray:
    """The coordinates (n, 3) float32 of the mesh itself."""
    values = np.empty(3 * len(obj.data.vertices), np.float32)
    obj.data.vertices.foreach_get("co", values)
    return values.reshape(-1, 3)


def set_coordinates(obj: bpy.types.Object, values: np.ndarray) -> None:
    """Write the coordinates (n, 3) of a mesh without shape keys."""
    obj.data.vertices.foreach_set("co", np.ascontiguousarray(values, np.float32).ravel())
    obj.data.update()


def key_coordinates(obj: bpy.types.Object, name: str) -> np.ndarray:
    """The coordinates (n, 3) float32 of a shape key."""
    key = obj.data.shape_keys.key_blocks[name]
    values = np.empty(3 * len(key.data) if obj.data.vertices else 0, np.float32)
    try:
        key.data.foreach_get("co", values)
    except TypeError:
        # Blender 5.2 takes any length for that of a key without points.
        values = values[:0]
    return values.reshape(-1, 3)


def add_key(obj: bpy.types.Object, name: str, offset: np.ndarray) -> bpy.types.ShapeKey:
    """A shape key that is the mesh plus an offset (n, 3)."""
    key = obj.shape_key_add(name=name, from_mix=False)
    key.data.foreach_set("co", (coordinates(obj) + offset).astype(np.float32).ravel())
    return key


@contextlib.contextmanager
def edited(obj: bpy.types.Object) -> Iterator[bmesh.types.BMesh]:
    """The mesh of an object, to be edited; it is written back at the end."""
    mesh = bmesh.new()
    mesh.from_mesh(obj.data)
    for elements in (mesh.verts, mesh.edges, mesh.faces):
        elements.ensure_lookup_table()
    yield mesh
    mesh.to_mesh(obj.data)
    mesh.free()


def same_bits(a: np.ndarray, b: np.ndarray) -> bool:
    """Whether two float32 arrays agree in every bit."""
    return a.dtype == b.dtype == np.float32 and np.array_equal(a.view(np.uint32), b.view(np.uint32))


def select_only(obj: bpy.types.Object, mask: np.ndarray) -> None:
    """Enter Edit Mode with exactly these vertices selected."""
    # Not above: the example in CONTRIBUTING.md is tried where no extension is installed.
    from bl_ext.user_default.ridgeform.blender import selected_elements  # noqa: PLC0415

    obj.data.polygons.foreach_set("select", np.zeros(len(obj.data.polygons), bool))
    selected_elements.write(obj.data, obj.data.edges, np.zeros(len(obj.data.edges), bool))
    obj.data.vertices.foreach_set("select", mask)
    bpy.context.scene.tool_settings.mesh_select_mode = (True, False, False)
    bpy.ops.object.mode_set(mode="EDIT")


BAD_MESHES = {
    "no area": ([[0, 0, 0], [1, 0, 0], [2, 0, 0]], [[0, 1, 2]]),
    "one point": ([[0, 0, 0]] * 4, [[0, 1, 2, 3]]),
    "three faces at an edge": (
        [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [0, -1, 0]],
        [[0, 1, 2], [0, 1, 3], [0, 1, 4]],
    ),
    "both sides": ([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2], [0, 2, 1]]),
    "loose vertex": ([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [5, 5, 5]], [[0, 1, 2, 3]]),
}
"""Vertices and faces that tools must end on with finite numbers, or refuse."""
