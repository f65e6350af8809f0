# SPDX-License-Identifier: GPL-3.0-or-later
"""The operators that check meshes, select what was found, and cure it."""

from collections.abc import Sequence

import bpy
from bpy.props import EnumProperty

from ..blender import mesh_io, selection
from ..blender.refusals import RefusedError
from . import cures, known
from .examine import NEEDS, examine
from .kinds import KIND, KINDS, Domain, Kind, Severity
from .select import select

SELECTABLE = tuple(kind for kind in KINDS if kind.domain is not Domain.NONE)
CURABLE = tuple(kind for kind in KINDS if kind.cure)


def meshes_of(context: bpy.types.Context) -> list[bpy.types.Object]:
    """The mesh objects that are checked, the active one first; linked duplicates share one, taken once."""
    if context.mode not in selection.MODES:
        return []
    by_mesh: dict[bpy.types.Mesh, bpy.types.Object] = {}
    for obj in selection.mesh_objects(context):
        by_mesh.setdefault(obj.data, obj)
    return list(by_mesh.values())


class RIDGEFORM_OT_check(bpy.types.Operator):  # noqa: N801
    """Look for what is wrong with the selected meshes for these tools, and change nothing"""

    bl_idname = "ridgeform.check"
    bl_label = "Check Mesh"
    bl_options = {"REGISTER"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Whether there is a mesh to look at."""
        return selection.can_start(cls, None if meshes_of(context) else "Select a mesh object")

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Look at all of them, and report."""
        reports = [known.check(obj) for obj in meshes_of(context)]
        known.remember(reports)
        stops = any(report.count(Severity.STOPS) for report in reports)
        self.report({"WARNING"} if stops else {"INFO"}, "; ".join(report.sentence for report in reports))
        return {"FINISHED"}


class _OnEditable:
    """Mixin of operators on meshes that can be edited."""

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Whether there is one."""
        objects, skipped = _editable(context)
        return selection.can_start(cls, None if objects else [*skipped, "Select a mesh object"][0])


def _fault(description: str, kinds: Sequence[tuple[Kind, str]]) -> object:
    """A property that is one of these kinds of faults, each with its tooltip."""
    items = [(kind.name, kind.label, text) for kind, text in kinds]
    return EnumProperty(name="Fault", description=description, items=items)


class RIDGEFORM_OT_select_faults(_OnEditable, bpy.types.Operator):  # noqa: N801
    """Enter Edit Mode with exactly what was found selected"""

    bl_idname = "ridgeform.select_faults"
    bl_label = "Select Faults"
    bl_options = {"REGISTER", "UNDO"}

    kind: _fault("What is selected", [(kind, kind.many.capitalize()) for kind in SELECTABLE])

    @classmethod
    def description(cls, _context: bpy.types.Context, properties: object) -> str:
        """What is selected."""
        return f"Enter Edit Mode with the {KIND[properties.kind].many} selected, and nothing else"

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Look again, so that it is right whatever has happened since, and select."""
        kind = KIND[self.kind]
        objects, skipped = _editable(context)
        found = {obj: known.check(obj)[self.kind] for obj in objects}
        count = sum(finding.count for finding in found.values() if finding is not None)
        if not count:
            self.report({"INFO"}, "; ".join([f"There are no {kind.many}", *skipped]))
            return {"CANCELLED"}
        select(found, kind.domain, context.scene)
        text = f"Selected {count} {kind.one if count == 1 else kind.many}"
        self.report({"INFO"}, "; ".join([text, *skipped]))
        return {"FINISHED"}


class RIDGEFORM_OT_cure_faults(_OnEditable, bpy.types.Operator):  # noqa: N801
    """Cure what was found in all selected meshes"""

    bl_idname = "ridgeform.cure_faults"
    bl_label = "Cure Faults"
    bl_options = {"REGISTER", "UNDO"}

    kind: _fault("What is cured", [(kind, kind.cure_text) for kind in CURABLE])

    @classmethod
    def description(cls, _context: bpy.types.Context, properties: object) -> str:
        """What the cure does."""
        return KIND[properties.kind].cure_text

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Cure it in every mesh that has it, and look again."""
        kind = KIND[self.kind]
        objects, notes = _editable(context)
        cured = 0
        with mesh_io.object_mode():
            for obj in objects:
                finding = examine(obj)[self.kind]
                if finding is None:
                    continue
                try:
                    cures.cure(obj, self.kind)
                except RefusedError as refusal:
                    notes.append(str(refusal))
                    continue
                cured += finding.count
                left = known.check(obj)[self.kind]
                if left is not None:
                    notes.append(f'left in "{obj.name}": {left.text}')
        if not cured:
            self.report({"WARNING"} if notes else {"INFO"}, "; ".join(notes or [f"There are no {kind.many}"]))
            return {"CANCELLED"}
        text = f"{kind.cure}: {cured} {kind.one if cured == 1 else kind.many}"
        self.report({"INFO"}, "; ".join([text, *notes]))
        return {"FINISHED"}


def _editable(context: bpy.types.Context) -> tuple[list[bpy.types.Object], list[str]]:
    """The meshes that can be edited, and why others cannot."""
    objects, skipped = [], []
    for obj in meshes_of(context):
        reason = _reason_against(obj)
        if reason is None:
            objects.append(obj)
        else:
            skipped.append(reason)
    return objects, skipped


def _reason_against(obj: bpy.types.Object) -> str | None:
    # A mesh of loose edges alone is one to cure.
    return selection.reason_against(obj, NEEDS) if len(obj.data.polygons) or obj.data.is_editmode else None


OPERATORS = (RIDGEFORM_OT_check, RIDGEFORM_OT_select_faults, RIDGEFORM_OT_cure_faults)
