# SPDX-License-Identifier: GPL-3.0-or-later
"""What lies on a mesh, continued into the patches that fill its holes."""
