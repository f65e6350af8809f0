# SPDX-License-Identifier: GPL-3.0-or-later
"""Material slots for segments: own materials are told by a custom property, all others are left alone."""

import colorsys

import bpy
import numpy as np

MARK = "ridgeform_segment"
"""The custom property of materials that were made for segments."""
GOLDEN = 0.618034
"""Hues this far apart on the circle stay apart for any number of them."""
TONES = ((0.52, 0.88), (0.34, 0.98), (0.55, 0.66))
"""Saturation and value in turns, so that hues that come near each other differ in these."""


def assign(mesh: bpy.types.Mesh, labels: np.ndarray, taking: np.ndarray) -> None:
    """Give each segment a slot of its own; own slots that no face uses any more go, and their materials."""
    index = np.zeros(len(mesh.polygons), np.int32)
    mesh.polygons.foreach_get("material_index", index)
    own = own_slots(mesh)
    kept = set(index[~taking].tolist())
    free = [slot for slot in own if slot not in kept]
    for number, segment in enumerate(np.unique(labels[taking])):
        if number == len(free):
            free.append(_new_slot(mesh))
        index[taking & (labels == segment)] = free[number]
    remove_unused(mesh, index)


def own_slots(mesh: bpy.types.Mesh) -> list[int]:
    """The slots whose materials were made for segments."""
    return [
        slot
        for slot, material in enumerate(mesh.materials)
        if material is not None and MARK in material and material.library is None
    ]


def remove_unused(mesh: bpy.types.Mesh, index: np.ndarray) -> None:
    """Drop own slots that no face is in, and materials that nothing uses; `index` (f,): the slot of each."""
    index = index.copy()
    used = set(index.tolist())
    for slot in reversed(own_slots(mesh)):
        if slot not in used:
            material = mesh.materials.pop(index=slot)
            index[index > slot] -= 1
            if material.users == 0:
                bpy.data.materials.remove(material)
    mesh.polygons.foreach_set("material_index", index)
    mesh.update()


def _new_slot(mesh: bpy.types.Mesh) -> int:
    number = 1 + max((mesh.materials[slot][MARK] for slot in own_slots(mesh)), default=-1)
    material = bpy.data.materials.new(f"Segment {number + 1}")
    material[MARK] = number
    color = color_of(number)
    material.diffuse_color = color
    if material.node_tree is None:
        material.use_nodes = True
    for node in material.node_tree.nodes:
        if node.type == "BSDF_PRINCIPLED":
            node.inputs["Base Color"].default_value = color
    mesh.materials.append(material)
    return len(mesh.materials) - 1


def color_of(number: int) -> tuple[float, float, float, float]:
    """A linear color with alpha for the number of a segment; numbers in a row differ clearly."""
    saturation, value = TONES[number % len(TONES)]
    screen = colorsys.hsv_to_rgb((0.58 + GOLDEN * number) % 1.0, saturation, value)
    linear = (c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in screen)
    return (*linear, 1.0)
