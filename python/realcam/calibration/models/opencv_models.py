"""OpenCV's camera models, which other programs use under other names.

Source: OpenCV's documentation of calib3d, "Camera Calibration and 3D Reconstruction" and "Fisheye camera model"; the
tilted sensor is that of Louhichi et al., Measurement Science and Technology 18 (2007) 2616.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..._core import InputError
from ..arrays import Array
from .central import CentralModel
from .distortion import BrownConrady
from .projections import Equidistant, Perspective, UnifiedSphere
from .radial import RationalRadius, even_powers

LENGTHS = (0, 4, 5, 8, 12, 14)


def distortion_of(coefficients: Sequence[float]) -> BrownConrady:
    """Returns the distortion of k1 k2 p1 p2 [k3 [k4 k5 k6 [s1 s2 s3 s4 [tau_x tau_y]]]].

    Raises InputError for another number of coefficients.
    """
    if len(coefficients) not in LENGTHS:
        raise InputError(f"OpenCV's model has {LENGTHS[1:]} distortion coefficients, not {len(coefficients)}")
    k1, k2, p1, p2, k3, k4, k5, k6, *rest = [*map(float, coefficients), *[0.0] * 14][:14]
    return BrownConrady(
        radius=RationalRadius(even_powers([k1, k2, k3]), even_powers([k4, k5, k6]) if k4 or k5 or k6 else (1.0,)),
        tangential=(p1, p2),
        prism=(rest[0], rest[1], rest[2], rest[3]),
    )


def tilt_of(coefficients: Sequence[float]) -> Array | None:
    """Returns the homography of a tilted sensor, [R33 0 -R13; 0 R33 -R23; 0 0 1] R with R = Ry(tau_y) Rx(tau_x)."""
    if len(coefficients) != 14 or not any(coefficients[12:]):
        return None
    x, y = coefficients[12:]
    about_x = np.array([[1, 0, 0], [0, np.cos(x), np.sin(x)], [0, -np.sin(x), np.cos(x)]])
    about_y = np.array([[np.cos(y), 0, -np.sin(y)], [0, 1, 0], [np.sin(y), 0, np.cos(y)]])
    R = about_y @ about_x
    tilt: Array = np.array([[R[2, 2], 0, -R[0, 2]], [0, R[2, 2], -R[1, 2]], [0, 0, 1]]) @ R
    return tilt


def pinhole_model(matrix: Array, coefficients: Sequence[float] = ()) -> CentralModel:
    """Returns the model of cv2.projectPoints. Raises InputError."""
    return CentralModel(Perspective(), distortion_of(coefficients), matrix, tilt_of(coefficients))


def fisheye_distortion(coefficients: Sequence[float]) -> BrownConrady:
    """Returns theta (1 + k1 theta^2 + k2 theta^4 + ...)."""
    return BrownConrady(RationalRadius(even_powers(coefficients)))


def fisheye_model(matrix: Array, coefficients: Sequence[float], largest_angle: float = np.pi / 2) -> CentralModel:
    """Returns the model of cv2.fisheye, theta (1 + k1 theta^2 + ... + k4 theta^8). largest_angle: radians."""
    return CentralModel(Equidistant(largest_angle), fisheye_distortion(coefficients), matrix)


def omnidirectional_model(matrix: Array, xi: float, coefficients: Sequence[float]) -> CentralModel:
    """Returns the model of cv2.omnidir with k1, k2, p1, p2 (C. Mei and P. Rives, ICRA 2007)."""
    return CentralModel(UnifiedSphere(xi), distortion_of(coefficients), matrix)
