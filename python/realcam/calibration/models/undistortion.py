"""Distortions that are given by their inverse: a polynomial from distorted to ideal points."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from ..arrays import Array
from .folds import Folds
from .plane_inverse import plane_inverse

STEP = 1e-30  # of the complex step, whose derivatives have no rounding error
DIFFERENCE = 1e-7  # of points whose distances from the centre are about 1


@dataclass(frozen=True)
class Undistortion:
    """The inverse of an analytic map of the plane that keeps the centre.

    function: ideal points of (N, 2) distorted ones, which may be complex. ratio: of its unit and that of ideal points.
    stated: the coefficients as the file states them.
    """

    function: Callable[[Array], Array]
    ratio: float
    stated: Mapping[str, Any] = field(default_factory=dict)

    @property
    def scale(self) -> float:
        return self.ratio / float(np.sqrt(np.abs(np.linalg.det(self._jacobian(np.zeros((1, 2)))[0]))))

    def distorted_before_fold(self, points: Array, largest: float) -> Array:
        values = points * self.ratio
        (reached,) = np.nonzero(self._folds.may_reach(values))
        found = np.full(points.shape, np.nan)
        found[reached] = plane_inverse(self.function, self._nearly_jacobian, values[reached], values[reached])
        (solved,) = np.nonzero(np.isfinite(found).all(axis=1))
        found[solved[~self._folds.is_before(found[solved])]] = np.nan
        return found

    def first_fold(self, largest: float) -> float:
        azimuths = np.linspace(0, 2 * np.pi, 256, endpoint=False)
        limits = self._folds.limit(azimuths)
        reached = np.isfinite(limits)
        if not reached.any():
            return np.inf
        ends = np.column_stack([np.cos(azimuths), np.sin(azimuths)])[reached] * limits[reached, None]
        return float(np.hypot(*self.function(ends).T).min()) / self.ratio

    def ideal(self, points: Array, largest: float) -> Array:
        found: Array = self.function(points) / self.ratio
        with np.errstate(invalid="ignore"):
            is_hidden = ~self._folds.is_before(np.nan_to_num(points)) | ~(np.hypot(*found.T) < largest)
        found[is_hidden] = np.nan
        return found

    def _jacobian(self, points: Array) -> Array:
        columns = [self.function(points + 1j * STEP * axis).imag / STEP for axis in np.eye(2)]
        return np.stack(columns, axis=2)

    def _nearly_jacobian(self, points: Array) -> Array:
        """Returns differences in place of derivatives, which are enough for Newton's steps and take a fourth of the
        time."""
        at = self.function(points)
        columns = [(self.function(points + DIFFERENCE * axis) - at) / DIFFERENCE for axis in np.eye(2)]
        return np.stack(columns, axis=2)

    @cached_property
    def _folds(self) -> Folds:
        return Folds(self.function, self._jacobian, np.inf)
