# SPDX-License-Identifier: GPL-3.0-or-later
"""A progress bar on standard error: tqdm's where it is installed, else a plain line."""

import importlib.util
import sys
from types import TracebackType
from typing import Self

PARTS = 1000


class ProgressBar:
    """A bar for one file, as a context manager; silent where standard error is not a terminal."""

    def __init__(self, title: str) -> None:
        """Make a bar with a title."""
        self._title = title
        self._shown = -1
        self._bar = None
        self._visible = sys.stderr.isatty()
        if self._visible and importlib.util.find_spec("tqdm") is not None:
            from tqdm import tqdm  # noqa: PLC0415

            self._bar = tqdm(
                total=PARTS, desc=title, bar_format="{desc}: {percentage:3.0f}% |{bar}| {elapsed}"
            )

    def show(self, fraction: float) -> None:
        """Show how much is done, 0 to 1."""
        parts = int(PARTS * fraction)
        if self._bar is not None:
            self._bar.update(parts - self._bar.n)
        elif self._visible and parts != self._shown:
            print(f"\r{self._title}: {100 * fraction:3.0f} %", end="", file=sys.stderr, flush=True)
        self._shown = parts

    def __enter__(self) -> Self:
        """Begin."""
        return self

    def __exit__(
        self, _kind: type[BaseException] | None, _error: BaseException | None, _trace: TracebackType | None
    ) -> None:
        """End the line."""
        if self._bar is not None:
            self._bar.close()
        elif self._visible:
            print(file=sys.stderr)
