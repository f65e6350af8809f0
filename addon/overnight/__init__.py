# SPDX-License-Identifier: GPL-3.0-or-later
"""Many files: one after another or side by side, a journal of what is done, pages on it, recipes, farms."""
