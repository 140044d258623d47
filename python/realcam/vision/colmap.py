"""Cameras and poses as a text model of COLMAP."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from .._core import Camera, Film, InputError, Lens
from ..files import write_whole
from .fit import CameraModelFit, fit_camera_model
from .models import distortion_coefficients, model_named

NAMES = {
    "pinhole": "PINHOLE",
    "opencv4": "OPENCV",
    "opencv5": "FULL_OPENCV",
    "opencv8": "FULL_OPENCV",
    "fisheye": "OPENCV_FISHEYE",
}


def save_colmap(folder: str | os.PathLike[str], pictures: Mapping[str, Camera], model: str = "opencv5") -> None:
    """Writes cameras.txt, images.txt and an empty points3D.txt for pictures, given by name with their cameras.

    folder: is made if it is missing. model: as fit_camera_model has it; each combination of lens, film and camera model
    is fitted once. "opencv4" becomes COLMAP's OPENCV, "opencv5" and "opencv8" FULL_OPENCV. Poses are those of the
    middle of the entrance pupil. Raises InputError, ImageFileError.
    """
    if model not in NAMES:
        model_named(model)  # raises for a name that is none
        raise InputError(f"COLMAP has no camera model {model}; one of {', '.join(NAMES)} is wanted")
    from scipy.spatial.transform import Rotation  # slow to load

    fits: dict[tuple[Lens, Film, str], tuple[int, CameraModelFit]] = {}
    images = []
    for i, (name, camera) in enumerate(pictures.items(), start=1):
        if not name or any(c.isspace() for c in name):
            raise InputError(f"COLMAP's text files hold no names with spaces, as {name!r}")
        kind = (camera.lens, camera.film, camera.model)
        if kind not in fits:
            fits[kind] = len(fits) + 1, fit_camera_model(camera, model)
        rotation, translation = camera.world_to_camera
        x, y, z, w = Rotation.from_matrix(rotation).as_quat()
        numbers = _text(np.array([w, x, y, z, *translation]))
        images.append(f"{i} {numbers} {fits[kind][0]} {name}\n\n")  # the second line: its points
    cameras = [f"{i} {_camera_line(fit)}\n" for i, fit in fits.values()]
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    heads = {
        "cameras.txt": "# CAMERA_ID MODEL WIDTH HEIGHT PARAMS[]\n" + "".join(cameras),
        "images.txt": "# IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME; then a line of POINTS2D\n" + "".join(images),
        "points3D.txt": "# POINT3D_ID X Y Z R G B ERROR TRACK[]\n",
    }
    for file, text in heads.items():
        write_whole(folder / file, text.encode())


def _camera_line(fit: CameraModelFit) -> str:
    K = fit.camera_matrix
    coefficients = distortion_coefficients(model_named(fit.model), fit.coefficients)
    if NAMES[fit.model] == "FULL_OPENCV":
        coefficients += [0.0] * (8 - len(coefficients))
    columns, rows = fit.camera.film.resolution
    parameters = _text(np.array([K[0, 0], K[1, 1], K[0, 2], K[1, 2], *coefficients]))
    return f"{NAMES[fit.model]} {columns} {rows} {parameters}"


def _text(values: NDArray[np.float64]) -> str:
    return " ".join(f"{value:.15g}" for value in values)
