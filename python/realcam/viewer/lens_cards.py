"""What the gallery says of each bundled lens, and chooses them by."""

from __future__ import annotations

import math
import re
from functools import cache
from typing import Any

from .._core import Camera, Lens, lens_names

# Angles of view over the diagonal, below which a lens is of this kind.
_BY_ANGLE = (("long", 30.0), ("normal", 56.0), ("wide angle", 100.0), ("very wide angle", math.inf))
_PHONE_DIAGONAL_MM = 12.0
# A number of four digits that is no part of a patent's number, and no page.
_YEAR = re.compile(r"(?<![\d,/.-])(?:1[89]|20)\d\d(?!\d|,\d|-\d)")


@cache
def lens_cards() -> list[dict[str, Any]]:
    """By name."""
    return [_card(name) for name in lens_names()]


def _card(name: str) -> dict[str, Any]:
    lens = Lens.load(name)
    data = lens.first_order()
    angle_deg = Camera(lens).field_of_view_deg.diagonal
    return {
        "name": name,
        "title": lens.title or name,
        "kind": kind_of(lens, angle_deg),
        "focal_length_mm": data.effective_focal_length_mm,
        "f_number": data.f_number,
        "angle_deg": angle_deg,
        "year": year_of(lens.source),
    }


def kind_of(lens: Lens, angle_deg: float) -> str:
    if lens.zoom_positions:
        return "zoom"
    if any(surface.type == "mirror" for surface in lens.surfaces):
        return "mirror lens"
    if is_anamorphic(lens):
        return "anamorphic"
    if math.hypot(*lens.film_mm) < _PHONE_DIAGONAL_MM:
        return "phone"
    return next(kind for kind, below in _BY_ANGLE if angle_deg < below)


def is_anamorphic(lens: Lens) -> bool:
    if lens.is_rotational:
        return False
    one, other = lens.meridians()
    return abs(one.focal_length_mm / other.focal_length_mm - 1) > 0.05


def year_of(source: str) -> int | None:
    """The first year that a lens's source names: that of the patent or of the book."""
    found = _YEAR.search(source)
    return int(found[0]) if found else None
