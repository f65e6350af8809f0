# SPDX-License-Identifier: GPL-3.0-or-later
"""Restore: noisy scans of parts put back onto planes, spheres, cylinders, cones, and tori."""

from ..framework.tool import Feature, Tool
from .settings import PRESETS
from .tool import Restoring

FEATURE = Feature(
    tools=(
        Tool(
            description="Put noisy parts onto the planes, spheres, cylinders, and cones that they were made "
            "of, with exact edges. In Edit Mode, only the selection moves",
            icon="MOD_SOLIDIFY",
            run=Restoring,
            page="manual_restore",
            finds="Reverse Engineering, Scan, Denoise Part",
            presets=PRESETS,
        ),
    ),
)
