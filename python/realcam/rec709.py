"""Colours of Rec. 709: their luminance, and the encoding of sRGB (IEC 61966-2-1)."""

from __future__ import annotations

from typing import Any

import numpy as np

LUMINANCE = np.array([0.2126, 0.7152, 0.0722])  # weights of linear R, G and B


def srgb_of_linear(values: Any) -> Any:
    """Encodes an array of linear values from 0 to 1, in its own precision."""
    return np.where(values <= 0.0031308, 12.92 * values, 1.055 * np.maximum(values, 0.0031308) ** (1 / 2.4) - 0.055)


def linear_of_srgb(values: Any) -> Any:
    """Decodes an array of sRGB values from 0 to 1, in its own precision."""
    return np.where(values <= 0.04045, values / 12.92, ((np.maximum(values, 0) + 0.055) / 1.055) ** 2.4)
