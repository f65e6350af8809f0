# SPDX-License-Identifier: GPL-3.0-or-later
"""Denoise, interpolate and show attributes; vibration modes."""
