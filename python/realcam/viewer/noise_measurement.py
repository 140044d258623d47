"""How noisy a picture still is, from its own samples."""

from __future__ import annotations

import math
from collections import deque

import numpy as np
from numpy.typing import NDArray

from .._core import develop

_ROUNDING = 1 / 6  # variance of the difference of two 8-bit codes that are rounded


class NoiseMeasurement:
    """Keeps two pictures, of which the second has the samples of the first and as many more."""

    def __init__(self) -> None:
        # Samples and illuminance (lx): what the exposure is has no say in it.
        self._pictures: deque[tuple[int, NDArray[np.float32]]] = deque(maxlen=2)

    def is_due(self, samples: int) -> bool:
        """Whether there are twice as many as the last picture had."""
        return not self._pictures or samples >= 2 * self._pictures[-1][0]

    def add(self, samples: int, illuminance_lx: NDArray[np.float32]) -> None:
        """illuminance_lx: (height, width, 3), the mean of all samples."""
        self._pictures.append((samples, illuminance_lx))

    def codes(self, exposure_time_s: float, iso: float, tone: str) -> float | None:
        """Root mean square in 8-bit codes of the picture as it is developed; None where too few samples are there.

        The variance of the mean of n samples is s^2 / n, and that of the difference between the means of the first m
        and of all n of them s^2 (1/m - 1/n). So it is n/m - 1 times the variance of the later mean. A longer exposure
        shows more noise.
        """
        if len(self._pictures) < 2:
            return None
        (samples, before), (all_samples, after) = self._pictures
        codes = [
            develop(illuminance * np.float32(exposure_time_s), iso, tone).astype(np.float32)
            for illuminance in (before, after)
        ]
        variance = max(0.0, float(np.mean((codes[1] - codes[0]) ** 2)) - _ROUNDING)
        return math.sqrt(variance * samples / (all_samples - samples))
