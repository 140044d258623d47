"""How noisy a picture still is, from its own samples."""

from __future__ import annotations

import math
from collections import deque

import numpy as np
from numpy.typing import NDArray

from .._core import develop

_TILES = 16
_ROUNDING = 1 / 6  # variance of the difference of two 8-bit codes that are rounded


class NoiseMeasurement:
    """Compares the newest picture with an earlier one, which has at most about half of its samples."""

    def __init__(self) -> None:
        # Samples and illuminance (lx): what the exposure is has no say in it.
        self._doublings: deque[tuple[int, NDArray[np.float32]]] = deque(maxlen=2)
        self._newest: tuple[int, NDArray[np.float32]] | None = None

    @property
    def samples(self) -> int:
        """Of the newest picture."""
        return self._newest[0] if self._newest else 0

    def is_doubled(self, samples: int) -> bool:
        """Whether there are twice as many as at the last doubling."""
        return not self._doublings or samples >= 2 * self._doublings[-1][0]

    def add(self, samples: int, illuminance_lx: NDArray[np.float32]) -> None:
        """illuminance_lx: (height, width, 3), the mean of all samples."""
        self._newest = samples, illuminance_lx
        if self.is_doubled(samples):
            self._doublings.append(self._newest)

    def codes(self, exposure_time_s: float, iso: float, tone: str) -> float | None:
        """Root mean square in 8-bit codes of the picture as it is developed; None where too few samples are there.

        The variance of the mean of n samples is s^2 / n, and that of the difference between the means of the first m
        and of all n of them s^2 (1/m - 1/n). So it is n/m - 1 times the variance of the later mean. A longer exposure
        shows more noise.
        """
        squares = self._squares(exposure_time_s, iso, tone)
        return None if squares is None else math.sqrt(max(0.0, float(np.mean(squares))))

    def tiles(self, exposure_time_s: float, iso: float, tone: str) -> list[list[float]] | None:
        """The same of each of _TILES x _TILES parts of the picture, or of its pixels where there are fewer."""
        squares = self._squares(exposure_time_s, iso, tone)
        if squares is None:
            return None
        means = squares.mean(axis=2)
        for axis, length in enumerate(means.shape):
            starts = np.unique(np.linspace(0, length, min(_TILES, length), endpoint=False).astype(int))
            counts = np.diff([*starts, length])
            means = np.add.reduceat(means, starts, axis=axis) / np.expand_dims(counts, 1 - axis)
        rows: list[list[float]] = np.sqrt(np.maximum(0, means)).round(1).tolist()
        return rows

    def _squares(self, exposure_time_s: float, iso: float, tone: str) -> NDArray[np.float32] | None:
        """Estimates of the variance, (height, width, 3), some of which are below 0."""
        if self._newest is None or len(self._doublings) < 2:
            return None
        (samples, before), (all_samples, after) = self._doublings[0], self._newest
        codes = [
            develop(illuminance * np.float32(exposure_time_s), iso, tone).astype(np.float32)
            for illuminance in (before, after)
        ]
        squares: NDArray[np.float32] = ((codes[1] - codes[0]) ** 2 - _ROUNDING) * (samples / (all_samples - samples))
        return squares
