"""Central camera models: a projection to a plane, a distortion of the plane, and a map of the plane to pixels."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Protocol

import numpy as np

from ..arrays import Array, Booleans, Integers
from ..status import PointStatus
from .distortion import BrownConrady, Distortion
from .projections import Projection


class CameraModel(Protocol):
    """A map of directions to pixels (first pixel's centre (0.5, 0.5), rows down), and its inverse."""

    @property
    def is_extrapolated(self) -> bool:
        """True if a fitted function without a fold defines the model beside the picture."""

    @property
    def largest_angle(self) -> float:
        """Angle to the axis in radians up to which all directions have a pixel."""

    @property
    def camera_matrix(self) -> Array:
        """(3, 3) matrix K of the pinhole camera that agrees with the model near the axis."""

    def project(self, points: Array) -> tuple[Array, Integers]:
        """Returns (N, 2) pixels of (N, 3) points in camera axes, and their status; NaN if refused."""

    def ray(self, pixels: Array) -> tuple[Array, Integers]:
        """Returns (N, 3) unit directions of (N, 2) pixels, and their status; NaN if refused."""

    def transformed(self, matrix: Array) -> CameraModel:
        """Returns the model with its pixels mapped by a (3, 3) affine matrix."""


@dataclass(frozen=True)
class CentralModel:
    """The camera model of all formats that state a formula.

    matrix: (3, 3) affine map of the distorted plane to pixels. tilt: angles (tau_x, tau_y) in radians of a tilted
    sensor, whose homography precedes it.
    """

    projection: Projection
    distortion: Distortion
    matrix: Array
    tilt: tuple[float, float] | None = None

    @cached_property
    def is_extrapolated(self) -> bool:
        is_fitted = not isinstance(self.distortion, BrownConrady) or not (
            self.distortion.is_radial and self.distortion.radius.is_identity
        )
        return is_fitted and not np.isfinite(self.distortion.first_fold(self.projection.largest))

    @cached_property
    def largest_angle(self) -> float:
        fold = self.distortion.first_fold(self.projection.largest)
        if fold >= self.projection.largest:
            return self.projection.largest_angle
        rho, z = self.projection.direction(np.array(fold))
        return float(np.arctan2(rho, z))

    @property
    def camera_matrix(self) -> Array:
        scale = self.projection.scale * self.distortion.scale
        return self.matrix @ np.diag([scale, scale, 1.0])

    def project(self, points: Array) -> tuple[Array, Integers]:
        rho, z = np.hypot(points[:, 0], points[:, 1]), points[:, 2]
        status = self.projection.status(rho, z)
        status[~((rho > 0) | (z != 0)) & (status == PointStatus.OK)] = PointStatus.NO_PROJECTION
        status[~np.isfinite(points).all(axis=1)] = PointStatus.NO_PROJECTION
        pixels = np.full((len(points), 2), np.nan)
        (inside,) = np.nonzero(status == PointStatus.OK)
        rho, z = rho[inside], z[inside]
        # On the axis the direction across it is arbitrary, and its distance 0.
        across = points[inside, :2] / np.where(rho > 0, rho, 1)[:, None]
        plane = across * self.projection.distance(rho, z)[:, None]
        distorted = self.distortion.distorted_before_fold(plane, self.projection.largest)
        is_single: Booleans = ~np.isnan(distorted[:, 0])
        mapped, is_in_front = self._pixels(distorted[is_single])
        is_single[is_single] = is_in_front
        pixels[inside[is_single]] = mapped[is_in_front]
        status[inside[~is_single]] = PointStatus.BEYOND_FOLD
        return pixels, status

    def ray(self, pixels: Array) -> tuple[Array, Integers]:
        plane = self.distortion.ideal(self._plane(pixels), self.projection.largest)
        distance = np.hypot(plane[:, 0], plane[:, 1])
        with np.errstate(invalid="ignore"):
            rho, z = self.projection.direction(distance)
            length = np.hypot(rho, z)
            across = (rho / length / np.where(distance > 0, distance, 1))[:, None] * plane
            directions = np.column_stack([across, z / length])
        status = np.full(len(pixels), int(PointStatus.OK), dtype=np.intp)
        fold = self.distortion.first_fold(self.projection.largest)
        reason = PointStatus.BEYOND_FOLD if np.isfinite(fold) else self.projection.refusal
        status[np.isnan(directions).any(axis=1)] = reason
        status[self.projection.status(rho, z) != PointStatus.OK] = self.projection.refusal
        status[~np.isfinite(pixels).all(axis=1)] = PointStatus.NO_PROJECTION
        directions[status != PointStatus.OK] = np.nan
        return directions, status

    def transformed(self, matrix: Array) -> CentralModel:
        return replace(self, matrix=matrix @ self.matrix)

    @cached_property
    def _homography(self) -> Array | None:
        return None if self.tilt is None else tilt_homography(*self.tilt)

    def _pixels(self, plane: Array) -> tuple[Array, np.ndarray]:
        """Returns pixels of distorted points, and True where these lie in front of a tilted sensor."""
        in_front = np.ones(len(plane), dtype=bool)
        if self._homography is not None:
            tilted = plane @ self._homography[:, :2].T + self._homography[:, 2]
            in_front = tilted[:, 2] > 0
            plane = tilted[:, :2] / np.where(in_front, tilted[:, 2], np.nan)[:, None]
        return plane @ self.matrix[:2, :2].T + self.matrix[:2, 2], in_front

    def _plane(self, pixels: Array) -> Array:
        # Solved by Cramer's rule, whose rounding does not depend on the other pixels of the array.
        (a, b, u0), (c, d, v0) = self.matrix[:2]
        u, v = pixels[:, 0] - u0, pixels[:, 1] - v0
        plane: Array = np.column_stack([d * u - b * v, a * v - c * u]) / (a * d - b * c)
        if self._homography is None:
            return plane
        inverse = np.linalg.inv(self._homography)
        upright = plane @ inverse[:, :2].T + inverse[:, 2]
        scale = upright[:, 2] / inverse[2, 2]
        plane = upright[:, :2] / np.where(scale > 0, upright[:, 2], np.nan)[:, None]
        return plane


def tilt_homography(tau_x: float, tau_y: float) -> Array:
    """Returns the homography of a tilted sensor, [R33 0 -R13; 0 R33 -R23; 0 0 1] R with R = Ry(tau_y) Rx(tau_x)
    (Louhichi et al., Measurement Science and Technology 18 (2007) 2616, as in OpenCV)."""
    about_x = np.array([[1, 0, 0], [0, np.cos(tau_x), np.sin(tau_x)], [0, -np.sin(tau_x), np.cos(tau_x)]])
    about_y = np.array([[np.cos(tau_y), 0, -np.sin(tau_y)], [0, 1, 0], [np.sin(tau_y), 0, np.cos(tau_y)]])
    R = about_y @ about_x
    homography: Array = np.array([[R[2, 2], 0, -R[0, 2]], [0, R[2, 2], -R[1, 2]], [0, 0, 1]]) @ R
    return homography


def camera_matrix(fx: float, fy: float, cx: float, cy: float, skew: float = 0.0) -> Array:
    """Returns the (3, 3) matrix K."""
    return np.array([[fx, skew, cx], [0.0, fy, cy], [0.0, 0.0, 1.0]])


def camera_matrix_near_axis(project: Callable[[Array], tuple[Array, Integers]]) -> Array:
    """Returns the (3, 3) matrix K of the pinhole camera near the axis of a model, by differences of its pixels."""
    step = 1e-3
    axes = np.array([[0, 0, 1], [step, 0, 1], [0, step, 1], [-step, 0, 1], [0, -step, 1]], dtype=float)
    centre, right, down, left, up = project(axes)[0]
    matrix = np.eye(3)
    matrix[:2] = np.column_stack([(right - left) / (2 * step), (down - up) / (2 * step), centre])
    return matrix


def shift(x: float, y: float) -> Array:
    """Returns the (3, 3) matrix that adds (x, y) to pixels."""
    return np.array([[1.0, 0.0, x], [0.0, 1.0, y], [0.0, 0.0, 1.0]])
