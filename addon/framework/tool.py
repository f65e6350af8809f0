# SPDX-License-Identifier: GPL-3.0-or-later
"""What a feature declares: its tools, and what else it adds to Blender."""

import argparse
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from .run import Run
from .settings import Settings


@dataclass(frozen=True, kw_only=True)
class Tool:
    """One thing that a modeler asks for: an operator with a panel, presets and a command, made from this."""

    description: str
    """What it does, for tooltips and `--help`."""
    icon: str
    run: type[Run]
    """What it does with some meshes; its name and settings are the tool's."""
    label: str = ""
    """What the operator is called, if not as its name says."""
    key: str = ""
    """What its panels and presets are named by, if not by the name."""
    scene: str = ""
    """The property of the scene with the panel's settings, if not `ridgeform_<key>`."""
    title: str = ""
    """What the panel is called, if not as the operator."""
    prominent: bool = False
    """Whether the panel is open at first and its button large."""
    open_sections: Sequence[str] = ()
    """The subpanels that are open at first."""
    page: str = "manual"
    """The page of the manual."""
    quick: Sequence[str] = ()
    """The settings that a redo takes no time for, however long a run takes."""
    group: str = ""
    """The panel that its panel is a part of, with those of other tools; none if empty."""
    finds: str = ""
    """Words in its menu entry by which the search finds it as well."""
    stays_bound: bool = False
    """Whether its panel stays bound to the last result: changed settings start again from the original."""
    presets: Mapping[str, Mapping[str, object]] | None = None
    """The shipped presets: what each sets; `None` for a tool without any. All set what any of them names, to
    the default where it is not said."""
    draw_more: Callable[[object, object], None] | None = None
    """Draws what else is below the button, from a layout and the settings."""

    def __post_init__(self) -> None:
        """Fill in what follows from the name."""
        object.__setattr__(self, "label", self.label or self.name.replace("_", " ").title())
        object.__setattr__(self, "key", self.key or self.name)

    @property
    def name(self) -> str:
        """The operator's: `bpy.ops.ridgeform.<name>`, and with dashes the word on the command line."""
        return self.run.name

    @property
    def settings(self) -> type[Settings]:
        """What can be set."""
        return self.run.takes

    @property
    def idname(self) -> str:
        """The operator's identifier."""
        return f"ridgeform.{self.name}"

    @property
    def command(self) -> str:
        """The word on the command line."""
        return self.name.replace("_", "-")

    @property
    def scene_property(self) -> str:
        """The name of the scene's property with the settings of the panel."""
        return self.scene or f"ridgeform_{self.key}"

    @property
    def panel_label(self) -> str:
        """What the panel is called."""
        return self.title or self.label

    @property
    def menu_text(self) -> str:
        """What its menu entry is called."""
        return f"{self.label} ({self.finds})" if self.finds else self.label

    @property
    def presets_menu(self) -> str:
        """The identifier of the menu of its presets."""
        return f"RIDGEFORM_MT_{self.key}_presets"

    def preset_values(self, name: str) -> dict[str, object]:
        """All that a shipped preset sets."""
        named = dict.fromkeys(key for values in self.presets.values() for key in values)
        return {key: self.settings.declared[key].default for key in named} | dict(self.presets[name])


@dataclass(frozen=True, kw_only=True)
class Command:
    """A word of the command line that is no tool: it writes no files."""

    name: str
    """The word."""
    description: str
    """What it does, for `--help`."""
    add_arguments: Callable[[argparse.ArgumentParser], None]
    """Adds what follows the word."""
    run: Callable[[argparse.Namespace], int]
    """Does it, and returns the exit code."""


@dataclass(frozen=True, kw_only=True)
class Feature:
    """A folder of the add-on: tools, and operators that are none."""

    tools: Sequence[Tool]
    operators: Sequence[type] = ()
    """Other operators; the registry registers them."""
    menu: Sequence[tuple[str, str]] = ()
    """Identifier and icon of those of them that have an entry in the menus."""
    panels: Sequence[type] = ()
    """Panels that are no tool's."""
    commands: Sequence[Command] = ()
    """Words of the command line that are no tool's."""
    draw_line: Callable[[object, object], None] | None = None
    """Draws a line above the button of every tool's panel, from a layout and the active object."""
    register: Callable[[], None] | None = None
    """What else is added to Blender."""
    unregister: Callable[[], None] | None = None
    """What takes it away again."""
