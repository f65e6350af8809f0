# SPDX-License-Identifier: GPL-3.0-or-later
"""Optional last steps on a result."""
