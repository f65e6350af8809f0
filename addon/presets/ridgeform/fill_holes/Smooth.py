# SPDX-License-Identifier: GPL-3.0-or-later
"""No ridges."""

import bpy

settings = bpy.context.scene.ridgeform_holes

settings.shape = "SMOOTH"
settings.sharpness = 0.5
settings.edge_length = 0.0
settings.material = "CONTINUE"
settings.marks = set()
settings.iterations = 50
settings.fidelity = 50.0
settings.coupling = "joint"
