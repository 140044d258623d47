"""Frames without noise."""

from __future__ import annotations

import math
import statistics
import time
from collections import deque
from collections.abc import Callable
from dataclasses import replace
from functools import cache

from .._core import Cancelled, RealcamError
from ..denoiser import GUIDES, opened, without_noise
from ..image import Image
from .pace import Size

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
        self._rates: deque[float] = deque([1.5e6], maxlen=5)  # pixels a second
        self._began = self._ended = 0.0

    @property
    def name(self) -> str:
        """With its version, as Image.denoiser has it."""
        return self._core.name

    @property
    def is_due(self) -> bool:
        """True if so much time has gone by since the last picture that denoising stays a small share of it."""
        now = time.perf_counter()
        return (self._ended - self._began) / max(now - self._began, 1e-9) <= _SHARE

    def foreseen_s(self, size: Size) -> float:
        """The time that a picture of so many pixels takes, its guides included."""
        return math.prod(size) / statistics.median(self._rates)

    def denoised(self, take: Callable[[], Image], is_wanted: Callable[[], bool] = lambda: True) -> Image:
        """The image that take returns, with GUIDES, without its noise. Raises Cancelled if is_wanted, which is called
        meanwhile, returns False."""
        if not is_wanted():
            raise Cancelled("another picture is wanted")
        self._began = time.perf_counter()
        image = take()
        guides = (image.layers[name] for name in GUIDES)
        exposure = without_noise(self._core, image.pixels, *guides, fast=True, progress=lambda _: is_wanted())
        self._ended = time.perf_counter()
        self._rates.append(image.depth.size / (self._ended - self._began))
        return replace(image, pixels=exposure, denoiser=self.name, layers={})
