"""Focusing of a lens: variable distances between vertices as polynomials of the focus parameter."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.polynomial import Polynomial, chebyshev

from .._core import InputError, Lens, RealcamError

# Error of a distance relative to the film's diagonal. At f/1 it displaces light on the film by as much: a fiftieth of a
# pixel in a large picture. The focus found with real rays is uneven by half of it, because rims cut off ray after ray.
_TOLERANCE = 1e-5
_MAX_TERMS = 9
_SAMPLES = 24  # focus settings to which the polynomials are fitted
_DEFAULT_MAGNIFICATION = 1 / 8  # at the nearest focus, unless the lens file has one


@dataclass(frozen=True)
class FocusRange:
    """A lens with its range of focus, wide open and with a circular diaphragm.

    The focus parameter is proportional to the inverse of the object's distance from the front focal point, so that
    image distances are nearly linear in it (Newton's equation): focus = (nearest - start) / (distance - start), 0 at
    infinity and 1 at the nearest focus. Distances are measured from the film.
    """

    lens: Lens
    nearest_m: float
    """Nearest focus distance, from the film."""
    start_m: float
    """Distance from the front focal point to the film at infinity focus."""
    gaps_mm: dict[int, Polynomial]
    """Variable distances by surface, as functions of focus: from its vertex to the next, or from the last to the
    film."""

    def distance_m(self, focus: float) -> float:
        """Focus distance of a focus parameter."""
        return self.start_m + (self.nearest_m - self.start_m) / focus if focus > 0 else math.inf

    def lens_at(self, focus: float) -> Lens:
        """The lens at a focus parameter."""
        return self.lens.focused(self.distance_m(focus))


def focus_range(lens: Lens) -> FocusRange:
    """Returns the focus range of a lens. Raises InputError if it cannot be focused at infinity or at a near object."""
    wide = lens.wide_open().with_iris(0).focused(math.inf)
    start_m = 1e-3 * (wide.film_position_mm - wide.first_order().front_focal_distance_mm)
    nearest_m = lens.nearest_focus_m or _nearest_m(wide, start_m)
    if math.isfinite(lens.focus_distance_m):
        nearest_m = min(nearest_m, lens.focus_distance_m)
    unfitted = FocusRange(wide, nearest_m, start_m, {})
    positions = 0.5 + 0.5 * chebyshev.chebpts1(_SAMPLES)
    gaps = np.array([gaps_of(unfitted.lens_at(position)) for position in positions])
    moving = np.flatnonzero(np.ptp(gaps, axis=0) > 1e-9)
    tolerance_mm = _TOLERANCE * math.hypot(*lens.film_mm)
    fits = {int(i): _fitted(positions, gaps[:, i], tolerance_mm) for i in moving}
    return FocusRange(wide, nearest_m, start_m, fits)


def gaps_of(lens: Lens) -> list[float]:
    """Distances in mm from each vertex to the next, and from the last to the film."""
    return [*(surface.thickness_mm for surface in lens.surfaces[:-1]), lens.film_distance_mm]


def _nearest_m(lens: Lens, start_m: float) -> float:
    """Nearest focus for a lens whose file has none: magnification 1/8, or the closest that the lens can reach."""
    object_m = 1e-3 * abs(lens.first_order().effective_focal_length_mm) / _DEFAULT_MAGNIFICATION
    for _ in range(12):
        distance_m = float(f"{start_m + object_m:.2g}")
        try:
            lens.focused(distance_m)
        except RealcamError:
            object_m *= 1.5
        else:
            return distance_m
    raise InputError(f'lens "{lens.name}" cannot be focused on a near object')


def _fitted(positions: np.ndarray, values: np.ndarray, tolerance: float) -> Polynomial:
    """Polynomial of the lowest degree that is within the tolerance."""
    for degree in range(1, _MAX_TERMS):
        fit: Polynomial = Polynomial.fit(positions, values, degree, domain=[0, 1], window=[0, 1])
        if np.abs(fit(positions) - values).max() < tolerance:
            break
    return fit
