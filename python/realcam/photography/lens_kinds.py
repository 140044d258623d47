"""Classification of lenses as photographers choose them."""

from __future__ import annotations

import math
import re

from .._core import Lens

# Upper limits of the diagonal angle of view of each kind, degrees.
_BY_ANGLE = (("long", 30.0), ("normal", 56.0), ("wide angle", 100.0), ("very wide angle", math.inf))
_PHONE_DIAGONAL_MM = 12.0  # lenses for smaller films count as phone lenses
# A year of four digits that is not part of a patent number or a page range.
_YEAR = re.compile(r"(?<![\d,/.-])(?:1[89]|20)\d\d(?!\d|,\d|-\d)")
KINDS = ("zoom", "mirror lens", "anamorphic", "phone", *(kind for kind, _ in _BY_ANGLE))


def kind_of(lens: Lens, angle_deg: float) -> str:
    """Returns the kind of a lens, one of KINDS. angle_deg: its diagonal angle of view."""
    if lens.zoom_positions:
        return "zoom"
    if any(surface.type == "mirror" for surface in lens.surfaces):
        return "mirror lens"
    if is_anamorphic(lens):
        return "anamorphic"
    if math.hypot(*lens.film_mm) < _PHONE_DIAGONAL_MM:
        return "phone"
    return next(kind for kind, limit_deg in _BY_ANGLE if angle_deg < limit_deg)


def is_anamorphic(lens: Lens) -> bool:
    """Returns True if the focal lengths in the two principal meridians differ by more than 5%."""
    if lens.is_rotational:
        return False
    one, other = lens.meridians()
    return abs(one.focal_length_mm / other.focal_length_mm - 1) > 0.05


def year_of(source: str) -> int | None:
    """Returns the first year in a lens's source citation, of the patent or book; None if there is none."""
    found = _YEAR.search(source)
    return int(found[0]) if found else None
