# SPDX-License-Identifier: GPL-3.0-or-later
"""Continue smoothly into the selection."""

import bpy

settings = bpy.context.scene.ridgeform_interpolate

settings.energy = "l2_curved_hessian"
settings.sharpness = 0.0
settings.known = "UNSELECTED"
settings.output = "IN_PLACE"
