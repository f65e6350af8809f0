# SPDX-License-Identifier: GPL-3.0-or-later
"""Fill Holes: patches, and what lies on a mesh continued into them."""
