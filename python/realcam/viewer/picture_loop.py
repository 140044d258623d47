"""A thread that photographs the newest request, first quickly and coarsely, then ever better, and then sleeps."""

from __future__ import annotations

import logging
import math
import threading
import time
from collections import deque
from collections.abc import Callable
from concurrent.futures import Future
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from .._core import Camera, Cancelled, InputError, LiveFrame, LiveView, RealcamError, Scene, develop
from ..image import Image, image_of
from .frame_encoder import FrameEncoder
from .light_meter import metered_exposure_lx_s, middle_grey_lx_s, point_at
from .noise_measurement import NoiseMeasurement
from .pace import Pace, Size
from .picture_request import Costs, Frame, PictureRequest, Point

T = TypeVar("T")
_log = logging.getLogger(__name__)

# After the first frame of a change, before it is refined: what is begun would be given up for the next change, of a
# movement above all.
_RESTING_S, _MOVING_S = 0.025, 0.15
_FEW_PIXELS = 50_000  # are developed here sooner than one more sample of them is taken

_Arrays = tuple[NDArray[np.float32], NDArray[np.float32]]  # exposure and depth


@dataclass
class _Growing:
    """The picture that collects samples."""

    request: PictureRequest
    serial: int
    begun: float
    size: Size
    samples: int = 0
    spent_s: float = 0.0  #: by these
    exposure_time_s: float = 0.0  #: with which the samples were developed last
    is_final: bool = False
    refines_from: float = 0.0  #: time.perf_counter()
    is_given_up: bool = False  #: and its samples with it
    noise_codes: float | None = None
    noise_tiles: list[list[float]] | None = None
    costs: Costs | None = None
    noise: NoiseMeasurement = field(default_factory=NoiseMeasurement)
    kept: _Arrays | None = None  #: of the last frame, where the next one is slow

    def can_be(self, request: PictureRequest) -> bool:
        """Whether its samples are there and serve a request."""
        return not self.is_given_up and self.request.is_same_picture(request)


@dataclass(frozen=True)
class _Pending:
    request: PictureRequest
    serial: int
    begun: float


@dataclass(frozen=True)
class _Question:
    ask: Callable[[], Any]
    answer: Future[Any]
    needs_samples: bool  #: and has to wait for the frame that is under way


