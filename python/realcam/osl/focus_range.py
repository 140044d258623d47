"""How a lens moves when it is focused: distances between its vertices as polynomials of the focus."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.polynomial import Polynomial, chebyshev

from .._core import InputError, Lens, RealcamError

# Of the film's diagonal: at f/1, light misses its place by as much, a fiftieth of the pixels of a large picture. The
# focus that real rays find is rough by half of it, because rims cut off one ray after the other.
_TOLERANCE = 1e-5
_MOST_TERMS = 9
_SAMPLES = 24
_SMALLEST_MAGNIFICATION = 1 / 8


@dataclass(frozen=True)
class FocusRange:
    """A lens between infinity and its nearest focus, wide open and with a round diaphragm.

    Counted is the object's distance from the front focal point, of which the image's distance from the rear one is
    nearly the inverse (Newton): focus = (nearest - start) / (distance - start), 0 at infinity and 1 at the nearest.
    """

    lens: Lens
    nearest_m: float
    start_m: float
    """From the front focal point to the film, at infinity."""
    gaps_mm: dict[int, Polynomial]
    """By surface, of those that move apart: from its vertex to the next one; of the last surface, to the film."""

    def distance_m(self, focus: float) -> float:
        return self.start_m + (self.nearest_m - self.start_m) / focus if focus > 0 else math.inf

    def lens_at(self, focus: float) -> Lens:
        return self.lens.focused(self.distance_m(focus))


def focus_range(lens: Lens) -> FocusRange:
    """Raises InputError where the lens cannot be focused on distant things."""
    wide = lens.wide_open().with_iris(0).focused(math.inf)
    start_m = 1e-3 * (wide.film_position_mm - wide.first_order().front_focal_distance_mm)
    nearest_m = lens.nearest_focus_m or _nearest_m(wide, start_m)
    if math.isfinite(lens.focus_distance_m):
        nearest_m = min(nearest_m, lens.focus_distance_m)
    unfitted = FocusRange(wide, nearest_m, start_m, {})
    places = 0.5 + 0.5 * chebyshev.chebpts1(_SAMPLES)
    gaps = np.array([gaps_of(unfitted.lens_at(place)) for place in places])
    moving = np.flatnonzero(np.ptp(gaps, axis=0) > 1e-9)
    tolerance_mm = _TOLERANCE * math.hypot(*lens.film_mm)
    fits = {int(i): _fitted(places, gaps[:, i], tolerance_mm) for i in moving}
    return FocusRange(wide, nearest_m, start_m, fits)


def gaps_of(lens: Lens) -> list[float]:
    """Distances in mm from each vertex to the next one, and from the last one to the film."""
    return [*(surface.thickness_mm for surface in lens.surfaces[:-1]), lens.film_distance_mm]


def _nearest_m(lens: Lens, start_m: float) -> float:
    """Of a lens whose file names no nearest focus: an eighth of life size, or what it can."""
    reach_m = 1e-3 * abs(lens.first_order().effective_focal_length_mm) / _SMALLEST_MAGNIFICATION
    for _ in range(12):
        distance_m = float(f"{start_m + reach_m:.2g}")
        try:
            lens.focused(distance_m)
        except RealcamError:
            reach_m *= 1.5
        else:
            return distance_m
    raise InputError(f'lens "{lens.name}" cannot be focused on anything near')


def _fitted(places: np.ndarray, values: np.ndarray, tolerance: float) -> Polynomial:
    """Of the least degree that is within the tolerance."""
    for degree in range(1, _MOST_TERMS):
        fit: Polynomial = Polynomial.fit(places, values, degree, domain=[0, 1], window=[0, 1])
        if np.abs(fit(places) - values).max() < tolerance:
            break
    return fit
