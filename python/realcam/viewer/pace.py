"""How many pixels and samples the next frame may have, by the time that the last ones took."""

from __future__ import annotations

import math
import statistics
from collections import deque
from itertools import pairwise

_PREVIEW_S = 0.032  # what the first frame of a change may take, so that 25 of them fit into a second
_LEAST_PREVIEW = 240 * 160  # pixels that it has, as long as it does not take more than this
_MOST_PREVIEW_S = 0.09  # so that 10 of them fit into a second
_QUICK_S = 0.008  # for so long it takes more than one sample, on a GPU: 60 frames a second remain
_REFINING_S = 0.040  # what a frame may take that only refines, as long as it is more than a sample
_MOST_REFINING_S = 1.0  # and one that adds no more than an eighth of the samples, of which little is seen
_SLOW_S = 0.050  # a frame that takes longer must not keep the user waiting for what needs no new samples
_MOST_SPP = 64  # of one frame, so that a fast GPU shows how a picture grows
_DIVISORS = (1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 8.0, 12.0, 16.0)  # of the width: few, because each size is prepared anew

Size = tuple[int, int]


class Pace:
    """Remembers samples a second of several frames, so that one that was slow for another reason makes nothing coarse.

    Frames that begin a picture have rates of their own, because the lens is prepared in their time.
    """

    def __init__(self) -> None:
        self._first_rates: deque[float] = deque([1e6], maxlen=5)
        self._rates: deque[float] = deque([1e6], maxlen=5)

    def took(self, samples: int, seconds: float, *, is_first: bool) -> None:
        """A frame has taken so many samples of all its pixels together in that time."""
        (self._first_rates if is_first else self._rates).append(samples / seconds)

    def preview_size(self, whole: Size) -> Size:
        """Pixels of the first frame of a picture."""
        rate = statistics.median(self._first_rates)
        sizes = [(max(1, round(whole[0] / d)), max(1, round(whole[1] / d))) for d in _DIVISORS]
        for size, next_size in pairwise(sizes):
            seconds = math.prod(size) / rate
            if seconds <= _PREVIEW_S or (math.prod(next_size) < _LEAST_PREVIEW and seconds <= _MOST_PREVIEW_S):
                return size
        return sizes[-1]

    def first_spp(self, size: Size) -> int:
        return self._affordable_spp(_QUICK_S * statistics.median(self._first_rates), size)

    def next_size(self, size: Size, whole: Size) -> Size:
        """The next size of a picture that has begun with fewer pixels, in as few steps as the whole resolution
        takes."""
        coarse = (min(2 * size[0], whole[0]), min(2 * size[1], whole[1]))
        is_nearly_whole = coarse[0] > 0.6 * whole[0]
        return whole if is_nearly_whole or self._seconds(1, whole) < 8 * _PREVIEW_S else coarse

    def refining_spp(self, size: Size, samples: int) -> int:
        """samples: of each pixel, which are there. Few large frames take less time than many small ones."""
        rate = statistics.median(self._rates)
        quick, slow = (self._affordable_spp(seconds * rate, size) for seconds in (_REFINING_S, _MOST_REFINING_S))
        return max(quick, min(slow, samples // 8))

    def is_slow(self, spp: int, size: Size) -> bool:
        """Whether a frame that refines is foreseen to keep the user waiting."""
        return self._seconds(spp, size) > _SLOW_S

    def was_slow(self, seconds: float) -> bool:
        return seconds > _SLOW_S

    def _seconds(self, spp: int, size: Size) -> float:
        return spp * math.prod(size) / statistics.median(self._rates)

    def _affordable_spp(self, samples: float, size: Size) -> int:
        return max(1, min(_MOST_SPP, int(samples / math.prod(size))))
