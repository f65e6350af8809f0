# SPDX-License-Identifier: GPL-3.0-or-later
"""The rows of settings, the same in the sidebar and in the redo panel."""

import bpy

from .settings import VERTEX_GROUP, Setting, Settings, switch_of


def sections_of(settings: type[Settings]) -> list[str]:
    """The named sections of a class of settings, in their order."""
    return list(dict.fromkeys(made.section for made in settings.declared.values() if made.section))


def draw_section(
    layout: bpy.types.UILayout,
    settings: object,
    declared: type[Settings],
    section: str,
    obj: bpy.types.Object | None,
) -> None:
    """Draw the rows of one section; `obj` is whose vertex groups are offered."""
    column = layout.column()
    for name, setting in declared.declared.items():
        if setting.section == section and (setting.shown is None or setting.shown(settings)):
            draw_setting(column, settings, name, setting, obj)


def draw_setting(
    layout: bpy.types.UILayout,
    settings: object,
    name: str,
    setting: Setting,
    obj: bpy.types.Object | None,
) -> None:
    """Draw one row, an optional number with its check box; vertex groups only where a mesh can have them."""
    is_active = setting.active is None or setting.active(settings)
    is_slider = setting.keywords.get("subtype") == "FACTOR"
    if setting.optional:
        row = layout.row(align=True, heading=setting.label)
        row.active = is_active
        row.prop(settings, switch_of(name), text="")
        value = row.row(align=True)
        value.active = is_active and getattr(settings, switch_of(name))
        value.prop(settings, name, text="", slider=is_slider)
        return
    row = layout.row(align=True)
    row.active = is_active
    if setting.metavar == VERTEX_GROUP:
        if obj is not None and obj.type == "MESH":
            row.prop_search(settings, name, obj, "vertex_groups")
    elif setting.expand:
        row.prop(settings, name, expand=True)
    elif "ENUM_FLAG" in setting.keywords.get("options", ()):
        row.column().prop(settings, name)
    else:
        row.prop(settings, name, slider=is_slider)


def split(layout: bpy.types.UILayout) -> bpy.types.UILayout:
    """Have names at the left of values, without the dots of animation; returns the layout."""
    layout.use_property_split = True
    layout.use_property_decorate = False
    return layout
