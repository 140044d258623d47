"""Distortions of a plane, as a map from ideal to distorted points and its inverse: the second stage of a camera model.

Sources: D. C. Brown, Photogrammetric Engineering 37 (1971) 855; OpenCV's documentation of calib3d, "Camera Calibration
and 3D Reconstruction"; COLMAP's src/colmap/sensor/models.h; Project Aria's FISHEYE624.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import Protocol

import numpy as np

from ..arrays import Array, Booleans
from .folds import Folds
from .plane_inverse import plane_inverse
from .radial import RationalRadius, monotone_inverse


class Distortion(Protocol):
    """A one-to-one map of a disc of the plane, of (N, 2) points."""

    @property
    def scale(self) -> float:
        """Magnification at the centre."""

    def first_fold(self, largest: float) -> float:
        """Returns the smallest distance from the centre at which the map folds; inf if it does not before `largest`."""

    def distorted_before_fold(self, points: Array, largest: float) -> Array:
        """Returns the distorted points of ideal points; NaN if the map folds between the centre and the point, within
        the distance `largest`."""

    def ideal(self, points: Array, largest: float) -> Array:
        """Returns the ideal points of distorted points, less than `largest` from the centre; NaN if there is none."""


@dataclass(frozen=True)
class BrownConrady:
    """Radial, tangential and thin-prism distortion.

    tangential: p1, p2 in OpenCV's order. prism: s1 to s4. is_sequential: the tangential and prism terms are functions
    of the radially distorted point instead of the ideal one, as in Project Aria's FISHEYE624.
    """

    radius: RationalRadius = field(default_factory=RationalRadius)
    tangential: tuple[float, float] = (0.0, 0.0)
    prism: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 0.0)
    is_sequential: bool = False

    @property
    def scale(self) -> float:
        return self.radius.top[0] / self.radius.bottom[0]

    @cached_property
    def is_radial(self) -> bool:
        """True if all points keep their azimuth."""
        return not any(self.tangential) and not any(self.prism)

    def distorted(self, points: Array) -> Array:
        radial = points * self.radius.factor(np.hypot(points[:, 0], points[:, 1]))[:, None]
        if self.is_radial:
            return radial
        return radial + self._shift(radial if self.is_sequential else points)

    def jacobian(self, points: Array) -> Array:
        """Returns the (N, 2, 2) derivatives of distorted points by ideal ones."""
        s = np.hypot(points[:, 0], points[:, 1])
        weight = self.radius.factor_slope(s) / np.where(s > 0, s, 1)
        radial = weight[:, None, None] * points[:, :, None] * points[:, None, :]
        factor = self.radius.factor(s)
        radial[:, 0, 0] += factor
        radial[:, 1, 1] += factor
        if self.is_radial:
            return radial
        if not self.is_sequential:
            return radial + self._shift_jacobian(points)
        return radial + self._shift_jacobian(points * factor[:, None]) @ radial

    def distorted_before_fold(self, points: Array, largest: float) -> Array:
        found = np.full(points.shape, np.nan)
        is_before = self._is_before_fold(points, largest)
        found[is_before] = self.distorted(points[is_before])
        return found

    def _is_before_fold(self, points: Array, largest: float) -> Booleans:
        if self.is_radial:
            return np.hypot(points[:, 0], points[:, 1]) < self.radius.first_fold
        return self._folds(largest).is_before(points)

    def first_fold(self, largest: float) -> float:
        if self.is_radial:
            return self.radius.first_fold if self.radius.first_fold < largest else np.inf
        return self._folds(largest).first

    def ideal(self, points: Array, largest: float) -> Array:
        if self.is_radial:
            return self._radially_ideal(points, largest)
        folds = self._folds(largest)
        limit = min(largest, folds.last)
        (reached,) = np.nonzero(folds.may_reach(points))
        start = self._radially_ideal(points[reached], min(largest, self.radius.first_fold))
        found = np.full(points.shape, np.nan)
        found[reached] = plane_inverse(self.distorted, self.jacobian, points[reached], start)
        inside = np.hypot(found[:, 0], found[:, 1]) < limit
        found[~inside] = np.nan
        found[inside] = np.where(self._is_before_fold(found[inside], largest)[:, None], found[inside], np.nan)
        return found

    def _radially_ideal(self, points: Array, largest: float) -> Array:
        r = np.hypot(points[:, 0], points[:, 1])
        if self.radius.is_identity:
            return np.where((r < largest)[:, None], points, np.nan)
        s = monotone_inverse(self.radius.value, self.radius.slope, r, min(largest, self.radius.first_fold))
        ideal: Array = points * np.where(r > 0, s / np.where(r > 0, r, 1), 1 / self.scale)[:, None]
        return ideal

    def _folds(self, largest: float) -> Folds:
        cache = self.__dict__.setdefault("_folds_of", {})
        if largest not in cache:
            cache[largest] = Folds(self.distorted, self.jacobian, largest)
        found: Folds = cache[largest]
        return found

    def _shift(self, points: Array) -> Array:
        x, y = points.T
        (p1, p2), (s1, s2, s3, s4) = self.tangential, self.prism
        square = x**2 + y**2
        return np.stack(
            [
                2 * p1 * x * y + p2 * (square + 2 * x**2) + square * (s1 + s2 * square),
                2 * p2 * x * y + p1 * (square + 2 * y**2) + square * (s3 + s4 * square),
            ],
            axis=1,
        )

    def _shift_jacobian(self, points: Array) -> Array:
        x, y = points.T
        (p1, p2), (s1, s2, s3, s4) = self.tangential, self.prism
        square = x**2 + y**2
        upper, lower = 2 * (s1 + 2 * s2 * square), 2 * (s3 + 2 * s4 * square)
        mixed = 2 * (p1 * x + p2 * y)
        return np.stack(
            [
                np.stack([2 * p1 * y + 6 * p2 * x + upper * x, mixed + upper * y], axis=1),
                np.stack([mixed + lower * x, 2 * p2 * x + 6 * p1 * y + lower * y], axis=1),
            ],
            axis=1,
        )
