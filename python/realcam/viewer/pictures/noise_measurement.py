"""Noise estimate of a picture from its own samples."""

from __future__ import annotations

import math
from collections import deque

import numpy as np
from numpy.typing import NDArray

from ...ocio import OcioView, develop

_TILES = 16  # tiles of the picture along each side
_ROUNDING = 1 / 6  # variance of the difference of two rounded 8-bit codes


class NoiseMeasurement:
    """Compares the newest picture with an earlier one that has at most about half of its samples."""

    def __init__(self) -> None:
        # Samples and illuminance (lx), which does not depend on the exposure time.
        self._doublings: deque[tuple[int, NDArray[np.float32]]] = deque(maxlen=2)
        self._newest: tuple[int, NDArray[np.float32]] | None = None

    @property
    def samples(self) -> int:
        """Number of samples of the newest picture."""
        return self._newest[0] if self._newest else 0

    def is_doubled(self, samples: int) -> bool:
        """True if the number of samples has doubled since the last stored picture."""
        return not self._doublings or samples >= 2 * self._doublings[-1][0]

    def add(self, samples: int, illuminance_lx: NDArray[np.float32]) -> None:
        """Adds a picture. illuminance_lx: (height, width, 3), mean of all samples."""
        self._newest = samples, illuminance_lx
        if self.is_doubled(samples):
            self._doublings.append(self._newest)

    def codes(self, exposure_time_s: float, iso: float, tone: str | OcioView) -> float | None:
        """RMS noise of the developed picture in 8-bit codes; None if there are too few samples.

        The mean of n samples has the variance s^2 / n. The difference between the means of the first m and of all n
        samples has s^2 (1/m - 1/n), which is n/m - 1 times the variance of the mean of n. The noise in codes grows with
        the exposure time.
        """
        squares = self._squares(exposure_time_s, iso, tone)
        return None if squares is None else math.sqrt(max(0.0, float(np.mean(squares))))

    def tiles(self, exposure_time_s: float, iso: float, tone: str | OcioView) -> list[list[float]] | None:
        """RMS noise as from `codes` of each of _TILES x _TILES tiles of the picture, or of each pixel if it has
        fewer."""
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

    def _squares(self, exposure_time_s: float, iso: float, tone: str | OcioView) -> NDArray[np.float32] | None:
        """Estimates of the variance of each pixel in 8-bit codes, (height, width, 3); some are negative. None: too few
        samples."""
        if self._newest is None or len(self._doublings) < 2:
            return None
        (samples, earlier), (all_samples, newest) = self._doublings[0], self._newest
        codes = [
            develop(illuminance * np.float32(exposure_time_s), iso, tone).astype(np.float32)
            for illuminance in (earlier, newest)
        ]
        squares: NDArray[np.float32] = ((codes[1] - codes[0]) ** 2 - _ROUNDING) * (samples / (all_samples - samples))
        return squares
