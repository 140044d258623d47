"""Digital Negatives (Adobe DNG 1.4) through tifffile, from the extra realcam[raw]."""

from __future__ import annotations

import io
import os
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from ._core import InputError, __version__
from .files import write_whole
from .short_text import ShortText

# EXIF LightSource codes. Other illuminants have no code of their own.
LIGHT_SOURCES = {"": 21, "D65": 21, "D50": 23, "A": 17, "FL2": 14}
OTHER_LIGHT_SOURCE = 255
CFA, LINEAR_RAW = 32803, 34892  # PhotometricInterpretation
# IEC 61966-2-1.
SRGB_FROM_XYZ = (3.2404542, -1.5371385, -0.4985314, -0.969266, 1.8760108, 0.041556, 0.0556434, -0.2040259, 1.0572252)
# Exposure that saturates a sensor, 78 / iso lux seconds (ISO 12232), over the exposure of display white,
# 1 / (0.018 iso) lux seconds.
SATURATION_OVER_WHITE = 0.018 * 78
# Types of TIFF tags, as tifffile names them.
ASCII, BYTE, SHORT, LONG, RATIONAL, SRATIONAL = "s", "B", "H", "I", "2I", "2i"


@dataclass(frozen=True, repr=False)
class ColorFilters(ShortText):
    """Colour data of a mosaic with red, green and blue filters.

    array: filters of the 2 x 2 pixels at the top left, row by row, as "RGGB". illuminant: a key of LIGHT_SOURCES or
    another name. camera_from_xyz, d50_from_balanced: (3, 3), and as_shot_neutral: (3,): see RawImage.
    """

    array: str
    illuminant: str
    camera_from_xyz: np.ndarray
    as_shot_neutral: np.ndarray
    d50_from_balanced: np.ndarray


@dataclass(frozen=True, repr=False)
class Negative(ShortText):
    """A mosaic, (H, W) uint16, with the data that raw developers need. filters: None for a monochrome sensor."""

    mosaic: np.ndarray
    sensor: str
    exposure_time_s: float
    iso: float
    extension: float  #: ISO over the ISO of the largest gain; 1 at or below it
    black_level_dn: float
    white_level_dn: int
    filters: ColorFilters | None
    metadata: Mapping[str, str]


def write(raw: Negative, path: str | os.PathLike[str]) -> None:
    """Writes a .dng file. Raises ImageFileError and InputError."""
    try:
        import tifffile
    except ImportError as error:
        raise InputError(f"tifffile is not installed ({error}); pip install realcam[raw] installs it") from None
    buffer = io.BytesIO()
    with tifffile.TiffWriter(buffer, byteorder="<") as file:
        file.write(
            # A monochrome mosaic is written as three equal channels: LibRaw develops a single one as grey, but
            # darktable 4.2 takes each pixel and its two neighbours for red, green and blue.
            raw.mosaic if raw.filters else np.repeat(raw.mosaic[..., None], 3, axis=2),
            photometric=CFA if raw.filters else LINEAR_RAW,
            planarconfig=None if raw.filters else "contig",
            software=f"realcam {__version__}",
            # TIFF text is ASCII only.
            description="\n".join(f"{name} = {value}" for name, value in raw.metadata.items())
            .encode("ascii", "replace")
            .decode(),
            metadata=None,
            extratags=[(code, kind, count, value, True) for code, kind, count, value in _tags(raw)],
        )
    write_whole(path, buffer.getvalue())


def write_array(array: np.ndarray, path: str | os.PathLike[str]) -> None:
    """Writes a .npy file. Raises ImageFileError."""
    buffer = io.BytesIO()
    np.save(buffer, array, allow_pickle=False)
    write_whole(path, buffer.getvalue())


