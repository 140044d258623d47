"""8-bit sRGB codes for benchmarks."""

from __future__ import annotations

import numpy as np


def srgb_codes(linear: np.ndarray) -> np.ndarray:
    """8-bit codes of linear values, 1 being white, without rounding; values above 1 are clipped."""
    linear = np.clip(linear, 0, 1)
    return 255 * np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
