# SPDX-License-Identifier: GPL-3.0-or-later
"""Color ramps for values: one from low to high, one from negative over zero to positive."""

import numpy as np


def _linear(srgb: list[tuple[int, int, int]]) -> np.ndarray:
    value = np.array(srgb) / 255.0
    return np.where(value <= 0.04045, value / 12.92, ((value + 0.055) / 1.055) ** 2.4)


# Viridis (matplotlib, CC0): even steps look even, also in gray and to the color-blind.
SEQUENTIAL = _linear(
    [
        (68, 1, 84),
        (72, 40, 120),
        (62, 74, 137),
        (49, 104, 142),
        (38, 130, 142),
        (31, 158, 137),
        (53, 183, 121),
        (110, 206, 88),
        (181, 222, 43),
        (253, 231, 37),
    ]
)
"""Linear colors (10, 3) from low to high, evenly spaced."""
DIVERGING = _linear([(24, 56, 140), (96, 152, 214), (242, 242, 238), (228, 140, 92), (150, 22, 34)])
"""Linear colors (5, 3) from negative to positive, evenly spaced, zero in the middle."""


def colors_at(ramp: np.ndarray, places: np.ndarray) -> np.ndarray:
    """Linear colors (n, 4) with alpha 1 at places (n,) from 0 to 1 on a ramp (k, 3)."""
    stops = np.linspace(0.0, 1.0, len(ramp))
    channels = [np.interp(places, stops, channel) for channel in ramp.T] + [np.ones(len(places))]
    return np.stack(channels, axis=1)


def value_range(values: list[np.ndarray], signed: bool) -> tuple[float, float]:
    """The least and the greatest finite value; symmetric about zero if `signed`; 0 to 1 if there is none."""
    finite = np.concatenate([array[np.isfinite(array)] for array in values] or [np.empty(0)])
    if len(finite) == 0:
        return 0.0, 1.0
    low, high = float(finite.min()), float(finite.max())
    if signed:
        high = max(-low, high)
        low = -high
    return low, high
