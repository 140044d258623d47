"""The part of a calibration that a camera uses."""

from __future__ import annotations

from typing import Protocol

from numpy.typing import ArrayLike

from ..arrays import Array, Integers


class CalibratedPicture(Protocol):
    """A picture of a calibrated camera, see Calibration."""

    @property
    def size(self) -> tuple[int, int]:
        """(width, height) in pixels."""

    @property
    def film_mm(self) -> tuple[float, float] | None:
        """(width, height) of the film, if known."""

    @property
    def camera_matrix(self) -> Array:
        """(3, 3) K near the axis."""

    def project(self, points: ArrayLike) -> tuple[Array, Integers]:
        """Returns pixels (N, 2) and PointStatus (N,) of points (N, 3)."""

    def ray(self, pixels: ArrayLike) -> tuple[Array, Integers]:
        """Returns directions (N, 3) and PointStatus (N,) of pixels (N, 2)."""
