# SPDX-License-Identifier: GPL-3.0-or-later
"""For scripts: `main(arguments)` is the batch command, and returns its exit code."""

from .framework.batch import main

__all__ = ("main",)
