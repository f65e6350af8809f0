# SPDX-License-Identifier: GPL-3.0-or-later
"""Few and hard creases, against strong noise."""

import bpy

settings = bpy.context.scene.ridgeform_denoise

settings.energy = "l1_hessian"
settings.strength = 0.6
settings.sharpness = 1.0
settings.use_fidelity = False
