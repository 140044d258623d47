"""Pose and intrinsics of a camera as JSON."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable
from typing import Any

from .._core import Camera, __version__
from ..calibration import Calibration
from ..files import write_whole
from ..json_values import json_value
from . import conventions
from .fit import CameraModelFit
from .models import distortion_coefficients, model_named


def camera_json(
    camera: Camera, fits: Iterable[CameraModelFit] = (), calibration: Calibration | None = None
) -> dict[str, Any]:
    """Returns pose and intrinsics as values for json.dump; docs/vision.md describes each entry. Infinity becomes None.

    fits: results of fit_camera_model for this camera. calibration: that of Calibration.camera for a camera made by it,
    as it was loaded, even if the camera's picture has another size. Raises InputError if the entrance pupil lies at
    infinity.
    """
    lens, film = camera.lens, camera.film
    rotation, translation = camera.world_to_camera
    matrix = camera.camera_matrix
    data = lens.first_order()
    values = {
        "realcam": __version__,
        "width": film.resolution[0],
        "height": film.resolution[1],
        "film_mm": [film.width_mm, film.height_mm],
        "film_shift_mm": film.shift_mm,
        "lens": {
            "name": lens.name,
            "focal_length_mm": data.effective_focal_length_mm,
            "f_number": lens.f_number,
            "focus_distance_m": lens.focus_distance_m,
        },
        "model": camera.model,
        "exposure_time_s": camera.exposure_time_s,
        "iso": camera.iso,
        "pose": {
            "position_m": camera.position,
            "film_centre_m": camera.film_centre_m,
            "entrance_pupil_m": camera.entrance_pupil_position_m or (),
            "world_to_camera": {"rotation": rotation, "translation_m": translation},
            "camera_to_world_opengl": conventions.opengl_pose(rotation, translation),
        },
        "camera_matrix": matrix,
        "opencv_camera_matrix": conventions.opencv_matrix(matrix),
        "fits": [_fit_json(fit) for fit in fits],
        **({} if calibration is None else {"calibration": _calibration_json(calibration)}),
    }
    converted: dict[str, Any] = json_value(values)
    return converted


def save_camera_json(path: str | os.PathLike[str], camera: Camera, fits: Iterable[CameraModelFit] = ()) -> None:
    """Writes the values of camera_json to a JSON file. Raises InputError, ImageFileError."""
    write_whole(path, (json.dumps(camera_json(camera, fits), indent=1) + "\n").encode())


def _calibration_json(calibration: Calibration) -> dict[str, Any]:
    return {
        "format": calibration.format,
        "camera": calibration.name,
        "model": calibration.model,
        "width": calibration.size[0],
        "height": calibration.size[1],
        "camera_matrix": calibration.camera_matrix,
        "pixel_origin": calibration.pixel_origin,
        "file_values": dict(calibration.file_values),
        "largest_angle_deg": calibration.largest_angle_deg,
    }


def _fit_json(fit: CameraModelFit) -> dict[str, Any]:
    entry = {
        "model": fit.model,
        "camera_matrix": fit.camera_matrix,
        "coefficients": fit.coefficients,
        "rms_px": fit.rms_px,
        "max_px": fit.max_px,
        "distance_m": fit.distance_m,
        "largest_angle_deg": fit.largest_angle_deg,
        "condition": fit.condition,
    }
    if fit.model != "f_theta":
        entry["opencv_camera_matrix"] = conventions.opencv_matrix(fit.camera_matrix)
        entry["opencv_coefficients"] = distortion_coefficients(model_named(fit.model), fit.coefficients)
    return entry
