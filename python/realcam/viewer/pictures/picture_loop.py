"""Thread that renders the newest request progressively: a coarse preview first, then refinement until done."""

from __future__ import annotations

import logging
import math
import threading
import time
from collections import deque
from collections.abc import Callable
from concurrent.futures import Future
from dataclasses import dataclass
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from ..._core import Cancelled, InputError, LiveFrame, RealcamError, Scene
from ...image import Image
from ...live_view import LiveView
from .frame_encoder import FrameEncoder
from .growing_picture import GrowingPicture
from .light_meter import point_at
from .picture_request import Frame, PictureRequest, Point
from .picture_taker import PictureTaker

T = TypeVar("T")
_log = logging.getLogger(__name__)

# Pauses between the first frame of a change and its refinement, which the next change would cancel, above all during
# a movement.
_RESTING_S, _MOVING_S = 0.025, 0.15


@dataclass(frozen=True)
class _Pending:
    """The newest request that has not been begun."""

    request: PictureRequest
    serial: int
    begun: float  #: time.perf_counter() when it was submitted


@dataclass(frozen=True)
class _Question:
    """A question about the picture, which the loop's thread answers."""

    ask: Callable[[], Any]  #: returns the answer
    answer: Future[Any]
    needs_samples: bool  #: the question must wait for the frame in progress


