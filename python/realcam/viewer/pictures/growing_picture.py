"""State of a progressively refined picture."""

from __future__ import annotations

import math
import time
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial

import numpy as np
from numpy.typing import NDArray

from ..._core import Camera, RenderSettings, effects
from .noise_measurement import NoiseMeasurement
from .pace import Size
from .picture_request import Costs, Frame, PictureRequest

# Effects omitted in previews. With few samples, spectral effects give colour noise that exceeds the effect.
_NOT_IN_PREVIEWS = {effect.name for effect in effects() if effect.has_wavelengths or not effect.shows_in_previews}

# Samples from which the remaining time is forecast: the demo's was 100 % too long from 3 samples, 25 % from 4.
_MIN_FORECAST_SAMPLES = 4

Arrays = tuple[NDArray[np.float32], NDArray[np.float32]]  # exposure and depth


@dataclass
class GrowingPicture:
    """State of a progressively refined picture; a PictureTaker adds samples."""

    request: PictureRequest
    serial: int  #: of the request
    begun: float  #: time.perf_counter() of the request
    size: Size  #: current resolution, which grows to full_size
    samples: int = 0  #: per pixel, at this resolution
    spent_s: float = 0.0  #: time spent on these samples
    steps: deque[tuple[int, float]] = field(default_factory=lambda: deque(maxlen=8))
    #: samples and seconds of the last refinements; more than four, because every fourth one may include denoising
    exposure_time_s: float = 0.0  #: with which the samples were rendered
    is_final: bool = False  #: refinement is complete
    refine_after: float = 0.0  #: time.perf_counter() before which refinement must not begin
    is_cancelled: bool = False  #: the picture was cancelled, and its samples are lost
    noise_codes: float | None = None  #: RMS noise in 8-bit codes; None: not known yet
    noise_tiles: list[list[float]] | None = None  #: RMS noise of tiles of the picture, rows from the top
    costs: Costs | None = None
    noise: NoiseMeasurement = field(default_factory=NoiseMeasurement)
    stored_arrays: Arrays | None = None  #: arrays of the last frame, stored if the next one is slow
    denoised_lx: NDArray[np.float32] | None = None  #: denoised illuminance, possibly at a lower resolution
    denoised_size: Size = (0, 0)  #: size of the picture when it was denoised
    denoised_serial: int = 0  #: serial of the last frame that showed the denoised picture

    def can_be_developed_for(self, request: PictureRequest) -> bool:
        """True if its samples are available and can be developed for a request."""
        return not self.is_cancelled and self.request.is_same_picture(request)

    @property
    def full_size(self) -> Size:
        """The full resolution."""
        return self.request.camera.film.resolution

    def settings(self) -> RenderSettings:
        """Render settings; below the full resolution, without effects that are smaller than noise or pixels."""
        settings = self.request.settings
        if self.size == self.full_size:
            return settings
        return settings.with_(
            effects=[effect for effect in settings.effects if effect.partition("=")[0] not in _NOT_IN_PREVIEWS]
        )

    def camera(self, metered_s: float) -> Camera:
        """The camera at the current resolution. metered_s: exposure time under automatic exposure."""
        camera = self.request.camera
        film = camera.film.replace(resolution=self.size)
        time_s = metered_s if self.request.is_automatic else camera.exposure_time_s
        return camera.replace(film=film, exposure_time_s=time_s)

    def update_noise(self, exposure_time_s: float) -> None:
        """Sets noise_codes and noise_tiles to the noise of the picture developed with this exposure time."""
        development = exposure_time_s, self.request.camera.iso, self.request.tone
        self.noise_codes = self.noise.codes(*development)
        self.noise_tiles = self.noise.tiles(*development)

    def expected_samples(self) -> float:
        """Samples needed for the requested noise, extrapolated from the last measurement; inf if unknown."""
        goal = self.request.noise_codes
        return self.noise.samples * (self.noise_codes / goal) ** 2 if self.noise_codes and goal > 0 else math.inf

    def left_s(self) -> float | None:
        """Estimated time until the picture is good enough, in seconds; None if there are too few samples."""
        if not self.steps or self.noise_codes is None or self.noise.samples < _MIN_FORECAST_SAMPLES:
            return None
        samples, seconds = map(sum, zip(*self.steps, strict=True))
        return max(0.0, min(self.expected_samples(), self.request.max_spp) - self.samples) * seconds / samples

    def final_noise_codes(self) -> float | None:
        """Forecast of the final noise, which exceeds the requested noise if that needs more than max_spp samples."""
        if self.noise_codes is None:
            return None
        return self.noise_codes * math.sqrt(self.noise.samples / min(self.expected_samples(), self.request.max_spp))

    def wants_measurement(self) -> bool:
        """True if the number of samples has doubled since the last measurement, or has reached the expected number."""
        return self.noise.is_doubled(self.samples) or self.samples >= self.expected_samples()

    def is_good_enough(self) -> bool:
        """True if the picture has at most the requested noise, or the maximum number of samples."""
        is_below_goal = self.noise_codes is not None and self.noise_codes <= self.request.noise_codes
        return is_below_goal or self.samples >= self.request.max_spp

    def frame_of(self, codes: NDArray[np.uint8], exposure_time_s: float, is_denoised: bool) -> Callable[..., Frame]:
        """Returns a function that makes the Frame of the current state from jpeg and jpeg_quality."""
        return partial(
            Frame,
            serial=self.serial,
            width=codes.shape[1],
            height=codes.shape[0],
            whole_width=self.full_size[0],
            whole_height=self.full_size[1],
            samples=self.samples,
            is_preview=codes.shape[1::-1] != self.full_size,
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
