"""Reading and writing of image files, by the same C++ code as in the executable."""

from __future__ import annotations

import os
import warnings
from collections.abc import Mapping

import numpy as np

from . import _core
from .files import system_name

# Suffixes of files with 8-bit pictures.
DEVELOPED = (".png", ".jpg", ".jpeg", ".tif", ".tiff", ".webp")


def read_environment(path: str | os.PathLike[str], *, layer: str = "") -> np.ndarray:
    """Reads a latitude-longitude picture as (H, W, 3) float32, linear, row 0 at the zenith, for Scene.with_environment.

    Values of EXR and HDR are cd/m^2; 8 and 16 bits are sRGB, with white as 1 cd/m^2. Colours in other primaries, if the
    EXR or HDR states them, are converted to Rec. 709. OpenEXR environment maps (attribute envmap) follow OpenEXR's
    orientation, and may be cube maps. layer: a layer of an EXR, such as "albedo"; by default the channels R, G and B,
    or the layer beauty or combined, or the only one. Negative values become 0, with a warning. Raises ImageFileError,
    also if negative values exceed a twentieth of the light, or if a value is not a number up to 1e20.
    """
    return _with_warnings(*_core._read_environment(system_name(path), layer))


def read_picture(path: str | os.PathLike[str]) -> np.ndarray:
    """Reads a picture as (H, W, 3) float32, linear Rec. 709, row 0 at the top. Values of 8 and 16 bits are sRGB with
    white as 1; values of EXR and HDR are not scaled. Raises ImageFileError.
    """
    return _with_warnings(*_core._read_picture(system_name(path)))


def _with_warnings(pixels: np.ndarray, messages: list[str]) -> np.ndarray:
    """Warns the caller's caller of each message, and returns the pixels."""
    for message in messages:
        warnings.warn(message, stacklevel=3)
    return pixels


def write_codes(
    codes: np.ndarray, path: str | os.PathLike[str], entries: Mapping[str, str], *, is_srgb: bool = True
) -> None:
    """Writes 8-bit display values (H, W, 3) as one of DEVELOPED, with metadata. is_srgb: the file declares sRGB. Raises
    ImageFileError."""
    _core._write_codes(system_name(path), codes, list(entries.items()), is_srgb)


def read_film(path: str | os.PathLike[str]) -> tuple[np.ndarray, dict[str, str]]:
    """Reads the film's exposure from an .exr of realcam, (H, W, 3) float32 lux seconds, and the "realcam:..." entries
    of its metadata. Raises ImageFileError.
    """
    exposure, entries = _core._read_film(system_name(path))
    return exposure, dict(entries)