class PictureLoop:
    """Renders a scene for one window.

    on_frame and on_error (with the request's serial and a message) are called on threads of the loop. submit() may be
    called at every mouse move: a request in progress always gets its first frame; of those submitted meanwhile only the
    newest is rendered. The resolution of a view never decreases from frame to frame.
    """

    def __init__(
        self,
        scene: Scene,
        on_frame: Callable[[Frame], None],
        on_error: Callable[[int, str], None],
        *,
        device: str = "auto",
    ) -> None:
        self._live = LiveView(scene, device=device)
        self._taker = PictureTaker(self._live, self._wait_for, self._is_wanted, device)
        self._on_error = on_error
        self._wake = threading.Condition()
        self._pending: _Pending | None = None
        self._questions: deque[_Question] = deque()
        self._refines = False  # a refining frame is in progress, which a change may cancel
        self._is_closed = False
        self._serial = 0
        self._picture: GrowingPicture | None = None
        self._begun = 0.0  # time.perf_counter() of the last request that started a new picture
        self._encoder = FrameEncoder(on_frame)
        self._thread = threading.Thread(target=self._run, name="realcam-picture", daemon=True)
        self._thread.start()

    def submit(self, request: PictureRequest) -> int:
        """Renders a request as soon as possible. Returns the serial of its frames."""
        with self._wake:
            self._serial += 1
            serial = self._serial
            self._pending = _Pending(request, serial, time.perf_counter())
            picture = self._picture
            self._wake.notify()
            if self._refines and picture and not picture.request.is_same_view(request):
                picture.is_cancelled = True
                self._live.cancel()  # under the lock, so that the other thread is still in the frame to be cancelled
        return serial

    @property
    def serial(self) -> int:
        """Serial of the newest request."""
        return self._serial

    @property
    def jpeg_quality(self) -> int:
        return self._encoder.quality

    @jpeg_quality.setter
    def jpeg_quality(self, quality: int) -> None:
        self._encoder.quality = quality

    def image(self) -> Future[Image]:
        """The picture as shown, denoised or not, at full resolution. The future raises InputError or Cancelled."""
        return self._ask(self._image, True)

    def point(self, u: float, v: float) -> Future[Point]:
        """Distance and illuminance at u, v (0 to 1, from the upper left corner). The future raises InputError or
        Cancelled."""
        return self._ask(lambda: self._point(u, v), False)

    def close(self) -> None:
        """Ends the thread. May be called from any other thread."""
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

    # The following functions run on the loop's thread.

    def _is_wanted(self) -> bool:
        return not self._pending and not self._is_closed

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
                # A newer request cancelled this frame. If the cancellation hit a later frame, its request is rendered
                # again.
                with self._wake:
                    self._pending = self._pending or pending
            except RealcamError as error:
                with self._wake:
                    is_cancelled = pending is None and self._pending is not None
                if not is_cancelled:  # a frame that was complete when it was cancelled has lost its samples
                    self._fail(pending, str(error))
            except Exception:
                _log.exception("the picture could not be rendered")
                self._fail(pending, "the picture could not be rendered; see the server's log")
        while self._questions:
            self._questions.popleft().answer.set_exception(Cancelled("the window is closed"))

    def _wait_for_work(self) -> bool:
        """Waits for a request, a question, or the time to refine the picture. Returns false if the loop is closed."""
        with self._wake:
            while not self._is_closed:
                if self._pending or self._questions:
                    return True
                if self._picture and not self._picture.is_final:
                    pause_s = self._picture.refine_after - time.perf_counter()
                    if pause_s <= 0:
                        return True
                    self._wake.wait(pause_s)
                else:
                    self._wake.wait()
        return False

    def _answerable(self) -> list[_Question]:
        """Removes and returns the questions that can be answered now: none while a newer request is pending, because
        questions refer to the newest picture."""
        with self._wake:
            answerable = [] if self._pending else list(self._questions)
            for question in answerable:
                self._questions.remove(question)
        return answerable

    def _answer(self, question: _Question) -> None:
        """Answers a question, unless its future was cancelled."""
        if not (question.answer.running() or question.answer.set_running_or_notify_cancel()):
            return
        try:
            question.answer.set_result(question.ask())
        except RealcamError as error:
            with self._wake:
                # The samples were cancelled for another picture; the question is asked again for that one.
                if self._pending and not self._is_closed:
                    self._questions.append(question)
                    return
            question.answer.set_exception(error)
        except BaseException as error:
            question.answer.set_exception(error)

    def _fail(self, pending: _Pending | None, message: str) -> None:
        """Discards the picture, and reports the error for the pending request or for the picture."""
        serial = pending.serial if pending else self._picture.serial if self._picture else 0
        self._picture = None
        if self._is_closed:
            return  # closing has cancelled the samples, which is not an error
        self._on_error(serial, message)

    def _begin(self, pending: _Pending) -> None:
        """Shows the first frame of a request: existing samples if they apply to it, otherwise a new preview."""
        request = pending.request
        picture = self._picture
        if picture and picture.samples and picture.can_be_developed_for(request):
            self._develop_for(picture, pending)
            return
        has_samples = picture and not picture.is_cancelled and (picture.samples or picture.stored_arrays)
        if picture and has_samples and picture.request.is_same_view(request):
            self._picture = self._taker.with_other_settings(picture, request, pending.serial)
            return
        self._picture = picture = self._taker.new_picture(request, pending.serial, pending.begun)
        codes = self._taker.shoot(picture, self._taker.pace.first_spp(picture.size))
        is_moving = pending.begun - self._begun < _MOVING_S
        self._begun = pending.begun
        picture.refine_after = time.perf_counter() + (_MOVING_S if is_moving else _RESTING_S)
        if request.is_automatic and self._taker.meter(picture):
            codes = self._taker.developed(picture)
        self._show(picture, codes, is_hurried=True)

    def _refine(self, picture: GrowingPicture) -> None:
        """Renders the next refining frame: at the next resolution, or with further samples."""
        start = time.perf_counter()
        request, pace = picture.request, self._taker.pace
        is_new_size = picture.size != picture.full_size
        if is_new_size:
            picture.size = pace.next_size(picture.size, picture.full_size)
        samples = 0 if is_new_size else picture.samples
        spp = min(pace.refining_spp(picture.size, samples), max(1, request.max_spp - samples))
        remaining = picture.expected_samples() - samples
        if remaining < spp:
            spp = min(spp, max(1, samples // 32, math.ceil(remaining)))
        if picture.stored_arrays is None and pace.is_slow(spp, picture.size):
            self._taker.store_arrays(picture)
        with self._wake:
            if self._pending:
                return
            self._refines = True
        if is_new_size:
            picture.samples, picture.spent_s = 0, 0.0
            picture.steps.clear()
        try:
            codes = self._taker.shoot(picture, spp)
        finally:
            with self._wake:
                self._refines = False
        if picture.size == picture.full_size:
            self._taker.measure_noise(picture)
        if request.is_automatic and picture.samples <= 2 * spp and self._taker.meter(picture):
            self._show(picture, self._taker.developed(picture))
        else:
            self._show(picture, codes)
        picture.steps.append((picture.samples - samples, time.perf_counter() - start))

    def _wait_for(self, frame: LiveFrame, picture: GrowingPicture) -> None:
        """Waits for a frame, and meanwhile serves requests and questions that need no new samples from the previous
        frame."""
        while not frame.ready:
            with self._wake:
                self._wake.wait(0.005)
                pending = (
                    self._pending if self._pending and picture.can_be_developed_for(self._pending.request) else None
                )
                if pending:
                    self._pending = None
                answerable = [] if self._pending else [q for q in self._questions if not q.needs_samples]
                for question in answerable:
                    self._questions.remove(question)
            for question in answerable:
                self._answer(question)
            if pending:
                self._develop_for(picture, pending, is_free=False)

    def _develop_for(self, picture: GrowingPicture, pending: _Pending, *, is_free: bool = True) -> None:
        """Develops the existing samples for a new request. is_free: true if no frame is in progress."""
        request = pending.request
        is_unchanged = request == picture.request
        picture.request, picture.serial, picture.begun = request, pending.serial, pending.begun
        if request.is_automatic:
            self._taker.meter(picture)
        if is_unchanged:
            self._show(picture, self._taker.developed(picture))
            return
        # Shows the picture first, because measuring its noise develops two more pictures.
        picture.noise_codes = picture.noise_tiles = None
        picture.is_final = picture.is_good_enough()
        self._show(picture, self._taker.developed(picture), is_free=is_free)
        picture.update_noise(self._taker.camera(picture).exposure_time_s)
        if picture.is_good_enough() and not picture.is_final:
            picture.is_final = True
            self._show(picture, self._taker.developed(picture))

    def _image(self) -> Image:
        picture = self._picture
        if picture is None:
            raise InputError("there is no picture yet")
        while picture.size != picture.full_size or not picture.samples:
            self._refine(picture)
            if self._pending:
                raise Cancelled("another picture was requested")
        return self._taker.image(picture, is_denoised=self._is_denoised(picture))

    def _point(self, u: float, v: float) -> Point:
        picture = self._picture
        # During the first frame at a higher resolution there are no samples, and the previous frame is kept.
        if picture is None or not (picture.samples or picture.stored_arrays):
            raise InputError("there is no picture yet")
        return point_at(u, v, *self._taker.arrays(picture), picture.exposure_time_s)

    @staticmethod
    def _is_denoised(picture: GrowingPicture) -> bool:
        """True if the picture is shown and saved denoised."""
        return picture.request.denoises and not picture.is_final

    def _show(
        self,
        picture: GrowingPicture,
        codes: NDArray[np.uint8],
        *,
        is_free: bool = True,
        is_hurried: bool = False,
    ) -> None:
        """Encodes a frame of the picture for the page, denoised if requested.

        codes: the picture without denoising, 8-bit. is_free: true if no frame is in progress. is_hurried: true for the
        first frame of a change, which is denoised only if that is fast enough.
        """
        is_denoised = self._is_denoised(picture)
        if is_denoised:
            denoised_codes = self._taker.developed_denoised(picture, is_free=is_free, is_hurried=is_hurried)
            is_denoised = picture.denoised_lx is not None
            if denoised_codes is not None:
                codes = denoised_codes
            elif is_denoised:
                return  # the previous frame remains
        frame_of = picture.frame_of(codes, self._taker.camera(picture).exposure_time_s, is_denoised)
        try:
            self._encoder.submit(codes, frame_of)
        except RuntimeError:  # the program is ending
            self._is_closed = True
