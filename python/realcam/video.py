"""Writing of video files. The commands in C++ call check_film and write_film."""

from __future__ import annotations

import secrets
from collections.abc import Callable, Iterable, Iterator
from fractions import Fraction
from pathlib import Path

import numpy as np

from ._core import Cancelled, ImageFileError, InputError
from .files import check_target
from .installation import imported

# Code points of ITU-T H.273.
_BT709, _SRGB = 1, 13


def write_video(path: Path, frames: Iterable[np.ndarray], frames_per_second: float) -> None:
    """Writes (H, W, 3) uint8 sRGB pictures of one size as H.264 in .mp4, completely or not at all.

    Chroma is subsampled 2 x 2, so the last row or column of pictures with odd sizes is repeated.
    Raises InputError if PyAV is missing or sizes differ, and ImageFileError.
    """
    av = imported("av", "video")
    check_target(path)
    temporary = path.with_name(f".realcam-{secrets.token_hex(8)}.mp4")
    try:
        with av.open(str(temporary), "w", format="mp4") as container:
            stream = container.add_stream("libx264", rate=Fraction(frames_per_second).limit_denominator(1001))
            stream.pix_fmt = "yuv420p"
            stream.options = {"crf": "16"}
            size: tuple[int, ...] | None = None
            for frame in frames:
                if size not in (None, frame.shape):
                    raise InputError(f"{path}: the frames of a video must have the same size")
                even = np.pad(frame, [(0, frame.shape[0] % 2), (0, frame.shape[1] % 2), (0, 0)], mode="edge")
                if size is None:
                    size = frame.shape
                    stream.height, stream.width = even.shape[:2]
                    # Without these tags, players guess the colour space from the size.
                    colours = stream.codec_context
                    colours.colorspace, colours.color_primaries, colours.color_trc = _BT709, _BT709, _SRGB
                picture = av.VideoFrame.from_ndarray(even, format="rgb24")
                container.mux(stream.encode(picture.reformat(format="yuv420p", dst_colorspace="ITU709")))
            container.mux(stream.encode())
        temporary.replace(path)
    except OSError as error:  # FFmpeg's errors derive from OSError
        raise ImageFileError(f"{path}: cannot be written: {error.strerror or error}") from None
    finally:
        temporary.unlink(missing_ok=True)


def check_film(path: str) -> None:
    """Raises InputError if PyAV is missing, and ImageFileError if the video file cannot be written."""
    imported("av", "video")
    check_target(path)


def write_film(path: str, pictures: list[str], frames_per_second: float, keep_going: Callable[[], bool]) -> None:
    """Writes a video of 8-bit picture files; see write_video. Raises Cancelled if keep_going() returns False."""

    def frames() -> Iterator[np.ndarray]:
        av = imported("av", "video")
        for picture in pictures:
            if not keep_going():
                raise Cancelled
            with av.open(picture) as opened:
                yield next(opened.decode(video=0)).to_ndarray(format="rgb24")

    write_video(Path(path), frames(), frames_per_second)
