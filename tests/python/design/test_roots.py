"""realcam.roots: where functions change their sign, and where they end."""

from __future__ import annotations

import math

import pytest
import realcam as rc
from realcam.fields import angle_of_height
from realcam.roots import root_between


@pytest.mark.parametrize("power", [1, 3, 9])
def test_a_root_is_found_to_the_tolerance(power: int) -> None:
    calls = []

    def function(x: float) -> float:
        calls.append(x)
        return x**power - 2

    root = root_between(function, 0.0, 3.0, -2.0, 3.0**power - 2, 1e-12)
    assert root == pytest.approx(2 ** (1 / power), abs=1e-11)
    assert len(calls) < 60


def test_the_end_of_a_function_counts_as_the_far_side() -> None:
    """sqrt(1 - x) - 2 has no root: what is found is the last place where it has a value."""

    def function(x: float) -> float:
        return math.sqrt(1 - x) - 2 if x <= 1 else math.nan

    assert root_between(function, 0.0, 5.0, -1.0, math.nan, 1e-9) == pytest.approx(1, abs=1e-8)
    # One with a root before its end: x - 0.5 up to 0.75.
    assert root_between(lambda x: x - 0.5 if x <= 0.75 else math.nan, 0.0, 5.0, -0.5, math.nan, 1e-9) == pytest.approx(
        0.5, abs=1e-8
    )


def test_a_root_at_an_end_is_that_end() -> None:
    for power in (1, 3):
        assert root_between(lambda x, power=power: x**power - 1, 0.0, 1.0, -1.0, 0.0, 1e-12) == 1.0
    assert root_between(lambda x: x - 1, 1.0, 3.0, 0.0, 2.0, 1e-12) == 1.0


def test_a_film_whose_corner_is_the_field_of_a_file_has_all_of_it() -> None:
    """The chief ray of 20 degrees meets the film's corner exactly: the field is 20 degrees, and not the step before."""
    lens = rc.Lens.load("tessar-50mm")
    height = lens.spot(20.0, pupil=[[0.0, 0.0]]).chief_ray_mm[1]
    assert angle_of_height(lens, abs(height)) == (pytest.approx(20, abs=1e-9), pytest.approx(abs(height)))
