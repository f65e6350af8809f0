# SPDX-License-Identifier: GPL-3.0-or-later
"""The batch command under the `bpy` package, from a checkout: `python -m addon stylize FILES -o OUT`."""

import os
import shutil
import sys

import bpy

from . import registry
from .framework import batch

if __name__ == "__main__":
    batch.offer(registry.TOOLS)
    code = batch.main(sys.argv[1:])
    sys.stdout.flush()
    sys.stderr.flush()
    # bpy 4.2 crashes when Python shuts down after its glTF add-on was used, which would hide the exit code.
    shutil.rmtree(bpy.app.tempdir, ignore_errors=True)
    os._exit(code)
