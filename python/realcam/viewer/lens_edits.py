"""Edits of a lens in its table and drawing."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from .._core import Glass, InputError, Lens, Surface

_PLATE_GLASS = "schott:N-BK7"
_BETWEEN_NUMBERS = str.maketrans(",/()", "    ")  # separators in labels of glasses: "1.67 / 47.1", "(1.67, 47.1)"
_DECIMAL_COMMA = re.compile(r"(?<=\d),(?=\d)")


def with_value(lens: Lens, index: int, field: str, value: Any) -> Lens:
    """Returns the lens with one number or glass of a surface changed. field: a column of the table. Raises InputError.

    A radius of 0 or an empty one is a plane.
    """
    surface = _surface(lens, index)
    if field in ("radius_mm", "radius_x_mm"):
        radius = math.inf if value in (None, "", 0, "inf", "∞") else _number(value, "the radius")
        if field == "radius_x_mm":
            return lens.with_surface(index, radius_of_curvature_x_mm=radius)
        return lens.with_surface(index, radius_of_curvature_mm=radius)
    if field == "thickness_mm":
        if _is_moved_by_zoom(lens, index):
            raise InputError(
                f"the zoom ring changes the thickness behind surface {index + 1}; the lens file has its value at each "
                "position",
            )
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
    raise InputError(f'the table of surfaces has no column "{field:.40}"')


def with_plate(lens: Lens, index: int) -> Lens:
    """Inserts a thin glass plate before surface `index` (or behind the last one), in the middle of the air gap.

    Surfaces behind it do not move. If curved faces leave no room for flat ones, the plate's faces have the shape of the
    surface before it. Inside glass, a single surface without effect is inserted, to be edited. Raises InputError.
    """
    surfaces = lens.surfaces
    if not 0 <= index <= len(surfaces):
        raise InputError(f"there is no position {index + 1} in a lens of {len(surfaces)} surfaces")
    if index == 0:
        rim = surfaces[0].clear_semi_diameter_mm
        back = Surface(thickness_mm=0.1 * rim, clear_semi_diameter_mm=rim)
        return lens.inserted(0, [back.replace(thickness_mm=0.2 * rim, material=_PLATE_GLASS), back])
    gap = _Gap.before(lens, index)
    if not gap.narrowest > 0.01:
        raise InputError(f"there is no room before surface {index + 1}, which touches the surface before it")
    medium = next((s.material for s in surfaces[index - 1 :: -1] if s.type == "refracting"), None)
    if medium is not None and medium.index(lens.wavelength_nm) != 1:
        start = 0.5 * gap.narrowest
        return lens.inserted(index, [gap.bent(start, 1, medium)], gap_mm=start * gap.length_mm)
    start, end, face = gap.flat_plate() or (gap.narrowest / 3, 2 * gap.narrowest / 3, gap.bent)
    glass = Glass.named(_PLATE_GLASS)
    return lens.inserted(index, [face(start, end, glass), face(end, 1, None)], gap_mm=start * gap.length_mm)


@dataclass(frozen=True)
class _Gap:
    """Space between two surfaces. Positions in it are fractions of its length on the axis."""

    front: Surface
    back: Surface
    length_mm: float  #: negative if a mirror has reversed the light

    @classmethod
    def before(cls, lens: Lens, index: int) -> _Gap:
        """Returns the gap before a surface, or before the film."""
        front = lens.surfaces[index - 1]
        if index < len(lens.surfaces):
            return cls(front, lens.surfaces[index], front.thickness_mm)
        return cls(front, Surface(clear_semi_diameter_mm=front.clear_semi_diameter_mm), lens.film_distance_mm)

    @property
    def rim_mm(self) -> float:
        """The smaller clear semi-diameter of both surfaces."""
        return min(self.front.clear_semi_diameter_mm, self.back.clear_semi_diameter_mm)

    @cached_property
    def _ends(self) -> list[tuple[float, float]]:
        """Start and end of the gap at 17 distances from the axis, up to the rim."""
        if self.length_mm == 0:
            return [(0.0, 0.0)]
        heights = (self.rim_mm * k / 16 for k in range(17))
        return [(self.front.sag_mm(h) / self.length_mm, 1 + self.back.sag_mm(h) / self.length_mm) for h in heights]

    @property
    def narrowest(self) -> float:
        """Smallest length of the gap within the rim."""
        return min(end - start for start, end in self._ends)

    def bent(self, start: float, end: float, material: Glass | None) -> Surface:
        """Returns a face with the shape of the front surface, which fits anywhere within `narrowest` behind it."""
        return self.flat(start, end, material).replace(
            radius_of_curvature_mm=self.front.radius_of_curvature_mm,
            conic=self.front.conic,
            aspheric_coefficients=self.front.aspheric_coefficients,
        )

    def flat(self, start: float, end: float, material: Glass | None) -> Surface:
        """Returns a flat face at `start` with a medium that reaches to `end`; None: air."""
        return Surface(
            thickness_mm=(end - start) * self.length_mm, material=material, clear_semi_diameter_mm=self.rim_mm
        )

    def flat_plate(self) -> tuple[float, float, Callable[[float, float, Glass | None], Surface]] | None:
        """Positions of the faces of a flat plate, and `flat`; None if the gap has no room for one."""
        start, end = max(start for start, _ in self._ends), min(end for _, end in self._ends)
        rim = self.rim_mm / abs(self.length_mm)
        thickness = min(0.2 * rim, 0.5 * (end - start))
        middle = 0.5 * (start + end)
        return (middle - 0.5 * thickness, middle + 0.5 * thickness, self.flat) if thickness > 0.05 * rim else None


def without(lens: Lens, index: int) -> Lens:
    """Returns the lens without a surface. Raises InputError if it cannot be removed, such as the stop or the last
    glass."""
    _surface(lens, index)
    return lens.removed(index)


def swapped(lens: Lens, index: int, other: int) -> Lens:
    """Returns the lens with two surfaces exchanged. Raises InputError."""
    return lens.with_surfaces({index: _surface(lens, other), other: _surface(lens, index)})


def glass_of(text: Any) -> float | tuple[float, float] | Glass | None:
    """Parses a glass of the table: air, 1.5168, "1.5168 / 64.2" or "schott:N-BK7". Raises InputError.

    Without any point in the text a comma is a decimal comma, as in "1,5168"; otherwise commas separate numbers.
    """
    typed = str("" if text is None else text)
    if "." not in typed:
        typed = _DECIMAL_COMMA.sub(".", typed)
    words = typed.translate(_BETWEEN_NUMBERS).split()
    if not words or words == ["air"]:
        return None
    if words[0][0].isdigit():
        numbers = [_number(word, "the index") for word in words]
        if len(numbers) > 2:
            raise InputError("a glass must be an index, an index and an Abbe number, or a name")
        return numbers[0] if len(numbers) == 1 else (numbers[0], numbers[1])
    return Glass.named(" ".join(words))


def _is_moved_by_zoom(lens: Lens, index: int) -> bool:
    """True if the thickness behind a surface depends on the zoom."""
    return len({lens.zoomed(name).surfaces[index].thickness_mm for name in lens.zoom_positions}) > 1


def _surface(lens: Lens, index: int) -> Surface:
    """Returns a surface by its index. Raises InputError."""
    if not (isinstance(index, int) and 0 <= index < len(lens.surfaces)):
        raise InputError(f"there is no surface {index + 1} in a lens of {len(lens.surfaces)} surfaces")
    return lens.surfaces[index]


def _number(value: Any, name: str) -> float:
    """Parses a number with a decimal point or comma. Raises InputError with the name of the quantity."""
    try:
        return float(str(value).replace(",", ".").replace("−", "-"))
    except ValueError:
        raise InputError(f'{name} must be a number; found "{value!s:.40}"') from None
