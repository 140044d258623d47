"""Properties by which the gallery of the lens bench selects lenses."""

from __future__ import annotations

import pytest
import realcam as rc
from realcam.photography.lens_kinds import KINDS, year_of
from realcam.viewer.page.lens_cards import lens_cards


@pytest.mark.parametrize(
    ("source", "year"),
    [
        ("US patent 1,882,530, A. W. Tronnier (Jos. Schneider), 1932, f = 1", 1932),
        ("Japanese patent publication JP S39-10178 (Canon, 1964), example 1", 1964),
        ("US patent application 2018/0364457 A1, Y. Yao (Apple)", 2018),
        ("US patent 2,019,985, scaled by 0.1987", None),
        ("a number of 20190 and 1.1954", None),
        ("the maker's data sheet", None),
    ],
)
def test_years_are_no_parts_of_other_numbers(source: str, year: int | None) -> None:
    assert year_of(source) == year


def test_kinds_are_those_of_the_lenses() -> None:
    kinds = {card["name"]: card["kind"] for card in lens_cards()}
    assert set(kinds) == set(rc.lens_names())
    assert set(kinds.values()) == set(KINDS)
    assert kinds["zoom-70-200mm"] == "zoom"
    assert kinds["mirror-telephoto-500mm"] == "mirror lens"
    assert kinds["phone-4mm"] == "phone"
    assert kinds["anamorphic-65mm"] == "anamorphic"
    assert kinds["tessar-50mm"] == "normal"
    assert kinds["sonnar-180mm"] == "long"
    assert kinds["fisheye-6mm-220deg"] == "very wide angle"
