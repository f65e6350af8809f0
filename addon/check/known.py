# SPDX-License-Identifier: GPL-3.0-or-later
"""What the last check of each mesh has found, and whether the mesh is still the one that was checked.

Panels are drawn many times a second, and only look here. Small meshes are checked again soon after a change;
of larger ones it is said that they have changed.
"""

import zlib
from dataclasses import dataclass

import bpy
import numpy as np
from bpy.app.handlers import persistent

from ..blender import mesh_io
from ..blender.handlers import Handlers
from ..framework import modal
from .examine import examine
from .kinds import Report

SMALL = 100_000
"""Corners of faces up to which a mesh is checked without being asked for: 60 ms of one core."""
PAUSE = 0.3
"""Seconds without a change until meshes are looked at again."""
OWN_MODES = ("OBJECT", "EDIT_MESH")
"""Modes in which that is done: in others a stroke may be going on."""


@dataclass
class Checked:
    """A report, and what its mesh was like."""

    report: Report
    obj: bpy.types.Object
    setting: tuple[object, ...]
    """What is not the mesh's own: which mesh it is, its scale, modifiers, and active shape key."""
    content: int
    """A check sum of the mesh as it is outside Edit Mode."""
    is_edited: bool
    """Whether it was in Edit Mode when it was looked at last."""
    may_have_changed: bool = False
    has_changed: bool = False

    def settle(self) -> None:
        """Find out whether it has changed, if it may have."""
        if self.may_have_changed:
            self.may_have_changed = False
            self.has_changed |= self.setting != _setting(self.obj) or self.content != _content(self.obj)


_checked: dict[int, Checked] = {}
"""By the objects' numbers of the session, which undo steps keep."""
_known: list[Report] = []


def last() -> list[dict[str, object]]:
    """What `bpy.ops.ridgeform.check` has found last: a dictionary for each mesh, which JSON can hold.

    Keys: name, vertices, faces, seconds, and findings, each with kind, count, text, severity, tools, notes,
    and cure.
    """
    return [report.as_dict() for report in _known]


def remember(reports: list[Report]) -> None:
    """Make these the answer of `last`."""
    _known[:] = reports


def check(obj: bpy.types.Object) -> Report:
    """Examine the mesh of an object, and keep what was found for the panels."""
    report = examine(obj)
    _checked[obj.session_uid] = Checked(report, obj, _setting(obj), _content(obj), obj.data.is_editmode)
    return report


def of(obj: bpy.types.Object) -> Checked | None:
    """What is known of an object; asks for a check soon where that is cheap and nothing is known."""
    known = _checked.get(obj.session_uid)
    if known is None or known.has_changed or known.may_have_changed:
        _look_soon()
    return known


def is_cheap(obj: bpy.types.Object) -> bool:
    """Whether a mesh is small enough to be checked without being asked for."""
    return len(obj.data.loops) + len(obj.data.edges) <= SMALL


def _setting(obj: bpy.types.Object) -> tuple[object, ...]:
    modifiers = tuple((modifier.name, modifier.type, modifier.show_viewport) for modifier in obj.modifiers)
    scale = tuple(round(x, 6) for x in obj.matrix_world.to_scale())
    return obj.data.session_uid, scale, modifiers, obj.active_shape_key_index, obj.show_only_shape_key


def _content(obj: bpy.types.Object) -> int:
    mesh = obj.data
    counts = len(mesh.vertices), len(mesh.edges), len(mesh.loops), len(mesh.polygons)
    return zlib.crc32(mesh_io.positions(mesh), zlib.crc32(np.array(counts)))


@persistent
def _on_update(_scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
    """Note which meshes may be others now. This runs after every change of anything: nothing is read."""
    if not _checked:
        return
    changed = {update.id.original.session_uid: update.is_updated_geometry for update in depsgraph.updates}
    for known in list(_checked.values()):
        try:
            obj = known.obj
            own, mesh = changed.get(obj.session_uid), changed.get(obj.data.session_uid)
        except ReferenceError:
            continue
        if own is None and mesh is None:
            continue
        known.may_have_changed = True
        if obj.data.is_editmode and known.is_edited and (own or mesh):
            # What is edited is not compared: it would have to be copied first.
            known.has_changed = True
        known.is_edited = obj.data.is_editmode


@persistent
def _on_undo(*_arguments: object) -> None:
    """The same after an undo step, which may have put other objects in the place of these."""
    for obj in bpy.data.objects:
        known = _checked.get(obj.session_uid)
        if known is not None and obj.type == "MESH":
            known.obj, known.may_have_changed = obj, True
            known.has_changed |= obj.data.is_editmode
            known.is_edited = obj.data.is_editmode


@persistent
def _on_load(*_arguments: object) -> None:
    _checked.clear()


def _look_soon() -> None:
    if bpy.app.background:
        return
    if not bpy.app.timers.is_registered(_look):
        bpy.app.timers.register(_look, first_interval=PAUSE)


def _look() -> float | None:
    """Settle what is known of the active mesh, and check it if it is small; seconds until the next look."""
    context = bpy.context
    obj = context.view_layer.objects.active if context.view_layer is not None else None
    if obj is None or obj.type != "MESH" or context.mode not in OWN_MODES:
        return None
    if modal.is_running() or any(window.modal_operators for window in context.window_manager.windows):
        return PAUSE
    known = _checked.get(obj.session_uid)
    before = None if known is None else known.has_changed
    if known is not None:
        known.settle()
    if known is None or known.has_changed:
        if is_cheap(obj):
            check(obj)
        elif known is None or before:
            return None
    for window in context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                area.tag_redraw()
    return None


_handlers = Handlers(
    depsgraph_update_post=_on_update, undo_post=_on_undo, redo_post=_on_undo, load_post=_on_load
)


def register() -> None:
    """Have Blender say what changes."""
    _handlers.add()


def unregister() -> None:
    """Have it say no more, and forget all."""
    _handlers.remove()
    if bpy.app.timers.is_registered(_look):
        bpy.app.timers.unregister(_look)
    _checked.clear()
    _known.clear()
