# SPDX-License-Identifier: GPL-3.0-or-later
"""Few, hard facets."""

import bpy

settings = bpy.context.scene.ridgeform_stylize

settings.steps = 40
settings.strength = 0.45
settings.sharpness = 0.8
settings.use_fidelity = False
settings.fidelity = 500.0
settings.scale = "max_edge"
settings.coupling = "joint"
