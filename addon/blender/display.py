# SPDX-License-Identifier: GPL-3.0-or-later
"""Showing an attribute: as viewport colors, by a color-ramp material, or, for colors, as it is."""

from collections.abc import Sequence

import bpy
import numpy as np

from . import ramp
from .attribute_io import read_values
from .attribute_names import COLORS, SHOWN
from .material import ramp_material


def show(
    shown: Sequence[tuple[bpy.types.Object, str]], settings: object, signed: bool = False
) -> list[list[str]]:
    """Show an attribute or vertex group of each object, in Object Mode, all with one range of values.

    `settings` has `display` and `bands`; `signed` puts zero in the middle. Returns notes for each object.
    """
    notes: list[list[str]] = [[] for _ in shown]
    if settings.display == "NONE" or not shown:
        return notes
    read = [read_values(obj, name) for obj, name in shown]
    scalars = [_scalar(values.values) for values in read if values.data_type not in COLORS]
    low, high = ramp.value_range(scalars, signed)
    colors = ramp.DIVERGING if signed else ramp.SEQUENTIAL
    by_material = False
    for (obj, name), values, note in zip(shown, read, notes, strict=True):
        mesh = obj.data
        if values.data_type in COLORS:
            mesh.color_attributes.active_color_name = name
        elif settings.display == "VIEWPORT":
            place = (_scalar(values.values) - low) / ((high - low) or 1.0)
            _store_colors(mesh, ramp.colors_at(colors, np.nan_to_num(place)))
        else:
            by_material = True
            is_vector = values.values.shape[1] > 1
            material = ramp_material(name, is_vector, (low, high), colors, settings.bands)
            note.extend(_assign(mesh, material))
        mesh.update()
    for space in _spaces():
        if by_material:
            if space.shading.type in {"SOLID", "WIREFRAME"}:
                space.shading.type = "MATERIAL"
        else:
            space.shading.type = "SOLID"
            space.shading.color_type = "VERTEX"
    return notes


def show_materials() -> None:
    """Have Solid shading show the colors of materials."""
    for space in _spaces():
        if space.shading.type == "SOLID":
            space.shading.color_type = "MATERIAL"


def _scalar(values: np.ndarray) -> np.ndarray:
    """One number (n,) for each row of values (n, k): a vector's length."""
    return values[:, 0] if values.shape[1] == 1 else np.linalg.norm(values, axis=1)


def _store_colors(mesh: bpy.types.Mesh, colors: np.ndarray) -> None:
    attribute = mesh.attributes.get(SHOWN)
    if attribute is not None and (attribute.data_type, attribute.domain) != ("FLOAT_COLOR", "POINT"):
        mesh.attributes.remove(attribute)
        attribute = None
    attribute = attribute or mesh.attributes.new(SHOWN, "FLOAT_COLOR", "POINT")
    attribute.data.foreach_set("color", colors.astype(np.float32).ravel())
    mesh.color_attributes.active_color_name = SHOWN


def _assign(mesh: bpy.types.Mesh, material: bpy.types.Material) -> list[str]:
    """Put a material on a mesh that has none; next to others it only gets a slot, which the note says."""
    others = [slot for slot in mesh.materials if slot is not None and slot != material]
    if material.name not in mesh.materials:
        empty = next((index for index, slot in enumerate(mesh.materials) if slot is None), None)
        if empty is None:
            mesh.materials.append(material)
        else:
            mesh.materials[empty] = material
    if others:
        return [f'the mesh keeps its materials; assign the material "{material.name}" to see the result']
    return []


def _spaces() -> list[bpy.types.SpaceView3D]:
    """The 3D view that the tool was called in, or else all that are open."""
    space = bpy.context.space_data
    if space is not None and space.type == "VIEW_3D":
        return [space]
    screen = bpy.context.screen
    areas = () if screen is None else screen.areas
    return [area.spaces.active for area in areas if area.type == "VIEW_3D"]