class PictureLoop:
    """Photographs a scene for one window.

    on_frame and on_error (with the request's serial and a message) are called on threads of the loop. submit() may come
    as often as a mouse moves: every request that is begun gets its first frame, and of those that come meanwhile the
    newest is next.
    """

    def __init__(
        self,
        scene: Scene,
        on_frame: Callable[[Frame], None],
        on_error: Callable[[int, str], None],
        *,
        device: str = "auto",
        max_bounces: int = 1,
        seed: int = 0,
    ) -> None:
        self._live = LiveView(scene, device=device, seed=seed, max_bounces=max_bounces)
        self._seed = seed
        self._on_error = on_error
        self._wake = threading.Condition()
        self._pending: _Pending | None = None
        self._questions: deque[_Question] = deque()
        self._refines = False  # a frame is under way that a change may give up
        self._is_closed = False
        self._serial = 0
        self._picture: _Growing | None = None
        self._exposure_time_s = 0.0  # that was metered last
        self._begun = 0.0  # time.perf_counter() of the last request that began a picture
        self._pace = Pace()
        self._encoder = FrameEncoder(on_frame)
        self._thread = threading.Thread(target=self._run, name="realcam-picture", daemon=True)
        self._thread.start()

    def submit(self, request: PictureRequest) -> int:
        """Photographs it as soon as possible. Returns the serial that its frames will have."""
        with self._wake:
            self._serial += 1
            serial = self._serial
            self._pending = _Pending(request, serial, time.perf_counter())
            picture = self._picture
            self._wake.notify()
            if self._refines and picture and not picture.request.is_same_picture(request):
                picture.is_given_up = True
                self._live.cancel()  # while the lock holds the other thread in the frame that is meant
        return serial

    @property
    def jpeg_quality(self) -> int:
        return self._encoder.quality

    @jpeg_quality.setter
    def jpeg_quality(self, quality: int) -> None:
        self._encoder.quality = quality

    def image(self) -> Future[Image]:
        """The picture as it stands, at its whole resolution with all its samples."""
        return self._ask(self._image, True)

    def point(self, u: float, v: float) -> Future[Point]:
        """What is at u, v (0 to 1, from the upper left corner)."""
        return self._ask(lambda: self._point(u, v), False)

    def close(self) -> None:
        """Ends the thread, from any other."""
        with self._wake:
            self._is_closed = True
            self._wake.notify()
        self._live.cancel()
        self._thread.join()
        self._encoder.close()

    def _ask(self, question: Callable[[], T], needs_samples: bool) -> Future[T]:
        answer: Future[T] = Future()
        with self._wake:
            if self._is_closed:
                answer.set_exception(Cancelled("the window is closed"))
            else:
                self._questions.append(_Question(question, answer, needs_samples))
                self._wake.notify()
        return answer

    # From here on: on the loop's thread.

    def _run(self) -> None:
        while self._wait_for_work():
            for question in self._answerable():
                self._answer(question)
            with self._wake:
                pending, self._pending = self._pending, None
            try:
                if pending:
                    self._begin(pending)
                elif self._picture and not self._picture.is_final:
                    self._refine(self._picture)
            except Cancelled:
                # A newer request has given this frame up; where it came too late for that, it is taken once more.
                with self._wake:
                    self._pending = self._pending or pending
            except RealcamError as error:
                with self._wake:
                    is_given_up = pending is None and self._pending is not None
                if not is_given_up:  # a frame that was done when it was given up has lost its samples
                    self._fail(pending, str(error))
            except Exception:
                _log.exception("the picture could not be taken")
                self._fail(pending, "the picture could not be taken; the server's log says more")
        while self._questions:
            self._questions.popleft().answer.set_exception(Cancelled("the window is closed"))

    def _wait_for_work(self) -> bool:
        with self._wake:
            while not self._is_closed:
                if self._pending or self._questions:
                    return True
                if self._picture and not self._picture.is_final:
                    resting = self._picture.refines_from - time.perf_counter()
                    if resting <= 0:
                        return True
                    self._wake.wait(resting)
                else:
                    self._wake.wait()
        return False

    def _answerable(self) -> list[_Question]:
        """Takes the questions that can be answered now. Who asks means the picture that was wanted last."""
        with self._wake:
            now = [] if self._pending else list(self._questions)
            for question in now:
                self._questions.remove(question)
        return now

    def _answer(self, question: _Question) -> None:
        if not (question.answer.running() or question.answer.set_running_or_notify_cancel()):
            return
        try:
            question.answer.set_result(question.ask())
        except RealcamError as error:
            with self._wake:
                # The samples were given up for another picture, of which the question is asked again.
                if self._pending and not self._is_closed:
                    self._questions.append(question)
                    return
            question.answer.set_exception(error)
        except BaseException as error:
            question.answer.set_exception(error)

    def _fail(self, pending: _Pending | None, message: str) -> None:
        serial = pending.serial if pending else self._picture.serial if self._picture else 0
        self._picture = None
        if self._is_closed:
            return  # which has given up the samples that somebody wanted to look at
        self._on_error(serial, message)

    def _begin(self, pending: _Pending) -> None:
        request = pending.request
        if not self._exposure_time_s:
            self._exposure_time_s = request.camera.exposure_time_s
        picture = self._picture
        if picture and picture.samples and picture.can_be(request):
            self._develop_for(picture, pending)
            return
        size = self._pace.preview_size(request.camera.film.resolution)
        self._picture = picture = _Growing(request, pending.serial, pending.begun, size)
        codes = self._shoot(picture, self._pace.first_spp(size))
        is_moving = pending.begun - self._begun < _MOVING_S
        self._begun = pending.begun
        picture.refines_from = time.perf_counter() + (_MOVING_S if is_moving else _RESTING_S)
        if request.is_automatic and self._meter(picture):
            self._develop(picture)
        else:
            self._show(picture, codes)

    def _refine(self, picture: _Growing) -> None:
        """Once more of its samples, after as few steps as the whole resolution takes."""
        request = picture.request
        whole = request.camera.film.resolution
        is_new_size = picture.size != whole
        if is_new_size:
            picture.size = self._pace.next_size(picture.size, whole)
        missing = request.max_spp - (0 if is_new_size else picture.samples)
        spp = min(self._pace.refining_spp(picture.size), max(1, missing))
        if picture.kept is None and self._pace.is_slow(spp, picture.size):
            picture.kept = self._live_arrays()
        with self._wake:
            if self._pending:
                return
            self._refines = True
        if is_new_size:
            picture.samples, picture.spent_s = 0, 0.0
        try:
            codes = self._shoot(picture, spp)
        finally:
            with self._wake:
                self._refines = False
        if picture.size == whole:
            self._measure_noise(picture)
        if request.is_automatic and picture.samples <= 2 * spp and self._meter(picture):
            self._develop(picture)
        else:
            self._show(picture, codes)

    def _shoot(self, picture: _Growing, spp: int) -> NDArray[np.uint8]:
        request, camera = picture.request, self._camera(picture)
        effects = self._effects(picture)
        start = time.perf_counter()
        frame = self._live.shoot(
            camera,
            spp=spp,
            tone=request.tone,
            effects=effects,
            illuminant=request.illuminant_with(effects),
            transport=request.transport,
            clamp_cd_m2=request.clamp_cd_m2,
        )
        if picture.kept:
            self._wait_for(frame, picture)
        codes = frame.codes
        seconds = max(time.perf_counter() - start, 1e-6)
        self._pace.took(spp * math.prod(picture.size), seconds, is_first=picture.samples == 0)
        picture.spent_s += seconds
        picture.samples, picture.exposure_time_s = frame.samples, camera.exposure_time_s
        picture.kept = self._live_arrays() if self._pace.was_slow(seconds) else None
        is_as_wanted = picture.request is request  # another exposure may have been set while this frame was taken
        return codes if is_as_wanted else self._developed(picture)

    def _effects(self, picture: _Growing) -> list[str]:
        """Of fewer pixels diffraction is left out: it is smaller than they are, and its tables take 50 ms of a core."""
        is_whole = picture.size == picture.request.camera.film.resolution
        return [effect for effect in picture.request.effects if is_whole or effect != "diffraction"]

    def _wait_for(self, frame: LiveFrame, picture: _Growing) -> None:
        """Meanwhile what asks for no new samples is done with those of the frame before."""
        while not frame.ready:
            with self._wake:
                self._wake.wait(0.005)
                pending = self._pending if self._pending and picture.can_be(self._pending.request) else None
                if pending:
                    self._pending = None
                quick = [] if self._pending else [q for q in self._questions if not q.needs_samples]
                for question in quick:
                    self._questions.remove(question)
            for question in quick:
                self._answer(question)
            if pending:
                self._develop_for(picture, pending)

    def _camera(self, picture: _Growing) -> Camera:
        camera = picture.request.camera
        film = camera.film.replace(resolution=picture.size)
        time_s = self._exposure_time_s if picture.request.is_automatic else camera.exposure_time_s
        return camera.replace(film=film, exposure_time_s=time_s)

    def _meter(self, picture: _Growing) -> bool:
        """Sets the exposure time by the light of the picture. Whether it has changed so that it is seen."""
        exposure, _ = self._arrays(picture)
        mean = metered_exposure_lx_s(exposure)
        if not (mean > 0 and math.isfinite(mean)):
            return False
        before = picture.exposure_time_s
        wanted = middle_grey_lx_s(picture.request.camera.iso, picture.request.compensation_ev)
        self._exposure_time_s = min(max(before * wanted / mean, 1e-6), 1e4)
        return abs(math.log2(self._exposure_time_s / before)) > 0.02

    def _develop_for(self, picture: _Growing, pending: _Pending) -> None:
        """Shows for a new request the samples that are there."""
        request = pending.request
        picture.request, picture.serial, picture.begun = request, pending.serial, pending.begun
        if request.is_automatic:
            self._meter(picture)
        # The picture first: its noise takes two pictures more to be developed.
        picture.noise_codes = picture.noise_tiles = None
        picture.is_final = self._is_good_enough(picture)
        self._develop(picture)
        self._tell_noise(picture)
        if self._is_good_enough(picture) and not picture.is_final:
            picture.is_final = True
            self._develop(picture)

    def _develop(self, picture: _Growing) -> None:
        """Shows the samples that are there with another exposure."""
        if not picture.kept and math.prod(picture.size) > _FEW_PIXELS:
            self._show(picture, self._shoot(picture, 1))  # the device takes a sample and develops in less time
            return
        self._show(picture, self._developed(picture))

    def _developed(self, picture: _Growing) -> NDArray[np.uint8]:
        """The samples that are there as they are wanted now."""
        exposure, _ = self._arrays(picture)
        ratio = self._camera(picture).exposure_time_s / picture.exposure_time_s
        return develop(exposure * np.float32(ratio), picture.request.camera.iso, picture.request.tone)

    def _arrays(self, picture: _Growing) -> _Arrays:
        return picture.kept or self._live_arrays()

    def _live_arrays(self) -> _Arrays:
        exposure, depth = self._live.picture()
        return np.asarray(exposure), np.asarray(depth)

    def _collected(self, picture: _Growing) -> Image:
        request = picture.request
        camera = self._camera(picture).replace(exposure_time_s=picture.exposure_time_s)
        return image_of(
            self._live._image(),
            camera,
            self._seed,
            request.transport,
            request.clamp_cd_m2,
            request.effects,
            request.illuminant_with(request.effects),
        )

    def _image(self) -> Image:
        picture = self._picture
        if picture is None:
            raise InputError("there is no picture yet")
        while picture.size != picture.request.camera.film.resolution or not picture.samples:
            self._refine(picture)
            if self._pending:
                raise Cancelled("another picture is wanted")
        image = self._collected(picture)
        time_s = self._camera(picture).exposure_time_s
        ratio = np.float32(time_s / image.camera.exposure_time_s)
        return replace(image, pixels=image.pixels * ratio, camera=image.camera.replace(exposure_time_s=time_s))

    def _point(self, u: float, v: float) -> Point:
        picture = self._picture
        # While the first frame of more pixels is taken, it has no samples, and the frame before is kept.
        if picture is None or not (picture.samples or picture.kept):
            raise InputError("there is no picture yet")
        return point_at(u, v, *self._arrays(picture), picture.exposure_time_s)

    def _measure_noise(self, picture: _Growing) -> None:
        if picture.noise.is_due(picture.samples):
            exposure, _ = self._arrays(picture)
            picture.noise.add(picture.samples, exposure / np.float32(picture.exposure_time_s))
            self._tell_noise(picture)
            if picture.noise_codes is not None:
                picture.costs = Costs.of(self._collected(picture).stats, picture.spent_s)
        picture.is_final = self._is_good_enough(picture)

    def _tell_noise(self, picture: _Growing) -> None:
        request = picture.request
        developed = self._camera(picture).exposure_time_s, request.camera.iso, request.tone
        picture.noise_codes = picture.noise.codes(*developed)
        picture.noise_tiles = picture.noise.tiles(*developed)

    def _is_good_enough(self, picture: _Growing) -> bool:
        request = picture.request
        is_quiet = picture.noise_codes is not None and picture.noise_codes <= request.noise_codes
        return is_quiet or picture.samples >= request.max_spp

    def _show(self, picture: _Growing, codes: NDArray[np.uint8]) -> None:
        whole = picture.request.camera.film.resolution
        frame_of = partial(
            Frame,
            serial=picture.serial,
            width=codes.shape[1],
            height=codes.shape[0],
            whole_width=whole[0],
            whole_height=whole[1],
            samples=picture.samples,
            is_preview=codes.shape[1::-1] != whole,
            is_final=picture.is_final,
            noise_codes=picture.noise_codes,
            noise_tiles=picture.noise_tiles,
            seconds=time.perf_counter() - picture.begun,
            exposure_time_s=self._camera(picture).exposure_time_s,
            costs=picture.costs,
        )
        try:
            self._encoder.submit(codes, frame_of)
        except RuntimeError:  # the program is ending, and takes no more work
            self._is_closed = True
