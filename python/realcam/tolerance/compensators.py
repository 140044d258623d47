"""Compensators: adjustments of an assembled lens."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .._core import InputError, Lens
from .elements import check_element


@dataclass(frozen=True)
class ElementShift:
    """Compensator that moves an element, given by its first and last surface counted from 0, to the sharpest image:
    "along" or "across" the axis, by at most range_mm to either side."""

    first: int
    last: int
    direction: str = "across"
    range_mm: float = 0.5


Compensator = str | ElementShift
NAMES = ("refocus", "film_tilt")  # compensators without parameters: focus, and tilt of the film about x and y


@dataclass(frozen=True)
class Chosen:
    """Compensators of a study: focus, tilt of the film, and shift of an element."""

    refocus: bool
    film_tilt: bool
    shift: ElementShift | None

    @property
    def shift_arguments(self) -> tuple[int, int, bool, float] | None:
        """first, last, whether along the axis, and range_mm of the shift, for the core."""
        s = self.shift
        return None if s is None else (s.first, s.last, s.direction == "along", s.range_mm)


def chosen(lens: Lens, compensators: Sequence[Compensator], fields_deg: NDArray[np.float64]) -> Chosen:
    """Parses compensators. Raises InputError for one that is invalid or has no effect on this lens or these fields."""
    if isinstance(compensators, str):
        compensators = (compensators,)
    names = [c for c in compensators if isinstance(c, str)]
    shifts = [c for c in compensators if not isinstance(c, str)]
    for name in names:
        if name not in NAMES:
            raise InputError(f'unknown compensator "{name:.40}"; expected refocus, film_tilt or an ElementShift')
    if len(shifts) > 1:
        raise InputError("expected at most one ElementShift")
    if "film_tilt" in names and np.linalg.matrix_rank(fields_deg - fields_deg.mean(0), tol=1e-6) < 2:
        raise InputError("film_tilt cannot compensate: the fields lie on one line; expected three that do not")
    if names and math.isinf(lens.first_order().effective_focal_length_mm):
        raise InputError(f"{names[0]} cannot compensate: the lens is afocal and has no image plane")
    for shift in shifts:
        _check_shift(lens, shift)
    return Chosen("refocus" in names, "film_tilt" in names, shifts[0] if shifts else None)


def _check_shift(lens: Lens, shift: ElementShift) -> None:
    """Raises InputError if the shift is invalid or has no effect."""
    if not isinstance(shift, ElementShift):
        raise InputError(f"unknown compensator {shift!r:.40}; expected refocus, film_tilt or an ElementShift")
    check_element(lens, shift.first, shift.last)
    if shift.direction not in ("along", "across"):
        raise InputError(f'ElementShift: unknown direction "{shift.direction!s:.40}"; expected along or across')
    if not (0 < shift.range_mm < math.inf):
        raise InputError(f"ElementShift: range_mm is {shift.range_mm!r:.40}; expected a positive length")
    if all(s.curvature_per_mm == 0 for s in lens.surfaces[shift.first : shift.last + 1]):
        raise InputError(
            f"surfaces {shift.first + 1} to {shift.last + 1} cannot compensate: they are planes, "
            "whose shift has no effect"
        )
