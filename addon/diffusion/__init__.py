# SPDX-License-Identifier: GPL-3.0-or-later
"""Diffusion curves in Blender: colours in, curve objects out and in again, colours and drawings out."""
