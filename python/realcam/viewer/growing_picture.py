"""The picture that collects samples."""

from __future__ import annotations

import math
import time
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial

import numpy as np
from numpy.typing import NDArray

from .._core import Camera, RenderSettings, effects
from .noise_measurement import NoiseMeasurement
from .pace import Size
from .picture_request import Costs, Frame, PictureRequest

# Of few samples, those with wavelengths are coloured dots, which are larger than the effect.
_NOT_IN_PREVIEWS = {effect.name for effect in effects() if effect.has_wavelengths or not effect.shows_in_previews}

_TELLING_SAMPLES = 4  # of 3, the demo's time was twice too long; of 4, a quarter

Arrays = tuple[NDArray[np.float32], NDArray[np.float32]]  # exposure and depth


@dataclass
class GrowingPicture:
    """What is known of it; a PictureTaker adds samples."""

    request: PictureRequest
    serial: int
    begun: float
    size: Size
    samples: int = 0
    spent_s: float = 0.0  #: by these
    steps: deque[tuple[int, float]] = field(default_factory=lambda: deque(maxlen=8))
    #: samples and seconds of the last refinements, in which a picture is denoised at most every fourth time
    exposure_time_s: float = 0.0  #: with which the samples were developed last
    is_final: bool = False
    refines_from: float = 0.0  #: time.perf_counter()
    is_given_up: bool = False  #: and its samples with it
    noise_codes: float | None = None
    noise_tiles: list[list[float]] | None = None
    costs: Costs | None = None
    noise: NoiseMeasurement = field(default_factory=NoiseMeasurement)
    kept: Arrays | None = None  #: of the last frame, where the next one is slow
    denoised_lx: NDArray[np.float32] | None = None  #: illuminance without noise, perhaps of fewer pixels
    denoised_of: Size = (0, 0)  #: the pixels of the picture then
    denoised_serial: int = 0  #: of the last frame that showed it

    def can_be(self, request: PictureRequest) -> bool:
        """Whether its samples are there and serve a request."""
        return not self.is_given_up and self.request.is_same_picture(request)

    @property
    def whole(self) -> Size:
        """The resolution that is wanted in the end."""
        return self.request.camera.film.resolution

    def settings(self) -> RenderSettings:
        """What is smaller than its noise or than pixels is left out where these are fewer than wanted."""
        settings = self.request.settings
        if self.size == self.whole:
            return settings
        return settings.with_(
            effects=[effect for effect in settings.effects if effect.partition("=")[0] not in _NOT_IN_PREVIEWS]
        )

    def camera(self, metered_s: float) -> Camera:
        """With the pixels of now. metered_s: the exposure time where it follows the light."""
        camera = self.request.camera
        film = camera.film.replace(resolution=self.size)
        time_s = metered_s if self.request.is_automatic else camera.exposure_time_s
        return camera.replace(film=film, exposure_time_s=time_s)

    def tell_noise(self, exposure_time_s: float) -> None:
        developed = exposure_time_s, self.request.camera.iso, self.request.tone
        self.noise_codes = self.noise.codes(*developed)
        self.noise_tiles = self.noise.tiles(*developed)

    def expected_samples(self) -> float:
        """With which it has the noise that is asked for, by the last measurement."""
        goal = self.request.noise_codes
        return self.noise.samples * (self.noise_codes / goal) ** 2 if self.noise_codes and goal > 0 else math.inf

    def left_s(self) -> float | None:
        """The time until it is good enough, at its present pace; None if too few samples are there to tell."""
        if not self.steps or self.noise_codes is None or self.noise.samples < _TELLING_SAMPLES:
            return None
        samples, seconds = map(sum, zip(*self.steps, strict=True))
        return max(0.0, min(self.expected_samples(), self.request.max_spp) - self.samples) * seconds / samples

    def final_noise_codes(self) -> float | None:
        """The noise when nothing will be added, which is more than is asked for where that takes too many samples."""
        if self.noise_codes is None:
            return None
        return self.noise_codes * math.sqrt(self.noise.samples / min(self.expected_samples(), self.request.max_spp))

    def wants_measurement(self) -> bool:
        """Whether its samples have doubled, or are as many as are expected to be enough."""
        return self.noise.is_doubled(self.samples) or self.samples >= self.expected_samples()

    def is_good_enough(self) -> bool:
        is_quiet = self.noise_codes is not None and self.noise_codes <= self.request.noise_codes
        return is_quiet or self.samples >= self.request.max_spp

    def frame_of(self, codes: NDArray[np.uint8], exposure_time_s: float, is_denoised: bool) -> Callable[..., Frame]:
        """Makes the Frame that shows it as it stands, of jpeg and jpeg_quality."""
        return partial(
            Frame,
            serial=self.serial,
            width=codes.shape[1],
            height=codes.shape[0],
            whole_width=self.whole[0],
            whole_height=self.whole[1],
            samples=self.samples,
            is_preview=codes.shape[1::-1] != self.whole,
            is_final=self.is_final,
            noise_codes=self.noise_codes,
            noise_tiles=self.noise_tiles,
            seconds=time.perf_counter() - self.begun,
            exposure_time_s=exposure_time_s,
            costs=self.costs,
            is_denoised=is_denoised,
            left_s=self.left_s(),
            final_noise_codes=self.final_noise_codes(),
        )
