"""Frames without noise."""

from __future__ import annotations

import math
import statistics
import time
from collections import deque
from collections.abc import Callable
from functools import cache

import numpy as np
from numpy.typing import NDArray

from .._core import Cancelled, RealcamError
from ..denoiser import GUIDES, opened, without_noise
from ..image import Image
from .pace import Size

_MOST_S = 0.05  # which the first frame of a change may take to be denoised, so that 10 of them fit into a second
_SHARE = 0.25  # of the time, at most: the rest is for samples


@cache
def why_missing(device: str) -> str:
    """Why there is no denoiser, and what to install; empty: there is one."""
    try:
        opened(device)
    except RealcamError as error:
        return str(error)
    return ""


class PreviewDenoiser:
    """For one thread. device: as Image.denoised has it."""

    def __init__(self, device: str) -> None:
        self._core = opened(device)
        self._rates: deque[float] = deque([1.5e6], maxlen=3)  # pixels a second
        self._began = self._ended = 0.0

    @property
    def is_due(self) -> bool:
        """Whether so much time has gone by since the last picture that denoising stays a small share of it."""
        now = time.perf_counter()
        return (self._ended - self._began) / max(now - self._began, 1e-9) <= _SHARE

    def denoised(
        self, image: Image, *, is_hurried: bool = False, is_wanted: Callable[[], bool] = lambda: True
    ) -> NDArray[np.float32]:
        """(h, w, 3) exposure without noise. image: with GUIDES. is_hurried: of fewer pixels where all take too long.
        Raises Cancelled where is_wanted, which is asked meanwhile, returns False."""
        if not is_wanted():
            raise Cancelled("another picture is wanted")
        self._began = time.perf_counter()
        height, width = image.depth.shape
        size = self._affordable_size((width, height)) if is_hurried else (width, height)
        exposure, *guides = (shrunk(array, size) for array in (image.pixels, *map(image.layers.__getitem__, GUIDES)))
        begin = time.perf_counter()
        result = without_noise(self._core, exposure, *guides, fast=True, progress=lambda _: is_wanted())
        self._ended = time.perf_counter()
        self._rates.append(math.prod(size) / (self._ended - begin))
        return result

    def _affordable_size(self, whole: Size) -> Size:
        """Halves and thirds of the width, because each size is prepared anew."""
        for divisor in (1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 8.0):
            size = max(1, round(whole[0] / divisor)), max(1, round(whole[1] / divisor))
            if math.prod(size) <= _MOST_S * statistics.median(self._rates):
                break
        return size


def shrunk(array: NDArray[np.float32], size: Size) -> NDArray[np.float32]:
    """The means of the pixels (H, W, 3) that fall into each of size = (w, h) larger ones."""
    for axis, length in enumerate(size[::-1]):
        if array.shape[axis] == length:
            continue
        starts = np.linspace(0, array.shape[axis], length, endpoint=False).astype(int)
        counts = np.diff([*starts, array.shape[axis]]).astype(np.float32)
        array = np.add.reduceat(array, starts, axis=axis)
        array /= counts.reshape(-1, *(1,) * (2 - axis))
    return array
