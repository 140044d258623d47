"""Pupils, principal planes and focal points, and the travel of the focus group."""

from __future__ import annotations

import math
from dataclasses import dataclass

from .._core import InputError, Lens


@dataclass(frozen=True)
class Mark:
    """A paraxial plane or point on the axis."""

    kind: str  #: "pupil", "principal plane" or "focal point"
    label: str  #: EP, XP (entrance and exit pupil); H, H', F, F' (object and image side)
    z_mm: float  #: lens frame
    semi_diameter_mm: float  #: of a pupil; 0 for other kinds


@dataclass(frozen=True)
class FocusGroup:
    """The surfaces that move for focusing."""

    first: int  #: indices in Lens.surfaces
    last: int
    travel_mm: float | None  #: from infinity to the nearest focus, positive towards the film; None: unknown
    nearest_focus_m: float


def marks_of(lens: Lens) -> tuple[Mark, ...]:
    """Returns the marks of a lens at the design wavelength, without those at infinity."""
    data = lens.first_order()
    focal_length = data.effective_focal_length_mm
    rear = lens.vertices_mm[-1] + data.back_focal_distance_mm
    front = data.front_focal_distance_mm
    marks = (
        Mark("pupil", "EP", data.entrance_pupil_position_mm, 0.5 * data.entrance_pupil_diameter_mm),
        Mark("pupil", "XP", data.exit_pupil_position_mm, 0.5 * data.exit_pupil_diameter_mm),
        Mark("principal plane", "H", front + focal_length, 0.0),
        Mark("principal plane", "H'", rear - data.image_index * focal_length, 0.0),
        Mark("focal point", "F", front, 0.0),
        Mark("focal point", "F'", rear, 0.0),
    )
    return tuple(mark for mark in marks if math.isfinite(mark.z_mm) and math.isfinite(mark.semi_diameter_mm))


def focus_group_of(lens: Lens) -> FocusGroup | None:
    """Returns the focus group; None if the whole lens moves."""
    if lens.focus_group is None:
        return None
    first, last = lens.focus_group
    return FocusGroup(first, last, _travel(lens, first), lens.nearest_focus_m)


def _travel(lens: Lens, first: int) -> float | None:
    """Returns FocusGroup.travel_mm of the group that begins with surface `first`."""
    if not lens.nearest_focus_m > 0:
        return None
    try:
        far, near = lens.focused(math.inf), lens.focused(lens.nearest_focus_m)
    except InputError:  # the lens cannot be focused at one of the two distances
        return None
    from_film = [state.vertices_mm[first] - state.film_position_mm for state in (far, near)]
    return from_film[1] - from_film[0]
