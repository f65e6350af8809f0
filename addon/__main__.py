# SPDX-License-Identifier: GPL-3.0-or-later
"""The batch command under the `bpy` package, from a checkout: `python -m addon stylize FILES -o OUT`."""

from .framework import batch

if __name__ == "__main__":
    batch.run_as_module()
