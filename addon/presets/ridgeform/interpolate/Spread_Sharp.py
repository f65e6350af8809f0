# SPDX-License-Identifier: GPL-3.0-or-later
"""Flat slopes between the selected vertices."""

import bpy

settings = bpy.context.scene.ridgeform_interpolate

settings.energy = "l1_hessian"
settings.sharpness = 0.0
settings.known = "SELECTED"
settings.output = "NEW"
