# SPDX-License-Identifier: GPL-3.0-or-later
"""For scripts: `last_summary()` says what the last run did."""

from .framework.job import last_summary

__all__ = ("last_summary",)
