"""Depth of field and hyperfocal distance, by real rays and by textbook formulas."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from .._core import InputError, Lens
from ..roots import root_between
from .formulas import ThinLens

# Stop points in the planes yz and xz, each representing an equal area of the stop. On the axis, rotationally symmetric
# lenses are the same in every plane; anamorphic ones have a different focus in these two.
_RADII = np.sqrt((np.arange(100) + 0.5) / 100)
_LINE = np.concatenate([-_RADII[::-1], _RADII])
_PUPIL = np.concatenate([np.column_stack([0 * _LINE, _LINE]), np.column_stack([_LINE, 0 * _LINE])])
_TOLERANCE = 1e-7  # tolerance of the inverse distance, relative to the depth of field


@dataclass(frozen=True)
class SharpRange:
    """Range of object distances from the film that are sharp.

    near_m, far_m: nan if no distance is sharp. far_m: inf if infinity is sharp.
    """

    near_m: float
    far_m: float

    @property
    def depth_m(self) -> float:
        """Length of the range."""
        return self.far_m - self.near_m


@dataclass(frozen=True)
class DepthOfField:
    """Depth of field of a lens at its focus and stop. Distances are from the film."""

    circle_of_confusion_mm: float
    focus_distance_m: float
    blur_in_focus_mm: float  #: blur diameter of the plane in focus by real rays: aberrations alone
    real: SharpRange  #: range with a blur diameter by real rays of at most the circle of confusion
    formula: SharpRange  #: range of a thin lens at the front principal plane, with the same focal length and f-number
    real_hyperfocal_m: float  #: nearest focus at which infinity is sharp; nan if there is none
    formula_hyperfocal_m: float  #: f^2 / (N c) + f from the principal plane
    approximate_depth_m: float  #: 2 N c (m + 1) / m^2, equation 8 of Liu and Hsu (2013); inf at infinity


def usual_circle_mm(film_mm: tuple[float, float]) -> float:
    """Returns the diameter of the largest blur that counts as sharp unless another is asked for: diagonal / 1500."""
    return math.hypot(*film_mm) / 1500


def circle_for(lens: Lens, circle_mm: float | None) -> float:
    """Returns the specified circle of confusion, or the usual one of the lens's film. Raises InputError unless it is
    positive and finite."""
    circle = usual_circle_mm(lens.film_mm) if circle_mm is None else circle_mm
    if not 0 < circle < math.inf:
        raise InputError("the circle of confusion must be a positive length")
    return circle


def blur_diameter_mm(lens: Lens, object_distance_m: float | None = None) -> float:
    """Returns the blur diameter of an axial point in mm: that of the uniform disc with the same second moment, sqrt(8)
    times the RMS radius.

    For a defocused lens without aberrations, it is the diameter of the blur disc. The diaphragm is replaced by a circle
    of the same area. object_distance_m: distance from the object plane to the front vertex, inf allowed; None: the
    plane in focus. Raises InputError if no ray passes.
    """
    spot = _with_round_stop(lens).spot(0.0, object_distance_m=object_distance_m, pupil=_PUPIL)
    return math.sqrt(8) * spot.rms_radius_mm


def depth_of_field(lens: Lens, circle_of_confusion_mm: float | None = None) -> DepthOfField:
    """Computes the depth of field and hyperfocal distance of a lens at its current focus and stop, on the axis.

    circle_of_confusion_mm: the largest blur that counts as sharp; None: the film's diagonal / 1500. The blur of real
    rays is blur_diameter_mm(). Raises InputError if the lens has no focal length, or if no light passes it.
    """
    circle = circle_for(lens, circle_of_confusion_mm)
    real, formula = sharp_ranges(lens, circle)
    thin = ThinLens.of(lens)
    return DepthOfField(
        circle_of_confusion_mm=circle,
        focus_distance_m=lens.focus_distance_m,
        blur_in_focus_mm=blur_diameter_mm(lens),
        real=real,
        formula=formula,
        real_hyperfocal_m=_real_hyperfocal(lens, thin, circle),
        formula_hyperfocal_m=(thin.hyperfocal_mm(circle) + thin.film_from_principal_plane_mm) / 1000,
        approximate_depth_m=thin.approximate_depth_mm(circle) / 1000,
    )


def sharp_ranges(lens: Lens, circle_mm: float) -> tuple[SharpRange, SharpRange]:
    """Returns the ranges whose blur is at most the circle of confusion, by real rays and by the formula.

    Raises InputError.
    """
    thin = ThinLens.of(lens)
    near, far = (distance + thin.film_from_principal_plane_mm for distance in thin.sharp_range_mm(circle_mm))
    return _real_range(lens, thin, circle_mm), SharpRange(near / 1000, far / 1000)


def _with_round_stop(lens: Lens) -> Lens:
    return lens.with_iris(0) if lens.iris_blades else lens


def _real_range(lens: Lens, thin: ThinLens, circle: float) -> SharpRange:
    """Returns the sharp range by real rays.

    The search runs over the inverse distance to the front vertex, over which blur is nearly symmetric about the focus.
    """
    film = lens.film_position_mm / 1000

    def excess(inverse_m: float) -> float:
        try:
            return blur_diameter_mm(lens, math.inf if inverse_m == 0 else 1 / inverse_m) - circle
        except InputError:  # too near for any ray to pass
            return math.nan

    in_focus = lens.focus_distance_m - film
    centre = 0.0 if math.isinf(in_focus) else 1 / in_focus
    step = 0.25 * thin.vergence_of_blur_per_mm(circle) * 1000
    sharpest = _sharpest(excess, centre, step)
    if sharpest is None:
        return SharpRange(math.nan, math.nan)
    near = _edge(excess, sharpest, step)
    far = 0.0 if excess(0.0) <= 0 else _edge(excess, sharpest, -step)
    return SharpRange(film + (1 / near if near > 0 else 0.0), film + (math.inf if far == 0 else 1 / far))


def _sharpest(excess: Callable[[float], float], centre: float, step: float) -> float | None:
    """Returns the sharpest of some inverse distances near the plane in focus, or None if none has acceptable blur.

    excess(inverse distance): blur diameter minus the circle of confusion. centre: inverse distance of the plane in
    focus. Focus is set with the stop open, so a stopped-down lens may be sharpest elsewhere (focus shift).
    """
    positions = [max(centre + k * step, 0.0) for k in (0, 1, -1, 2, -2, 3, -3, 4, -4, 6, -6, 8, -8)]
    blur = {position: excess(position) for position in positions}
    acceptable = {position: value for position, value in blur.items() if value <= 0}
    return min(acceptable, key=lambda position: acceptable[position]) if acceptable else None


def _edge(excess: Callable[[float], float], sharp: float, step: float) -> float:
    """Returns the inverse distance at which the blur becomes too large, stepping away from a sharp one."""
    low, at_low = sharp, excess(sharp)
    for _ in range(200):
        high = max(low + step, 0.0)
        at_high = excess(high)
        if at_high > 0 or math.isnan(at_high):
            return root_between(excess, low, high, at_low, at_high, _TOLERANCE * abs(step))
        if high == 0.0:
            break
        low, at_low = high, at_high
        step *= 1.3
    return low


def _real_hyperfocal(lens: Lens, thin: ThinLens, circle: float) -> float:
    """Returns the nearest focus of the lens, m, at which infinity is sharp by real rays; nan if there is none."""

    def excess(inverse_m: float) -> float:
        try:
            focused = lens.focused(math.inf if inverse_m == 0 else 1 / inverse_m)
            return blur_diameter_mm(focused, math.inf) - circle
        except InputError:  # nearer than the focus range of the lens
            return math.nan

    at_infinity = excess(0.0)
    if not at_infinity <= 0:
        return math.nan
    guess = 1000 / (thin.hyperfocal_mm(circle) + thin.film_from_principal_plane_mm)
    low, at_low, high = 0.0, at_infinity, guess
    for _ in range(20):
        at_high = excess(high)
        if is_beyond := math.isnan(at_high):
            high = _last_defined(excess, low, high)
            at_high = excess(high)
        if at_high > 0:
            inverse = root_between(excess, low, high, at_low, at_high, 1e-7 * guess)
            return 1 / inverse if inverse > 0 else math.inf
        if is_beyond:
            return 1 / high if high > 0 else math.nan
        low, at_low, high = high, at_high, 1.5 * high
    return math.nan


def _last_defined(function: Callable[[float], float], low: float, high: float) -> float:
    """Returns the largest number below `high` at which a function is not nan. It is not nan at `low`."""
    for _ in range(40):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if math.isnan(function(middle)) else (middle, high)
    return low
