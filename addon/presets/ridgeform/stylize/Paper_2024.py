# SPDX-License-Identifier: GPL-3.0-or-later
"""The flow as published: Rowe et al. 2024."""

import bpy

settings = bpy.context.scene.ridgeform_stylize

settings.steps = 20
settings.strength = 0.5
settings.sharpness = 0.0
settings.use_fidelity = True
settings.fidelity = 500.0
settings.scale = "max_edge"
settings.coupling = "separate"
