"""Least squares over a lens's numbers: the closed forms that it must find."""

from __future__ import annotations

import numpy as np
import pytest
import realcam as rc


def thin_lens(n: float, c1: float, c2: float) -> rc.Lens:
    """Of f = 100 mm at f/20, the stop at its front."""
    return rc.Lens(
        surfaces=[
            rc.Stop(clear_semi_diameter_mm=2.5),
            rc.Surface(radius_of_curvature_mm=1 / c1, material=n, thickness_mm=0.01, clear_semi_diameter_mm=6),
            rc.Surface(radius_of_curvature_mm=1 / c2, clear_semi_diameter_mm=6),
        ],
        film_distance_mm=100,
        allow_crossing=True,
    )


@pytest.mark.parametrize("n", [1.5, 1.8])
def test_a_thin_lens_bends_to_the_least_spherical_aberration(n: float) -> None:
    power = 0.01 / (n - 1)
    lens = thin_lens(n, 0.5 * power, -0.5 * power).focused(np.inf)
    found = rc.optimised(
        lens,
        [rc.Variable.radius(1), rc.Variable.radius(2)],
        rc.Targets(focal_length_mm=100.0, focal_length_weight=10.0),
    )
    c1, c2 = (found.lens.surfaces[i].curvature_per_mm for i in (1, 2))
    # Jenkins and White, Fundamentals of Optics, section 9.4: q = (r2 + r1) / (r2 - r1) = -2 (n^2 - 1) p / (n + 2), with
    # p = -1 for a far object. At f/20 fifth order is a hundredth of the third.
    assert (c1 + c2) / (c1 - c2) == pytest.approx(2 * (n * n - 1) / (n + 2), rel=0.02)
    assert found.lens.first_order().effective_focal_length_mm == pytest.approx(100, rel=1e-4)
    assert found.rms_spot_mm < found.rms_spot_before_mm


def test_a_hyperbola_is_found() -> None:
    n = 1.6
    lens = rc.Lens(
        surfaces=[
            rc.Stop(clear_semi_diameter_mm=10, thickness_mm=1),
            rc.Surface(material=n, thickness_mm=5, clear_semi_diameter_mm=11),
            rc.Surface(radius_of_curvature_mm=-60, conic=-1.0, clear_semi_diameter_mm=11),
        ],
    ).focused(np.inf)
    found = rc.optimised(lens, [rc.Variable.conic(2)])
    # Collimated light in a medium of index n is focused by a hyperbola of conic -n^2, to a point.
    assert found.lens.surfaces[2].conic == pytest.approx(-n * n, abs=1e-4)
    assert found.rms_spot_mm < 1e-6 < found.rms_spot_before_mm


def test_bounds_hold_and_no_impossible_lens_is_stepped_to() -> None:
    lens = rc.Lens.load("cooke-triplet-50mm")
    seen: list[float] = []

    def note(_: int, rms_mm: float) -> None:
        seen.append(rms_mm)

    gap = lens.surfaces[1].thickness_mm
    variables = [
        rc.Variable.radius(0, least_radius_mm=15),
        rc.Variable.thickness(1, lower_mm=gap - 0.05, upper_mm=gap + 0.05),
        rc.Variable.radius(5, least_radius_mm=10),
    ]
    targets = rc.Targets(fields_deg=(0, 10, 16), field_weights=(1, 2, 1), wavelengths_nm=(486.1, 587.6, 656.3))
    found = rc.optimised(lens, variables, targets, most_steps=12, samples=4, progress=note)
    assert abs(found.lens.surfaces[1].thickness_mm - gap) <= 0.05 + 1e-9
    assert abs(found.lens.surfaces[0].radius_of_curvature_mm) >= 15 - 1e-9
    assert found.rms_spot_mm <= found.rms_spot_before_mm
    assert len(seen) == found.evaluations or len(seen) > 3
    assert found.lens.crossings() == []


def test_it_stops_where_the_progress_function_says_so() -> None:
    found = rc.optimised(rc.Lens.load("tessar-50mm"), [rc.Variable.radius(0)], progress=lambda count, _: count < 2)
    assert "stopped" in found.message
    assert found.evaluations == 2


@pytest.mark.parametrize(
    ("variables", "targets", "message"),
    [
        ([], rc.Targets(), "nothing to change"),
        ([rc.Variable("colour", 0)], rc.Targets(), "unknown quantity"),
        ([rc.Variable.radius(99)], rc.Targets(), "no surface 99"),
        ([rc.Variable.radius(6)], rc.Targets(), "a plane, and has no curvature"),
        ([rc.Variable.thickness(7)], rc.Targets(), "last surface has no thickness"),
        ([rc.Variable.thickness(0, lower_mm=50)], rc.Targets(), "does not lie between"),
        ([rc.Variable.radius(0), rc.Variable.radius(0)], rc.Targets(), "named twice"),
        ([rc.Variable.radius(0)], rc.Targets(fields_deg=()), "at least one field"),
        ([rc.Variable.radius(0)], rc.Targets(field_weights=(1, 2)), "as many"),
        ([rc.Variable.radius(0)], rc.Targets(field_weights=(-1,)), "positive"),
    ],
)
def test_what_makes_no_sense_is_said(variables: list[rc.Variable], targets: rc.Targets, message: str) -> None:
    lens = rc.Lens.load("tessar-50mm")
    variables = [rc.Variable.radius(lens.stop_index) if "plane" in message else v for v in variables]
    if "last surface" in message:
        variables = [rc.Variable.thickness(len(lens.surfaces) - 1)]
    with pytest.raises(rc.InputError, match=message):
        rc.optimised(lens, variables, targets)
