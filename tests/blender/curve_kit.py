"""Painted planes and their diffusion curves, for the tests of these."""

import addon_kit as kit
import bpy
import numpy as np

RED, BLUE = (0.8, 0.1, 0.05, 1.0), (0.05, 0.2, 0.7, 1.0)
CELLS = 16


def add_plane(paint=None, cells=CELLS):
    """A flat square of quads, painted by a function of the places (n, 2) in it."""
    x, y = np.meshgrid(np.linspace(0, 1, cells + 1), np.linspace(0, 1, cells + 1))
    places = np.column_stack([x.ravel(), y.ravel()])
    corner = (np.arange(cells)[:, None] * (cells + 1) + np.arange(cells)).ravel()
    quads = np.column_stack([corner, corner + 1, corner + cells + 2, corner + cells + 1])
    obj = kit.add_object("Plane", np.column_stack([places, np.zeros(len(places))]), quads)
    if paint is not None:
        store_colors(obj, paint(places))
    return obj


def store_colors(obj, colors, name="paint"):
    """Store colors (n, 4) as an attribute."""
    attribute = obj.data.attributes.new(name, "FLOAT_COLOR", "POINT")
    attribute.data.foreach_set("color", np.ascontiguousarray(colors, np.float32).ravel())


def halves(places):
    """Red on the left of places (n, 2), blue on the right."""
    return np.where(places[:, :1] < 0.5, RED, BLUE)


def split_materials(obj, mask=None):
    """Give the faces for which a mask (f,) holds, those at larger x without one, a second material."""
    obj.data.materials.append(bpy.data.materials.new("A"))
    obj.data.materials.append(bpy.data.materials.new("B"))
    if mask is None:
        mask = np.array([face.center.x > 0.5 for face in obj.data.polygons])
    obj.data.polygons.foreach_set("material_index", mask.astype(np.int32))


def corner_colors(obj, name="paint_diffused"):
    """The colors (c, 4) of an attribute at the face corners."""
    attribute = obj.data.attributes[name]
    assert (attribute.data_type, attribute.domain) == ("FLOAT_COLOR", "CORNER")
    colors = np.empty(4 * len(attribute.data), np.float32)
    attribute.data.foreach_get("color", colors)
    return colors.reshape(-1, 4)


def point_values(child, name, prop="color", size=4):
    """The values (k, size) of an attribute of curves."""
    data = child.data.attributes[name].data
    values = np.empty(size * len(data), np.int32 if prop == "value" else np.float32)
    data.foreach_get(prop, values)
    return values.reshape(-1, size)


def find(**settings):
    """Find diffusion curves, by material slots if nothing else is said."""
    return bpy.ops.ridgeform.diffusion_curves(**({"regions": "MATERIALS"} | settings))
