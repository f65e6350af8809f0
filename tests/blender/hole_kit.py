"""Meshes with holes, and readings, that the tests of Fill Holes share."""

import addon_kit as kit
import bpy
import numpy as np
import ridgeform
from bl_ext.user_default.ridgeform.blender import mesh_io, selected_elements
from bl_ext.user_default.ridgeform.framework.settings import defaults_of
from bl_ext.user_default.ridgeform.holes.settings import HoleSettings, hole_options

SIZES = {"FLOAT2": 2, "FLOAT_VECTOR": 3, "FLOAT_COLOR": 4, "BYTE_COLOR": 4}
PROPS = {"FLOAT2": "vector", "FLOAT_VECTOR": "vector", "FLOAT_COLOR": "color", "BYTE_COLOR": "color"}


def quad_mesh(name, vertices, quads):
    """An object of those of the vertices that the quads use."""
    used, renumbered = np.unique(quads, return_inverse=True)
    return kit.add_object(name, np.asarray(vertices, float)[used], renumbered.reshape(-1, 4).tolist())


def sheet(n=12, hole=(4, 8), name="Sheet"):
    """A flat sheet of n by n quads, side 1, without the squares from hole[0] to hole[1] either way."""
    at = np.linspace(0, 1, n + 1)
    vertices = [(x, y, 0.0) for x in at for y in at]
    inside = range(*hole)
    corners = [x * (n + 1) + y for x in range(n) for y in range(n) if not (x in inside and y in inside)]
    return quad_mesh(name, vertices, [(a, a + n + 1, a + n + 2, a + 1) for a in corners])


def box(n=8, radius=0.6, name="Box", centers=((1.0, 0.0, 1.0),)):
    """A cube of side 2 of quads, n along a side, without those whose middle is near the centers."""
    at = np.linspace(-1, 1, n + 1)
    square = np.array([(x, y, 1.0) for x in at for y in at])
    flat = np.array(
        [(a, a + n + 1, a + n + 2, a + 1) for a in (x * (n + 1) + y for x in range(n) for y in range(n))]
    )
    sides = []
    for axis in range(3):
        turned = np.roll(square, axis, axis=1)
        sides += [(turned, flat), (-turned, flat)]
    # A point reflection turns the faces over.
    vertices = np.concatenate([side for side, _ in sides])
    quads = np.concatenate(
        [faces[:, :: -1 if i % 2 else 1] + i * len(square) for i, (_, faces) in enumerate(sides)]
    )
    _, first, number = np.unique(np.round(vertices, 9), axis=0, return_index=True, return_inverse=True)
    vertices, quads = vertices[first], number.ravel()[quads]
    middle = vertices[quads].mean(axis=1)
    kept = np.all([np.linalg.norm(middle - center, axis=1) > radius for center in centers], axis=0)
    return quad_mesh(name, vertices, quads[kept])


def state(obj):
    """Everything on a mesh in Object Mode that a tool could change, as plain values."""
    mesh = obj.data
    found = {
        "faces": [tuple(face.vertices) for face in mesh.polygons],
        "edges": [tuple(edge.vertices) for edge in mesh.edges],
        "positions": kit.coordinates(obj).tobytes(),
        "groups": [[(g.group, g.weight) for g in v.groups] for v in mesh.vertices],
        "keys": {} if mesh.shape_keys is None else {
            key.name: kit.key_coordinates(obj, key.name).tobytes() for key in mesh.shape_keys.key_blocks
        },
    }  # fmt: skip
    for attribute in mesh.attributes:
        if attribute.data_type in PROPS or attribute.data_type in ("FLOAT", "INT", "BOOLEAN"):
            found[attribute.name] = values(mesh, attribute.name).tobytes()
    return found


def values(mesh, name):
    """The values (k, c) of an attribute."""
    attribute = mesh.attributes[name]
    dtype = {"INT": np.int32, "BOOLEAN": bool}.get(attribute.data_type, np.float32)
    size = SIZES.get(attribute.data_type, 1)
    read = np.empty(len(attribute.data) * size, dtype)
    attribute.data.foreach_get(PROPS.get(attribute.data_type, "value"), read)
    return read.reshape(-1, size)


def set_values(mesh, name, data_type, domain, data):
    """A new attribute with values (k, c)."""
    attribute = mesh.attributes.new(name, data_type, domain)
    prop = PROPS.get(data_type, "value")
    attribute.data.foreach_set(prop, np.ascontiguousarray(data).ravel())
    return attribute.name


def corner_vertices(mesh):
    """The vertex (c,) of each corner."""
    read = np.empty(len(mesh.loops), np.int32)
    mesh.loops.foreach_get("vertex_index", read)
    return read


def wheel_result(obj, loops=None, **changes):
    """What the wheel makes of the mesh of an object with the settings of the add-on."""
    vertices = kit.coordinates(obj).astype(np.float64)
    mesh = ridgeform.Mesh(vertices, mesh_io.triangles(obj.data))
    if loops is None:
        loops = [hole.vertices for hole in ridgeform.find_holes(mesh) if not hole.is_outer_border]
    return ridgeform.fill_holes(mesh, loops=loops, **hole_options(defaults_of(HoleSettings, **changes)))


def pick(obj, *edges):
    """Enter Edit Mode with exactly these edges, pairs of vertices, selected."""
    mesh = obj.data
    for kind in (mesh.vertices, mesh.edges, mesh.polygons):
        selected_elements.write(mesh, kind, np.zeros(len(kind), bool))
    wanted = {frozenset(edge) for edge in edges}
    chosen = np.array([frozenset(edge.vertices) in wanted for edge in mesh.edges], bool)
    selected_elements.write(mesh, mesh.edges, chosen)
    mesh.vertices.foreach_set("select", np.isin(np.arange(len(mesh.vertices)), list(set().union(*wanted))))
    bpy.context.scene.tool_settings.mesh_select_mode = (False, True, False)
    bpy.ops.object.mode_set(mode="EDIT")


def around_holes(obj):
    """The holes of the mesh of an object in Object Mode, outer borders last."""
    mesh = ridgeform.Mesh(kit.coordinates(obj).astype(np.float64), mesh_io.triangles(obj.data))
    return sorted(ridgeform.find_holes(mesh), key=lambda hole: hole.is_outer_border)
