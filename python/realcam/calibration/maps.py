"""Maps between a calibrated camera's picture and the picture of a pinhole camera in its place."""

from __future__ import annotations

import numpy as np

from .arrays import Array
from .resampling import pixel_centres
from .stated_camera import StatedCamera
from .status import PointStatus


def undistorting_map(
    camera: StatedCamera, camera_matrix: Array, size: tuple[int, int], rotation: Array | None = None
) -> Array:
    """Returns the pixel of the camera's picture that each pixel of the pinhole camera shows, (H, W, 2); NaN if none.

    camera_matrix: (3, 3), of the pinhole camera. size: (width, height) of its picture. rotation: (3, 3), from the
    camera's axes to the pinhole camera's.
    """
    turn = np.eye(3) if rotation is None else rotation
    pixels = pixel_centres(size)
    rays = np.column_stack([pixels, np.ones(len(pixels))]) @ (np.linalg.inv(camera_matrix).T @ turn)
    found, status = camera.camera_model.project(rays)
    found[status != PointStatus.OK] = np.nan
    return found.reshape(size[1], size[0], 2)


def redistorting_map(camera: StatedCamera, camera_matrix: Array) -> Array:
    """Returns the pixel of the pinhole camera's picture that each pixel of the camera shows, (H, W, 2); NaN if none."""
    rays, _ = camera.camera_model.ray(pixel_centres(camera.size))
    in_front = rays[:, 2] > 0
    plane = rays[:, :2] / np.where(in_front, rays[:, 2], np.nan)[:, None]
    found: Array = plane @ camera_matrix[:2, :2].T + camera_matrix[:2, 2]
    return found.reshape(camera.size[1], camera.size[0], 2)
