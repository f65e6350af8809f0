# SPDX-License-Identifier: GPL-3.0-or-later
"""The panels of the sidebar tab "Ridgeform" of the 3D Viewport, made from the tools."""

from collections.abc import Callable, Sequence
from typing import ClassVar

import bpy

from . import bound, former, job, manual, rows, wrapping
from .run import NO_RESULT
from .settings import properties_of
from .shared_settings import EXPERT
from .tool import Tool

LAST_RUN_LINES = 4
"""Meshes of the last run that a panel says something about."""
ATTRIBUTES = "Attributes and Curves"
"""The panel that the tools on attributes are in."""
LARGE = 1.4
"""Height of the button of a prominent tool."""

_lines: list[Callable[[bpy.types.UILayout, object], None]] = []


def offer_lines(lines: Sequence[Callable[[bpy.types.UILayout, object], None]]) -> None:
    """Take what draws a line above the button of every tool, from a layout and the active object."""
    _lines[:] = lines


class InTab:
    """Mixin for a panel in the tab."""

    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Ridgeform"


class _ToolPanel(InTab):
    """Mixin for a panel of a tool, or a part of one."""

    tool: ClassVar[object]
    section = ""

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the panel. Blender would call what is raised here again with every redraw."""
        try:
            self.draw_all(context)
        except Exception as error:
            self.layout.label(text=f"{type(error).__name__}: {error}", icon="ERROR")

    def draw_all(self, context: bpy.types.Context) -> None:
        """Draw the rows of the section; the panel itself also has presets, button, and what a run did."""
        tool, layout = self.tool, rows.split(self.layout)
        settings = getattr(context.scene, tool.scene_property)
        if former.is_due(settings, tool.settings):
            former.take_soon()
        if not self.section and tool.presets is not None:
            # Its label is the preset that was chosen last.
            layout.menu(tool.presets_menu, text=getattr(bpy.types, tool.presets_menu).bl_label, icon="PRESET")
        rows.draw_section(layout, settings, tool.settings, self.section, context.object)
        if self.section == EXPERT:
            draw_last_run(context, layout, tool, tool.run.numbers)
        if self.section:
            return
        for draw_line in _lines:
            draw_line(layout, context.object)
        row = layout.row()
        row.scale_y = LARGE if tool.prominent else 1.0
        if bound.current(tool) is None:
            row.operator(tool.idname, icon=tool.icon).from_panel = True
        else:
            row.operator("ridgeform.apply_result", icon="CHECKMARK")
            row.operator(tool.idname, text="Go On", icon="PLAY").from_panel = True
            layout.label(text="A change starts from the original", icon="FILE_REFRESH")
        if tool.draw_more is not None:
            tool.draw_more(layout, settings)
        draw_last_run(context, layout, tool, lambda entry: tool.run.lines(entry) + _notes(entry))


def draw_last_run(
    context: bpy.types.Context, layout: bpy.types.UILayout, tool: Tool, said: Callable[[dict], list[str]]
) -> None:
    """Say of each mesh what there is to be `said` of it in the last run, if that was one of this tool."""
    column = layout.column(align=True)
    done = [
        entry
        for entry, uid in zip(job.shown_summary(), job.shown_uids(), strict=False)
        if entry["tool"] == tool.run.name
        and entry["status"] not in NO_RESULT
        and (obj := bpy.data.objects.get(entry["name"])) is not None
        and obj.session_uid == uid
    ]
    for entry in done[:LAST_RUN_LINES]:
        lines = [line for text in said(entry) for line in wrapping.label_lines(context, text)]
        for line, text in enumerate(lines):
            column.label(text=text, icon="BLANK1" if line else "INFO")
    if len(done) > LAST_RUN_LINES:
        column.label(text=f"… and {len(done) - LAST_RUN_LINES} more")


def _notes(entry: dict[str, object]) -> list[str]:
    return [note[:1].upper() + note[1:] for note in entry["warnings"]]


def group_class(tool: Tool) -> type:
    """The property group of a tool's settings, which the scene has and saves."""
    words = "".join(word.capitalize() for word in tool.key.split("_"))
    return _made(
        f"Ridgeform{words}Settings",
        (bpy.types.PropertyGroup,),
        "Settings of a panel, saved with the scene",
        __annotations__=properties_of(tool.settings) | former.properties_of(tool.settings),
    )


def panel_classes(tool: Tool) -> list[type]:
    """The panel of a tool, and a subpanel for each section."""
    name = f"RIDGEFORM_PT_{tool.key}"
    options = {"bl_label": tool.panel_label, "tool": tool}
    if not tool.prominent:
        options["bl_options"] = {"DEFAULT_CLOSED"}
    if tool.group:
        options["bl_parent_id"] = _group_idname(tool.group)
    options["draw_header_preset"] = _draw_header_buttons
    classes = [_made(name, (_ToolPanel, bpy.types.Panel), tool.description, **options)]
    for section in rows.sections_of(tool.settings):
        classes.append(
            _made(
                f"{name}_{section.lower().replace(' ', '_')}",
                (_ToolPanel, bpy.types.Panel),
                f"{section}: {tool.panel_label}",
                bl_label=section,
                bl_parent_id=name,
                bl_options=set() if section in tool.open_sections else {"DEFAULT_CLOSED"},
                tool=tool,
                section=section,
            )
        )
    return classes


def group_panel(label: str) -> type:
    """The closed panel that panels of several tools are in."""
    return _made(
        _group_idname(label),
        (_GroupPanel, bpy.types.Panel),
        label,
        bl_label=label,
        bl_options={"DEFAULT_CLOSED"},
    )


def _group_idname(label: str) -> str:
    return f"RIDGEFORM_PT_{label.lower().replace(' ', '_')}"


class _GroupPanel(InTab):
    """Mixin for a panel that has nothing but other panels."""

    def draw(self, _context: bpy.types.Context) -> None:
        """Draw nothing."""


def _draw_header_buttons(self: bpy.types.Panel, _context: bpy.types.Context) -> None:
    self.layout.emboss = "NONE"
    manual.draw_button(self.layout, self.tool)
    if self.tool.presets is not None:
        self.layout.popover(panel=f"RIDGEFORM_PT_{self.tool.key}_presets", icon="PRESET", text="")


def _made(name: str, bases: tuple[type, ...], doc: str, **own: object) -> type:
    return type(name, bases, {"__module__": __name__, "__doc__": doc, **own})
