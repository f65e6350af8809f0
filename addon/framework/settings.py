# SPDX-License-Identifier: GPL-3.0-or-later
"""How a setting is declared, once: its property, its row, whether presets keep it, and its flag.

A class of settings derives from `Settings` and annotates each name with what one of the functions here
returns. From what it has `declared`, operators and property groups get their properties, `rows` draws panels,
`flags` makes the command line, and `presets` knows what is stored.
"""

import dataclasses
import inspect
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from types import SimpleNamespace

import bpy.props

Condition = Callable[[object], bool]
"""What a row depends on: a function of the object with the settings."""
Item = tuple[str, str, str]
"""A choice: identifier, label, description."""


@dataclass(frozen=True)
class Range:
    """The values of a number: the one at first, the limits, how far the slider goes, and the decimals."""

    default: float
    min: float | None = None
    max: float | None = None
    soft_min: float | None = None
    soft_max: float | None = None
    precision: int | None = None

    def keywords(self) -> dict[str, float]:
        """The arguments of the property; Blender's own for all that is not said."""
        return {name: value for name, value in vars(self).items() if value is not None}


@dataclass(frozen=True, kw_only=True)
class Setting:
    """One setting: what Blender makes of it, and what rows, presets and the command line do with it."""

    make: Callable[..., object]
    """The function of `bpy.props`."""
    keywords: Mapping[str, object]
    """Its arguments."""
    section: str = ""
    """The part of the panel that it is in: the panel itself, or a subpanel of this name."""
    active: Condition | None = None
    """When its row is not grayed out; `None` for always."""
    shown: Condition | None = None
    """When it has a row at all; `None` for always."""
    expand: bool = False
    """Whether its choices stand side by side."""
    in_presets: bool = True
    """Whether presets store it; not what belongs to one mesh."""
    flag: str | None = ""
    """Its flag on the command line: made from its name if empty, none with `None`."""
    metavar: str | None = None
    """What `--help` calls its value."""
    switches: Mapping[str, str] = field(default_factory=dict)
    """Flags without a value, for a choice: which identifier each stands for."""
    implies: Mapping[str, object] = field(default_factory=dict)
    """The other settings that its flag also sets."""
    otherwise: str = ""
    """For a number with a check box beside it, `use_<name>`: what happens where that is off, for its
    tooltip."""
    used: bool = False
    """Whether that check box is on at first."""

    @property
    def optional(self) -> bool:
        """Whether a check box stands beside the number."""
        return bool(self.otherwise)

    @property
    def label(self) -> str:
        """What the row is called."""
        return self.keywords["name"]

    @property
    def default(self) -> object:
        """The default; a set of its own for flags, since two objects must not share one."""
        value = self.keywords.get("default", "")
        return set(value) if isinstance(value, set) else value

    @property
    def items(self) -> Sequence[Item]:
        """The choices."""
        return self.keywords.get("items", ())

    def but(self, **changes: object) -> "Setting":
        """The same setting with some fields, or arguments of the property, changed."""
        own = {name: changes.pop(name) for name in list(changes) if name in _FIELDS}
        return dataclasses.replace(self, keywords={**self.keywords, **changes}, **own)


_FIELDS = {part.name for part in dataclasses.fields(Setting)}


def _setting(make: Callable[..., object], name: str, description: str, more: dict[str, object]) -> Setting:
    return Setting(make=make, keywords={"name": name, "description": description}).but(**more)


def boolean(name: str, description: str, *, default: bool = False, **more: object) -> Setting:
    """A check box."""
    return _setting(bpy.props.BoolProperty, name, description, {"default": default, **more})


def integer(name: str, description: str, values: Range, **more: object) -> Setting:
    """A whole number."""
    return _setting(bpy.props.IntProperty, name, description, {**values.keywords(), **more})


def number(name: str, description: str, values: Range, **more: object) -> Setting:
    """A decimal number."""
    return _setting(bpy.props.FloatProperty, name, description, {**values.keywords(), **more})


def angle(name: str, description: str, values: Range, **more: object) -> Setting:
    """An angle: in radians, in degrees where Blender shows it and on the command line."""
    return number(name, description, values, subtype="ANGLE", **more)


def distance(name: str, description: str, values: Range, **more: object) -> Setting:
    """A length in the units of the object, which Blender shows in those of the scene."""
    return number(name, description, values, subtype="DISTANCE", **more)


def factor(name: str, description: str, *, default: float, **more: object) -> Setting:
    """A slider from 0 to 1."""
    given = {"default": default, "min": 0.0, "max": 1.0, "subtype": "FACTOR", **more}
    return _setting(bpy.props.FloatProperty, name, description, given)


