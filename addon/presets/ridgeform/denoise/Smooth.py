# SPDX-License-Identifier: GPL-3.0-or-later
"""Smooth everything, creases too."""

import bpy

settings = bpy.context.scene.ridgeform_denoise

settings.energy = "l2_curved_hessian"
settings.strength = 0.5
settings.sharpness = 0.0
settings.use_fidelity = False
