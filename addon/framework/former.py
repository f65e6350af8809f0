# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings that scenes and presets of versions before have, and others have taken the place of or come with.

Panels keep such a property, hidden. Where a preset or an opened scene has set it, it is unset, and what took
its place is set. Operators keep it as well, for scripts that name it.

Not by a function that Blender calls when it is set: Blender 4.2 as a module keeps that until the end,
and then crashes.
"""

from collections.abc import Sequence

import bpy
from bpy.app.handlers import persistent

from .settings import Settings
from .tool import Tool

_tools: list[Tool] = []


def properties_of(settings: type[Settings]) -> dict[str, object]:
    """The annotations of the hidden properties for a property group."""
    return {name: bpy.props.BoolProperty(name=name, options={"HIDDEN"}) for name in settings.former}


def given_properties_of(settings: type[Settings]) -> dict[str, object]:
    """The annotations of the hidden properties for an operator."""
    return {
        name: bpy.props.BoolProperty(name=name, options={"HIDDEN", "SKIP_SAVE"}) for name in settings.former
    }


def take_given(group: bpy.types.bpy_struct, settings: type[Settings]) -> None:
    """Set what took the place of the properties that a panel, or a call of an operator, was given.

    And what follows from them.
    """
    for name in settings.former:
        if not group.is_property_set(name):
            continue
        first, *others = settings.former[name][getattr(group, name)].items()
        setattr(group, *first)
        for other, value in others:
            # Only where it was left at what was the default then.
            if not group.is_property_set(other):
                setattr(group, other, value)
        group.property_unset(name)
    for name in _following(group, settings):
        other, of = settings.follows[name]
        setattr(group, name, of(getattr(group, other)))


def _following(group: bpy.types.bpy_struct, settings: type[Settings]) -> list[str]:
    """The settings that follow from one that was given, and were not given themselves."""

    def is_given(name: str) -> bool:
        return group.is_property_set(name, ghost=False)

    return [name for name, (other, _) in settings.follows.items() if is_given(other) and not is_given(name)]


@persistent
def take_all(*_arguments: object) -> None:
    """Do so in the panels of all scenes."""
    for scene in bpy.data.scenes:
        for tool in _tools:
            take_given(getattr(scene, tool.scene_property), tool.settings)


def is_due(group: bpy.types.PropertyGroup, settings: type[Settings]) -> bool:
    """Whether a panel has been given such a property, or something follows from one that it was given."""
    return any(group.is_property_set(name) for name in settings.former) or bool(_following(group, settings))


def take_soon() -> None:
    """Do so when Blender has drawn: while it draws nothing may be set."""
    if not bpy.app.timers.is_registered(take_all):
        bpy.app.timers.register(take_all)


def register(tools: Sequence[Tool]) -> None:
    """Look through every scene that is opened."""
    _tools[:] = [tool for tool in tools if tool.settings.former or tool.settings.follows]
    bpy.app.handlers.load_post.append(take_all)


def unregister() -> None:
    """Look no longer."""
    bpy.app.handlers.load_post.remove(take_all)
    _tools.clear()
