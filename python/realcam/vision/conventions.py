"""Where the conventions of other programs differ from realcam's.

realcam and COLMAP count pixels from the corner of the picture: the middle of the first is (0.5, 0.5). In OpenCV it is
(0, 0). All three have columns to the right and rows down. Cameras of OpenCV and COLMAP, and Camera.world_to_camera,
have x right, y down and z forward. Those of OpenGL, Blender and NeRF have x right, y up and z backward.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

OPENCV_PIXEL_SHIFT = -0.5


def opencv_matrix(camera_matrix: Array) -> Array:
    """K for pixels as OpenCV counts them."""
    shifted: Array = camera_matrix.copy()
    shifted[:2, 2] += OPENCV_PIXEL_SHIFT
    return shifted


def opengl_pose(rotation: Array, translation: Array) -> Array:
    """(4, 4): from the axes of an OpenGL camera to the scene."""
    pose = np.eye(4)
    pose[:3, :3] = rotation.T @ np.diag([1.0, -1.0, -1.0])
    pose[:3, 3] = -rotation.T @ translation
    return pose


Pose = tuple[NDArray[np.float64], NDArray[np.float64]]


def relative_pose(pose: Pose, seen_from: Pose) -> Pose:
    """(R, t) from the axes of one camera to those of another, of their (R, t) from the scene."""
    turn = pose[0] @ seen_from[0].T
    return turn, pose[1] - turn @ seen_from[1]
