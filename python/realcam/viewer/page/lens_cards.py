"""Data of the bundled lenses for the gallery and its filters."""

from __future__ import annotations

from functools import cache
from typing import Any

from ..._core import Camera, Lens, lens_names
from ...photography.lens_kinds import kind_of, year_of


@cache
def lens_cards() -> list[dict[str, Any]]:
    """Returns the cards in the order of the lenses' names."""
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
        "f_number": lens.f_number,
        "angle_deg": angle_deg,
        "year": year_of(lens.source),
    }
