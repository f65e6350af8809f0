"""Balls and what tests of facets look at."""

import addon_kit as kit
import bpy
import numpy as np
from bl_ext.user_default.ridgeform.blender import mesh_io
from bl_ext.user_default.ridgeform.framework import job


def facet(**settings):
    """Press the button with these settings."""
    assert bpy.ops.ridgeform.facet(**settings) == {"FINISHED"}
    return job.last_summary()


def ball(kind="uv", name="Ball"):
    """A sphere, shaded smooth."""
    if kind == "uv":
        bpy.ops.mesh.primitive_uv_sphere_add(segments=24, ring_count=16)
    else:
        bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=4)
    bpy.ops.object.shade_smooth()
    bpy.context.object.name = name
    return bpy.context.object


def off_planes(mesh):
    """How far corners of faces are from the planes of these, at most."""
    worst = 0.0
    for face in mesh.polygons:
        places = np.array([mesh.vertices[vertex].co for vertex in face.vertices])
        worst = max(worst, np.abs((places - places.mean(axis=0)) @ np.array(face.normal)).max())
    return worst


def is_closed(mesh):
    """Whether each edge has two faces, which run along it in opposite ways."""
    _, corners, edges = mesh_io.face_corners(mesh)
    first = mesh_io.edges(mesh)[edges, 0] == corners
    return (np.bincount(edges[first]) == 1).all() and (np.bincount(edges[~first]) == 1).all()


def read_all(mesh):
    """All that lies on a mesh, as bytes."""
    named = {}
    for attribute in mesh.attributes:
        prop = "vector" if attribute.data_type in {"FLOAT2", "FLOAT_VECTOR"} else "value"
        prop = "color" if "COLOR" in attribute.data_type else prop
        named[attribute.name] = [
            tuple(value) if hasattr(value, "__len__") else value
            for value in (getattr(item, prop) for item in attribute.data)
        ]
    return named


def layered_box():
    """A box with everything on it: two materials, UVs, colors, weights, attributes of all domains."""
    obj = kit.bumpy_box(cuts=6)
    mesh = obj.data
    for name in "AB":
        mesh.materials.append(bpy.data.materials.new(name))
    places = kit.coordinates(obj)
    for face in mesh.polygons:
        face.material_index = int(face.center.z > 0.9)
    colors = mesh.color_attributes.new("Paint", "FLOAT_COLOR", "CORNER")
    for corner, color in zip(mesh.loops, colors.data, strict=True):
        color.color = (*(0.5 * places[corner.vertex_index] + 0.5), 1.0)
    tall = mesh.attributes.new("height", "FLOAT", "POINT")
    tall.data.foreach_set("value", np.ascontiguousarray(places[:, 2]))
    side = mesh.attributes.new("side", "INT", "FACE")
    side.data.foreach_set("value", [int(np.argmax(np.abs(face.normal))) for face in mesh.polygons])
    group = obj.vertex_groups.new(name="Up")
    for vertex, place in enumerate(places):
        group.add([vertex], float(np.clip(0.5 + 0.5 * place[2], 0, 1)), "REPLACE")
    return obj
