# SPDX-License-Identifier: GPL-3.0-or-later
"""The features of the add-on, and how all of it is added to Blender."""

from importlib import import_module

import bpy

from .framework import (
    batch,
    bound,
    former,
    manual,
    menus,
    modal,
    preferences,
    presets,
    sidebar,
    tool_operator,
)
from .overnight import recipe_operators

NAMES = (
    "stylize",
    "holes",
    "facets",
    "restore",
    "segments",
    "attributes",
    "diffusion",
    "check",
)
"""The folders of the features, in the order of their panels and menu entries."""

FEATURES = [import_module(f".{name}", __package__).FEATURE for name in NAMES]
TOOLS = [tool for feature in FEATURES for tool in feature.tools]
COMMANDS = [command for feature in FEATURES for command in feature.commands]


def _classes() -> list[type]:
    """All classes in the order of their registration, made once."""
    made = [
        presets.RIDGEFORM_OT_shipped_preset,
        *bound.OPERATORS,
        menus.RIDGEFORM_MT_tools,
        preferences.RIDGEFORM_OT_save_defaults,
    ]
    groups = set()
    for feature in FEATURES:
        made += feature.operators
        for tool in feature.tools:
            made.append(tool_operator.operator_class(tool))
            if tool.presets is not None:
                made += presets.preset_classes(tool)
            if tool.group and tool.group not in groups:
                groups.add(tool.group)
                made.append(sidebar.group_panel(tool.group))
            made += [GROUPS[tool.scene_property], *sidebar.panel_classes(tool)]
        made += feature.panels
    made += recipe_operators.classes(TOOLS)
    return [*made, preferences.preferences_class(TOOLS, GROUPS)]


GROUPS = {tool.scene_property: sidebar.group_class(tool) for tool in TOOLS}
CLASSES = _classes()


def register() -> None:
    """Add the operators, the panels, the menu entries and the command to Blender."""
    modal.register()
    bound.register()
    presets.offer(TOOLS)
    sidebar.offer_lines([feature.draw_line for feature in FEATURES if feature.draw_line is not None])
    former.register(TOOLS)
    preferences.register(TOOLS)
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    for name, group in GROUPS.items():
        setattr(bpy.types.Scene, name, bpy.props.PointerProperty(type=group))
    for feature in FEATURES:
        if feature.register is not None:
            feature.register()
    menus.register(FEATURES)
    manual.register(TOOLS)
    batch.register(TOOLS, COMMANDS)


def unregister() -> None:
    """Take everything out of Blender again; a job that runs is cancelled first."""
    bound.unregister()
    modal.unregister()
    preferences.unregister()
    former.unregister()
    batch.unregister()
    manual.unregister()
    menus.unregister()
    for feature in reversed(FEATURES):
        if feature.unregister is not None:
            feature.unregister()
    for name in GROUPS:
        delattr(bpy.types.Scene, name)
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
