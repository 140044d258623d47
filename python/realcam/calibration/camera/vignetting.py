"""Measured falloff of light towards the corners of a picture, in place of the lens's own."""

from __future__ import annotations

import os
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.polynomial import chebyshev

from ..._core import Camera, InputError
from ...files import record_input
from ...rec709 import linear_of_srgb
from ..arrays import Array
from ..errors import CalibrationFileError
from ..files.document import Document
from ..files.entries import Entries, element_entries
from ..status import PointStatus
from .calibrated_picture import CalibratedPicture

LARGEST_GAIN = 4.0  # over the lens's own light; beyond it the lens passes too little for its pupil to be trusted
_DEGREE = 6  # of the polynomial through a flat field, in each direction: smooth, and far above the noise of a picture
_LARGEST_SIDE = 32768  # pixels of a flat field


@dataclass(frozen=True)
class Vignetting:
    """Transmission over the picture, as measured.

    transmission: function of pixels (..., 2) and the size (width, height) of a picture that returns values (...) up to
    a common factor. f_number, focus_m: of the measurement, None if unknown. name: of the file, for messages.
    """

    transmission: Callable[[Array, tuple[int, int]], Array]
    f_number: float | None = None
    focus_m: float | None = None
    name: str = ""

    @staticmethod
    def load(
        path: str | os.PathLike[str],
        *,
        lens: str | None = None,
        focal_length_mm: float | None = None,
        f_number: float | None = None,
        focus_m: float | None = None,
        crop_factor: float | None = None,
        linear: bool = True,
    ) -> Vignetting:
        """Loads a flat field (.exr, .hdr, .png, .tif), or the vignetting of a lens in lensfun's database (.xml).

        A flat field is a picture of an evenly lit surface; the mean of its channels counts, smoothed by a polynomial
        of degree 6 in each direction. linear: False: values of 8 and 16 bits are sRGB. f_number, focus_m: of the
        measurement; for lensfun, the entry that is nearest to them is taken (None: the first). lens, focal_length_mm:
        choose among several in a database. crop_factor: of the camera, for lensfun; None: that of the lens's entry.
        Raises CalibrationFileError, InputError.
        """
        if Path(path).suffix.lower() == ".xml":
            return _lensfun(Document(path), lens, focal_length_mm, f_number, focus_m, crop_factor)
        return Vignetting(_polynomial(_flat_field(Path(path), linear), path), f_number, focus_m, Path(path).name)


def gain_of(vignetting: Vignetting, calibration: CalibratedPicture, camera: Camera) -> Callable[[Array], Array]:
    """Returns a function of pixels (..., 2): the measured transmission over the light of a camera's own lens, both
    relative to the lens's axis. Beyond the picture it is that at its edge.

    camera: with the film of the calibration, but without its geometry. The function raises InputError if a gain exceeds
    LARGEST_GAIN, or if the lens brings no light to a pixel of the calibration.
    """
    _warn_of_other_settings(vignetting, camera)
    low, high = 1e-3, np.array(calibration.size) - 1e-3  # within the picture despite rounding
    axis = np.clip(np.array(camera.film.principal_point), low, high)
    on_axis = float(vignetting.transmission(axis, calibration.size))
    light_on_axis = float(camera.ray(axis[None], return_light=True)[2][0])

    def gain(pixels: Array) -> Array:
        inside = np.clip(pixels, low, high)
        measured = vignetting.transmission(inside, calibration.size) / on_axis
        light = camera.ray(inside.reshape(-1, 2), return_light=True)[2].reshape(measured.shape)
        light = np.nan_to_num(light / light_on_axis)
        _, status = calibration.ray(inside.reshape(-1, 2))
        seen = (status == PointStatus.OK).reshape(measured.shape)
        with np.errstate(divide="ignore", invalid="ignore"):
            gain = np.where(seen & (light > 0), measured / light, np.where(seen & (measured > 0), np.inf, 1.0))
        if gain.max() > LARGEST_GAIN:
            _refuse(calibration, camera, inside, gain)
        return np.maximum(gain, 0.0)

    return gain


def _refuse(calibration: CalibratedPicture, camera: Camera, pixels: Array, gain: Array) -> None:
    row, column = np.unravel_index(int(gain.argmax()), gain.shape)
    pixel = pixels[row, column]
    directions, _ = calibration.ray(pixel[None])
    angle = np.degrees(np.arccos(np.clip(directions[0, 2], -1, 1)))
    where = f"at pixel ({pixel[0]:.0f}, {pixel[1]:.0f}), {angle:.3g} degrees from the axis"
    if np.isinf(gain.max()):
        raise InputError(f"the measured vignetting has light where lens {camera.lens.name} transmits none, {where}")
    raise InputError(
        f"the measured vignetting is {gain.max():.3g} times as bright as lens {camera.lens.name} {where}; expected at "
        f"most {LARGEST_GAIN:g}"
    )


