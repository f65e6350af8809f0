# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings that scenes and presets of versions before have, and others have taken the place of.

Panels keep such a property, hidden: a preset that sets it sets what took its place, and so does a scene that
has it when it is opened. Operators keep it as well, for scripts that name it.
"""

from collections.abc import Sequence

import bpy
from bpy.app.handlers import persistent

from .settings import Settings
from .tool import Tool

_tools: list[Tool] = []


def properties_of(settings: type[Settings]) -> dict[str, object]:
    """The annotations of the hidden properties for a property group."""
    return {
        name: bpy.props.BoolProperty(name=name, options={"HIDDEN"}, update=_taker(name))
        for name in settings.former
    }


def given_properties_of(settings: type[Settings]) -> dict[str, object]:
    """The annotations of the hidden properties for an operator."""
    return {
        name: bpy.props.BoolProperty(name=name, options={"HIDDEN", "SKIP_SAVE"}) for name in settings.former
    }


def take_given(operator: bpy.types.Operator, settings: type[Settings]) -> None:
    """Set what took the place of the properties that a call of an operator has named."""
    for name in settings.former:
        if operator.properties.is_property_set(name):
            _take(operator.properties, settings, name, given=True)
            operator.properties.property_unset(name)


def _taker(name: str) -> object:
    def take(group: bpy.types.PropertyGroup, _context: bpy.types.Context) -> None:
        tool = next((tool for tool in _tools if _is_of(group, tool)), None)
        if tool is not None:
            _take(group, tool.settings, name, given=False)

    return take


def _is_of(group: bpy.types.PropertyGroup, tool: Tool) -> bool:
    return group.id_data.bl_rna.identifier == "Scene" and group == getattr(group.id_data, tool.scene_property)


def _take(group: bpy.types.PropertyGroup, settings: type[Settings], name: str, given: bool) -> None:
    """Set what took the place of a property; if `given`, not those that have a value already."""
    for other, value in settings.former[name][getattr(group, name)].items():
        if not (given and group.is_property_set(other)):
            setattr(group, other, value)


@persistent
def _take_all(*_arguments: object) -> None:
    for scene in bpy.data.scenes:
        for tool in _tools:
            group = getattr(scene, tool.scene_property)
            for name in tool.settings.former:
                if group.is_property_set(name):
                    _take(group, tool.settings, name, given=True)
                    group.property_unset(name)


def register(tools: Sequence[Tool]) -> None:
    """Look through every scene that is opened."""
    _tools[:] = [tool for tool in tools if tool.settings.former]
    bpy.app.handlers.load_post.append(_take_all)


def unregister() -> None:
    """Look no longer."""
    bpy.app.handlers.load_post.remove(_take_all)
    _tools.clear()
