"""Projections of directions to a plane, as distances from the axis: the first stage of a camera model.

A direction is given by rho = hypot(x, y) and z in camera axes. Each projection grows with the angle to the axis inside
its domain, and is inverted in closed form.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from ..arrays import Array, Integers
from ..status import PointStatus


class Projection(Protocol):
    """Distance from the axis as a function of the direction."""

    @property
    def largest(self) -> float:
        """Upper limit of the distance, which is not reached; inf if there is none."""

    @property
    def largest_angle(self) -> float:
        """Upper limit of the angle to the axis, in radians."""

    @property
    def scale(self) -> float:
        """Derivative of the distance by the angle, on the axis."""

    @property
    def refusal(self) -> PointStatus:
        """Status of pixels beyond the largest distance."""

    def status(self, rho: Array, z: Array) -> Integers:
        """Returns OK inside the domain, and otherwise the reason for refusing the direction."""

    def distance(self, rho: Array, z: Array) -> Array:
        """Returns the distance from the axis."""

    def direction(self, distance: Array) -> tuple[Array, Array]:
        """Returns (rho, z) of a distance, of any length. NaN at or beyond the largest one."""


def refused(is_inside: Array | np.ndarray, reason: PointStatus) -> Integers:
    """Returns OK where is_inside, and `reason` elsewhere."""
    return np.where(is_inside, PointStatus.OK, reason).astype(np.intp)


@dataclass(frozen=True)
class Perspective:
    """rho / z, for z > 0: the pinhole camera. refusal: status of points with z <= 0."""

    refusal: PointStatus = PointStatus.BEHIND
    largest: float = np.inf
    largest_angle: float = np.pi / 2
    scale: float = 1.0

    def status(self, rho: Array, z: Array) -> Integers:
        return refused(z > 0, self.refusal)

    def distance(self, rho: Array, z: Array) -> Array:
        return rho / z

    def direction(self, distance: Array) -> tuple[Array, Array]:
        return distance, np.ones_like(distance)


@dataclass(frozen=True)
class Equidistant:
    """The angle to the axis, below `largest_angle` (J. Kannala and S. Brandt, IEEE PAMI 28 (2006) 1335)."""

    largest_angle: float = np.pi / 2
    scale: float = 1.0
    refusal: PointStatus = PointStatus.NO_PROJECTION

    @property
    def largest(self) -> float:
        return self.largest_angle

    def status(self, rho: Array, z: Array) -> Integers:
        return refused(np.arctan2(rho, z) < self.largest_angle, self.refusal)

    def distance(self, rho: Array, z: Array) -> Array:
        return np.arctan2(rho, z)

    def direction(self, distance: Array) -> tuple[Array, Array]:
        angle = np.where(distance < self.largest_angle, distance, np.nan)
        return np.sin(angle), np.cos(angle)


class _Sphere:
    """Models with a unit sphere whose domain is a cone about the axis."""

    xi: float
    refusal: PointStatus

    @property
    def _least_cosine(self) -> float:
        """Cosine of the largest angle to the axis."""
        raise NotImplementedError

    @property
    def largest_angle(self) -> float:
        return float(np.arccos(self._least_cosine))

    @property
    def scale(self) -> float:
        return 1 / (1 + self.xi)

    def status(self, rho: Array, z: Array) -> Integers:
        return refused(z > self._least_cosine * np.hypot(rho, z), self.refusal)


@dataclass(frozen=True)
class UnifiedSphere(_Sphere):
    """rho / (z + xi d), d = hypot(rho, z): the unified model (C. Mei and P. Rives, ICRA 2007)."""

    xi: float
    refusal: PointStatus = PointStatus.NO_PROJECTION

    @property
    def _least_cosine(self) -> float:
        return -self.xi if self.xi <= 1 else -1 / self.xi

    @property
    def largest(self) -> float:
        return np.inf if self.xi <= 1 else 1 / np.sqrt(self.xi**2 - 1)

    def distance(self, rho: Array, z: Array) -> Array:
        return rho / (z + self.xi * np.hypot(rho, z))

    def direction(self, distance: Array) -> tuple[Array, Array]:
        square = distance**2
        root = np.sqrt(1 + (1 - self.xi**2) * square)
        return (self.xi + root) * distance, root - self.xi * square


def _sphere_limit(alpha: float) -> float:
    """Returns w1 of V. Usenko, N. Demmel and D. Cremers, 3DV 2018 (arXiv 1807.08957), equations 35 and 44."""
    return alpha / (1 - alpha) if alpha <= 0.5 else (1 - alpha) / alpha


@dataclass(frozen=True)
class DoubleSphere(_Sphere):
    """The double-sphere model (V. Usenko, N. Demmel and D. Cremers, 3DV 2018, arXiv 1807.08957, section 3.3)."""

    xi: float
    alpha: float
    refusal: PointStatus = PointStatus.NO_PROJECTION

    @property
    def _least_cosine(self) -> float:
        w1 = _sphere_limit(self.alpha)
        return -(w1 + self.xi) / float(np.sqrt(2 * w1 * self.xi + self.xi**2 + 1))

    @property
    def largest(self) -> float:
        return np.inf if self.alpha <= 0.5 else 1 / np.sqrt(2 * self.alpha - 1)

    def distance(self, rho: Array, z: Array) -> Array:
        shifted = self.xi * np.hypot(rho, z) + z
        return rho / (self.alpha * np.hypot(rho, shifted) + (1 - self.alpha) * shifted)

    def direction(self, distance: Array) -> tuple[Array, Array]:
        square, alpha, xi = distance**2, self.alpha, self.xi
        z = (1 - alpha**2 * square) / (alpha * np.sqrt(1 - (2 * alpha - 1) * square) + 1 - alpha)
        length = (z * xi + np.sqrt(z**2 + (1 - xi**2) * square)) / (z**2 + square)
        return length * distance, length * z - xi


@dataclass(frozen=True)
class ExtendedUnified:
    """rho / (alpha d + (1 - alpha) z), d = sqrt(beta rho^2 + z^2) (B. Khomutenko, G. Garcia and P. Martinet, RA-L 1
    (2016) 137; domain and inverse as in arXiv 1807.08957)."""

    alpha: float
    beta: float
    refusal: PointStatus = PointStatus.NO_PROJECTION

    @property
    def largest(self) -> float:
        return np.inf if self.alpha <= 0.5 else 1 / np.sqrt(self.beta * (2 * self.alpha - 1))

    @property
    def largest_angle(self) -> float:
        # Equality in z = -w sqrt(beta rho^2 + z^2).
        w = _sphere_limit(self.alpha)
        return float(np.arctan2(np.sqrt(1 - w**2), -w * np.sqrt(self.beta)))

    @property
    def scale(self) -> float:
        return 1.0

    def _length(self, rho: Array, z: Array) -> Array:
        length: Array = np.hypot(np.sqrt(self.beta) * rho, z)
        return length

    def status(self, rho: Array, z: Array) -> Integers:
        return refused(z > -_sphere_limit(self.alpha) * self._length(rho, z), self.refusal)

    def distance(self, rho: Array, z: Array) -> Array:
        return rho / (self.alpha * self._length(rho, z) + (1 - self.alpha) * z)

    def direction(self, distance: Array) -> tuple[Array, Array]:
        square, alpha = self.beta * distance**2, self.alpha
        return distance, (1 - alpha**2 * square) / (alpha * np.sqrt(1 - (2 * alpha - 1) * square) + 1 - alpha)


@dataclass(frozen=True)
class FieldOfViewAngle:
    """atan(2 tan(omega / 2) rho / z) / omega, for z > 0 (F. Devernay and O. Faugeras, Machine Vision and Applications
    13 (2001) 14). omega: radians."""

    omega: float
    refusal: PointStatus = PointStatus.BEHIND
    largest_angle: float = np.pi / 2

    @property
    def _factor(self) -> float:
        return 2 * float(np.tan(self.omega / 2))

    @property
    def largest(self) -> float:
        return np.pi / 2 / self.omega

    @property
    def scale(self) -> float:
        return self._factor / self.omega

    def status(self, rho: Array, z: Array) -> Integers:
        return refused(z > 0, self.refusal)

    def distance(self, rho: Array, z: Array) -> Array:
        return np.arctan2(self._factor * rho, z) / self.omega

    def direction(self, distance: Array) -> tuple[Array, Array]:
        angle = np.where(distance < self.largest, distance, np.nan) * self.omega
        return np.sin(angle), self._factor * np.cos(angle)
