"""The picture thread of a lens-bench window, with a record of its reports."""

from __future__ import annotations

import threading
from collections.abc import Callable

import numpy as np
import realcam as rc
import simplejpeg
from realcam.viewer.pictures.picture_loop import PictureLoop
from realcam.viewer.pictures.picture_request import Frame, PictureRequest

LENS = rc.Lens.load("double-gauss-50mm").focused(5.0)
FILM = rc.Film(36, 24, (120, 80))


def camera(x: float = 0.0, **options: object) -> rc.Camera:
    options = {"film": FILM, "exposure_time_s": 0.01} | options
    return rc.Camera(LENS, position=(x, 1, 3), look_at=(0, 0.4, -3), **options)


def codes_of(frame: Frame) -> np.ndarray:
    return simplejpeg.decode_jpeg(frame.jpeg)


class Watched:
    def __init__(self, scene: rc.Scene) -> None:
        self.scene = scene
        self.frames: list[Frame] = []
        self.errors: list[tuple[int, str]] = []
        self._news = threading.Condition()
        self.loop = PictureLoop(scene, self._take, self._fail, device="cpu")

    def _take(self, frame: Frame) -> None:
        with self._news:
            self.frames.append(frame)
            self._news.notify_all()

    def _fail(self, serial: int, message: str) -> None:
        with self._news:
            self.errors.append((serial, message))
            self._news.notify_all()

    def until(self, has_come: Callable[[], object], seconds: float = 120.0) -> None:
        with self._news:
            assert self._news.wait_for(has_come, seconds), (self.frames[-1:], self.errors)

    def photograph(self, request: PictureRequest) -> Frame:
        """The final frame of it."""
        serial = self.loop.submit(request)
        self.until(lambda: self.frames and self.frames[-1].serial == serial and self.frames[-1].is_final)
        return self.frames[-1]
