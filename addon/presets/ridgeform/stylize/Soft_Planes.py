# SPDX-License-Identifier: GPL-3.0-or-later
"""Broad, soft planes."""

import bpy

settings = bpy.context.scene.ridgeform_stylize

settings.steps = 12
settings.strength = 0.4
settings.sharpness = 0.25
settings.use_fidelity = False
settings.fidelity = 500.0
settings.scale = "max_edge"
settings.coupling = "joint"
