"""The native module under one name in every version.

Its file is named after the version: Windows cannot replace a library that is loaded, so an update must not
overwrite the one in use. `scripts/set_version.py` changes the name.
"""

from ._native_0_1_0 import *  # noqa: F403
