# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel with what was found, and the line that every tool's panel has of it."""

import bpy

from ..framework.sidebar import InTab
from . import known
from .kinds import Domain, Finding, Report, Severity
from .operators import RIDGEFORM_OT_check, RIDGEFORM_OT_cure_faults, RIDGEFORM_OT_select_faults

ICONS = {Severity.STOPS: "ERROR", Severity.LIMITS: "INFO", Severity.HANDLED: "CHECKMARK"}
CHANGED = "Changed since the check"


class RIDGEFORM_PT_check(InTab, bpy.types.Panel):  # noqa: N801
    """What is wrong with the active mesh for these tools, and what to do about it"""

    bl_idname = "RIDGEFORM_PT_check"
    bl_label = "Check Mesh"
    bl_options = {"DEFAULT_CLOSED"}
    # As a popover, wide enough for its sentences.
    bl_ui_units_x = 15

    def draw(self, context: bpy.types.Context) -> None:
        """Draw what was found last, and the button to look again."""
        obj = context.object
        checked = known.of(obj) if obj is not None and obj.type == "MESH" else None
        if checked is not None and checked.has_changed:
            self.layout.label(text=CHANGED, icon="FILE_REFRESH")
        self.layout.operator(RIDGEFORM_OT_check.bl_idname, icon="VIEWZOOM")
        if checked is None:
            return
        if not checked.report.findings:
            self.layout.label(text=f"{checked.report.name}: nothing wrong", icon="CHECKMARK")
        for found in checked.report.findings:
            _draw_finding(self.layout, found)


def _draw_finding(layout: bpy.types.UILayout, found: Finding) -> None:
    kind = found.kind
    column = layout.box().column(align=True)
    column.label(text=found.text, icon=ICONS[kind.severity])
    for text in (*found.notes, kind.tools):
        row = column.row()
        row.active = False
        row.label(text=text, icon="BLANK1")
    if kind.domain is Domain.NONE and not kind.cure:
        return
    row = column.row(align=True)
    if kind.domain is not Domain.NONE:
        row.operator(
            RIDGEFORM_OT_select_faults.bl_idname, text="Select", icon="RESTRICT_SELECT_OFF"
        ).kind = kind.name
    if kind.cure:
        row.operator(RIDGEFORM_OT_cure_faults.bl_idname, text=kind.cure, icon="MODIFIER").kind = kind.name


def draw_line(layout: bpy.types.UILayout, obj: bpy.types.Object | None) -> None:
    """Draw one line on the active mesh: what was found last opens from it."""
    if obj is None or obj.type != "MESH":
        return
    checked = known.of(obj)
    row = layout.row(align=True)
    if checked is None:
        row.operator(RIDGEFORM_OT_check.bl_idname, icon="VIEWZOOM")
        return
    text, icon = line_of(checked.report)
    if checked.has_changed:
        text, icon = CHANGED, "FILE_REFRESH"
    row.popover(panel=RIDGEFORM_PT_check.bl_idname, text=text, icon=icon)
    row.operator(RIDGEFORM_OT_check.bl_idname, text="", icon="VIEWZOOM")


def line_of(report: Report) -> tuple[str, str]:
    """What the line says of a report, and its icon."""
    findings = report.findings
    if not findings:
        return "Ready", ICONS[Severity.HANDLED]
    text = findings[0].text if len(findings) == 1 else f"{len(findings)} kinds of faults"
    gravest = findings[0].kind.severity
    return (f"Ready: {text}" if gravest is Severity.HANDLED else text), ICONS[gravest]
