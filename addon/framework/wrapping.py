# SPDX-License-Identifier: GPL-3.0-or-later
"""Sentences in a panel: a label of Blender's is one line, and is cut where the panel ends."""

from collections.abc import Callable

import blf
import bpy

UNIT = 20.0
"""Pixels of a button's height at a resolution scale of 1, the unit of Blender's layouts."""
AROUND = 4.25
"""Units of the sidebar's width that the text of a label with an icon does not have: tabs, margins of panel
and label, icon. Measured in a window of Blender 5.2: 82 of 292 pixels at a scale of 1, and a little air."""


def wrapped(text: str, width: float, measure: Callable[[str], float]) -> list[str]:
    """The lines of a text, none wider than `width` by `measure` but for single words that are."""
    lines: list[str] = []
    for word in text.split():
        longer = f"{lines[-1]} {word}" if lines else word
        if lines and measure(longer) <= width:
            lines[-1] = longer
        else:
            lines.append(word)
    return lines


def label_lines(context: bpy.types.Context, text: str) -> list[str]:
    """The lines of a text, as wide as labels with an icon are in the region that is drawn."""
    if context.region is None:
        return [text]
    scale = context.preferences.system.ui_scale
    blf.size(0, context.preferences.ui_styles[0].widget.points * scale)
    return wrapped(
        text, context.region.width - AROUND * UNIT * scale, lambda line: blf.dimensions(0, line)[0]
    )
