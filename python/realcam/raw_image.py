"""Raw sensor images: the mosaic of digital numbers from a film's exposure, and its development."""

from __future__ import annotations

import math
import os
import warnings
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from numbers import Real
from typing import Any

import numpy as np

from . import _core, demosaicing, dng, image_file
from ._core import Film, InputError, Sensor
from .image import Image
from .ocio import OcioView, develop, metadata_of
from .pickling import PickledByFields

# Range of exposure times in s, of ISO values and of pixel pitches in um: positive numbers that float32 represents.
MIN_POSITIVE, MAX_POSITIVE = 1e-37, 1e38


@dataclass(frozen=True, eq=False)
class RawImage(PickledByFields):
    """Raw digital numbers of a sensor, linear in light, with the data for their development.

    mosaic: (H, W) uint16, one digital number per pixel, row 0 at the top; sensor.color_filter_array tells its filter.
    iso, exposure_time_s, temperature_c, seed, serial: arguments of the exposure, see Sensor.expose.
    illuminant: spectrum of the light, as in Image; empty: D65. pixel_pitch_um: pixel pitch of the sensor.
    image_metadata: metadata of the exposed Image.
    """

    mosaic: np.ndarray
    sensor: Sensor
    iso: float
    exposure_time_s: float
    pixel_pitch_um: float
    seed: int = 0
    serial: int = 0
    temperature_c: float | None = None
    illuminant: str = ""
    image_metadata: Mapping[str, str] = field(default_factory=dict)

    __hash__ = None  # type: ignore[assignment]  # its arrays may be written to

    def __post_init__(self) -> None:
        mosaic = self.mosaic
        if not isinstance(mosaic, np.ndarray) or mosaic.dtype != np.uint16 or mosaic.ndim != 2 or mosaic.size == 0:
            raise InputError("mosaic must be an array of uint16 of shape (H, W)")
        if not isinstance(self.sensor, Sensor):
            raise InputError("sensor must be a Sensor")
        if not isinstance(self.image_metadata, Mapping):
            raise InputError("image_metadata must be a mapping of names to texts")
        for name in ("iso", "exposure_time_s", "pixel_pitch_um"):
            number = getattr(self, name)
            if not (isinstance(number, Real) and MIN_POSITIVE <= float(number) <= MAX_POSITIVE):
                raise InputError(f"{name} must be a positive number, from 1e-37 to 1e38")
        self.metadata()  # raises for other attributes of the wrong type

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, RawImage):
            return NotImplemented
        return (
            np.array_equal(self.mosaic, other.mosaic)
            and self.sensor == other.sensor
            and self.metadata() == other.metadata()
        )

    def __repr__(self) -> str:
        height, width = self.mosaic.shape
        name = self.sensor.name if len(self.sensor.name) <= 40 else f"{self.sensor.name[:37]}..."
        return f"<realcam.RawImage {width} x {height} pixels of {name!r}, ISO {self.iso:.4g}>"

    @property
    def color_filter_array(self) -> str:
        """Filters of the 2 x 2 pixels at the upper left, row by row, such as "RGGB"; "" for a monochrome sensor."""
        return self.sensor.color_filter_array

    @cached_property
    def gain_dn_per_e(self) -> float:
        """Overall system gain at this ISO, in digital numbers per electron."""
        return _core._sensor_gain(self.sensor, self.pixel_pitch_um, self.iso)

    @property
    def black_level_dn(self) -> float:
        """Digital number of a pixel without light."""
        return self.sensor.black_level_dn

    @property
    def white_level_dn(self) -> int:
        """Digital number of a saturated pixel, or the converter's largest if that is smaller."""
        saturated_dn = self.black_level_dn + self.gain_dn_per_e * self.sensor.full_well_e
        return int(min(saturated_dn, 2**self.sensor.adc_bits - 1))

    @cached_property
    def _color(self) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """White (3,), and the matrices camera_from_xyz, film_from_balanced and d50_from_balanced (3, 3)."""
        if not self.color_filter_array:
            raise InputError(f"the sensor {self.sensor.name!r} has no colour filters")
        white, camera_from_xyz, film_from_balanced, d50_from_balanced = _core._sensor_color(
            self.sensor, self.illuminant
        )
        return white, camera_from_xyz, film_from_balanced, d50_from_balanced

    @property
    def as_shot_neutral(self) -> np.ndarray:
        """(3,): responses of red, green and blue pixels to the illuminant's white, normalised to a maximum of 1."""
        return self._color[0]

    @property
    def camera_from_xyz(self) -> np.ndarray:
        """(3, 3): from XYZ under the illuminant to camera RGB; white of Y = 1 becomes as_shot_neutral."""
        return self._color[1]

    @property
    def d50_from_balanced(self) -> np.ndarray:
        """(3, 3): from white-balanced camera RGB to XYZ under D50 (DNG's ForwardMatrix)."""
        return self._color[3]

    def exposure(self, demosaic: str = "menon") -> np.ndarray:
        """Returns the film's exposure estimated from the mosaic, with noise: (H, W, 3) float32, lux seconds, linear
        Rec. 709.

        All channels are clipped at the same white, so that saturated highlights are neutral. demosaic: "menon" (Menon
        2007), "malvar" (2004) or "bilinear", by colour-demosaicing, which the extra realcam[raw] provides. A monochrome
        sensor has equal channels. Noise may be negative. Raises InputError.
        """
        light = (self.mosaic.astype(np.float32) - np.float32(self.black_level_dn)) / np.float32(self.gain_dn_per_e)
        saturation_e = (self.white_level_dn - self.black_level_dn) / self.gain_dn_per_e
        per_lux_s = self.sensor.electrons_per_um2(self.illuminant or "D65").sum(axis=1) * self.pixel_pitch_um**2
        if not self.color_filter_array:
            return np.repeat((light / np.float32(per_lux_s[0]))[..., None], 3, axis=2)
        film_from_balanced = self._color[2].astype(np.float32)
        for position, color in enumerate(self.color_filter_array):
            light[position // 2 :: 2, position % 2 :: 2] /= np.float32(per_lux_s["RGB".index(color)])
        balanced = demosaicing.demosaiced(light, self.color_filter_array, demosaic)
        np.minimum(balanced, np.float32(saturation_e / per_lux_s.max()), out=balanced)
        result: np.ndarray = balanced @ film_from_balanced.T
        return result

    def developed(
        self, tone: str | OcioView = "linear", iso: float | None = None, demosaic: str = "menon"
    ) -> np.ndarray:
        """Returns the picture as 8-bit display values, (H, W, 3) uint8, like Image.developed.

        tone: "linear" (clipped at white, half a stop below saturation) or "film", whose shoulder expects brighter
        highlights than a sensor records; or a view of OpenColorIO. iso: None is that of the exposure; another value
        scales the brightness. demosaic: as for exposure(). Raises InputError.
        """
        return develop(self.exposure(demosaic), self.iso if iso is None else iso, tone)

    def save(self, path: str | os.PathLike[str], tone: str | OcioView = "linear", demosaic: str = "menon") -> None:
        """Writes the mosaic as .dng (for raw developers) or .npy, or the developed picture as .png, .jpg, .tif or
        .webp.

        tone, demosaic: see RawImage.developed. DNG, PNG, JPEG and TIFF contain the metadata. Raises ImageFileError and
        InputError; no half-written file is left.
        """
        suffix = os.path.splitext(os.fsdecode(path))[1].lower()  # noqa: PTH122 - bytes are paths, too
        if suffix == ".dng":
            dng.write(self._negative(), path)
        elif suffix == ".npy":
            dng.write_array(self.mosaic, path)
        elif suffix in image_file.DEVELOPED:
            image_file.write_codes(
                self.developed(tone, demosaic=demosaic),
                path,
                self.metadata() | metadata_of(tone),
                is_srgb=not isinstance(tone, OcioView) or tone.is_srgb,
            )
        else:
            raise InputError(
                f"{os.fsdecode(path)}: expected .dng, .npy (the mosaic) or .png, .jpg, .tif, .webp (developed)"
            )

    def _negative(self) -> dng.Negative:
        filters = None
        if self.color_filter_array:
            white, camera_from_xyz, _, d50_from_balanced = self._color
            filters = dng.ColorFilters(
                self.color_filter_array, self.illuminant, camera_from_xyz, white, d50_from_balanced
            )
        return dng.Negative(
            mosaic=self.mosaic,
            sensor=self.sensor.name,
            exposure_time_s=self.exposure_time_s,
            iso=self.iso,
            extension=max(1.0, self.iso / self.sensor.iso_range(self.pixel_pitch_um)[1]),
            black_level_dn=self.black_level_dn,
            white_level_dn=self.white_level_dn,
            filters=filters,
            metadata=self.metadata(),
        )

    def metadata(self) -> dict[str, str]:
        """Returns the metadata in files, values by their names "realcam:...": those of the picture and of the
        sensor."""
        entries = dict(self.image_metadata)
        entries["realcam:iso"] = f"{self.iso:.9g}"
        entries["realcam:sensor"] = self.sensor.name
        entries["realcam:sensor_seed"] = str(self.seed)
        entries["realcam:sensor_serial"] = str(self.serial)
        entries["realcam:sensor_gain_dn_per_e"] = f"{self.gain_dn_per_e:.6g}"
        if self.temperature_c is not None:
            entries["realcam:sensor_temperature_c"] = f"{self.temperature_c:.6g}"
        if self.sensor.assumptions:
            entries["realcam:sensor_assumptions"] = "; ".join(self.sensor.assumptions)
        return entries


def exposed(
    sensor: Sensor,
    image: Image,
    iso: float | None,
    seed: int,
    serial: int,
    temperature_c: float | None,
    threads: int,
) -> RawImage:
    """Implements Sensor.expose; see there for the arguments. Raises InputError."""
    if not isinstance(image, Image):
        raise InputError(f"image must be a realcam.Image; it is {image!r:.60}")
    camera = image.camera
    return exposed_film(
        sensor,
        image.pixels,
        camera.film,
        exposure_time_s=camera.exposure_time_s,
        iso=camera.iso if iso is None else iso,
        illuminant=image.illuminant or "",
        exit_pupil_distance_mm=_exit_pupil_distance_mm(image),
        temperature_c=temperature_c,
        seed=seed,
        serial=serial,
        threads=threads,
        metadata=image.metadata(),
        stacklevel=3,
    )


def exposed_film(
    sensor: Sensor,
    pixels: np.ndarray,
    film: Film,
    *,
    exposure_time_s: float,
    iso: float,
    illuminant: str = "",
    exit_pupil_distance_mm: float = math.inf,
    temperature_c: float | None = None,
    seed: int = 0,
    serial: int = 0,
    threads: int = 0,
    metadata: Mapping[str, str] | None = None,
    stacklevel: int = 2,
) -> RawImage:
    """Exposes a sensor like Sensor.expose, but to an exposure without an Image, such as one read from a file.

    pixels: exposure (H, W, 3) in lux seconds. film: its size and pixels. exit_pupil_distance_mm: distance from the exit
    pupil to the film, which determines the angles of incidence. metadata: of the picture. stacklevel: of warnings.
    Raises InputError.
    """
    if not MIN_POSITIVE <= exposure_time_s <= MAX_POSITIVE:
        raise InputError(f"the exposure time must be a number of seconds from 1e-37 to 1e38, not {exposure_time_s:g}")
    if not MIN_POSITIVE <= iso <= MAX_POSITIVE:
        raise InputError(f"the ISO number must be positive, from 1e-37 to 1e38, not {iso:g}")
    height, width = np.shape(pixels)[:2]
    nan_count = int(np.isnan(pixels).any(axis=-1).sum())
    if nan_count == width * height:
        raise InputError("the film holds no exposure: all of its pixels are NaN")
    if nan_count > 0:
        warnings.warn(f"{nan_count} pixels of the film are NaN and count as unexposed", stacklevel=stacklevel)
    columns, rows = sensor.resolution or (width, height)
    if width > columns or height > rows:
        raise InputError(
            f"the picture has {width} x {height} pixels, and the sensor {sensor.name!r:.60} {columns} x {rows}"
        )
    film_pitch_um = 1000 * math.sqrt(film.width_mm * film.height_mm / (width * height))
    pitch_um = sensor.pixel_pitch_um or film_pitch_um
    if abs(pitch_um / film_pitch_um - 1) > 0.01:
        size = f"{columns * pitch_um / 1000:.4g} x {rows * pitch_um / 1000:.4g} mm"
        warnings.warn(
            f"the film's pixels of {film_pitch_um:.4g} um are exposed as the sensor's of {pitch_um:.4g} um: the noise "
            f"is the sensor's and the sharpness the film's; both are the sensor's on a film of {size} of {columns} x "
            f"{rows} pixels",
            stacklevel=stacklevel,
        )
    mosaic = _core._expose(
        sensor,
        pixels,
        pitch_um,
        film_pitch_um,
        exit_pupil_distance_mm,
        exposure_time_s,
        iso,
        illuminant,
        temperature_c,
        seed,
        serial,
        threads,
    )
    return RawImage(
        mosaic=mosaic,
        sensor=sensor,
        iso=iso,
        exposure_time_s=exposure_time_s,
        pixel_pitch_um=pitch_um,
        seed=seed,
        serial=serial,
        temperature_c=temperature_c,
        illuminant=illuminant,
        image_metadata=dict(metadata or {}),
    )


def _exit_pupil_distance_mm(image: Image) -> float:
    """Returns the distance from the exit pupil to the film in mm, to first order."""
    lens: Any = image.camera.lens
    return abs(float(lens.film_position_mm - lens.first_order().exit_pupil_position_mm))
