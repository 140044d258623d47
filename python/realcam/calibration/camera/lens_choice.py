"""The bundled lens that resembles a calibration most, scaled to its focal length."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..._core import Camera, Film, InputError, Lens, LensFileError, lens_names, traced_chief_rays
from ..arrays import Array
from ..status import PointStatus
from .calibrated_picture import CalibratedPicture

LARGEST_ROTATION_DEG = 10.0  # of a bundle; beyond it the lens's field does not resemble the calibration's
_LEAST_LIGHT = 0.02  # of that in the middle of the film, at every pixel that the calibration sees
_SMALLEST_APERTURE = 64.0  # f-number at which a lens must still light the picture: a camera's rings end there
_POINTS = 17  # along each side of the picture


@dataclass(frozen=True)
class _Candidate:
    lens: Lens
    rotation_deg: float
    lacks: str  # what makes it unsuitable; empty if nothing does


def chosen_lens(calibration: CalibratedPicture, film: Film, f_number: float | None) -> Lens:
    """Returns the lens, in focus at infinity and stopped down to f_number if that is not None.

    Raises InputError that says what would fit if no bundled lens does.
    """
    pitch_mm = film.width_mm / film.resolution[0]
    focal_length_mm = float(calibration.camera_matrix[0, 0]) * pitch_mm
    pixels, directions = _sampled(calibration)
    candidates = []
    for name in lens_names():
        candidate = _candidate(Lens.load(name), film, focal_length_mm, f_number, pixels, directions)
        if candidate is not None:
            candidates.append(candidate)
    candidates.sort(key=lambda candidate: (bool(candidate.lacks), candidate.rotation_deg))
    for index, candidate in enumerate(candidates):
        if candidate.lacks or candidate.rotation_deg > LARGEST_ROTATION_DEG:
            break
        smallest = candidate.lens.stopped_down(max(_SMALLEST_APERTURE, candidate.lens.f_number))
        dark = [lens.f_number for lens in (candidate.lens, smallest) if not _lights(lens, film, pixels)]
        if not dark:
            return candidate.lens
        candidates[index] = replace(candidate, lacks=f"it brings no light to parts of the picture at f/{dark[0]:.3g}")
    raise InputError(_refusal(calibration, focal_length_mm, f_number, directions, candidates))


def _sampled(calibration: CalibratedPicture) -> tuple[Array, Array]:
    """Returns pixels (N, 2) over the picture, to its corners, and their directions in the camera's axes."""
    width, height = calibration.size
    x, y = np.meshgrid(np.linspace(0, width, _POINTS), np.linspace(0, height, _POINTS))
    pixels = np.column_stack([x.ravel(), y.ravel()])
    directions, status = calibration.ray(pixels)
    seen = status <= PointStatus.OUTSIDE_PICTURE
    return pixels[seen], directions[seen] * (1, -1, -1)


def _candidate(
    lens: Lens, film: Film, focal_length_mm: float, f_number: float | None, pixels: Array, directions: Array
) -> _Candidate | None:
    """Returns a lens scaled to the focal length; None if it cannot take the picture at all."""
    try:
        own = abs(lens.first_order().effective_focal_length_mm)
        scaled = lens.scaled(focal_length_mm / own).focused(np.inf)
        _, rays = traced_chief_rays(Camera(scaled, film=film), pixels)
    except (InputError, LensFileError):
        return None
    cosines = (rays * directions).sum(axis=1)
    if np.isnan(cosines).any():
        return None
    rotation = float(np.degrees(np.arccos(np.clip(cosines.min(), -1, 1))))
    lacks = ""
    if f_number is not None:
        try:
            scaled = scaled.stopped_down(f_number)
        except (InputError, LensFileError):
            lacks = f"it opens to f/{scaled.f_number:.3g} only"
    return _Candidate(scaled, rotation, lacks)


def _lights(lens: Lens, film: Film, pixels: Array) -> bool:
    """True if the lens brings light to all these pixels."""
    inside = np.clip(pixels, 1e-3, np.array(film.resolution) - 1e-3)
    try:
        light = Camera(lens, film=film).ray(inside, return_light=True)[2]
    except (InputError, LensFileError):
        return False
    return bool(np.isfinite(light).all() and light.min() >= _LEAST_LIGHT)


def _refusal(
    calibration: CalibratedPicture,
    focal_length_mm: float,
    f_number: float | None,
    directions: Array,
    candidates: list[_Candidate],
) -> str:
    angle = float(np.degrees(np.arccos(np.clip((-directions[:, 2]).min(), -1, 1))))
    text = (
        f"no bundled lens resembles the calibration; expected a lens of f = {focal_length_mm:.3g} mm that sees "
        f"{angle:.3g} degrees from its axis"
    )
    if f_number is not None:
        text += f" and opens to f/{f_number:.3g}"
    if candidates:
        nearest = candidates[0]
        text += f"; the nearest is {nearest.lens.name}, rotated by up to {nearest.rotation_deg:.3g} degrees"
        text += f", but {nearest.lacks}" if nearest.lacks else ""
    return text + "; give one as lens=..."
