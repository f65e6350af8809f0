# SPDX-License-Identifier: GPL-3.0-or-later
"""The flags of the command line, made from the declared settings, and the settings that they stand for."""

import argparse
import math
from collections.abc import Callable

import bpy.props
import numpy as np

from .settings import Setting, Settings, chosen, defaults_of

PREFIX = "setting_"
"""What the names of settings begin with among the parsed options, apart from those of files."""


def add_flags(parser: argparse.ArgumentParser, settings: type[Settings]) -> None:
    """Add the flags of a class of settings to a parser."""
    for name, setting in settings.declared.items():
        for word, value in setting.switches.items():
            text = next(text for identifier, _, text in setting.items if identifier == value)
            _add(parser, word, name, action="store_const", const=value, help=_escaped(text))
        word = flag_of(name, setting)
        if word is not None:
            _add(parser, word, name, **_arguments(setting))


def settings_from(options: argparse.Namespace, settings: type[Settings]) -> object:
    """The settings that parsed options stand for, with defaults for all that is not given."""
    given: dict[str, object] = {}
    for name, setting in settings.declared.items():
        value = getattr(options, PREFIX + name, None)
        if value is not None:
            given |= setting.implies | {name: set(value) - {None} if isinstance(value, list) else value}
    return defaults_of(settings, **given)


def flag_of(name: str, setting: Setting) -> str | None:
    """The flag of a setting, `None` if it has none: `--no-` before one that is on by default."""
    if setting.flag != "":
        return setting.flag
    return ("--no-" if setting.default is True else "--") + name.replace("_", "-")


def flags_of(name: str, setting: Setting) -> list[str]:
    """All flags of a setting."""
    word = flag_of(name, setting)
    return [*setting.switches, *([word] if word is not None else [])]


def default_text(setting: Setting) -> str:
    """The default in words of the command line; empty where none counts unless the flag is given."""
    value = setting.default
    if isinstance(value, bool) or setting.implies or (setting.optional and not setting.used):
        return ""
    if isinstance(value, set):
        return ", ".join(_word(item) for item in sorted(value))
    if isinstance(value, str):
        return _word(value)
    return f"{math.degrees(value) if _is_angle(setting) else value:g}"


def _add(parser: argparse.ArgumentParser, word: str, name: str, **arguments: object) -> None:
    parser.add_argument(word, dest=PREFIX + name, default=None, **arguments)


def _arguments(setting: Setting) -> dict[str, object]:
    default = default_text(setting)
    arguments: dict[str, object] = {
        "help": _escaped(setting.keywords["description"]) + (f" ({default})" if default else "")
    }
    if setting.make is bpy.props.BoolProperty:
        if setting.default:
            arguments["help"] = f"Turn off: {arguments['help']}"
        return arguments | {"action": "store_const", "const": not setting.default}
    if setting.items:
        words = {_word(identifier): identifier for identifier, *_ in setting.items}
        if isinstance(setting.default, set) and setting.default:
            # Otherwise what is on by default could not be turned off.
            words["none"] = None
        arguments |= {"type": _chosen(words), "metavar": "{" + ",".join(words) + "}"}
        if isinstance(setting.default, set):
            arguments |= {"action": "append"}
            arguments["help"] += "; may be repeated"
        return arguments
    if setting.make is bpy.props.StringProperty:
        return arguments | {"metavar": "NAME"}
    metavar = "DEGREES" if _is_angle(setting) else setting.metavar
    return arguments | {"type": _in_range(setting), "metavar": metavar or "N"}


def _word(identifier: str) -> str:
    """An identifier as a word of the command line: Blender's are in capitals, the package's stay."""
    return identifier if identifier.islower() else identifier.lower().replace("_", "-")


def _chosen(words: dict[str, str | None]) -> Callable[[str], str | None]:
    def parse(text: str) -> str | None:
        if text not in words:
            raise argparse.ArgumentTypeError(f'"{text}" is not one of {", ".join(words)}')
        return words[text]

    return parse


def _in_range(setting: Setting) -> Callable[[str], float]:
    """What reads a number within the limits of a property, which an operator keeps to as well."""
    kind = int if setting.make is bpy.props.IntProperty else float
    unit = math.degrees if _is_angle(setting) else kind
    low, high = (unit(setting.keywords[end]) if end in setting.keywords else None for end in ("min", "max"))

    def parse(text: str) -> float:
        try:
            value = kind(text)
        except ValueError:
            wanted = "a whole number" if kind is int else "a number"
            raise argparse.ArgumentTypeError(f'"{text}" is not {wanted}') from None
        if not (math.isfinite(value) and (low is None or value >= low) and (high is None or value <= high)):
            raise argparse.ArgumentTypeError(f"{text} is out of range: {_range_text(low, high)}")
        return math.radians(value) if _is_angle(setting) else value

    return parse


def _range_text(low: float | None, high: float | None) -> str:
    if high is None:
        return f"at least {low:g}"
    return f"at most {high:g}" if low is None else f"{low:g} to {high:g}"


def _is_angle(setting: Setting) -> bool:
    return setting.keywords.get("subtype") == "ANGLE"


def _escaped(text: str) -> str:
    return text.replace("%", "%%")


def takes(setting: Setting, word: str) -> str:
    """What is written after a flag: nothing (`"on"`), a `"number"`, a `"word"`, or several `"words"`."""
    if word in setting.switches or setting.make is bpy.props.BoolProperty:
        return "on"
    if setting.items or setting.make is bpy.props.StringProperty:
        return "words" if isinstance(setting.default, set) else "word"
    return "number"


def given_flags(values: object, settings: type[Settings]) -> dict[str, object]:
    """The flags, with what is written after them, that give all of a tool's settings that count.

    The inverse of `settings_from`, but for settings that depend on one that is off.
    """
    given: dict[str, object] = {}
    for name, setting in settings.declared.items():
        value = getattr(values, name)
        given |= {word: True for word, identifier in setting.switches.items() if identifier == value}
        word = flag_of(name, setting)
        if word is None:
            continue
        if any(getattr(values, other) != implied for other, implied in setting.implies.items()):
            continue
        if setting.optional:
            counts = chosen(values, name) is not None
            changed = _written(setting, value) != _written(setting, setting.default)
            if counts != setting.used or (counts and changed):
                # Zero is none.
                given[word] = _written(setting, value) if counts else 0
        elif setting.implies or _written(setting, value) != _written(setting, setting.default):
            given[word] = _written(setting, value)
    for name, (other, _) in settings.follows.items():
        setting = settings.declared[name]
        word = flag_of(name, setting)
        # It would follow from the other one.
        if word is not None and flag_of(other, settings.declared[other]) in given:
            given[word] = _written(setting, getattr(values, name))
    return given


def _written(setting: Setting, value: object) -> object:
    """A value as it is written after its flag: a boolean one has nothing, which is `True`."""
    if isinstance(value, bool):
        return value != setting.default
    if isinstance(value, set):
        return sorted(_word(item) for item in value) or ["none"]
    if isinstance(value, str):
        return _word(value) if setting.items else value
    if isinstance(value, float):
        # Blender has single precision: the shortest number that it takes for this one.
        return float(str(np.float32(math.degrees(value) if _is_angle(setting) else value)))
    return value
