# SPDX-License-Identifier: GPL-3.0-or-later
"""Planes and the hardest ridges, marked sharp."""

import bpy

settings = bpy.context.scene.ridgeform_holes

settings.shape = "SHARP"
settings.sharpness = 1.0
settings.edge_length = 0.0
settings.material = "CONTINUE"
settings.marks = {"SHARP"}
settings.iterations = 50
settings.fidelity = 50.0
settings.coupling = "joint"
