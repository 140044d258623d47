"""Projections whose polynomial is a function of the pixel: the angle to the axis grows with the distance in pixels.

Both stop at a limit of the angle, or at the fold, where the angle no longer grows with the distance.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.polynomial import Polynomial

from ..arrays import Array, Integers
from ..status import PointStatus
from .radial import RationalRadius, monotone_inverse


def _first_positive_root(polynomial: Polynomial) -> float:
    roots = (r for r in polynomial.roots() if r.real > 0 and abs(r.imag) < 1e-9 * abs(r))
    return min((float(r.real) for r in roots), default=np.inf)


class _AngleOfDistance:
    """A projection given by its inverse, the angle as a function of the distance."""

    limit: float  # of the angle, stated by the file

    @property
    def refusal(self) -> PointStatus:
        return PointStatus.NO_PROJECTION if self.limit <= self._fold_angle else PointStatus.BEYOND_FOLD

    @cached_property
    def _fold(self) -> float:
        """The distance at which the angle stops growing."""
        raise NotImplementedError

    def _angle(self, distance: Array) -> Array:
        raise NotImplementedError

    def _slope(self, distance: Array) -> Array:
        raise NotImplementedError

    @cached_property
    def _fold_angle(self) -> float:
        return float(self._angle(np.array(self._fold))) if np.isfinite(self._fold) else np.inf

    @cached_property
    def largest(self) -> float:
        if self.limit > self._fold_angle:
            return self._fold
        found = monotone_inverse(self._angle, self._slope, np.array([self.limit]), self._fold)
        return float(found[0]) if np.isfinite(found[0]) else self._fold

    @property
    def largest_angle(self) -> float:
        return min(self.limit, self._fold_angle)

    @property
    def scale(self) -> float:
        return 1 / float(self._slope(np.array(0.0)))

    def status(self, rho: Array, z: Array) -> Integers:
        angle = np.arctan2(rho, z)
        inside = np.where(angle < self._fold_angle, PointStatus.OK, PointStatus.BEYOND_FOLD)
        return np.where(angle < self.limit, inside, PointStatus.NO_PROJECTION).astype(np.intp)

    def distance(self, rho: Array, z: Array) -> Array:
        return monotone_inverse(self._angle, self._slope, np.arctan2(rho, z), self._fold)

    def direction(self, distance: Array) -> tuple[Array, Array]:
        angle = np.where(distance < self.largest, self._angle(distance), np.nan)
        return np.sin(angle), np.cos(angle)


@dataclass(frozen=True)
class AnglePolynomial(_AngleOfDistance):
    """theta = a1 d + a2 d^2 + ...: the f-theta model of automotive simulators with its polynomial from pixels.

    coefficients: a1, a2, ... in radians per power of a pixel. limit: of the angle, in radians.
    """

    coefficients: tuple[float, ...]
    limit: float = np.pi

    @cached_property
    def _function(self) -> RationalRadius:
        return RationalRadius(self.coefficients)

    @cached_property
    def _fold(self) -> float:
        return self._function.first_fold

    def _angle(self, distance: Array) -> Array:
        return self._function.value(distance)

    def _slope(self, distance: Array) -> Array:
        return self._function.slope(distance)


@dataclass(frozen=True)
class RayPolynomial(_AngleOfDistance):
    """The ray (x, y, a0 + a2 d^2 + a3 d^3 + a4 d^4) of a pixel at distance d: D. Scaramuzza, A. Martinelli and
    R. Siegwart, ICVS 2006, as in MATLAB's fisheyeIntrinsics.

    coefficients: of ascending powers, that of d being 0. limit: of the angle, in radians. longest: distance beyond
    which the polynomial is not used, as if it folded there.
    """

    coefficients: tuple[float, ...]
    limit: float = np.pi
    longest: float = np.inf

    @cached_property
    def _height(self) -> Polynomial:
        return Polynomial(self.coefficients)

    @cached_property
    def _fold(self) -> float:
        # The numerator of the derivative of atan2(d, height) by d.
        fold = _first_positive_root(self._height - Polynomial([0.0, 1.0]) * self._height.deriv())
        return min(fold, self.longest)

    def _angle(self, distance: Array) -> Array:
        angle: Array = np.arctan2(distance, self._height(distance))
        return angle

    def _slope(self, distance: Array) -> Array:
        height: Array = self._height(distance)
        slope: Array = (height - distance * self._height.deriv()(distance)) / (distance**2 + height**2)
        return slope
