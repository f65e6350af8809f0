# SPDX-License-Identifier: GPL-3.0-or-later
"""Material slots for segments: own materials are told by a custom property, all others are left alone.

The slots that faces had before are kept in a face attribute, so that they can be given back.
"""

import colorsys

import bpy
import numpy as np

from ..blender.stored_numbers import read_ints, write_numbers

KEPT = "ridgeform_material"
"""The face attribute with the slots that faces had before segments took them."""
MARK = "ridgeform_segment"
"""The custom property of materials that were made for segments."""
GOLDEN = 0.618034
"""Hues this far apart on the circle stay apart for any number of them."""
TONES = ((0.52, 0.88), (0.34, 0.98), (0.55, 0.66))
"""Saturation and value in turns, so that hues that come near each other differ in these."""


def assign(mesh: bpy.types.Mesh, labels: np.ndarray, taking: np.ndarray, name: str) -> bool:
    """Give each segment a slot of its own; own slots that no face uses any more go, and their materials.

    New materials are called by the name and their number. Returns whether faces had other materials, which
    are kept.
    """
    index = index_of(mesh)
    own = own_slots(mesh)
    before = user_index(mesh)
    write_numbers(mesh, KEPT, "INT", "FACE", before)
    kept = set(index[~taking].tolist())
    free = [slot for slot in own if slot not in kept]
    for number, segment in enumerate(np.unique(labels[taking])):
        if number == len(free):
            free.append(_new_slot(mesh, name))
        index[taking & (labels == segment)] = free[number]
    remove_unused(mesh, index)
    slots = np.unique(before[taking]).tolist()
    return any(0 <= slot < len(mesh.materials) and mesh.materials[slot] is not None for slot in slots)


def user_index(mesh: bpy.types.Mesh) -> np.ndarray:
    """The slot (f,) that each face has, or had before segments took it; -1 where there was none."""
    index, own = index_of(mesh), own_slots(mesh)
    others = index if len(own) < len(mesh.materials) else np.full_like(index, -1)
    return np.where(np.isin(index, own), read_ints(mesh, KEPT, "FACE", -1), others)


def give_back(mesh: bpy.types.Mesh, faces: np.ndarray) -> None:
    """Give faces (f,) bool the slots back that they had before segments took them."""
    if KEPT not in mesh.attributes:
        return
    remove_unused(mesh, np.where(faces, user_index(mesh), index_of(mesh)))
    if not own_slots(mesh):
        mesh.attributes.remove(mesh.attributes[KEPT])


def index_of(mesh: bpy.types.Mesh) -> np.ndarray:
    """The slot (f,) of each face."""
    index = np.zeros(len(mesh.polygons), np.int32)
    mesh.polygons.foreach_get("material_index", index)
    return index


def own_slots(mesh: bpy.types.Mesh) -> list[int]:
    """The slots whose materials were made for segments."""
    return [
        slot
        for slot, material in enumerate(mesh.materials)
        if material is not None and MARK in material and material.library is None
    ]


def remove_unused(mesh: bpy.types.Mesh, index: np.ndarray) -> None:
    """Drop own slots that no face is in, and materials that nothing uses.

    `index` (f,): the slot of each face, -1 for none.
    """
    index = index.copy()
    used = set(index.tolist())
    kept = read_ints(mesh, KEPT, "FACE", -1)
    for slot in reversed(own_slots(mesh)):
        if slot not in used:
            material = mesh.materials.pop(index=slot)
            index[index > slot] -= 1
            kept[kept > slot] -= 1
            if material.users == 0:
                bpy.data.materials.remove(material)
    if KEPT in mesh.attributes:
        write_numbers(mesh, KEPT, "INT", "FACE", kept)
    mesh.polygons.foreach_set("material_index", np.maximum(index, 0))
    mesh.update()


def _new_slot(mesh: bpy.types.Mesh, name: str) -> int:
    number = 1 + max((mesh.materials[slot][MARK] for slot in own_slots(mesh)), default=-1)
    wanted = f"{name} Segment {number + 1}"
    left = bpy.data.materials.get(wanted)
    if left is not None and MARK in left and left.users == 0:
        # Of a mesh that is gone: it would have this one called by another name.
        bpy.data.materials.remove(left)
    material = bpy.data.materials.new(wanted)
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
