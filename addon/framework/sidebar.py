# SPDX-License-Identifier: GPL-3.0-or-later
"""The panels of the sidebar tab "Ridgeform" of the 3D Viewport, made from the tools."""

from typing import ClassVar

import bpy

from . import bound, former, job, rows
from .run import NO_RESULT
from .settings import properties_of
from .tool import Tool

LAST_RUN_LINES = 4
"""Meshes of the last run that a panel says something about."""
LARGE = 1.4
"""Height of the button of a prominent tool."""


class _ToolPanel:
    """Mixin for a panel of a tool, or a part of one."""

    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Ridgeform"
    tool: ClassVar[object]
    section = ""

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the rows of the section; the panel itself also has the button, and what the last run did."""
        tool, layout = self.tool, rows.split(self.layout)
        settings = getattr(context.scene, tool.scene_property)
        rows.draw_section(layout, settings, tool.settings, self.section, context.object)
        if self.section:
            return
        row = layout.row()
        row.scale_y = LARGE if tool.prominent else 1.0
        if bound.current(tool) is None:
            row.operator(tool.idname, icon=tool.icon).from_panel = True
        else:
            row.operator("ridgeform.apply_result", icon="CHECKMARK")
            row.operator(tool.idname, text="Go On from Here", icon="PLAY").from_panel = True
            layout.label(text="A change starts from the original", icon="FILE_REFRESH")
        if tool.draw_more is not None:
            tool.draw_more(layout, settings)
        draw_last_run(layout, tool)


def draw_last_run(layout: bpy.types.UILayout, tool: Tool) -> None:
    """Say what the last run did, if it was one of this tool."""
    column = layout.column(align=True)
    done = [
        entry
        for entry in job.last_summary()
        if entry["tool"] == tool.run.name and entry["status"] not in NO_RESULT
    ]
    for entry in done[:LAST_RUN_LINES]:
        for line, text in enumerate(tool.run.lines(entry)):
            column.label(text=text, icon="BLANK1" if line else "INFO")
    if len(done) > LAST_RUN_LINES:
        column.label(text=f"… and {len(done) - LAST_RUN_LINES} more")


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
    if tool.presets is not None:
        options["draw_header_preset"] = _draw_presets_button
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


def _draw_presets_button(self: bpy.types.Panel, _context: bpy.types.Context) -> None:
    self.layout.emboss = "NONE"
    self.layout.popover(panel=f"RIDGEFORM_PT_{self.tool.key}_presets", icon="PRESET", text="")


def _made(name: str, bases: tuple[type, ...], doc: str, **own: object) -> type:
    return type(name, bases, {"__module__": __name__, "__doc__": doc, **own})
