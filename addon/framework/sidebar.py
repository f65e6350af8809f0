# SPDX-License-Identifier: GPL-3.0-or-later
"""What the panels of the sidebar tab "Ridgeform" of the 3D viewport share."""

import bpy

from . import job

LAST_RUN_LINES = 4


class Sidebar:
    """Mixin that puts a panel into the tab."""

    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Ridgeform"

    @property
    def split_layout(self) -> bpy.types.UILayout:
        """The layout, with names at the left of values."""
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        return layout


def draw_last_run(layout: bpy.types.UILayout, tool: str, counted: str) -> None:
    """Say what the last run did, if it was one of this tool; `counted` is what it counts its steps as."""
    column = layout.column(align=True)
    done = [
        entry for entry in job.last_summary() if entry["tool"] == tool and entry["energy_after"] is not None
    ]
    for entry in done[:LAST_RUN_LINES]:
        before = "" if entry["energy_before"] is None else f"{entry['energy_before']:.3g} → "
        column.label(text=f"{entry['name']}: energy {before}{entry['energy_after']:.3g}", icon="INFO")
        column.label(text=f"{entry['steps']} {counted}, {entry['seconds']:.1f} s", icon="BLANK1")
    if len(done) > LAST_RUN_LINES:
        column.label(text=f"… and {len(done) - LAST_RUN_LINES} more")
