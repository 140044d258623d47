"""Raw access to picture files through the package OpenImageIO, for the extension.

cpp/bindings/pictures/openimageio_package.cpp calls this module; cpp/image_io interprets the values.
"""

from __future__ import annotations

import tempfile
import threading
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

try:
    import OpenImageIO as oiio
except ImportError as error:
    raise ImportError(
        f"picture files need the package OpenImageIO; pip install OpenImageIO installs it ({error})"
    ) from None


# File suffixes by OpenImageIO's names of formats.
_SUFFIXES = {"jpeg": ".jpg", "openexr": ".exr", "tiff": ".tif", "bmp": ".bmp", "targa": ".tga", "webp": ".webp"}
_LARGEST_NUMBER = 2**24  # above it OpenImageIO, which computes in float32, would round integers
_MAX_PARTS = 256  # kMostParts in cpp/image_io/openimageio.hpp
_opening = threading.Lock()  # guards OpenImageIO's global option try_all_readers


def _text(get: Callable[[], str]) -> str:
    """Returns get() with valid characters alone.

    OpenImageIO's names and messages hold bytes of the file, which may be invalid UTF-8: its bindings then raise an
    error or return surrogates.
    """
    try:
        return get().encode(errors="surrogateescape").decode(errors="replace")
    except UnicodeDecodeError as error:
        return error.object.decode(errors="replace")


def _name_of(attribute: Any) -> str:
    return _text(lambda: str(attribute.name))


def _opened(format: str, name: str) -> Any:
    """Opens a file as this format only. Raises ValueError with OpenImageIO's message if it has another format.

    OpenImageIO takes the format from the suffix and then tries all others, some of which crash on broken files. So the
    file is opened through a temporary link with the right suffix.
    """
    configuration = oiio.ImageSpec()
    configuration.attribute("oiio:UnassociatedAlpha", 1)
    with _opening, tempfile.TemporaryDirectory(prefix="realcam-") as folder:
        link = Path(folder, "picture" + _SUFFIXES[format])
        link.symlink_to(name)
        tries_all = oiio.get_int_attribute("try_all_readers", 1)
        oiio.attribute("try_all_readers", 0)
        try:
            opened = oiio.ImageInput.open(str(link), configuration)
        finally:
            oiio.attribute("try_all_readers", tries_all)
        if opened is None:
            raise ValueError(_text(oiio.geterror).replace(str(link), "picture"))
    return opened


def _channel_name(spec: Any, channel: int) -> str:
    return str(spec.channel_name(channel))


class Decoder:
    """A picture file with its headers read. Raises ValueError with OpenImageIO's message if it cannot be read."""

    def __init__(self, format: str, name: str) -> None:
        self._input = _opened(format, name)
        self._opening = _text(self._input.geterror)  # errors of a broken header that OpenImageIO has accepted
        self._specs: list[Any] = []
        max_parts = _MAX_PARTS if format == "openexr" else 1  # other formats have one; WebP cannot go back
        while len(self._specs) < max_parts and self._input.seek_subimage(len(self._specs), 0):
            self._specs.append(self._input.spec())
        end = _text(self._input.geterror)  # the error that says that there is no further part
        if not self._specs:
            raise ValueError(self._opening + end)

    @property
    def headers(self) -> list[dict[str, Any]]:
        """Headers of all parts of the file, with the members of EncodedHeader (cpp/image_io/openimageio.hpp)."""
        return [self._header(spec) for spec in self._specs]

    @staticmethod
    def _header(spec: Any) -> dict[str, Any]:
        names = ("x", "y", "width", "height", "depth", "full_x", "full_y", "full_width", "full_height")
        entries = [name for name in map(_name_of, spec.extra_attribs) if name.startswith("realcam:")]
        return {
            **{name: getattr(spec, name) for name in (*names, "deep")},
            "part_name": _text(lambda: spec.get_string_attribute("oiio:subimagename")),
            "channels": [
                (_text(partial(_channel_name, spec, c)), spec.channelformat(c).basetype == oiio.UINT32)
                for c in range(spec.nchannels)
            ],
            "bytes_per_value": spec.format.size(),
            "is_floating_point": spec.format.basetype in (oiio.HALF, oiio.FLOAT, oiio.DOUBLE),
            "tile_height": spec.tile_height if spec.tile_width > 0 else 0,
            "chromaticities": spec.getattribute("chromaticities", oiio.TypeDesc("float[8]")),
            "textureformat": _text(lambda: spec.get_string_attribute("textureformat")),
            "entries": [(name, spec.get_bytes_attribute(name)) for name in entries],
        }

    def read(
        self, part: int, first: int, end: int, first_channel: int, end_channel: int, format: str
    ) -> tuple[np.ndarray | None, str]:
        """Returns rows `first` to `end` of some channels of a part's data window, or None if they cannot be read, and
        OpenImageIO's error message. format: numpy type of the result."""
        spec, channels = self._specs[part], (first_channel, end_channel)
        begin_row, end_row = spec.y + first, spec.y + end
        if spec.tile_width > 0:
            columns = (spec.x, spec.x + spec.width)
            pixels = self._input.read_tiles(
                part, 0, *columns, begin_row, end_row, spec.z, spec.z + 1, *channels, format
            )
        else:
            pixels = self._input.read_scanlines(part, 0, begin_row, end_row, spec.z, *channels, format)
        return pixels, self._opening + _text(self._input.geterror)


