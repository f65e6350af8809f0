# SPDX-License-Identifier: GPL-3.0-or-later
"""Few, hard facets."""

import bpy

settings = bpy.context.scene.ridgeform_stylize

settings.steps = 30
settings.strength = 0.7
settings.sharpness = 1.0
settings.use_fidelity = False
settings.fidelity = 500.0
settings.scale = "max_edge"
settings.coupling = "joint"
