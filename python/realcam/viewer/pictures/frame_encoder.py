"""JPEG encoding of frames, concurrent with rendering of the next frame."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor

import numpy as np
import simplejpeg
from numpy.typing import NDArray

from .picture_request import Frame


class FrameEncoder:
    """Encodes on its own thread, one frame at a time, so that frames stay in order."""

    def __init__(self, on_frame: Callable[[Frame], None]) -> None:
        """on_frame: called on the encoder's thread."""
        self._on_frame = on_frame
        self._executor = ThreadPoolExecutor(1, "realcam-jpeg")
        self._encoding: Future[None] | None = None
        self.quality = 85  #: JPEG quality, 0 to 100

    def submit(self, codes: NDArray[np.uint8], frame_of: Callable[..., Frame]) -> None:
        """Encodes a frame after waiting for the previous one.

        codes: (H, W, 3), RGB. frame_of: called as frame_of(jpeg=..., jpeg_quality=...). Raises RuntimeError if the
        program is ending, and errors of the previous frame's encoding.
        """
        previous, self._encoding = self._encoding, None
        if previous:
            previous.result()
        self._encoding = self._executor.submit(self._encode, codes, frame_of)

    def close(self) -> None:
        """Waits for the last frame, and ends the thread."""
        self._executor.shutdown()

    def _encode(self, codes: NDArray[np.uint8], frame_of: Callable[..., Frame]) -> None:
        quality = self.quality
        jpeg = simplejpeg.encode_jpeg(codes, quality=quality, colorsubsampling="420")
        self._on_frame(frame_of(jpeg=jpeg, jpeg_quality=quality))
