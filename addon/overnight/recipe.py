# SPDX-License-Identifier: GPL-3.0-or-later
"""Recipes: several tools in a row, in a TOML file.

    [[step]]
    tool = "fill-holes"
    max-edges = 40

    [[step]]
    tool = "stylize"
    strength = 0.6
    mark = ["sharp", "bevel"]

A key is a flag of the tool's command without its dashes, `true` for a flag that takes no value.
"""

import argparse
import difflib
import json
import re
import tomllib
from collections.abc import Iterable, Mapping
from pathlib import Path

from ..framework import flags
from ..framework.settings import Setting
from ..framework.tool import Tool
from .one_file import Step

STEP, TOOL = "step", "tool"
EXPECTED = {
    "on": "true or false",
    "number": "a number",
    "word": 'a text in quotes, such as "sharp"',
    "words": 'a list of texts, such as ["sharp", "bevel"]',
}


class RecipeError(Exception):
    """A recipe that cannot be read; the message names file, line, tool, and key."""


def read(path: Path, tools: Mapping[str, Tool]) -> list[Step]:
    """The steps of a recipe, of tools by their commands. `RecipeError`."""
    try:
        return parse(path.read_text(encoding="utf-8"), str(path), tools)
    except (OSError, UnicodeDecodeError) as error:
        reason = getattr(error, "strerror", None) or error
        raise RecipeError(f"{path} cannot be read: {reason}") from error


def parse(text: str, name: str, tools: Mapping[str, Tool]) -> list[Step]:
    """The steps of the text of a recipe that is called `name`. `RecipeError`."""
    try:
        content = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise RecipeError(f"{name} is no TOML: {error}") from error
    for key in content:
        if key != STEP:
            place = _Place(name, text, 0)
            raise place.error(key, f'"{key}" stands outside of a step: a recipe has [[step]] tables only')
    steps = content.get(STEP, [])
    if not isinstance(steps, list) or not all(isinstance(step, dict) for step in steps):
        raise RecipeError(f"{name}: write each step as a table that begins with [[step]]")
    if not steps:
        raise RecipeError(f"{name} has no step: begin each one with a line [[step]]")
    return [_step(table, _Place(name, text, number), tools) for number, table in enumerate(steps, 1)]


def step_text(tool: Tool, values: object) -> str:
    """The text of a step: a tool with all settings that are not at their defaults."""
    lines = ["[[step]]", f"{TOOL} = {_toml(tool.command)}"]
    for word, value in flags.given_flags(values, tool.settings).items():
        lines.append(f"{word.removeprefix('--')} = {_toml(value)}")
    return "\n".join(lines) + "\n"


class _Place:
    """Where a step stands in a file, for messages."""

    def __init__(self, name: str, text: str, number: int) -> None:
        """Take the step of this number, from 1; 0 for what stands before all of them."""
        self._name, self._lines, self._number = name, text.splitlines(), number
        self.tool = ""

    def error(self, key: str, message: str) -> RecipeError:
        """What is wrong with a key."""
        tool = f"{self.tool}: " if self.tool else ""
        return RecipeError(f"{self._name}, line {self._line(key)}: {tool}{message}")

    def _line(self, key: str) -> int:
        """The line of a key, or the first of its step."""
        number, begin = 0, 1
        pattern = re.compile(rf"""\s*["']?{re.escape(key)}["']?\s*[=.]|\s*\[+\s*{re.escape(key)}\s*\]""")
        for line, text in enumerate(self._lines, 1):
            if re.match(r"\s*\[\[\s*step\s*\]\]", text):
                number += 1
                if number == self._number:
                    begin = line
            elif number == self._number and pattern.match(text):
                return line
        return begin


def _step(table: Mapping[str, object], place: _Place, tools: Mapping[str, Tool]) -> Step:
    name = table.get(TOOL)
    if not isinstance(name, str):
        raise place.error(TOOL, f'a step names its tool: tool = "{next(iter(tools))}"')
    if name not in tools:
        raise place.error(TOOL, f'there is no tool "{name}"{_meant(name, tools)}: {", ".join(tools)}')
    tool = tools[name]
    place.tool = name
    known: dict[str, tuple[str, Setting]] = {}
    for setting_name, setting in tool.settings.declared.items():
        for word in flags.flags_of(setting_name, setting):
            known[word.removeprefix("--")] = word, setting
    arguments = []
    for key, value in table.items():
        if key == TOOL:
            continue
        if key not in known:
            raise place.error(key, f'there is no setting "{key}"{_meant(key, known)}; see {name} --help')
        arguments += _arguments(key, value, *known[key], place)
    parser = argparse.ArgumentParser(exit_on_error=False, add_help=False, allow_abbrev=False)
    flags.add_flags(parser, tool.settings)
    try:
        options = parser.parse_args(arguments)
    except argparse.ArgumentError as error:
        key = error.argument_name.removeprefix("--")
        raise place.error(key, f"{key}: {error.message}") from error
    return Step(tool, flags.settings_from(options, tool.settings))


def _arguments(key: str, value: object, word: str, setting: Setting, place: _Place) -> list[str]:
    """A key with its value as arguments of the command line."""
    kind = flags.takes(setting, word)
    fits = {
        "on": isinstance(value, bool),
        "number": isinstance(value, int | float) and not isinstance(value, bool),
        "word": isinstance(value, str),
        "words": isinstance(value, list) and all(isinstance(item, str) for item in value),
    }
    if not fits[kind]:
        raise place.error(key, f"{key} is {json.dumps(value, default=str)}: write {EXPECTED[kind]}")
    if kind == "on":
        return [word] if value else []
    if kind == "words":
        return [f"{word}={item}" for item in value or ["none"]]
    return [f"{word}={value!r}" if kind == "number" else f"{word}={value}"]


def _meant(word: str, known: Iterable[str]) -> str:
    """Which one was probably meant, as a part of a sentence."""
    close = difflib.get_close_matches(word.replace("_", "-"), list(known), 1)
    return f', but there is "{close[0]}"' if close else ""


def _toml(value: object) -> str:
    """A value in TOML: texts, numbers, booleans, and lists of texts are written as in JSON."""
    return json.dumps(value, ensure_ascii=False)
