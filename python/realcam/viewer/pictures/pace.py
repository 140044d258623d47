"""Adaptive resolution and sample count of the next frame, from the times of previous frames."""

from __future__ import annotations

import math
import statistics
from collections import deque
from itertools import pairwise

_PREVIEW_S = 0.032  # target time of the first frame after a change: 25 frames per second
_LEAST_PREVIEW = 240 * 160  # minimum number of its pixels, unless it then takes longer than _MAX_PREVIEW_S
_MAX_PREVIEW_S = 0.09  # 10 frames per second
_QUICK_S = 0.008  # time limit for more than one sample in a first frame, on a GPU: keeps 60 frames per second
_REFINING_S = 0.040  # target time of a refining frame of more than one sample
_MAX_REFINING_S = 1.0  # limit for a frame that adds at most an eighth of the samples, whose effect is hardly visible
_SLOW_S = 0.050  # during longer frames, requests that need no new samples are served concurrently
_MAX_SPP = 64  # per frame, so that refinement is visible even on a fast GPU
_DIVISORS = (1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 8.0, 12.0, 16.0)  # of the resolution: few, as each size needs preparation

Size = tuple[int, int]


class Pace:
    """Median sample rate of several frames, so that a single slow frame does not reduce the resolution.

    First frames of a picture have their own rate, because their time includes the preparation of the lens.
    """

    def __init__(self) -> None:
        self._first_rates: deque[float] = deque([1e6], maxlen=5)
        self._rates: deque[float] = deque([1e6], maxlen=5)

    def record(self, samples: int, seconds: float, *, is_first: bool) -> None:
        """Records a frame. samples: total number over all pixels."""
        (self._first_rates if is_first else self._rates).append(samples / seconds)

    def preview_size(self, full_size: Size) -> Size:
        """Size in pixels of the first frame of a picture."""
        rate = statistics.median(self._first_rates)
        sizes = [(max(1, round(full_size[0] / d)), max(1, round(full_size[1] / d))) for d in _DIVISORS]
        for size, next_size in pairwise(sizes):
            seconds = math.prod(size) / rate
            if seconds <= _PREVIEW_S or (math.prod(next_size) < _LEAST_PREVIEW and seconds <= _MAX_PREVIEW_S):
                return size
        return sizes[-1]

    def first_spp(self, size: Size) -> int:
        """Samples per pixel of the first frame of a picture."""
        return self._affordable_spp(_QUICK_S * statistics.median(self._first_rates), size)

    def next_size(self, size: Size, full_size: Size) -> Size:
        """Next size of a picture below its full resolution: the full one if it is fast or close enough, else twice as
        large."""
        coarse = (min(2 * size[0], full_size[0]), min(2 * size[1], full_size[1]))
        is_nearly_full = coarse[0] > 0.6 * full_size[0]
        return full_size if is_nearly_full or self._seconds(1, full_size) < 8 * _PREVIEW_S else coarse

    def refining_spp(self, size: Size, samples: int) -> int:
        """Samples per pixel of the next frame. samples: number per pixel so far. A few large frames have less overhead
        than many small ones."""
        rate = statistics.median(self._rates)
        quick, slow = (self._affordable_spp(seconds * rate, size) for seconds in (_REFINING_S, _MAX_REFINING_S))
        return max(quick, min(slow, samples // 8))

    def is_slow(self, spp: int, size: Size) -> bool:
        """True if a refining frame is expected to keep the user waiting."""
        return self._seconds(spp, size) > _SLOW_S

    def was_slow(self, seconds: float) -> bool:
        """True if a frame of this duration kept the user waiting."""
        return seconds > _SLOW_S

    def _seconds(self, spp: int, size: Size) -> float:
        """Expected time of a frame that is not the first of a picture."""
        return spp * math.prod(size) / statistics.median(self._rates)

    def _affordable_spp(self, samples: float, size: Size) -> int:
        """Samples per pixel of a frame with this total number of samples, within 1 to _MAX_SPP."""
        return max(1, min(_MAX_SPP, int(samples / math.prod(size))))
