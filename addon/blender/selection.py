# SPDX-License-Identifier: GPL-3.0-or-later
"""What takes part: the meshes that a tool would work on, and why others cannot."""

from collections.abc import Iterable
from dataclasses import dataclass, field

import bpy

from . import mesh_io

MODES = ("OBJECT", "EDIT_MESH", *mesh_io.PAINTING)


@dataclass(frozen=True)
class Needs:
    """What a tool needs of a mesh beyond its faces."""

    coordinates: bool = True
    """Whether it writes coordinates, which a modifier or a lock may forbid."""
    selection: bool = True
    """Whether something must be selected in Edit Mode."""


MOVES = Needs()
"""What a tool needs that moves the selection."""


@dataclass
class Selection:
    """The mesh objects that take part, each mesh once, and a sentence for each that was left out."""

    objects: list[bpy.types.Object] = field(default_factory=list)
    skipped: list[str] = field(default_factory=list)


def reason_against(obj: bpy.types.Object, needs: Needs = MOVES) -> str | None:
    """Why the mesh of this object cannot be worked on, and what to do about it; `None` if it can."""
    mesh, name, key = obj.data, obj.name, obj.active_shape_key
    mode = obj.mode.replace("_", " ").title()
    reasons = (
        (mesh.library, f'"{name}" is linked from another file: make its mesh local first'),
        (mesh.override_library, f'"{name}" has overridden mesh data: make its mesh local first'),
        (not mesh.is_editable, f'"{name}" cannot be edited'),
        (
            mesh_io.is_out_of_reach(obj),
            f'"{name}" is in {mode} Mode, but hidden or not active: show it, and leave {mode} Mode',
        ),
        (
            needs.coordinates and any(modifier.type == "MULTIRES" for modifier in obj.modifiers),
            f'"{name}" has a Multiresolution modifier: apply it first',
        ),
        (
            needs.selection and mesh.is_editmode and mesh.total_vert_sel == 0,
            f'Nothing is selected in "{name}": select the part to work on',
        ),
        (not mesh.is_editmode and len(mesh.polygons) == 0, f'"{name}" has no faces'),
        (
            _has_foreign_keys(mesh),
            f'"{name}" has shape keys with another number of vertices, as scripts can leave them: '
            "remove the shape keys first",
        ),
        (
            needs.coordinates and key and key.lock_shape,
            f'The active shape key of "{name}" is locked: unlock it first',
        ),
    )
    return next((reason for applies, reason in reasons if applies), None)


def _has_foreign_keys(mesh: bpy.types.Mesh) -> bool:
    """Whether a shape key is not one of this mesh: a script has added vertices, or made other ones."""
    keys = () if mesh.shape_keys is None or not mesh.vertices else mesh.shape_keys.key_blocks
    return any(len(key.data) != len(mesh.vertices) for key in keys)


def mesh_objects(context: bpy.types.Context) -> list[bpy.types.Object]:
    """The mesh objects of the mode: those in it, in Object Mode the selected ones, the active one first."""
    active = context.view_layer.objects.active
    if context.mode == "EDIT_MESH":
        chosen = context.objects_in_mode
    else:
        chosen = [active] if context.mode in mesh_io.PAINTING else context.selected_objects
    return sorted((obj for obj in chosen if obj.type == "MESH"), key=lambda obj: obj != active)


def usable(objects: Iterable[bpy.types.Object], needs: Needs = MOVES) -> Selection:
    """Those of the objects that can be worked on; linked duplicates share one mesh, which is taken once."""
    selection = Selection()
    seen = set()
    for obj in objects:
        if obj.data in seen:
            continue
        seen.add(obj.data)
        reason = reason_against(obj, needs)
        if reason is None:
            selection.objects.append(obj)
        else:
            selection.skipped.append(reason)
    return selection


def can_start(operator: type[bpy.types.Operator], reason: str | None) -> bool:
    """Whether an operator can start: without a reason against it, which otherwise its tooltip says."""
    if reason is not None:
        operator.poll_message_set(reason)
    return reason is None


def reason_disabled(context: bpy.types.Context, needs: Needs = MOVES) -> str | None:
    """Why a tool cannot start here, for the tooltip of its button; `None` if it can."""
    if context.mode not in MODES:
        return "Switch to Object Mode, or to Edit Mode, Sculpt Mode, or a paint mode of a mesh"
    objects = mesh_objects(context)
    if not objects:
        return "Select a mesh object"
    selection = usable(objects, needs)
    return None if selection.objects else selection.skipped[0]
