"""Takes and develops the samples of a picture that grows."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from .._core import Camera, LiveFrame, develop
from ..denoiser import GUIDES
from ..image import Image
from ..live_view import LiveView
from .growing_picture import Arrays, GrowingPicture
from .light_meter import metered_exposure_lx_s, middle_grey_lx_s
from .pace import Pace
from .picture_request import Costs, PictureRequest
from .preview_denoiser import PreviewDenoiser

_FIRST_FRAME_S = 0.1  # which the first frame of a change may take, denoised, so that 10 of them fit into a second
_FEW_PIXELS = 50_000  # are developed here sooner than one more sample of them is taken


class PictureTaker:
    """Works on one thread; what it has metered stays from picture to picture.

    wait_for: called with a frame that is under way while the one before is kept, and returns when it is ready.
    is_wanted: whether the picture is still wanted whose noise is taken away.
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
        """Without samples yet."""
        self._metered_s = self._metered_s or request.camera.exposure_time_s
        return GrowingPicture(request, serial, begun, self.pace.preview_size(request.camera.film.resolution))

    def with_other_settings(self, picture: GrowingPicture, request: PictureRequest, serial: int) -> GrowingPicture:
        """The same view with other settings, as fine as the picture that is shown, whose samples it has until its own
        first ones come."""
        new = replace(self.new_picture(request, serial, time.perf_counter()), size=picture.size)
        new.kept, new.exposure_time_s = self.arrays(picture), picture.exposure_time_s
        new.denoised_lx = picture.denoised_lx
        return new

    def camera(self, picture: GrowingPicture) -> Camera:
        return picture.camera(self._metered_s)

    def shoot(self, picture: GrowingPicture, spp: int) -> NDArray[np.uint8]:
        """Takes samples; all that are there, as they are wanted now."""
        request, camera = picture.request, self.camera(picture)
        start = time.perf_counter()
        frame = self._live.shoot(camera, picture.settings(), spp=spp, tone=request.tone)
        if picture.kept:
            self._wait_for(frame, picture)
        codes = frame.codes
        seconds = max(time.perf_counter() - start, 1e-6)
        self.pace.took(spp * math.prod(picture.size), seconds, is_first=picture.samples == 0)
        picture.spent_s += seconds
        picture.samples, picture.exposure_time_s = frame.samples, camera.exposure_time_s
        picture.kept = self._live_arrays() if self.pace.was_slow(seconds) else None
        is_as_wanted = picture.request is request  # another exposure may have been set while this frame was taken
        return codes if is_as_wanted else self._developed_here(picture)

    def keep(self, picture: GrowingPicture) -> None:
        """Keeps the last frame, where the next one is slow."""
        picture.kept = self._live_arrays()

    def meter(self, picture: GrowingPicture) -> bool:
        """Sets the exposure time by the light of the picture. Whether it has changed so that it is seen."""
        exposure, _ = self.arrays(picture)
        mean = metered_exposure_lx_s(exposure)
        if not (mean > 0 and math.isfinite(mean)):
            return False
        before = picture.exposure_time_s
        wanted = middle_grey_lx_s(picture.request.camera.iso, picture.request.compensation_ev)
        self._metered_s = min(max(before * wanted / mean, 1e-6), 1e4)
        return abs(math.log2(self._metered_s / before)) > 0.02

    def developed(self, picture: GrowingPicture) -> NDArray[np.uint8]:
        """The samples that are there with another exposure."""
        if not picture.kept and math.prod(picture.size) > _FEW_PIXELS:
            return self.shoot(picture, 1)  # the device takes a sample and develops in less time
        return self._developed_here(picture)

    def without_noise(
        self, picture: GrowingPicture, *, is_free: bool, is_hurried: bool = False
    ) -> NDArray[np.uint8] | None:
        """The samples that are there, denoised. is_free: no frame is under way, whose end this would have to wait for.
        is_hurried: only if it is quick, as for the first frame of a change.

        Returns None if there is nothing that a frame has not shown, or no time for it. Raises Cancelled if another
        picture is wanted.
        """
        is_new = picture.denoised_of != picture.size
        is_quick = not is_hurried or self._denoiser.foreseen_s(picture.size) < _FIRST_FRAME_S - picture.spent_s
        if is_free and is_quick and (is_new or self._denoiser.is_due):
            # The first frame of a change is shown, whatever is wanted by then.
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
        picture.denoised_of = picture.size

    @cached_property
    def _denoiser(self) -> PreviewDenoiser:
        return PreviewDenoiser(self._device)

    def measure_noise(self, picture: GrowingPicture) -> None:
        """Where it is due; and whether the picture is good enough with it."""
        if picture.wants_measurement():
            exposure, _ = self.arrays(picture)
            picture.noise.add(picture.samples, exposure / np.float32(picture.exposure_time_s))
            picture.tell_noise(self.camera(picture).exposure_time_s)
            if picture.noise_codes is not None:
                picture.costs = Costs.of(self._live.image().stats, picture.spent_s)
        picture.is_final = picture.is_good_enough()

    def image(self, picture: GrowingPicture, *, is_denoised: bool) -> Image:
        """All pixels, with the exposure time that is wanted now. is_denoised: as denoised last. Raises Cancelled if
        another picture is wanted."""
        image, camera = self._live.image(), self.camera(picture)
        if is_denoised:
            if picture.denoised_of != picture.size:
                self._denoise(picture, self._is_wanted)
            assert picture.denoised_lx is not None
            pixels = picture.denoised_lx * np.float32(camera.exposure_time_s)
            return replace(image, pixels=pixels, camera=camera, denoiser=self._denoiser.name)
        ratio = np.float32(camera.exposure_time_s / image.camera.exposure_time_s)
        return replace(image, pixels=image.pixels * ratio, camera=camera)

    def arrays(self, picture: GrowingPicture) -> Arrays:
        return picture.kept or self._live_arrays()

    def _developed_here(self, picture: GrowingPicture) -> NDArray[np.uint8]:
        exposure, _ = self.arrays(picture)
        ratio = self.camera(picture).exposure_time_s / picture.exposure_time_s
        return develop(exposure * np.float32(ratio), picture.request.camera.iso, picture.request.tone)

    def _live_arrays(self) -> Arrays:
        exposure, depth = self._live.picture()
        return np.asarray(exposure), np.asarray(depth)
