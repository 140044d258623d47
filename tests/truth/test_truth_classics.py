"""Case B: first-order data of four classic prescriptions, on which two programs agree."""

from __future__ import annotations

import pytest
import realcam as rc

# Name: surfaces, stop (from 1), focal length, back focal distance, f-number.
CLASSICS = {
    "double-gauss-50mm": (11, 6, 50.3582, 36.1059, 2.03),
    "wide-22mm": (13, 6, 22.0235, 14.3183, 2.68),
    "fisheye-10mm": (12, 7, 9.9914, 23.1605, 3.95),
    "telephoto-250mm": (7, 4, 249.5666, 105.0704, 5.42),
}

# Radius, thickness, index behind, clear diameter; "STO" the stop. A prescription is its numbers: built here
# again, so that a slip in the lens file and one in the program cannot hide each other.
TABLES = {
    "double-gauss-50mm": (
        "29.475 3.76 1.67 25.2 | 84.83 .12 1 25.2 | 19.275 4.025 1.67 23 | 40.77 3.275 1.699 23 | "
        "12.75 5.705 1 18 | STO 4.5 1 17.1 | -14.495 1.18 1.603 17 | 40.77 6.065 1.658 20 | "
        "-20.385 .19 1 20 | 437.065 3.22 1.717 20 | -39.73 0 1 20"
    ),
    "wide-22mm": (
        "35.98738 1.21638 1.54 23.716 | 11.69718 9.9957 1 17.996 | 13.08714 5.12622 1.772 12.364 "
        "| -22.63294 1.76924 1.617 9.812 | 71.05802 .8184 1 9.152 | STO 2.27766 1 8.756 | "
        "-9.58584 2.43254 1.617 8.184 | -11.28864 .11506 1 9.152 | -166.7765 3.09606 1.713 10.648 "
        "| -7.5911 1.32682 1.805 11.44 | -16.7662 3.98068 1 12.276 | -7.70286 1.21638 1.617 13.42 "
        "| -11.97328 0 1 17.996"
    ),
    "fisheye-10mm": (
        "30.2249 .8335 1.62 30.34 | 11.3931 7.4136 1 20.68 | 75.2019 1.0654 1.639 17.8 | "
        "8.3349 11.1549 1 13.42 | 9.5882 2.0054 1.654 9.02 | 43.8677 5.3895 1 8.14 | "
        "STO 1.4163 1 6.08 | 29.4541 2.1934 1.517 5.96 | -5.2265 .9714 1.805 5.84 | "
        "-14.2884 .0627 1 5.96 | -22.3726 .94 1.673 5.96 | -15.0404 0 1 6.52"
    ),
    "telephoto-250mm": (
        "54.6275 12.52 1.529 47.5 | -86.365 3.755 1.599 44.5 | 271.7625 2.8175 1 41.5 | "
        "STO 67.4125 1 40.5 | -32.13 3.755 1.613 31.5 | 49.5325 12.52 1.603 33.5 | -50.945 0 1 37"
    ),
}


def built(name: str) -> rc.Lens:
    surfaces = []
    for row in TABLES[name].split("|"):
        radius, *numbers = row.split()
        thickness, index, diameter = (float(n) for n in numbers)
        if radius == "STO":
            surfaces.append(rc.Stop(clear_semi_diameter_mm=diameter / 2, thickness_mm=thickness))
        else:
            surfaces.append(
                rc.Surface(
                    radius_of_curvature_mm=float(radius),
                    thickness_mm=thickness,
                    material=index if index != 1 else None,
                    clear_semi_diameter_mm=diameter / 2,
                )
            )
    return rc.Lens(surfaces=surfaces, name=name)


@pytest.mark.parametrize("name", CLASSICS)
def test_first_order_data(name: str) -> None:
    lens = rc.Lens.load(name)
    count, stop, focal_length, back_focal_distance, f_number = CLASSICS[name]
    first = lens.first_order()
    assert (len(lens.surfaces), lens.stop_index + 1) == (count, stop)
    # Half a unit of the last printed digit.
    assert first.effective_focal_length_mm == pytest.approx(focal_length, abs=0.5e-4)
    assert first.back_focal_distance_mm == pytest.approx(back_focal_distance, abs=0.5e-4)
    assert first.f_number == pytest.approx(f_number, abs=0.5e-2)


@pytest.mark.parametrize("name", CLASSICS)
def test_lens_file_and_table_are_one_lens(name: str) -> None:
    for a, b in zip(rc.Lens.load(name).surfaces, built(name).surfaces, strict=True):
        assert a.type == b.type
        assert a.curvature_per_mm == pytest.approx(b.curvature_per_mm, rel=1e-15)
        assert a.thickness_mm == b.thickness_mm
        assert a.clear_semi_diameter_mm == pytest.approx(b.clear_semi_diameter_mm, rel=1e-15)
        assert a.material.index(587.5618) == b.material.index(587.5618)
