"""Camera models of computer vision, as functions of the angle to the axis.

A model is rotationally symmetric: it gives the distance r(s) from the principal point in units of the focal length,
where s is the angle theta to the axis or its tangent. Tangential terms are 0. Sources: OpenCV's documentation of
calib3d and fisheye (J. Kannala and S. Brandt, IEEE PAMI 28 (2006) 1335, with the odd powers up to the ninth); f_theta
is the polynomial of automotive simulators and data sets, with all powers from the first to the fifth.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .._core import InputError
from ..calibration.models.radial import RationalRadius

Array = NDArray[np.float64]


@dataclass(frozen=True)
class RadialModel:
    """r(s) = s (1 + sum k_i s^numerator_i) / (1 + sum k_j s^denominator_j)."""

    name: str
    numerator: tuple[int, ...] = ()
    denominator: tuple[int, ...] = ()
    by_tangent: bool = True

    @property
    def terms(self) -> int:
        """Number of coefficients."""
        return len(self.numerator) + len(self.denominator)

    def argument(self, angle: Array) -> Array:
        """Returns s of angles in radians; NaN at 90 degrees or more if s is the tangent."""
        if not self.by_tangent:
            return angle
        with np.errstate(invalid="ignore"):
            return np.where(angle < np.pi / 2, np.tan(angle), np.nan)

    def radius(self, s: Array, coefficients: Array) -> Array:
        """Returns r(s)."""
        with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
            return self._function(coefficients).value(s)

    def linear_terms(self, s: Array, r: Array) -> Array:
        """Returns the columns of the linear system for r: r is their sum weighted by f, f k_i and k_j."""
        top = [s ** (power + 1) for power in (0, *self.numerator)]
        return np.stack([*top, *(-r * s**power for power in self.denominator)], axis=-1)

    def largest_angle(self, coefficients: Array) -> float:
        """Returns the largest angle in radians up to which r increases with the angle."""
        fold = self._function(coefficients).first_fold
        return float(np.arctan(fold)) if self.by_tangent else min(fold, np.pi)

    def _function(self, coefficients: Array) -> RationalRadius:
        numerator = dict(zip(self.numerator, coefficients, strict=False))
        denominator = dict(zip(self.denominator, coefficients[len(self.numerator) :], strict=True))
        top, bottom = (
            (1.0, *(float(powers.get(k, 0.0)) for k in range(1, max(powers, default=0) + 1)))
            for powers in (numerator, denominator)
        )
        return RationalRadius(top, bottom)


MODELS = {
    model.name: model
    for model in (
        RadialModel("pinhole"),
        RadialModel("opencv4", (2, 4)),
        RadialModel("opencv5", (2, 4, 6)),
        RadialModel("opencv8", (2, 4, 6), (2, 4, 6)),
        RadialModel("fisheye", (2, 4, 6, 8), by_tangent=False),
        RadialModel("f_theta", (1, 2, 3, 4), by_tangent=False),
    )
}


def model_named(name: str) -> RadialModel:
    """Returns the model of a name. Raises InputError if it is unknown."""
    if name not in MODELS:
        raise InputError(f'unknown camera model "{name}"; expected one of {", ".join(MODELS)}')
    return MODELS[name]


def distortion_coefficients(model: RadialModel, coefficients: Array) -> list[float]:
    """Returns the coefficients in OpenCV's order: k1, k2, p1, p2, k3, ..., k6; for cv2.fisheye k1 to k4.

    Raises InputError for f_theta, which OpenCV does not have.
    """
    k = [float(value) for value in coefficients]
    if model.name == "f_theta":
        raise InputError("OpenCV and COLMAP have no model f_theta; their closest model is fisheye")
    if model.name == "fisheye" or not k:
        return k
    return [*k[:2], 0.0, 0.0, *k[2:]]