def _warn_of_other_settings(vignetting: Vignetting, camera: Camera) -> None:
    lens = camera.lens
    differences = []
    if vignetting.f_number is not None and abs(np.log2(lens.f_number / vignetting.f_number)) > 1 / 6:
        differences.append(f"f/{vignetting.f_number:.3g}, not f/{lens.f_number:.3g}")
    if vignetting.focus_m is not None:
        # The falloff depends on the magnification, about f over the distance.
        focal_m = abs(lens.first_order().effective_focal_length_mm) / 1000
        if abs(focal_m / vignetting.focus_m - focal_m / lens.focus_distance_m) > 0.02:
            differences.append(f"{vignetting.focus_m:.3g} m, not {lens.focus_distance_m:.3g} m")
    if differences:
        warnings.warn(f"the vignetting of {vignetting.name} was measured at {' and '.join(differences)}", stacklevel=5)


def _flat_field(path: Path, linear: bool) -> Array:
    """Returns the mean of a picture's colour channels, (H, W), linear."""
    import OpenImageIO as oiio  # slow to load

    record_input(path)
    opened = oiio.ImageInput.open(str(path))
    if opened is None:
        raise CalibrationFileError(f"{path}: cannot be read: {oiio.geterror():.80}".replace("\n", " "))
    try:
        spec = opened.spec()
        if not (2 <= spec.width <= _LARGEST_SIDE and 2 <= spec.height <= _LARGEST_SIDE):
            raise CalibrationFileError(f"{path}: expected 2 to {_LARGEST_SIDE} pixels a side")
        channels = min(spec.nchannels, 3)
        values = opened.read_image(0, 0, 0, channels, oiio.FLOAT)
        is_encoded = not linear and spec.format.basetype in (oiio.UINT8, oiio.UINT16)
    finally:
        opened.close()
    if values is None or not np.isfinite(values).all():
        raise CalibrationFileError(f"{path}: is damaged, or holds values that are not finite")
    pixels = np.asarray(values, dtype=float).reshape(spec.height, spec.width, channels)
    if is_encoded:
        pixels = linear_of_srgb(pixels)
    mean: Array = pixels.mean(axis=-1)
    return mean


def _polynomial(values: Array, path: str | os.PathLike[str]) -> Callable[[Array, tuple[int, int]], Array]:
    """Returns the least-squares polynomial through pixels (H, W), see Vignetting.transmission."""
    height, width = values.shape
    x, y = 2 * (np.arange(width) + 0.5) / width - 1, 2 * (np.arange(height) + 0.5) / height - 1
    # A product of two one-dimensional fits is the fit in both, because the pixels form a grid.
    along_x = np.linalg.pinv(chebyshev.chebvander(x, min(_DEGREE, width - 1)))
    along_y = np.linalg.pinv(chebyshev.chebvander(y, min(_DEGREE, height - 1)))
    coefficients = along_x @ values.T @ along_y.T
    if not chebyshev.chebval2d(0.0, 0.0, coefficients) > 0:
        raise CalibrationFileError(f"{os.fspath(path)}: expected a flat field that is bright in its middle")

    def transmission(pixels: Array, size: tuple[int, int]) -> Array:
        x, y = 2 * pixels[..., 0] / size[0] - 1, 2 * pixels[..., 1] / size[1] - 1
        return np.asarray(chebyshev.chebval2d(x, y, coefficients))

    return transmission


def _lensfun(
    document: Document,
    lens: str | None,
    focal_length_mm: float | None,
    f_number: float | None,
    focus_m: float | None,
    crop_factor: float | None,
) -> Vignetting:
    """Returns 1 + k1 r^2 + k2 r^4 + k3 r^6, r = 1 in the centre of the corner pixel (lensfun 0.3, mod-color.cpp)."""
    found = []
    for element in document.xml.iter("lens"):
        entries = element_entries(document, element)
        if lens is not None and entries.text("model") != lens:
            continue
        for vignetting in element.iterfind("calibration/vignetting"):
            found.append((entries, element_entries(document, vignetting)))
    if not found:
        document.fail("expected a lens with vignetting" + (f', named "{lens}"' if lens is not None else ""))
    models = sorted({entries.text("model") for entries, _ in found})
    if len(models) > 1:
        raise InputError(f"{document.path}: expected lens=..., one of {', '.join(models[:8])}")
    sought = {"focal": focal_length_mm, "aperture": f_number, "distance": focus_m}

    def mismatch(stated: Entries) -> float:
        pairs = [(stated.positive(key), value) for key, value in sought.items() if value is not None]
        return float(sum(abs(np.log(min(value, 1e4) / known)) for known, value in pairs))

    entries, nearest = min(found, key=lambda pair: mismatch(pair[1]))
    nearest.choice("model", ("pa",))
    k1, k2, k3 = (nearest.number(key, 0.0) for key in ("k1", "k2", "k3"))
    lens_crop = entries.positive("cropfactor") if "cropfactor" in entries else 1.0
    scale = 1.0 if crop_factor is None else lens_crop / crop_factor

    def transmission(pixels: Array, size: tuple[int, int]) -> Array:
        corner = np.hypot(size[0] - 1, size[1] - 1) / 2
        squared = (((pixels - np.array(size) / 2) / corner * scale) ** 2).sum(axis=-1)
        return np.asarray(1 + squared * (k1 + squared * (k2 + squared * k3)))

    return Vignetting(transmission, nearest.positive("aperture"), nearest.positive("distance"), document.path.name)
