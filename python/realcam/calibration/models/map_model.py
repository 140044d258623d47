"""A camera model given by a map between its picture and that of a pinhole camera, such as an ST map."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from ..arrays import Array, Booleans, Integers
from ..status import PointStatus
from .central import camera_matrix_near_axis
from .plane_inverse import plane_inverse

EXTRAPOLATED = 8  # pixels beyond the map; farther values change the splines inside by less than 1e-4 of themselves


@dataclass(frozen=True, eq=False)
class MapModel:
    """Positions at pixel centres, with bicubic splines between them.

    Positions in the pinhole camera's picture, which has no end towards 90 degrees, are interpolated as directions in
    stereographic coordinates, (x, y) / (1 + z).
    positions: (H, W, 2), pixels of one picture that each pixel of the other one shows; NaN if there is none.
    is_redistorting: False if the positions lie in the camera's picture, and True if they lie in the pinhole camera's.
    pinhole_matrix: (3, 3) K of the pinhole camera. matrix: (3, 3), from the map's pixels of the camera to its pixels.
    """

    positions: Array
    is_redistorting: bool
    pinhole_matrix: Array
    matrix: Array

    @property
    def is_extrapolated(self) -> bool:
        return False

    @property
    def is_empty(self) -> bool:
        """True if there is no position to interpolate between."""
        return not self._is_set.any()

    @cached_property
    def largest_angle(self) -> float:
        """The angle of the corner that is farthest from the axis, of those with a position."""
        pixels = np.argwhere(self._is_set)[:, ::-1] + 0.5
        plane = self.positions[self._is_set] if self.is_redistorting else pixels
        inverse = np.linalg.inv(self.pinhole_matrix)
        return float(np.arctan(np.hypot(*(plane @ inverse[:2, :2].T + inverse[:2, 2]).T).max()))

    @property
    def camera_matrix(self) -> Array:
        return camera_matrix_near_axis(self.project)

    def project(self, points: Array) -> tuple[Array, Integers]:
        in_front = np.where(points[:, 2:] > 0, points, np.nan)
        if self.is_redistorting:
            found = self._inverse(_stereographic(in_front / np.linalg.norm(in_front, axis=1)[:, None]))
        else:
            plane = in_front[:, :2] / in_front[:, 2:]
            found = self._position(plane @ self.pinhole_matrix[:2, :2].T + self.pinhole_matrix[:2, 2])
        pixels = found @ self.matrix[:2, :2].T + self.matrix[:2, 2]
        status = np.where(np.isnan(pixels[:, 0]), PointStatus.NO_PROJECTION, PointStatus.OK).astype(np.intp)
        status[points[:, 2] <= 0] = PointStatus.BEHIND
        return pixels, status

    def ray(self, pixels: Array) -> tuple[Array, Integers]:
        own = np.linalg.solve(self.matrix[:2, :2], (pixels - self.matrix[:2, 2]).T).T
        rays = _direction(self._position(own)) if self.is_redistorting else self._pinhole_rays(self._inverse(own))
        status = np.where(np.isnan(rays[:, 0]), PointStatus.NO_PROJECTION, PointStatus.OK).astype(np.intp)
        return rays, status

    def transformed(self, matrix: Array) -> MapModel:
        return replace(self, matrix=matrix @ self.matrix)

    @cached_property
    def _is_set(self) -> Booleans:
        """True at pixels with a position, in a square of four of them: others are not used (_is_known)."""
        from scipy.ndimage import binary_opening  # slow to load

        is_set: Booleans = binary_opening(np.isfinite(self.positions).all(axis=2), np.ones((2, 2)))
        return is_set

    def _pinhole_rays(self, flat: Array) -> Array:
        """Returns the unit directions of pixels (N, 2) of the pinhole camera."""
        rays: Array = np.column_stack([flat, np.ones(len(flat))]) @ np.linalg.inv(self.pinhole_matrix).T
        rays /= np.linalg.norm(rays, axis=1)[:, None]
        return rays

    @cached_property
    def _values(self) -> Array:
        """The interpolated quantity, (H, W, 2)."""
        if not self.is_redistorting:
            return self.positions
        return _stereographic(self._pinhole_rays(self.positions.reshape(-1, 2))).reshape(self.positions.shape)

    @cached_property
    def _splines(self) -> list[Any]:
        from scipy.interpolate import RectBivariateSpline  # slow to load
        from scipy.ndimage import distance_transform_edt

        height, width = self._is_set.shape
        # Splines need all values, also those of pixels without a position, which are not used.
        nearest = np.stack(distance_transform_edt(~self._is_set, return_distances=False, return_indices=True))
        filled = self._values[tuple(nearest)]
        self._extrapolate(filled, nearest)
        rows, columns = np.arange(height) + 0.5, np.arange(width) + 0.5
        degrees = {"kx": min(3, height - 1), "ky": min(3, width - 1)}
        return [
            RectBivariateSpline(rows, columns, filled[:, :, i], bbox=[0, height, 0, width], s=0, **degrees)
            for i in range(2)
        ]

    def _extrapolate(self, filled: Array, nearest: Integers) -> None:
        """Sets the values about the map to quadratic extrapolations, with which splines are smooth up to its end.

        nearest: (2, H, W), row and column of the nearest pixel with a position.
        """
        distance = np.abs(nearest - np.indices(self._is_set.shape)).max(axis=0)
        missing = np.stack(np.nonzero((distance > 0) & (distance <= EXTRAPOLATED)))
        first = nearest[:, missing[0], missing[1]]
        third = first + 2 * (first - missing)
        inside = np.logical_and.reduce((third >= 0) & (third < np.array(self._is_set.shape)[:, None]), axis=0)
        missing, first, third = missing[:, inside], first[:, inside], third[:, inside]
        pixels = [tuple(at) for at in (first, (first + third) // 2, third)]
        known = np.logical_and.reduce([self._is_set[at] for at in pixels])
        a, b, c = (self._values[at][known] for at in pixels)
        filled[tuple(missing[:, known])] = 3 * a - 3 * b + c

    def _position(self, pixels: Array) -> Array:
        found = self._function(pixels)
        found[~self._is_known(pixels)] = np.nan
        return found

    def _inverse(self, positions: Array) -> Array:
        """Newton's method from the pixel whose position is nearest."""
        from scipy.spatial import cKDTree  # slow to load

        found = np.full((len(positions), 2), np.nan)
        (valid,) = np.nonzero(np.isfinite(positions).all(axis=1))
        tree = cKDTree(self._values[self._is_set])
        start = (np.argwhere(self._is_set)[:, ::-1] + 0.5)[tree.query(positions[valid])[1]]
        found[valid] = plane_inverse(self._function, self._jacobian, positions[valid], start)
        found[~self._is_known(found)] = np.nan
        return found

    def _function(self, pixels: Array) -> Array:
        return np.stack([spline.ev(pixels[:, 1], pixels[:, 0]) for spline in self._splines], axis=1)

    def _jacobian(self, pixels: Array) -> Array:
        y, x = pixels[:, 1], pixels[:, 0]
        return np.stack([np.stack([s.ev(y, x, dy=1), s.ev(y, x, dx=1)], axis=1) for s in self._splines], axis=1)

    def _is_known(self, pixels: Array) -> Booleans:
        """True in the map, where the positions of all four pixels around are set."""
        height, width = self._is_set.shape
        with np.errstate(invalid="ignore"):
            inside: Booleans = np.logical_and.reduce((pixels >= 0) & (pixels <= [width, height]), axis=1)
        cell = np.floor(np.where(inside[:, None], pixels, 0.5) - 0.5).astype(int)
        for x in (0, 1):
            for y in (0, 1):
                column, row = np.clip(cell[:, 0] + x, 0, width - 1), np.clip(cell[:, 1] + y, 0, height - 1)
                inside &= self._is_set[row, column]
        return inside


def _stereographic(directions: Array) -> Array:
    """Returns (N, 2) coordinates of unit directions, in the unit disc for those in front of the camera."""
    coordinates: Array = directions[:, :2] / (1 + directions[:, 2:])
    return coordinates


def _direction(coordinates: Array) -> Array:
    """Returns the unit directions (N, 3) of stereographic coordinates."""
    square = np.sum(coordinates**2, axis=1)
    directions: Array = np.column_stack([2 * coordinates, 1 - square]) / (1 + square)[:, None]
    return directions
