# SPDX-License-Identifier: GPL-3.0-or-later
"""The faces that a person would name: the defaults."""

import bpy

settings = bpy.context.scene.ridgeform_segment

settings.method = "fitted"
settings.length_weight = 0.5
settings.use_count = False
settings.min_faces = 0
settings.use_fidelity = False
settings.fidelity = 1000.0
settings.cut_threshold = 0.6
settings.epsilon_start = 0.1
settings.epsilon_end = 0.001
settings.scale = "extent"
