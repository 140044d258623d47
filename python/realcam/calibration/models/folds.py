"""Folds of a plane map: the distances from the centre, azimuth by azimuth, at which it stops being one to one."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property

import numpy as np

from ..arrays import Array, Booleans
from .radial import spread

AZIMUTHS = 256
NEAR = 0.01  # relative margin about the tabulated folds within which a point is tested itself
NARROW = 1.1  # largest ratio of the distances of the band about the fold in which the map is tested at few points
STEPS = 4  # tested points in such a band, with the point itself
CHUNK = 4096  # points whose azimuths are searched together
BINS = 64  # directions in which the reach of the map is tabulated


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
        is_near = (s >= low) & (s <= high)
        # In a narrow band the map folds once, so that it has folded if it does not grow at the point itself.
        is_narrow = high <= NARROW * low
        (narrow,) = np.nonzero(is_near & is_narrow)
        before[narrow] = self._grows_between(low[narrow], points[narrow], s[narrow])
        (near,) = np.nonzero(is_near & ~is_narrow)
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

    def may_reach(self, values: Array) -> Booleans:
        """False if the map has no value like this before its fold; True for all others, and for some of these."""
        turn = np.arctan2(values[:, 1], values[:, 0]) / (2 * np.pi) * BINS
        with np.errstate(invalid="ignore"):
            reach = self._reach[np.nan_to_num(np.floor(turn)).astype(int) % BINS]
            reached: Booleans = np.hypot(values[:, 0], values[:, 1]) <= reach
        return reached

    @cached_property
    def _reach(self) -> Array:
        """For each bin of directions, an upper bound of the distance of values; inf if there is none."""
        ends = np.minimum(self._table, self._largest)
        azimuths = 2 * np.pi * np.arange(AZIMUTHS) / AZIMUTHS
        unit = np.stack([np.cos(azimuths), np.sin(azimuths)], axis=1)
        is_bounded = np.isfinite(ends)
        reach = np.full(BINS, np.inf)
        if not is_bounded.all():
            return reach
        with np.errstate(all="ignore"):
            values = self._distorted(unit * ends[:, None])
        distance = np.hypot(values[:, 0], values[:, 1])
        if not np.isfinite(distance).all():
            return reach
        cell = np.floor(np.arctan2(values[:, 1], values[:, 0]) / (2 * np.pi) * BINS).astype(int) % BINS
        largest = np.zeros(BINS)
        np.maximum.at(largest, cell, distance)
        bounds = np.max([np.roll(largest, step) for step in (-1, 0, 1)], axis=0)
        # The curve may have no sample in a bin.
        return np.where(bounds > 0, bounds * (1 + 5 * NEAR), np.inf)

    def _grows_between(self, low: Array, points: Array, s: Array) -> Booleans:
        """True if the map grows at equal steps from a distance `low` on the half-line to the point, at distance s."""
        grows = np.ones(len(points), dtype=bool)
        for step in range(1, STEPS + 1):
            share = step / STEPS
            scale = (low + share * (s - low)) / s if step < STEPS else np.ones_like(s)
            grows &= self._is_growing(points * scale[:, None])
        return grows

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
