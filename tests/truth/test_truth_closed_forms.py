"""Case C: a thick lens in closed form, through the Python API.

tests/cpp/optics/trace/test_perfect_surfaces.cpp has surfaces that image a point perfectly. test_truth_peers.py holds
rays on their way back and the pupils of every bundled lens.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import pytest
import realcam as rc


@pytest.mark.parametrize(
    ("r1", "r2", "d", "n"),
    [
        (50, -50, 5, 1.5),
        (30, 60, 12, 1.7),
        (-40, -25, 8, 1.6),
        (80, math.inf, 3, 1.5168),
        (-100, -30, 20, 2.0),
    ],
)
def test_thick_lens(r1: float, r2: float, d: float, n: float, trace: Callable[..., rc.TraceResult]) -> None:
    rim = {"clear_semi_diameter_mm": 5.0}
    front = rc.Surface(radius_of_curvature_mm=r1, thickness_mm=d, material=n, **rim)
    lens = rc.Lens(
        surfaces=[rc.Stop(clear_semi_diameter_mm=2), front, rc.Surface(radius_of_curvature_mm=r2, **rim)],
        film_distance_mm=1000,
    )
    # Lensmaker's equation; the focal points from the vertices.
    focal_length = 1 / ((n - 1) * (1 / r1 - 1 / r2 + (n - 1) * d / (n * r1 * r2)))
    first = lens.first_order()
    # Double precision.
    assert first.effective_focal_length_mm == pytest.approx(focal_length, rel=1e-12)
    assert first.back_focal_distance_mm == pytest.approx(focal_length * (1 - (n - 1) * d / (n * r1)), rel=1e-12)
    assert first.front_focal_distance_mm == pytest.approx(-focal_length * (1 + (n - 1) * d / (n * r2)), rel=1e-12)
    # The stop is in front of the glass: it is the entrance pupil.
    assert (first.entrance_pupil_position_mm, first.entrance_pupil_diameter_mm) == (0, 4)
    # A real ray close to the axis crosses it at the back focal point.
    out = trace(lens, [[1e-4, 0, -10]], [[0, 0, 1]], start="scene")
    reach = -out.origins_mm[0, 0] / out.directions[0, 0] * out.directions[0, 2]
    crossing = out.origins_mm[0, 2] + reach - lens.vertices_mm[-1]
    # Third order: (1e-4 / 25)^2, and the rounding of the slope of 1e-6.
    assert crossing == pytest.approx(first.back_focal_distance_mm, rel=1e-8)
