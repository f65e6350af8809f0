# SPDX-License-Identifier: GPL-3.0-or-later
"""The batch command where Blender is a module: `python -m addon stylize FILES -o OUT` from a checkout."""

from . import registry
from .framework import batch

if __name__ == "__main__":
    batch.run_as_module(registry.TOOLS, registry.COMMANDS)
