"""Field points of a lens: by their height on the film, or by their field angle."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ._core import InputError, Lens, RayStatus, Spot
from .roots import root_between

FieldPosition = float | tuple[float, float]  #: an angle in degrees, or a film point (x, y) in mm from the film's centre
_LARGEST_STEP_DEG = 5.0
_STEPS_INWARDS = 160  # steps of 5%, down to 0.03% of the height
_PROBES = np.column_stack([np.zeros(21), np.linspace(-1, 1, 21)])  # points of the stop in the meridional plane
# Points of the stop, nearest to its centre first: the centre may be obstructed, and the edge vignetted.
STOP_PROBES = np.array(
    [(0.0, 0.0), *((r * x, r * y) for r in (0.35, 0.7, 0.9) for x, y in ((0, 1), (1, 0), (0, -1), (-1, 0)))]
)


def field_arguments(field: FieldPosition) -> dict[str, Any]:
    """Returns the keyword arguments that specify a field point in Lens.spot and similar methods."""
    return {"film_mm": field} if isinstance(field, tuple) else {"field_deg": float(field)}


def area_weighted_spot(lens: Lens, **arguments: Any) -> Spot:
    """Returns the spot from whose rays all RMS radii of spots are computed, in tables and in plots.

    The stop is sampled by 12 rings of Gauss quadrature, so that each ray counts by its area of the stop. The equal
    weights of hexapolar rays make the edge of the pupil count too much. arguments: of Lens.spot, except the pattern.
    """
    return lens.spot(pattern="rings", samples=12, **arguments)


def field_text(field: FieldPosition) -> str:
    """Returns the text of a field point, for messages."""
    return f"the film point ({field[0]:.6g}, {field[1]:.6g}) mm" if isinstance(field, tuple) else f"{field:.6g} deg"


@dataclass(frozen=True)
class Field:
    """A field point."""

    angle_deg: float  #: field angle in object space, as in Lens.spot
    film_height_mm: float  #: height of the chief ray at the design wavelength
    share: (
        float | None
    )  #: requested fraction of the film's corner or side, or of the illuminated height; None: by angle


def fields_at(lens: Lens, shares: Sequence[float], object_distance_m: float | None = None) -> tuple[Field, ...]:
    """Returns field points at fractions of the height of the film's corner, or of the largest illuminated height if
    that is smaller.

    object_distance_m: distance from the object plane to the front vertex; None: the plane in focus.
    Raises InputError if no light passes the lens, or if a fraction does not lie between -1 and 1.
    """
    if not all(-1 <= share <= 1 for share in shares):
        raise InputError("fields must be fractions of the height of the film's corner, from -1 to 1")
    corner = 0.5 * math.hypot(*lens.film_mm)
    edge = angle_of_height(lens, corner, object_distance_m)
    fields = []
    for share in shares:
        if abs(share) == 1:
            angle, height = edge
        elif share == 0:
            angle, height = 0.0, 0.0
        else:
            angle, height = angle_of_height(lens, abs(share) * edge[1], object_distance_m)
        fields.append(Field(math.copysign(angle, share), math.copysign(height, share), share))
    return tuple(fields)


def fields_along(lens: Lens, shares: Sequence[float], axis: int) -> tuple[Field, ...]:
    """Returns field points along x (axis 0) or y (1) of the film, at fractions of half its side, for any lens.

    A point without light is moved inwards until it has some. The angle is between the chief ray and the z axis. Raises
    InputError if no light passes the lens.
    """
    if not all(-1 <= share <= 1 for share in shares):
        raise InputError("fields must be fractions of half the film's side, from -1 to 1")
    probes = _PROBES if axis == 1 else _PROBES[:, ::-1]
    from_centre = np.abs(probes[:, axis])
    fields = []
    for share in shares:
        height = share * 0.5 * lens.film_mm[axis]
        for _ in range(_STEPS_INWARDS):  # the light may end before the film's edge
            film_point = (height, 0.0) if axis == 0 else (0.0, height)
            try:
                rays = lens.aim(probes, film_mm=film_point)
            except InputError:
                rays = None
            if rays is not None and (rays.status == RayStatus.OK).any():
                # The chief ray, or the ray closest to it if the centre of the pupil is obstructed.
                closest = np.argmin(np.where(rays.status == RayStatus.OK, from_centre, np.inf))
                direction = rays.directions[closest]
                angle = math.degrees(math.atan2(direction[axis], direction[2]))
                fields.append(Field(round(angle, 9) + 0.0, height, share))  # turns -1e-23 and -0.0 on the axis into 0
                break
            height *= 0.95
        else:
            raise InputError(
                f'no light of lens "{lens.name}" reaches the film between its centre and {share:.3g} of its '
                f"half side along {'xy'[axis]}"
            )
    return tuple(fields)


def fields_of_angles(lens: Lens, angles_deg: Sequence[float], object_distance_m: float | None) -> tuple[Field, ...]:
    """Returns field points by their angles in object space. Raises InputError if no light of an angle passes."""
    return tuple(
        Field(angle, _meridional_spot(lens, angle, object_distance_m).chief_ray_mm[1], None) for angle in angles_deg
    )


def angle_of_height(lens: Lens, height_mm: float, object_distance_m: float | None = None) -> tuple[float, float]:
    """Returns the field angle, degrees, whose chief ray reaches a height on the film, mm, and that height.

    If the illuminated field ends below that height, returns the largest angle at which at least a quarter of the rays
    that pass on the axis still pass, and its height. Raises InputError if no light passes the lens.
    """
    min_rays = 1  # rays that must pass at an angle inside the field

    def height_error(angle: float) -> float:
        try:
            spot = _meridional_spot(lens, angle, object_distance_m)
        except InputError:  # beyond the edge of the lens's field
            return math.nan
        return abs(spot.chief_ray_mm[1]) - height_mm if _passing(spot) >= min_rays else math.nan

    at_low = height_error(0.0)
    if math.isnan(at_low):
        raise InputError(f'no light passes lens "{lens.name}"')
    min_rays = max(1, _passing(_meridional_spot(lens, 0.0, object_distance_m)) // 4)
    focal_length = lens.first_order().effective_focal_length_mm
    guess = math.degrees(math.atan(height_mm / abs(focal_length)))
    low, step, growth = 0.0, min(max(guess, 1e-3), _LARGEST_STEP_DEG), 2.0
    while at_low < 0:
        high = low + step
        at_high = height_error(high)
        if at_high >= 0:
            low = root_between(height_error, low, high, at_low, at_high, 1e-10)
            break
        if math.isnan(at_high):
            step, growth = 0.5 * step, 1.0
            if step < 1e-6:
                break
        else:
            low, at_low = high, at_high
            step = min(growth * step, _LARGEST_STEP_DEG)
    return low, abs(_meridional_spot(lens, low, object_distance_m).chief_ray_mm[1])


def _meridional_spot(lens: Lens, angle_deg: float, object_distance_m: float | None) -> Spot:
    return lens.spot(angle_deg, object_distance_m=object_distance_m, pupil=_PROBES)


def _passing(spot: Spot) -> int:
    """Returns the number of rays that pass the lens."""
    return int(np.count_nonzero(spot.status == RayStatus.OK))
