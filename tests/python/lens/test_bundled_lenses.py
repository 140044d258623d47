"""The bundled lenses against what their sources state: focal length, f-number, back focus, field."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import pytest
import realcam as rc

from ...centred_lenses import CENTRED


class Claim(NamedTuple):
    """Values that a lens's source states, in the scale of the lens file; None if it states none. The lens's file names
    deviations."""

    focal_length_mm: float | None
    f_number: float
    back_focus_mm: float | None
    field_deg: float
    focal_length_share: float = 0.003  # prescriptions of four to five digits
    f_number_share: float = 0.005  # the stop's semi-diameter is the first-order one


CLAIMS = {
    "angulon-210mm": Claim(210, 6.8, None, 75.5),
    "apo-telephoto-180mm": Claim(180, 2.3, 80.622, 12.36),
    "biotar-50mm": Claim(50, 1.4, None, 34.6, f_number_share=0.03),  # f/1.4 would need faces that cross
    "cinema-50mm": Claim(49.99, 1.24, 36.004, 35.33),
    "double-gauss-50mm-fast": Claim(50, 1.4, 36.5, 46.7, f_number_share=0.04),  # f/1.4 would need faces that cross
    "fast-50mm": Claim(50, 1.2, 35.38, 46, f_number_share=0.06),  # the drawing's rims pass less
    "fast-52mm": Claim(51.6, 0.95, 20.317, 45),
    "flektogon-20mm": Claim(20, 4, 36.13, 93),
    "heliar-100mm": Claim(100, 4.5, None, 43.2),
    "hologon-15mm": Claim(15, 8, 4.545, 110),
    "landscape-100mm": Claim(None, 10, 101.50245, 33.4),
    "long-800mm": Claim(800, 5.9, None, 3.1, focal_length_share=0.01),  # nominal figure
    "machine-vision-10mm": Claim(10, 1.8, 17, 66),
    "machine-vision-25mm": Claim(25, 1.4, 14.4975, 27),
    "macro-105mm": Claim(105, 2.8, None, 23.25),
    "petzval-50mm": Claim(None, 1.4, 0.3921 * 25.4, 14),
    "phone-4mm-seven-elements": Claim(4.361, 1.65, 0.581, 80.3),
    "phone-4mm-three-elements": Claim(None, 2.8053, None, 60),
    "planar-50mm-1897": Claim(None, 4.5, 42.3517, 48),
    "projection-24mm-160deg": Claim(None, 2, 2.2376 * 25.4, 160),
    "projection-28mm-120deg": Claim(None, 2.8, 2 * 25.4, 120),
    "retrofocus-28mm": Claim(28, 3.5, 37.59, 75, focal_length_share=0.011),  # nominal figure
    "sonnar-180mm": Claim(180, 2.8, 74.268, 13.7),
    "summicron-50mm": Claim(52, 2, 30.62, 45),
    "ultra-wide-14mm": Claim(14.2, 2.8, 38.65, 113.4),
    "wide-16mm-100deg": Claim(None, 4, 1.5604 * 25.4, 100),
    "wide-24mm": Claim(24.5, 1.4, 36.43, 84),
    "wide-28mm-serenar": Claim(28, 3.5, 22.40, 75, focal_length_share=0.006),  # nominal figure
    "zoom-11-24mm": Claim(11.33, 4.12, 39.88, 124.72),
    "zoom-25-50mm": Claim(25.5, 4, 39.612, 80.6),
    "zoom-70-200mm": Claim(72.10, 2.923, 52.37, 33.4),
    "zoom-80-200mm": Claim(80.1, 4.5, 42.495, 30.2),
}

# Focal lengths of lenses whose sources state little else.
FOCAL_LENGTHS_MM = {
    "achromat-75mm": 75,
    "cooke-triplet-50mm": 50,
    "fisheye-6mm-220deg": 6,
    "mirror-telephoto-500mm": 499.482,
    "phone-4mm": 4.10,
    "sonnar-50mm": 50,
    "telephoto-200mm-inner-focus": 200,
    "tessar-50mm": 50,
    "zoom-70-210mm": 70.55,
}

# Their figures are compared in tests/truth.
COMPARED_ELSEWHERE = {
    "double-gauss-100mm",
    "double-gauss-50mm",
    "fisheye-10mm",
    "singlet-100mm",
    "telephoto-250mm",
    "wide-22mm",
}


def test_no_bundled_lens_is_left_out() -> None:
    """test_unusual_lenses.py has those that are not centred."""
    assert CLAIMS.keys() | FOCAL_LENGTHS_MM.keys() | COMPARED_ELSEWHERE == set(CENTRED)
    assert len(rc.lens_names()) >= 40


@pytest.mark.parametrize("name", CLAIMS)
def test_first_order_is_what_the_source_states(name: str) -> None:
    claim, lens = CLAIMS[name], rc.Lens.load(name)
    data = lens.first_order()
    if claim.focal_length_mm is not None:
        assert data.effective_focal_length_mm == pytest.approx(claim.focal_length_mm, rel=claim.focal_length_share)
    assert data.f_number == pytest.approx(claim.f_number, rel=claim.f_number_share)
    if claim.back_focus_mm is not None:
        # Some sources state the paraxial back focal distance, some that of the best focus; either is accepted.
        # Figures are rounded: 17 for 17.4 at the coarsest.
        nearest = min((data.back_focal_distance_mm, lens.best_focus_mm()), key=lambda b: abs(b - claim.back_focus_mm))
        assert nearest == pytest.approx(claim.back_focus_mm, rel=0.025)


@pytest.mark.parametrize("name", FOCAL_LENGTHS_MM)
def test_focal_length_is_what_the_source_states(name: str) -> None:
    data = rc.Lens.load(name).first_order()
    # Nominal figures and prescriptions with four to five digits: 0.2%.
    assert data.effective_focal_length_mm == pytest.approx(FOCAL_LENGTHS_MM[name], rel=0.002)


@pytest.mark.parametrize("name", CLAIMS)
def test_the_film_and_the_stated_field_belong_together(name: str) -> None:
    """The light of the edge of the stated field passes, and meets the film's plane at about its corner."""
    claim, lens = CLAIMS[name], rc.Lens.load(name)
    rays = lens.aim(np.array([[0.0, 0.0]]), field_deg=claim.field_deg / 2)
    passed = lens.trace(rays.origins_mm, rays.directions, start="scene")
    assert passed.status[0] == rc.RayStatus.OK
    origin, direction = passed.origins_mm[0], passed.directions[0]
    height = abs(origin[1] + (lens.film_position_mm - origin[2]) / direction[2] * direction[1])
    # Films have standard sizes and sources round their angles: a tenth.
    assert height == pytest.approx(0.5 * math.hypot(*lens.film_mm), rel=0.105)
