"""OpenEXR files of values that are no colours: directions, coordinates, maps."""

from __future__ import annotations

import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from ..._core import ImageFileError
from ...files import record_input
from ..arrays import Array
from .markup import Fail

LARGEST = 8192  # texels along a side


def exr_values(path: Path, channels: int, fail: Fail) -> Array:
    """Returns the first channels of a picture, (H, W, channels) doubles. Calls `fail` with the reason if it cannot."""
    import OpenImageIO as oiio  # slow to load

    record_input(path)
    opened = oiio.ImageInput.open(str(path))
    if opened is None:
        fail(f"cannot be read: {oiio.geterror():.80}".replace("\n", " "))
    try:
        spec = opened.spec()
        if not (spec.nchannels >= channels and 2 <= spec.width <= LARGEST and 2 <= spec.height <= LARGEST):
            fail(f"expected {channels} channels and 2 to {LARGEST} texels a side")
        pixels = opened.read_image(0, 0, 0, channels, oiio.FLOAT)
    finally:
        opened.close()
    if pixels is None or not np.isfinite(pixels).all():
        fail("is damaged or holds values that are not finite")
    values: Array = np.asarray(pixels, dtype=float).reshape(spec.height, spec.width, channels)
    return values


def exr_attribute(path: Path, name: str) -> str:
    """Returns a text of a picture's header; empty if there is none."""
    import OpenImageIO as oiio  # slow to load

    opened = oiio.ImageInput.open(str(path))
    if opened is None:
        return ""
    try:
        return str(opened.spec().get_string_attribute(name))
    finally:
        opened.close()


def exr_content(values: Array, channels: Sequence[str], attributes: Mapping[str, str] | None = None) -> bytes:
    """Returns an OpenEXR file with (H, W, C) values in 32 bits. attributes: texts of its header.

    Raises ImageFileError.
    """
    import OpenImageIO as oiio  # slow to load

    height, width = values.shape[:2]
    spec = oiio.ImageSpec(width, height, len(channels), "float")
    spec.channelnames = tuple(channels)
    spec.attribute("compression", "zip")
    for name, text in (attributes or {}).items():
        spec.attribute(name, text)
    with tempfile.TemporaryDirectory(prefix="realcam-") as folder:
        path = Path(folder, "values.exr")
        output = oiio.ImageOutput.create("openexr")
        if output is None or not output.open(str(path), spec):
            raise ImageFileError(f"OpenImageIO cannot write OpenEXR files: {oiio.geterror():.80}")
        is_written = output.write_image(np.ascontiguousarray(values, dtype=np.float32))
        if not (output.close() and is_written):
            raise ImageFileError(f"OpenImageIO cannot write an OpenEXR file: {output.geterror():.80}")
        return path.read_bytes()