def _rationals(values: Any, signed: bool = False) -> tuple[int, ...]:
    """Returns numerators and denominators of numbers in turn, precise to 1e-9 below 2, to 1e-6 above, and less for
    large numbers. Values beyond the range of 32 bits are clamped.
    """
    flat = []
    limit = 2 ** (31 if signed else 32) - 1
    for value in np.clip(np.ravel(values).astype(np.float64), -limit if signed else 0, limit):
        denominator = 10**9 if abs(value) < 2 else 10**6
        while denominator > 1 and abs(value) * denominator > limit:
            denominator //= 10
        flat += [round(float(value) * denominator), denominator]
    return tuple(flat)


def _tags(raw: Negative) -> list[tuple[int, str, int, Any]]:
    """Returns (code, type, count, value) of all DNG and EXIF tags, in the order of the codes."""
    height, width = raw.mosaic.shape
    model = f"realcam {raw.sensor}"
    filters = raw.filters
    samples = 1 if filters else 3

    def text(code: int, value: str) -> tuple[int, str, int, Any]:
        return code, ASCII, 0, value.encode("ascii", "replace").decode()

    def rational(code: int, values: Any, signed: bool = False) -> tuple[int, str, int, Any]:
        return code, SRATIONAL if signed else RATIONAL, np.size(values), _rationals(values, signed)

    tags: list[tuple[int, str, int, Any]] = [
        (254, LONG, 1, 0),  # NewSubfileType: the full picture
        text(271, "realcam"),  # Make
        text(272, model),  # Model
        (274, SHORT, 1, 1),  # Orientation
        rational(33434, raw.exposure_time_s),  # ExposureTime
        (34855, SHORT, 1, min(round(raw.iso), 65535)),  # ISOSpeedRatings
        (50706, BYTE, 4, (1, 4, 0, 0)),  # DNGVersion
        (50707, BYTE, 4, (1, 1, 0, 0)),  # DNGBackwardVersion
        text(50708, model),  # UniqueCameraModel
        rational(50714, samples * (raw.black_level_dn,)),  # BlackLevel
        (50717, LONG, samples, samples * (raw.white_level_dn,)),  # WhiteLevel
        rational(50718, (1, 1)),  # DefaultScale
        (50719, LONG, 2, (0, 0)),  # DefaultCropOrigin
        (50720, LONG, 2, (width, height)),  # DefaultCropSize
        # BaselineExposure, in stops: saturation over display white.
        rational(50730, np.log2(SATURATION_OVER_WHITE * raw.extension), signed=True),
        (50829, LONG, 4, (0, 0, height, width)),  # ActiveArea
    ]
    for code, name in ((33437, "realcam:f_number"), (37386, "realcam:focal_length_mm")):
        value = float(raw.metadata.get(name, "inf"))
        if 0 < value < 1e6:
            tags.append(rational(code, value))
    if filters:
        tags += [
            (33421, SHORT, 2, (2, 2)),  # CFARepeatPatternDim
            (33422, BYTE, 4, tuple("RGB".index(color) for color in filters.array)),  # CFAPattern
            (50710, BYTE, 3, (0, 1, 2)),  # CFAPlaneColor
            (50711, SHORT, 1, 1),  # CFALayout: rectangular
            rational(50721, filters.camera_from_xyz, signed=True),  # ColorMatrix1
            rational(50728, filters.as_shot_neutral),  # AsShotNeutral
            (50778, SHORT, 1, LIGHT_SOURCES.get(filters.illuminant, OTHER_LIGHT_SOURCE)),  # CalibrationIlluminant1
            rational(50964, filters.d50_from_balanced, signed=True),  # ForwardMatrix1
        ]
    else:
        tags += [
            rational(50721, SRGB_FROM_XYZ, signed=True),  # ColorMatrix1: maps D65 white to equal channels
            rational(50728, (1, 1, 1)),  # AsShotNeutral
            (50778, SHORT, 1, LIGHT_SOURCES["D65"]),  # CalibrationIlluminant1
        ]
    return sorted(tags, key=lambda tag: tag[0])
