# SPDX-License-Identifier: GPL-3.0-or-later
"""Clear facets."""

import bpy

settings = bpy.context.scene.ridgeform_stylize

settings.steps = 20
settings.strength = 0.5
settings.sharpness = 0.75
settings.use_fidelity = False
settings.fidelity = 500.0
settings.scale = "max_edge"
settings.coupling = "joint"
