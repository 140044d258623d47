"""Rays of one object point behind the lens, for propagation to any plane."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from .._core import Lens
from ..fields import FieldPosition, field_arguments
from ..short_text import ShortText
from .fields import Doubles


@dataclass(frozen=True, repr=False)
class ExitRays(ShortText):
    """N rays behind a lens.

    points_mm: (N, 2), on the film, from the axis; nan for rays that do not pass.
    slopes: (N, 2), dx/dz and dy/dz behind the lens.
    cosines: (N, 2), direction cosines x and y.
    """

    points_mm: Doubles
    slopes: Doubles
    cosines: Doubles

    def at(self, defocus_mm: float) -> Doubles:
        """(N, 2): points on the plane defocus_mm behind the film."""
        moved: Doubles = self.points_mm + defocus_mm * self.slopes
        return moved


def exit_rays(
    lens: Lens,
    pupil: ArrayLike,
    field: FieldPosition,
    wavelength_nm: float,
    object_distance_m: float | None = None,
) -> ExitRays:
    """Rays through points of the stop, found by real ray aiming.

    pupil: (N, 2), points in units of the stop's radius. object_distance_m: object plane to front vertex; None: the
    plane in focus. Raises InputError if no light passes.
    """
    spot = lens.spot(
        **field_arguments(field), wavelength_nm=wavelength_nm, object_distance_m=object_distance_m, pupil=pupil
    )
    directions = spot.directions
    return ExitRays(spot.points_mm, directions[:, :2] / directions[:, 2:], directions[:, :2])


def hexapolar(rings: int) -> Doubles:
    """(N, 2): hexapolar stop points, each for an equal area: the centre, and rings of 6, 12, 18, ... to the edge."""
    pupil_points = [np.zeros((1, 2))]
    for ring in range(1, rings + 1):
        angle = 2 * np.pi * np.arange(6 * ring) / (6 * ring)
        pupil_points.append(ring / rings * np.column_stack([np.cos(angle), np.sin(angle)]))
    return np.concatenate(pupil_points)
