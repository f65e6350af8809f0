# SPDX-License-Identifier: GPL-3.0-or-later
"""What all tools share: a run, its job and operator, presets, the command line, the sidebar."""