def items(**meanings: str | tuple[str, str]) -> tuple[Item, ...]:
    """The items of a choice by their identifiers: what each means.

    With a label before it where that is not the identifier in words.
    """
    rows = []
    for identifier, meaning in meanings.items():
        given = (identifier.replace("_", " ").title(), meaning) if isinstance(meaning, str) else meaning
        rows.append((identifier, *given))
    return tuple(rows)


def choice(name: str, description: str, items: Sequence[Item], *, default: str, **more: object) -> Setting:
    """One of some items."""
    given = {"items": tuple(items), "default": default, **more}
    return _setting(bpy.props.EnumProperty, name, description, given)


def choices(name: str, description: str, items: Sequence[Item], **more: object) -> Setting:
    """Any number of some items."""
    given = {"items": tuple(items), "options": {"ENUM_FLAG"}, "default": set(), **more}
    return _setting(bpy.props.EnumProperty, name, description, given)


def data_name(name: str, description: str, **more: object) -> Setting:
    """The name of something on a mesh: `search` offers names. No preset stores it."""
    return _setting(bpy.props.StringProperty, name, description, {"in_presets": False, **more})


VERTEX_GROUP = "vertex group"
"""The metavar of names of vertex groups, by which rows know to offer those of the object."""


def vertex_group(name: str, description: str, **more: object) -> Setting:
    """The name of a vertex group."""
    return data_name(name, description, metavar=VERTEX_GROUP, **more)


def switch_of(name: str) -> str:
    """The name of the check box of an optional number."""
    return f"use_{name}"


def chosen(settings: object, name: str) -> float | None:
    """The value of an optional number; `None` where its check box is off, and for 0."""
    return (getattr(settings, name) or None) if getattr(settings, switch_of(name)) else None


def _with_switches(own: Mapping[str, Setting]) -> dict[str, Setting]:
    """Declared settings, with the check boxes of those that are optional before them."""
    made: dict[str, Setting] = {}
    for name, setting in own.items():
        if setting.optional:
            text = f"Set {setting.label}. Otherwise {setting.otherwise}"
            box = boolean(setting.label, text, default=setting.used, flag=None)
            # Drawn in the row of the number.
            made[switch_of(name)] = box.but(section=setting.section, shown=lambda _settings: False)
        made[name] = setting
    return made


class Settings:
    """Base of the classes of settings, which collects what they declare."""

    declared: Mapping[str, Setting] = {}
    """All settings by name: those of the bases first, in their order."""
    former: Mapping[str, Mapping[bool, Mapping[str, object]]] = {}
    """Check boxes of versions before, and what each of their values sets now: the first always."""
    follows: Mapping[str, tuple[str, Callable[[object], object]]] = {}
    """Settings that, where they are not given, follow from one that is: its name, and how."""

    def __init_subclass__(cls, **arguments: object) -> None:
        """Collect what is declared."""
        super().__init_subclass__(**arguments)
        own = _with_switches(
            {name: made for name, made in inspect.get_annotations(cls).items() if isinstance(made, Setting)}
        )
        inherited: dict[str, Setting] = {}
        for base in cls.__bases__:
            inherited |= getattr(base, "declared", {})
        cls.declared = {name: made for name, made in inherited.items() if name not in own} | own
        # A number that is given counts: so it was before there were check boxes, and 0 stood for none.
        cls.follows = {
            switch_of(name): (name, lambda value: value > 0)
            for name, made in cls.declared.items()
            if made.optional
        } | dict(cls.follows)


def properties_of(settings: type[Settings]) -> dict[str, object]:
    """The annotations that make Blender's properties of the settings in an operator or a property group.

    The class of settings itself must not be among their bases: Blender 4.2 keeps what it registered until the
    end, and if `bpy` hangs on that, as it does on the functions in a setting, Python cannot end without a
    crash.
    """
    return {name: made.make(**made.keywords) for name, made in settings.declared.items()}


def setting_names(settings: type[Settings]) -> tuple[str, ...]:
    """The names of all settings of a class of settings."""
    return tuple(settings.declared)


def values_of(settings: type[Settings], owner: object) -> SimpleNamespace:
    """The settings of a class as a plain object with the values that an operator or a panel has."""
    values = {name: getattr(owner, name) for name in settings.declared}
    return SimpleNamespace(**{name: set(v) if isinstance(v, set) else v for name, v in values.items()})


def defaults_of(settings: type[Settings], **changes: object) -> SimpleNamespace:
    """The settings of a class as a plain object with Blender's defaults, for use without an operator.

    Raises `TypeError` for a name that is not a setting.
    """
    unknown = sorted(set(changes) - set(settings.declared))
    if unknown:
        raise TypeError(f"There is no setting {', '.join(unknown)}.")
    followed = {
        name: of(changes[other])
        for name, (other, of) in settings.follows.items()
        if other in changes and name not in changes
    }
    defaults = {name: made.default for name, made in settings.declared.items()}
    return SimpleNamespace(**(defaults | followed | changes))
