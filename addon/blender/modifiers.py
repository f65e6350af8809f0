# SPDX-License-Identifier: GPL-3.0-or-later
"""What the modifiers of an object mean for a tool that works on its mesh.

Tools see the mesh below the modifiers. A Mirror modifier is seen through (`mirroring`); of others a sentence
says what they do to the result.
"""

from collections.abc import Iterable

import bpy
import numpy as np

from . import blending
from .mirroring import Mirror

ROUNDING = 1e-6
"""Without Merge, vertices count as one with their image if they are this part of the mesh's size apart."""
ROUNDS_OFF = {"SUBSURF", "SMOOTH", "LAPLACIANSMOOTH", "CORRECTIVE_SMOOTH"}
"""Modifiers that make facets round again."""
DEFORMS = {
    "ARMATURE",
    "CAST",
    "CURVE",
    "DISPLACE",
    "HOOK",
    "LAPLACIANDEFORM",
    "LATTICE",
    "MESH_CACHE",
    "MESH_DEFORM",
    "MESH_SEQUENCE_CACHE",
    "SHRINKWRAP",
    "SIMPLE_DEFORM",
    "SURFACE_DEFORM",
    "WARP",
    "WAVE",
    "CLOTH",
    "SOFT_BODY",
}
"""Modifiers that move vertices."""
REBUILDS = {"REMESH", "SKIN", "NODES"}
"""Modifiers that may put other faces in the place of the mesh's."""
ADDS = {"BEVEL", "BOOLEAN", "SCREW", "WELD", "WIREFRAME", "DECIMATE", "TRIANGULATE"}
"""Modifiers that cut the faces, or add some that are not copies of the mesh's."""


def visible(obj: bpy.types.Object) -> list[bpy.types.Modifier]:
    """The modifiers that show in the viewport."""
    return [modifier for modifier in obj.modifiers if modifier.show_viewport]


def mirrors(obj: bpy.types.Object, coordinates: np.ndarray) -> list[Mirror]:
    """The reflections that the Mirror modifiers of an object make, in their order; coordinates (n, 3)."""
    size = float(np.ptp(coordinates, axis=0).max(initial=0.0))
    found = []
    for modifier in visible(obj):
        if modifier.type != "MIRROR":
            continue
        reach = modifier.merge_threshold if modifier.use_mirror_merge else ROUNDING * size
        to_center = np.eye(4)
        if modifier.mirror_object is not None:
            center = np.array(modifier.mirror_object.matrix_world, np.float64)
            if not _is_invertible(center):
                continue
            to_center = np.linalg.inv(center) @ np.array(obj.matrix_world, np.float64)
        if not _is_invertible(to_center):
            continue
        for axis in range(3):
            if modifier.use_axis[axis]:
                turned = np.eye(4)
                turned[axis, axis] = -1.0
                found.append(Mirror(np.linalg.inv(to_center) @ turned @ to_center, reach))
    return found


def _is_invertible(matrix: np.ndarray) -> bool:
    return bool(np.isfinite(matrix).all()) and np.linalg.matrix_rank(matrix) == len(matrix)


def mirror_notes(obj: bpy.types.Object, coordinates: np.ndarray) -> list[str]:
    """What a modeler should know of Mirror modifiers that cut a mesh with these coordinates (n, 3)."""
    notes = []
    for modifier in visible(obj):
        if modifier.type != "MIRROR" or modifier.mirror_object is not None:
            continue
        for axis in range(3):
            cuts = modifier.use_axis[axis] and modifier.use_bisect_axis[axis]
            side = -1.0 if modifier.use_bisect_flip_axis[axis] else 1.0
            if cuts and (side * coordinates[:, axis] < -modifier.merge_threshold).any():
                notes.append(
                    f"its Mirror modifier cuts off what lies beyond its {'XYZ'[axis]} plane (Bisect), which "
                    "took part in place of the mirror image (apply the modifier to avoid that)"
                )
    return notes


def shape_notes(obj: bpy.types.Object, creased: bool) -> list[str]:
    """What a modeler should know of other modifiers when the shape of a mesh was made flat.

    `creased` says whether its ridges got subdivision creases.
    """
    shown = [modifier for modifier in visible(obj) if not blending.is_blend(modifier)]
    notes = []
    rounding = [
        modifier for modifier in shown if modifier.type in ROUNDS_OFF and not _keeps_ridges(modifier, creased)
    ]
    deforming = [modifier for modifier in shown if modifier.type in DEFORMS]
    rebuilding = [modifier for modifier in shown if modifier.type in REBUILDS]
    adding = [modifier for modifier in shown if modifier.type in ADDS]
    arrays = [modifier for modifier in shown if modifier.type == "ARRAY" and modifier.use_merge_vertices]
    if rounding:
        cure = ", or mark ridges with Crease" if any(item.type == "SUBSURF" for item in rounding) else ""
        notes.append(f"{_named(rounding)} rounds the facets off again (apply it first{cure})")
    if rebuilding:
        notes.append(
            f"{_named(rebuilding)} makes new faces of the facets (apply it first to flatten what it makes)"
        )
    if adding:
        notes.append(
            f"{_named(adding)} works on the facets, and what it cuts or adds was not flattened (apply it "
            "first to do so)"
        )
    if deforming:
        notes.append(
            f"{_named(deforming)} moves the facets, which are flat without it (apply it first to avoid that)"
        )
    if arrays:
        notes.append(
            f"{_named(arrays)} merges copies whose borders were computed apart (hold these borders with a "
            "mask, or apply it first)"
        )
    return notes


def _keeps_ridges(modifier: bpy.types.Modifier, creased: bool) -> bool:
    if modifier.type != "SUBSURF":
        return False
    return modifier.subdivision_type == "SIMPLE" or (creased and modifier.use_creases)


def _named(modifiers: Iterable[bpy.types.Modifier]) -> str:
    names = [f'"{modifier.name}"' for modifier in modifiers]
    return f"its modifier {names[0]}" if len(names) == 1 else f"its modifiers {' and '.join(names)} each"


def blend_notes(obj: bpy.types.Object) -> list[str]:
    """What a modeler should know of a modifier that shows a result of before in place of the mesh."""
    modifier = blending.modifier_of(obj)
    if modifier is None or not modifier.show_viewport or blending.stored(obj.data) is None:
        return []
    return [
        f'its modifier "{modifier.name}" shows the result that was stored before (remove it, or lower Factor)'
    ]


def normal_notes(mesh: bpy.types.Mesh) -> list[str]:
    """What a modeler should know of custom normals that are not relative to the faces, and so do not turn."""
    normals = mesh.attributes.get("custom_normal")
    if normals is None or normals.data_type != "FLOAT_VECTOR":
        return []
    # Newer versions call it otherwise.
    cure = bpy.ops.mesh.customdata_custom_splitnormals_clear.get_rna_type().name
    return [f"its free custom normals stay as they are and hide the facets ({cure})"]


def key_notes(obj: bpy.types.Object) -> list[str]:
    """What a modeler should know of the active shape key of a mesh if its result does not show."""
    key = obj.active_shape_key
    if key is None or obj.data.is_editmode or obj.show_only_shape_key:
        return []
    if key == obj.data.shape_keys.reference_key or not obj.data.shape_keys.use_relative:
        return []
    if key.mute:
        return [f'the shape key "{key.name}" was changed, which is muted (turn it on to see the result)']
    if key.value == 0.0:
        return [f'the shape key "{key.name}" was changed, which has the value 0 (raise it to see the result)']
    return []
