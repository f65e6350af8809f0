# SPDX-License-Identifier: GPL-3.0-or-later
"""The batch command under the `bpy` package, from a checkout: `python -m addon stylize FILES -o OUT`."""

import sys

from .batch import main

if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
