"""Numbers as people write them."""

from __future__ import annotations

import math
import re

import pytest
import realcam as rc
from realcam.number_text import counted, number_text, percent_text

from ..programs import Command


@pytest.mark.parametrize(
    ("value", "digits", "text"),
    [
        (50.3612, 4, "50.36"),
        (2.0, 4, "2"),
        (0.00001, 2, "0.00001"),
        (-0.25, 4, "-0.25"),
        (1234567.8, 3, "1 234 568"),  # %g has 1.23e+06
        (-12345.6, 4, "-12 346"),
        (9999.7, 4, "10 000"),
        (9999, 4, "9999"),
        (0, 4, "0"),
        (math.inf, 4, "infinity"),
        (-math.inf, 4, "-infinity"),
        (math.nan, 4, "nan"),
        (6.02214076e23, 3, "6.02e+23"),
        (5e-9, 2, "5e-09"),
    ],
)
def test_numbers(value: float, digits: int, text: str) -> None:
    assert number_text(value, digits) == text


def test_shares_and_counts() -> None:
    assert percent_text(1.4, signed=True) == "+140%"  # %.2g has +1.4e+02
    assert percent_text(-0.016, signed=True) == "-1.6%"
    assert percent_text(0.954, 3) == "95.4%"
    assert (percent_text(0), percent_text(1)) == ("0%", "100%")
    assert [counted(n, "sample") for n in (0, 1, 24, 10_000)] == [
        "0 samples",
        "1 sample",
        "24 samples",
        "10 000 samples",
    ]


def test_texts_of_values_and_commands_have_them(command: Command) -> None:
    one = rc.Image(**{**vars(_picture()), "spp": 1})
    assert "pixels of 1 sample," in repr(one)
    # f^2 / (N c) = 806.6^2 / (5.9 x 0.001) mm is about 110 km.
    printed = command("lens", "photo", "long-800mm", "--circle-of-confusion", "1um").stdout
    assert not re.search(r"\de[+-]\d|\binf\b", printed), printed
    assert re.search(r"by formula +\d{2,3} \d{3} m\n", printed), printed


def _picture() -> rc.Image:
    camera = rc.Camera(rc.Lens.load("tessar-50mm"), film=rc.Film(36, 24, (6, 4)), exposure_time_s=1)
    return rc.render(rc.Scene.load("demo"), camera, spp=2, effects=(), device="cpu")
