"""The projection of OCamCalib: the distance from the centre as a polynomial of the angle to the plane of the sensor."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.polynomial import Polynomial

from ..arrays import Array, Integers
from ..status import PointStatus
from .projections import refused
from .radial import monotone_inverse


@dataclass(frozen=True)
class InversePolynomial:
    """rho = sum c_i (theta - pi / 2)^i (D. Scaramuzza, A. Martinelli and R. Siegwart, ICVS 2006, world2cam).

    limit: of the angle theta to the axis, in radians. forward: the toolbox's polynomial of the other direction, which
    is no exact inverse and only goes into files. On the axis rho is not exactly 0, as the polynomial is fitted; pixels
    closer to the centre have the direction of the axis.
    """

    coefficients: tuple[float, ...]
    limit: float
    refusal: PointStatus = PointStatus.NO_PROJECTION
    forward: tuple[float, ...] = ()

    @cached_property
    def _polynomial(self) -> Polynomial:
        return Polynomial(self.coefficients)

    @property
    def largest(self) -> float:
        return float(self._distance(np.array(self.limit)))

    @property
    def largest_angle(self) -> float:
        return self.limit

    @property
    def scale(self) -> float:
        return float(self._slope(np.array(0.0)))

    def _distance(self, angle: Array) -> Array:
        distance: Array = self._polynomial(angle - np.pi / 2)
        return distance

    def _slope(self, angle: Array) -> Array:
        slope: Array = self._polynomial.deriv()(angle - np.pi / 2)
        return slope

    def status(self, rho: Array, z: Array) -> Integers:
        return refused(np.arctan2(rho, z) < self.limit, self.refusal)

    def distance(self, rho: Array, z: Array) -> Array:
        return np.where(rho > 0, self._distance(np.arctan2(rho, z)), 0.0)

    def direction(self, distance: Array) -> tuple[Array, Array]:
        start = float(self._distance(np.array(0.0)))
        angle = monotone_inverse(
            lambda s: self._distance(s) - start, self._slope, np.maximum(distance - start, 0.0), self.limit
        )
        return np.sin(angle), np.cos(angle)
