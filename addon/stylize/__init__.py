# SPDX-License-Identifier: GPL-3.0-or-later
"""Stylize: the flow on each mesh, then what is made of the result."""
