# SPDX-License-Identifier: GPL-3.0-or-later
"""The border to Blender: meshes, attributes, selections to NumPy arrays and back. No tool is known here."""
