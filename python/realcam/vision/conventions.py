"""Conversions to the conventions of other programs.

In realcam and COLMAP the pixel origin is the corner of the picture: the centre of the first pixel is (0.5, 0.5). In
OpenCV it is (0, 0). In all three, columns increase to the right and rows downwards. Camera axes of OpenCV, COLMAP and
Camera.world_to_camera are x right, y down, z forward; those of OpenGL, Blender and NeRF are x right, y up, z backward.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..calibration.transforms import inverse_of, turned

Array = NDArray[np.float64]

OPENCV_PIXEL_SHIFT = -0.5
FLIPPED = np.diag([1.0, -1.0, -1.0, 1.0])  # between axes with y down and z forward, and y up and z backward


def opencv_matrix(camera_matrix: Array) -> Array:
    """Returns a (3, 3) camera matrix K of Camera.camera_matrix in OpenCV's pixel coordinates."""
    shifted: Array = camera_matrix.copy()
    shifted[:2, 2] += OPENCV_PIXEL_SHIFT
    return shifted


def opengl_pose(rotation: Array, translation: Array) -> Array:
    """Returns the (4, 4) matrix from OpenGL camera axes to the scene.

    rotation, translation: (R, t) of Camera.world_to_camera, in metres.
    """
    pose: Array = inverse_of(turned(rotation, translation)) @ FLIPPED
    return pose


Pose = tuple[NDArray[np.float64], NDArray[np.float64]]


def relative_pose(pose: Pose, seen_from: Pose) -> Pose:
    """Returns (R, t) from the camera axes of `seen_from` to those of `pose`, in metres.

    Both poses are given as (R, t) from the scene to the camera's axes, as by Camera.world_to_camera.
    """
    rotation = pose[0] @ seen_from[0].T
    return rotation, pose[1] - rotation @ seen_from[1]
