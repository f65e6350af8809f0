# SPDX-License-Identifier: GPL-3.0-or-later
"""One module per thing that a modeler asks for: read the meshes, call the wheel, write the result."""
