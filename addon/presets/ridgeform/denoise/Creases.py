# SPDX-License-Identifier: GPL-3.0-or-later
"""Keep creases, take noise away."""

import bpy

settings = bpy.context.scene.ridgeform_denoise

settings.energy = "l1_hessian"
settings.strength = 0.5
settings.sharpness = 0.0
settings.use_fidelity = False
