"""A realcam camera with the geometry of a calibration."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..._core import Camera, Film, InputError, Lens
from ..arrays import rows_of
from .calibrated_picture import CalibratedPicture
from .lens_choice import chosen_lens
from .measuring import geometry_error, lens_chief_rays
from .sampled_geometry import defined_mask, precise_mask, sampled_geometry
from .vignetting import Vignetting, gain_of

COLUMNS = (96, 192, 384, 768)  # cells of the grid of directions; the first that is precise
PRECISION_PX = 0.004
LARGEST_ERROR_PX = 0.03  # in the middle of a cell of the mask; pixels about a larger one, near a fold, are black
DEFAULT_FILM_WIDTH_MM = 7.2  # of a sensor of the type 1/1.8 inch, as machine vision has it


def calibrated_camera(
    calibration: CalibratedPicture,
    lens: Lens | str,
    film_width_mm: float | None,
    f_number: float | None,
    focus_m: float | None,
    vignetting: Vignetting | None,
    scene_from_camera: ArrayLike | None,
    settings: dict[str, Any],
) -> Camera:
    """See Calibration.camera."""
    if isinstance(lens, str) and lens != "auto":
        lens = Lens.load(lens)
    film = _film(calibration, lens, film_width_mm)
    chosen = chosen_lens(calibration, film, f_number) if isinstance(lens, str) else lens
    chosen = chosen.with_rings(f_number=None if lens == "auto" else f_number, focus_m=focus_m)
    gain = None if vignetting is None else gain_of(vignetting, calibration, Camera(chosen, film=film))
    camera = Camera(chosen, film=film, **settings)
    mask, lens_rays = defined_mask(calibration), lens_chief_rays(calibration, camera)
    for columns in COLUMNS:
        camera = camera.replace(geometry=sampled_geometry(calibration, film, columns, mask, gain))
        error_px = geometry_error(calibration, camera, lens_rays).everywhere_px
        if error_px <= PRECISION_PX:
            break
    if error_px > LARGEST_ERROR_PX:
        mask = precise_mask(calibration, mask, COLUMNS[-1], LARGEST_ERROR_PX)
        camera = camera.replace(geometry=sampled_geometry(calibration, film, COLUMNS[-1], mask, gain))
    return camera if scene_from_camera is None else posed(camera, scene_from_camera)


def _film(calibration: CalibratedPicture, lens: Lens | str, width_mm: float | None) -> Film:
    """Returns the film whose axis is that of the calibration; pixels have the shape that K states."""
    width, height = calibration.size
    pixels, _ = calibration.project([[0.0, 0.0, 1.0]])
    focal_x, focal_y = float(calibration.camera_matrix[0, 0]), float(calibration.camera_matrix[1, 1])
    if not np.isfinite(pixels).all() or not focal_x > 0 or not focal_y > 0:
        raise InputError("the calibration has no pixel on its forward axis, which is that of the lens")
    if width_mm is None:
        width_mm = calibration.film_mm[0] if calibration.film_mm else DEFAULT_FILM_WIDTH_MM
        if calibration.film_mm is None and isinstance(lens, Lens):
            width_mm = width * abs(lens.first_order().effective_focal_length_mm) / focal_x
    height_mm = width_mm / width * height * focal_x / focal_y
    column, row = pixels[0]
    shift = ((0.5 - column / width) * width_mm, (row / height - 0.5) * height_mm)
    return Film(width_mm, height_mm, (width, height), shift)


def posed(camera: Camera, scene_from_camera: ArrayLike) -> Camera:
    """Returns the camera with its centre of projection at a pose, (4, 4) in the axes of computer vision."""
    pose = rows_of(scene_from_camera, 4, "scene_from_camera")
    if pose.shape != (4, 4) or not np.allclose(pose[3], (0, 0, 0, 1)):
        raise InputError("scene_from_camera must be a (4, 4) matrix whose last row is (0, 0, 0, 1)")
    right, down, forward, centre = pose[:3, :3][:, 0], pose[:3, 1], pose[:3, 2], pose[:3, 3]
    axes = np.column_stack([right, -down, -forward])
    if not np.allclose(axes.T @ axes, np.eye(3), atol=1e-6) or np.linalg.det(axes) < 0:
        raise InputError("the first three rows and columns of scene_from_camera must be a rotation")
    at_origin = camera.replace(position=(0, 0, 0), look_at=(0, 0, -1), up=(0, 1, 0))
    position = centre - axes @ np.array(at_origin.entrance_pupil_position_m)
    return camera.replace(position=tuple(position), look_at=tuple(position + forward), up=tuple(-down))
