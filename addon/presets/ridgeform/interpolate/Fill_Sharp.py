# SPDX-License-Identifier: GPL-3.0-or-later
"""Continue creases into the selection."""

import bpy

settings = bpy.context.scene.ridgeform_interpolate

settings.energy = "l1_hessian"
settings.sharpness = 0.5
settings.known = "UNSELECTED"
settings.output = "IN_PLACE"
