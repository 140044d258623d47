"""Denoising of preview frames."""

from __future__ import annotations

import math
import statistics
import time
from collections import deque
from collections.abc import Callable
from dataclasses import replace
from functools import cache

from ..._core import Cancelled, RealcamError
from ...denoiser import GUIDES, opened, without_noise
from ...image import Image
from .pace import Size

_SHARE = 0.25  # largest fraction of time spent on denoising


@cache
def why_missing(device: str) -> str:
    """Reason why the denoiser is unavailable, and what to install; empty if it is available."""
    try:
        opened(device)
    except RealcamError as error:
        return str(error)
    return ""


class PreviewDenoiser:
    """Denoiser for use on one thread. device: as in Image.denoised."""

    def __init__(self, device: str) -> None:
        self._core = opened(device)
        self._rates: deque[float] = deque([1.5e6], maxlen=5)  # pixels per second
        self._began = self._ended = 0.0

    @property
    def name(self) -> str:
        """Name with version, as in Image.denoiser."""
        return self._core.name

    @property
    def is_due(self) -> bool:
        """True if enough time has passed since the last picture for denoising to stay below _SHARE of it."""
        now = time.perf_counter()
        return (self._ended - self._began) / max(now - self._began, 1e-9) <= _SHARE

    def expected_s(self, size: Size) -> float:
        """Expected time for a picture of this size, including its guide layers, in seconds."""
        return math.prod(size) / statistics.median(self._rates)

    def denoised(self, render: Callable[[], Image], is_wanted: Callable[[], bool] = lambda: True) -> Image:
        """Returns the denoised image. render: returns an image with the layers GUIDES. is_wanted: polled during the
        work. Raises Cancelled if it returns False."""
        if not is_wanted():
            raise Cancelled("another picture was requested")
        self._began = time.perf_counter()
        image = render()
        guides = (image.layers[name] for name in GUIDES)
        exposure = without_noise(self._core, image.pixels, *guides, fast=True, progress=lambda _: is_wanted())
        self._ended = time.perf_counter()
        self._rates.append(image.depth.size / (self._ended - self._began))
        return replace(image, pixels=exposure, denoiser=self.name, layers={})
