"""Folds of a plane map: the distances from the centre, azimuth by azimuth, at which it stops being one to one."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property

import numpy as np

from ..arrays import Array, Booleans
from .radial import spread

AZIMUTHS = 256
NEAR = 0.01  # relative margin about the tabulated fold within which the azimuth of a point is searched itself
CHUNK = 4096  # points whose azimuths are searched together


class Folds:
    """First folds of a map along half-lines from the centre.

    A fold is where the determinant of the Jacobian, or the growth of the distorted distance along the half-line, is no
    longer positive; a pole of a rational map is one, too. largest: the distance up to which folds are looked for.
    """

    def __init__(self, distorted: Callable[[Array], Array], jacobian: Callable[[Array], Array], largest: float) -> None:
        self._distorted, self._jacobian, self._largest = distorted, jacobian, largest

    def is_before(self, points: Array) -> Booleans:
        """True if the map does not fold between the centre and the point."""
        s = np.hypot(points[:, 0], points[:, 1])
        turn = np.arctan2(points[:, 1], points[:, 0]) / (2 * np.pi) * AZIMUTHS
        cell = np.floor(turn).astype(int)
        ends = self._table[np.stack([cell, cell + 1]) % AZIMUTHS]
        low, high = ends.min(axis=0) * (1 - NEAR), ends.max(axis=0) * (1 + NEAR)
        before: Booleans = s < low
        (near,) = np.nonzero((s >= low) & (s <= high))
        for part in np.split(near, range(CHUNK, len(near), CHUNK)):
            before[part] = s[part] < self.limit(np.arctan2(points[part, 1], points[part, 0]))
        return before

    @property
    def first(self) -> float:
        """The smallest tabulated distance of a fold; inf if there is none."""
        return float(self._table.min())

    @property
    def last(self) -> float:
        """An upper bound of the distances of folds; inf if an azimuth has none."""
        return float(self._table.max()) * (1 + NEAR)

    def limit(self, azimuths: Array) -> Array:
        """Returns the distance of the first fold of each azimuth in radians; inf if there is none."""
        unit = np.stack([np.cos(azimuths), np.sin(azimuths)], axis=1)
        s = np.concatenate([[0.0], spread(self._largest)])
        grows = self._is_growing(unit[:, None] * s[1:, None])
        first = np.argmin(grows, axis=1)  # the first sample that does not grow
        low, high = s[first], s[first + 1]
        for _ in range(60):
            middle = 0.5 * (low + high)
            is_growing = self._is_growing(unit * middle[:, None])
            low, high = np.where(is_growing, middle, low), np.where(is_growing, high, middle)
        return np.where(grows.all(axis=1), np.inf, high)

    @cached_property
    def _table(self) -> Array:
        return self.limit(2 * np.pi * np.arange(AZIMUTHS) / AZIMUTHS)

    def _is_growing(self, points: Array) -> Booleans:
        flat = points.reshape(-1, 2)
        with np.errstate(all="ignore"):
            q, slopes = self._distorted(flat), self._jacobian(flat)
            along = np.einsum("nij,nj->ni", slopes, flat)
            determinant = slopes[:, 0, 0] * slopes[:, 1, 1] - slopes[:, 0, 1] * slopes[:, 1, 0]
            is_growing: Booleans = (determinant > 0) & (np.sum(q * along, axis=1) > 0)
        return is_growing.reshape(points.shape[:-1])
