"""Changes of a lens as a user makes them in its table and drawing, with undo and redo."""

from __future__ import annotations

import math
from typing import Any

from .._core import Glass, InputError, Lens, Surface

_MOST_STEPS = 200
_PLATE_GLASS = "schott:N-BK7"
_BETWEEN_NUMBERS = str.maketrans(",/()", "    ")  # as labels of glasses have them: "1.67 / 47.1" and "(1.67, 47.1)"


def with_value(lens: Lens, index: int, field: str, value: Any) -> Lens:
    """A lens with one number or glass of a surface changed. field: a column of the table. Raises InputError.

    A radius of 0 or of no number is a plane.
    """
    surface = _surface(lens, index)
    if field == "radius_mm":
        radius = math.inf if value in (None, "", 0, "inf", "∞") else _number(value, "the radius")
        return lens.with_surface(index, radius_of_curvature_mm=radius)
    if field == "thickness_mm":
        return lens.with_surface(index, thickness_mm=_number(value, "the thickness"))
    if field == "semi_diameter_mm":
        return lens.with_surface(index, clear_semi_diameter_mm=_number(value, "the semi-diameter"))
    if field == "conic":
        return lens.with_surface(index, conic=_number(value, "the conic constant"))
    if field == "glass":
        return lens.with_surface(index, material=glass_of(value))
    if field.startswith("a") and field[1:].isdecimal():
        terms = dict(surface.aspheric_coefficients)
        terms[int(field[1:])] = _number(value, "the aspheric coefficient")
        return lens.with_surface(index, aspheric_coefficients=terms)
    raise InputError(f'"{field:.40}" is no column of the table of surfaces')


def with_plate(lens: Lens, index: int) -> Lens:
    """With a thin plate of glass before surface `index` (or behind the last one), in the middle of the air there."""
    surfaces = lens.surfaces
    if not 0 <= index <= len(surfaces):
        raise InputError(f"there is no place {index + 1} in a lens of {len(surfaces)} surfaces")
    beside = surfaces[min(index, len(surfaces) - 1)].clear_semi_diameter_mm
    thickness = 0.2 * beside
    plate = [
        Surface(thickness_mm=thickness, material=_PLATE_GLASS, clear_semi_diameter_mm=beside),
        Surface(clear_semi_diameter_mm=beside),
    ]
    if index == 0:
        return lens.inserted(0, [plate[0], plate[1].replace(thickness_mm=0.1 * beside)])
    room = lens.film_distance_mm if index == len(surfaces) else surfaces[index - 1].thickness_mm
    gap = 0.5 * (room - thickness)
    if gap <= 0:
        raise InputError(f"there is no room for a plate of {thickness:.3g} mm before surface {index + 1}")
    return lens.inserted(index, plate, gap_mm=gap)


def without(lens: Lens, index: int) -> Lens:
    """Raises InputError, for the stop as for the last glass."""
    _surface(lens, index)
    return lens.removed(index)


def swapped(lens: Lens, index: int, other: int) -> Lens:
    """Two surfaces in each other's places. Raises InputError."""
    return lens.with_surfaces({index: _surface(lens, other), other: _surface(lens, index)})


def glass_of(text: Any) -> float | tuple[float, float] | Glass | None:
    """A glass as the table has it: air, 1.5168, "1.5168 / 64.2" or "schott:N-BK7". Raises InputError."""
    words = [word for word in str("" if text is None else text).translate(_BETWEEN_NUMBERS).split() if word]
    if not words or words == ["air"]:
        return None
    if words[0][0].isdigit():
        numbers = [_number(word, "the index") for word in words]
        if len(numbers) > 2:
            raise InputError("a glass is its index, its index and its Abbe number, or its name")
        return numbers[0] if len(numbers) == 1 else (numbers[0], numbers[1])
    return Glass.named(" ".join(words))


class LensHistory:
    """The lenses that edits have made, of which one is shown."""

    def __init__(self, lens: Lens) -> None:
        self._lenses, self._at = [lens], 0
        self._gesture: object = None

    @property
    def lens(self) -> Lens:
        return self._lenses[self._at]

    @property
    def can_undo(self) -> bool:
        return self._at > 0

    @property
    def can_redo(self) -> bool:
        return self._at + 1 < len(self._lenses)

    def push(self, lens: Lens, gesture: object = None) -> None:
        """What comes of one drag has one `gesture`, and is undone in one step."""
        if gesture is not None and gesture == self._gesture:
            self._lenses[self._at] = lens
            return
        self._gesture = gesture
        self._lenses[self._at + 1 :] = [lens]
        del self._lenses[:-_MOST_STEPS]
        self._at = len(self._lenses) - 1

    def undo(self) -> Lens:
        self._gesture = None
        self._at = max(0, self._at - 1)
        return self.lens

    def redo(self) -> Lens:
        self._gesture = None
        self._at = min(len(self._lenses) - 1, self._at + 1)
        return self.lens


def _surface(lens: Lens, index: int) -> Surface:
    if not (isinstance(index, int) and 0 <= index < len(lens.surfaces)):
        raise InputError(f"there is no surface {index + 1} in a lens of {len(lens.surfaces)}")
    return lens.surfaces[index]


def _number(value: Any, what: str) -> float:
    try:
        return float(str(value).replace(",", ".").replace("−", "-"))
    except ValueError:
        raise InputError(f'{what}: "{value!s:.40}" is no number') from None