class Encoder:
    """A picture file that is being written. Raises OSError, with the reason, if it cannot be written.

    channels: (name, True for uint32 and False for float32) of each channel; empty: RGB as uint8.
    """

    def __init__(
        self,
        format: str,
        name: str,
        width: int,
        height: int,
        channels: Sequence[tuple[str, bool]],
        attributes: Sequence[tuple[str, str | float | Sequence[float]]],
    ) -> None:
        self._width = width
        self._numbers = [is_number for _, is_number in channels]
        # Channels of several types are passed in one type that holds the values of both: float64.
        type_name = "double" if any(self._numbers) else "float" if channels else "uint8"
        spec = oiio.ImageSpec(width, height, len(channels) or 3, type_name)
        if channels:
            spec.channelnames = tuple(channel for channel, _ in channels)
            spec.z_channel = spec.channelnames.index("Z") if "Z" in spec.channelnames else -1
        if any(self._numbers):
            spec.channelformats = tuple(oiio.TypeDesc("uint" if number else "float") for number in self._numbers)
        for key, value in attributes:
            if isinstance(value, (str, float)):
                spec.attribute(key, value)
            else:
                is_vector = len(value) == 2
                type_ = oiio.TypeDesc(oiio.FLOAT, oiio.VEC2) if is_vector else oiio.TypeDesc(f"float[{len(value)}]")
                spec.attribute(key, type_, tuple(value))
        output = oiio.ImageOutput.create(format)
        if output is None:
            raise OSError(f"OpenImageIO cannot write .{format}: {_text(oiio.geterror)}")
        if not output.open(name, spec):
            raise OSError(_text(output.geterror))
        self._output = output

    def write(self, first: int, end: int, rows: memoryview) -> tuple[bool, str]:
        """Writes rows `first` to `end`: uint8, or float32 or uint32 per channel. Returns success and error message."""
        shape = (end - first, self._width, -1)
        pixels = np.frombuffer(rows, np.float32 if self._numbers else np.uint8).reshape(shape)
        if any(self._numbers):
            whole = np.frombuffer(rows, np.uint32).reshape(shape)
            if whole[..., self._numbers].max() > _LARGEST_NUMBER:
                return False, f"a layer has numbers above {_LARGEST_NUMBER}"
            # OpenImageIO maps 1.0 to the largest integer, and computes with 24 bits.
            pixels = np.where(self._numbers, whole / float(2**32 - 1), pixels)
        return self._output.write_scanlines(first, end, 0, pixels), _text(self._output.geterror)

    def close(self) -> tuple[bool, str]:
        """Completes the file. Returns success and error message."""
        return self._output.close(), _text(self._output.geterror)
