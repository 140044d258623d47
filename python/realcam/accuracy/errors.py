"""Perceived differences of pictures."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..image import Image
from ..rec709 import srgb_of_linear

Codes = NDArray[np.float64]


def codes(image: Image) -> Codes:
    """Returns the sRGB values of a picture developed with the linear tone curve: (H, W, 3), 0 to 255, not rounded."""
    linear = np.clip(0.018 * image.camera.iso * image.pixels.astype(np.float64), 0, 1)
    encoded: Codes = 255 * srgb_of_linear(linear)
    return encoded


def mean_square(a: Codes, b: Codes) -> float:
    """Returns the mean square of the differences of two pictures, in codes^2."""
    return float(np.mean((a - b) ** 2))


def flip(reference: Codes, picture: Codes) -> float | None:
    """Returns the mean FLIP error (Andersson et al. 2020), 0 to 1; None without the package flip-evaluator."""
    try:
        import flip_evaluator
    except ImportError:
        return None
    pictures = [(codes / 255).astype(np.float32) for codes in (reference, picture)]
    return float(flip_evaluator.evaluate(*pictures, "LDR")[1])
