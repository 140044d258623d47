"""Errors of the geometry of a calibrated camera, measured with traced rays."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..._core import Camera, InputError, traced_chief_rays
from ..arrays import Array
from ..status import PointStatus
from .calibrated_picture import CalibratedPicture

DISTANCES_M = (0.5, 5.0, np.inf)
_POINTS = 4000
_MIDDLE = 0.95  # of the picture's width and height


@dataclass(frozen=True)
class GeometryError:
    """Distances in pixels between pixels and the calibration's projections of points on their chief rays.

    middle_px, everywhere_px: largest in the middle 95% of the picture's width and height, and in all of it. rms_px:
    over all of it. pupil_shift_mm: largest distance of the lens's own chief rays from the centre of projection, which
    the camera drops. rotation_deg: largest angle between the lens's and the calibration's directions.
    """

    middle_px: float
    everywhere_px: float
    rms_px: float
    pupil_shift_mm: float
    rotation_deg: float


Rays = tuple[Array, Array]  # origins and directions, (N, 3)


def lens_chief_rays(calibration: CalibratedPicture, camera: Camera) -> Rays:
    """Traces the chief rays of a camera's lens at the points of geometry_error, in the camera's axes."""
    lens = Camera(camera.ray_pairs or camera.lens, film=camera.film, model=camera.model)
    return traced_chief_rays(lens, _pixels(calibration))


def geometry_error(calibration: CalibratedPicture, camera: Camera, lens_rays: Rays | None = None) -> GeometryError:
    """Measures a calibrated camera at points drawn over its picture, 0.5 m, 5 m and infinitely far away.

    lens_rays: those of lens_chief_rays for the same lens and film; None: traced here.
    Raises InputError if the camera's picture has another size, or no chief ray.
    """
    if camera.film.resolution != calibration.size:
        raise InputError(
            f"expected a camera of {calibration.size[0]} x {calibration.size[1]} pixels; found "
            f"{camera.film.resolution[0]} x {camera.film.resolution[1]}"
        )
    still = camera.replace(position=(0, 0, 0), look_at=(0, 0, -1), up=(0, 1, 0))
    pixels, size = _pixels(calibration), np.array(calibration.size, dtype=float)
    expected, status = calibration.ray(pixels)
    lens_origins, lens_directions = lens_rays or lens_chief_rays(calibration, camera)
    origins, directions = traced_chief_rays(still, pixels, (lens_origins, lens_directions))
    used = (status == PointStatus.OK) & np.isfinite(directions[:, 0])
    if not used.any():
        raise InputError("no pixel of the camera has a chief ray")
    pixels, origins, directions, expected = pixels[used], origins[used], directions[used], expected[used]
    lens_origins, lens_directions = lens_origins[used], lens_directions[used]
    centre = np.array(still.entrance_pupil_position_m)
    errors = np.stack([_errors(calibration, pixels, origins - centre, directions, d) for d in DISTANCES_M])
    is_middle = (np.abs(pixels / size - 0.5) <= _MIDDLE / 2).all(axis=1)
    cosines = (lens_directions * expected * (1, -1, -1)).sum(axis=1)
    return GeometryError(
        middle_px=float(errors[:, is_middle].max()),
        everywhere_px=float(errors.max()),
        rms_px=float(np.sqrt(np.mean(errors**2))),
        pupil_shift_mm=float(1000 * np.linalg.norm(lens_origins - centre, axis=1).max()),
        rotation_deg=float(np.degrees(np.arccos(np.clip(cosines.min(), -1, 1)))),
    )


def _pixels(calibration: CalibratedPicture) -> Array:
    """Returns the pixels (N, 2) at which the geometry is measured."""
    pixels: Array = np.random.default_rng(20130712).random((_POINTS, 2)) * calibration.size
    return pixels


def _errors(
    calibration: CalibratedPicture, pixels: Array, origins: Array, directions: Array, distance_m: float
) -> Array:
    """Returns the errors (N,) of rays whose origins (N, 3) are relative to the centre of projection."""
    points = directions if np.isinf(distance_m) else origins + distance_m * directions
    projected, _ = calibration.project(points * (1, -1, -1))
    errors: Array = np.linalg.norm(projected - pixels, axis=1)
    errors[np.isnan(errors)] = np.inf  # a point that the calibration refuses
    return errors
