# SPDX-License-Identifier: GPL-3.0-or-later
"""The manual, a part of the extension: Blender's Online Manual entry and a button in every panel open it."""

from collections.abc import Sequence
from pathlib import Path

import bpy

from .tool import Tool

PAGES = Path(__file__).parents[1] / "help"
"""Made of the manual when the extension is built."""

_tools: list[Tool] = []


def address_of(tool: Tool) -> str:
    """Where the manual is on a tool, as a web browser opens it."""
    return f"{PAGES.as_uri()}/{tool.page}.html"


def draw_button(layout: bpy.types.UILayout, tool: Tool) -> None:
    """Draw the button that opens the manual."""
    if PAGES.is_dir():
        layout.operator("wm.url_open", text="", icon="HELP").url = address_of(tool)


def manual_map() -> tuple[str, tuple[tuple[str, str], ...]]:
    """Where Blender looks operators up."""
    entries = [(f"bpy.ops.ridgeform.{tool.name}*", f"{tool.page}.html") for tool in _tools]
    return f"{PAGES.as_uri()}/", (*entries, ("bpy.ops.ridgeform.*", "manual.html"))


def register(tools: Sequence[Tool]) -> None:
    """Tell Blender where the manual is."""
    _tools[:] = tools
    bpy.utils.register_manual_map(manual_map)


def unregister() -> None:
    """Take it away."""
    bpy.utils.unregister_manual_map(manual_map)
