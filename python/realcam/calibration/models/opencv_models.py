"""OpenCV's camera models, which other programs use under other names.

Source: OpenCV's documentation of calib3d, "Camera Calibration and 3D Reconstruction" and "Fisheye camera model".
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
from .terms import Inexpressible, Terms

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


def tilt_of(coefficients: Sequence[float]) -> tuple[float, float] | None:
    """Returns the angles (tau_x, tau_y) of a tilted sensor; None if it is upright."""
    if len(coefficients) != 14 or not any(coefficients[12:]):
        return None
    return float(coefficients[12]), float(coefficients[13])


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


def opencv_coefficients(terms: Terms, lengths: Sequence[int] = LENGTHS[2:]) -> list[float]:
    """Returns the shortest list of OpenCV's coefficients that states the terms. lengths: those allowed, increasing.

    Raises Inexpressible.
    """
    terms.projected_by(Perspective)
    terms.without("is_sequential")
    k1, k2, k3 = terms.even(terms.top, 3)
    D = [k1, k2, *terms.tangential, k3, *terms.even(terms.bottom, 3), *terms.prism, *(terms.tilt or (0.0, 0.0))]
    needed = max((i + 1 for i, value in enumerate(D) if value), default=0)
    if needed > lengths[-1]:
        raise Inexpressible(f"has only {lengths[-1]} of OpenCV's distortion coefficients")
    return D[: next(length for length in lengths if length >= needed)]


def fisheye_coefficients(terms: Terms, count: int = 4) -> list[float]:
    """Returns k1, k2, ... of theta (1 + k1 theta^2 + k2 theta^4 + ...). Raises Inexpressible."""
    terms.projected_by(Equidistant)
    terms.without("bottom", "tangential", "prism", "tilt")
    return terms.even(terms.top, count)
