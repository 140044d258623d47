"""Renders, meters, denoises and develops a progressively refined picture."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ..._core import Camera, LiveFrame
from ...denoiser import GUIDES
from ...image import Image
from ...live_view import LiveView
from ...ocio import OcioView, develop
from .growing_picture import Arrays, GrowingPicture
from .light_meter import metered_exposure_lx_s, middle_grey_lx_s
from .pace import Pace
from .picture_request import Costs, PictureRequest
from .preview_denoiser import PreviewDenoiser

_FIRST_FRAME_S = 0.1  # limit for the first frame of a change with denoising: 10 frames per second
_FEW_PIXELS = 50_000  # up to this number, developing here is faster than one more sample on the device


class PictureTaker:
    """Adds samples to pictures, meters, denoises and develops them. For use on one thread.

    The metered exposure time is retained from picture to picture.
    wait_for: called with a slow frame in progress, while the previous one is kept; returns when the frame is ready.
    is_wanted: returns false to cancel denoising, because the picture is obsolete. device: of the denoiser.
    """

    def __init__(
        self,
        live: LiveView,
        wait_for: Callable[[LiveFrame, GrowingPicture], None],
        is_wanted: Callable[[], bool],
        device: str,
    ) -> None:
        self._live = live
        self._wait_for = wait_for
        self._is_wanted = is_wanted
        self._device = device
        self._metered_s = 0.0
        self.pace = Pace()

    def new_picture(self, request: PictureRequest, serial: int, begun: float) -> GrowingPicture:
        """Returns a picture without samples, at the resolution of a preview."""
        self._metered_s = self._metered_s or request.camera.exposure_time_s
        return GrowingPicture(request, serial, begun, self.pace.preview_size(request.camera.film.resolution))

    def with_other_settings(self, picture: GrowingPicture, request: PictureRequest, serial: int) -> GrowingPicture:
        """Returns a picture of the same view with other settings, at the resolution of the one shown, whose samples it
        uses until its own first ones are rendered."""
        new = replace(self.new_picture(request, serial, time.perf_counter()), size=picture.size)
        new.stored_arrays, new.exposure_time_s = self.arrays(picture), picture.exposure_time_s
        new.denoised_lx = picture.denoised_lx
        return new

    def camera(self, picture: GrowingPicture) -> Camera:
        """The camera at the picture's resolution, with the metered exposure time under automatic exposure."""
        return picture.camera(self._metered_s)

    def shoot(self, picture: GrowingPicture, spp: int) -> NDArray[np.uint8]:
        """Adds spp samples per pixel, and returns all samples developed with the current exposure, 8-bit."""
        request, camera = picture.request, self.camera(picture)
        start = time.perf_counter()
        is_developed_here = isinstance(request.tone, OcioView)
        tone = "film" if isinstance(request.tone, OcioView) else request.tone
        frame = self._live.shoot(camera, picture.settings(), spp=spp, tone=tone)
        if picture.stored_arrays:
            self._wait_for(frame, picture)
        codes = frame.codes
        seconds = max(time.perf_counter() - start, 1e-6)
        self.pace.record(spp * math.prod(picture.size), seconds, is_first=picture.samples == 0)
        picture.spent_s += seconds
        picture.samples, picture.exposure_time_s = frame.samples, camera.exposure_time_s
        picture.stored_arrays = self._live_arrays() if self.pace.was_slow(seconds) else None
        # The exposure may have been changed during this frame.
        is_outdated = picture.request is not request
        return self._developed_here(picture) if is_outdated or is_developed_here else codes

    def store_arrays(self, picture: GrowingPicture) -> None:
        """Stores the last frame, for use during a slow one."""
        picture.stored_arrays = self._live_arrays()

    def meter(self, picture: GrowingPicture) -> bool:
        """Meters the picture and sets the exposure time. Returns true if the change is visible."""
        exposure, _ = self.arrays(picture)
        mean = metered_exposure_lx_s(exposure)
        if not (mean > 0 and math.isfinite(mean)):
            return False
        previous_s = picture.exposure_time_s
        middle_grey = middle_grey_lx_s(picture.request.camera.iso, picture.request.compensation_ev)
        self._metered_s = min(max(previous_s * middle_grey / mean, 1e-6), 1e4)
        return abs(math.log2(self._metered_s / previous_s)) > 0.02

    def developed(self, picture: GrowingPicture) -> NDArray[np.uint8]:
        """Returns the existing samples developed with the current exposure."""
        is_view = isinstance(picture.request.tone, OcioView)
        if not picture.stored_arrays and not is_view and math.prod(picture.size) > _FEW_PIXELS:
            return self.shoot(picture, 1)  # the device takes a sample and develops in less time
        return self._developed_here(picture)

    def developed_denoised(
        self, picture: GrowingPicture, *, is_free: bool, is_hurried: bool = False
    ) -> NDArray[np.uint8] | None:
        """Denoises and develops the existing samples. is_free: true if no frame is in progress, for which denoising
        would have to wait. is_hurried: denoise only if it is fast enough for the first frame of a change.

        Returns None if there is nothing new to show or no time for it. Raises Cancelled if the picture is obsolete.
        """
        is_new = picture.denoised_size != picture.size
        is_quick = not is_hurried or self._denoiser.expected_s(picture.size) < _FIRST_FRAME_S - picture.spent_s
        if is_free and is_quick and (is_new or self._denoiser.is_due):
            # The first frame of a change is always shown, even if it is already obsolete.
            self._denoise(picture, (lambda: True) if is_hurried else self._is_wanted)
        elif picture.denoised_lx is None or picture.denoised_serial == picture.serial:
            return None
        assert picture.denoised_lx is not None
        picture.denoised_serial = picture.serial
        camera = self.camera(picture)
        return develop(picture.denoised_lx * np.float32(camera.exposure_time_s), camera.iso, picture.request.tone)

    def _denoise(self, picture: GrowingPicture, is_wanted: Callable[[], bool]) -> None:
        image = self._denoiser.denoised(lambda: self._live.image(GUIDES), is_wanted)
        picture.denoised_lx = image.pixels / np.float32(image.camera.exposure_time_s)
        picture.denoised_size = picture.size

    @cached_property
    def _denoiser(self) -> PreviewDenoiser:
        return PreviewDenoiser(self._device)

    def measure_noise(self, picture: GrowingPicture) -> None:
        """Measures the noise if it is due, and sets is_final if the picture is good enough."""
        if picture.wants_measurement():
            exposure, _ = self.arrays(picture)
            picture.noise.add(picture.samples, exposure / np.float32(picture.exposure_time_s))
            picture.update_noise(self.camera(picture).exposure_time_s)
            if picture.noise_codes is not None:
                picture.costs = Costs.of(self._live.image().stats, picture.spent_s)
        picture.is_final = picture.is_good_enough()

    def image(self, picture: GrowingPicture, *, is_denoised: bool) -> Image:
        """Returns the picture at its current resolution with the current exposure time. is_denoised: uses the last
        denoised picture. Raises Cancelled if the picture is obsolete."""
        image, camera = self._live.image(), self.camera(picture)
        if is_denoised:
            if picture.denoised_size != picture.size:
                self._denoise(picture, self._is_wanted)
            assert picture.denoised_lx is not None
            pixels = picture.denoised_lx * np.float32(camera.exposure_time_s)
            return replace(image, pixels=pixels, camera=camera, denoiser=self._denoiser.name)
        ratio = np.float32(camera.exposure_time_s / image.camera.exposure_time_s)
        return replace(image, pixels=image.pixels * ratio, camera=camera)

    def arrays(self, picture: GrowingPicture) -> Arrays:
        """Exposure (lx s) and depth (m) of the picture's samples."""
        return picture.stored_arrays or self._live_arrays()

    def _developed_here(self, picture: GrowingPicture) -> NDArray[np.uint8]:
        """Develops the existing samples on the CPU."""
        exposure, _ = self.arrays(picture)
        ratio = self.camera(picture).exposure_time_s / picture.exposure_time_s
        return develop(exposure * np.float32(ratio), picture.request.camera.iso, picture.request.tone)

    def _live_arrays(self) -> Arrays:
        exposure, depth = self._live.picture()
        return np.asarray(exposure), np.asarray(depth)
