"""Least squares over a lens's numbers: the closed forms that it must find."""

from __future__ import annotations

import numpy as np
import pytest
import realcam as rc
from realcam.optimisation.optimiser import _Search

TRIPLET = rc.Lens.load("cooke-triplet-50mm")


def thin_lens(n: float, c1: float, c2: float) -> rc.Lens:
    """Thin lens of f = 100 mm at f/20, the stop at its front."""
    return rc.Lens(
        surfaces=[
            rc.Stop(clear_semi_diameter_mm=2.5),
            rc.Surface(radius_of_curvature_mm=1 / c1, material=n, thickness_mm=0.01, clear_semi_diameter_mm=6),
            rc.Surface(radius_of_curvature_mm=1 / c2, clear_semi_diameter_mm=6),
        ],
        film_distance_mm=100,
        allow_overlap=True,
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


def plano_convex(conic: float) -> rc.Lens:
    """Plano-convex lens of index 1.6, its plane face towards the light."""
    return rc.Lens(
        surfaces=[
            rc.Stop(clear_semi_diameter_mm=10, thickness_mm=1),
            rc.Surface(material=1.6, thickness_mm=5, clear_semi_diameter_mm=11),
            rc.Surface(radius_of_curvature_mm=-60, conic=conic, clear_semi_diameter_mm=11),
        ],
    ).focused(np.inf)


def test_a_hyperbola_is_found() -> None:
    found = rc.optimised(plano_convex(conic=-1.0), [rc.Variable.conic(2)])
    # Collimated light in a medium of index n is focused by a hyperbola of conic -n^2, to a point.
    assert found.lens.surfaces[2].conic == pytest.approx(-(1.6**2), abs=1e-4)
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
    assert found.lens.overlaps() == []


def test_it_stops_where_the_progress_function_says_so() -> None:
    found = rc.optimised(rc.Lens.load("tessar-50mm"), [rc.Variable.radius(0)], progress=lambda count, _: count < 2)
    assert "stopped" in found.message
    assert found.evaluations == 2


FRONT = [rc.Variable.radius(0)]


@pytest.mark.parametrize(
    ("variables", "targets", "message"),
    [
        ([], {}, "must have at least one Variable"),
        ([rc.Variable("colour", 0)], {}, "unknown quantity"),
        ([rc.Variable.radius(99)], {}, "no surface 99"),
        ([rc.Variable.radius(TRIPLET.stop_index)], {}, r"surface \d is a plane stop and has no curvature"),
        ([rc.Variable.conic(1)], {}, "is a plane: its conic has no effect"),
        ([rc.Variable.thickness(6)], {}, "last surface has no thickness"),
        ([rc.Variable.thickness(0, lower_mm=50)], {}, "the thickness of surface 1 is .* does not lie between"),
        ([*FRONT, *FRONT], {}, "variables must be distinct"),
        (FRONT, {"fields_deg": ()}, "at least one field"),
        (FRONT, {"field_weights": (1, 2)}, "as many"),
        (FRONT, {"field_weights": (-1,)}, "positive"),
        (FRONT, {"wavelength_weights": (1, 2)}, "wavelength_weights must be 1 positive"),
        (FRONT, {"operands": [rc.Operand("blur")]}, 'unknown operand "blur"'),
        (FRONT, {"operands": [rc.Operand("length_mm", bound="about")]}, "equal, least or most"),
        (FRONT, {"operands": [rc.Operand("length_mm", weight=0)]}, "positive weight"),
        (
            FRONT,
            {"operands": [rc.Operand("edge_thickness_mm", surface=6)]},
            "surface 7 is the last and has",
        ),
        (
            FRONT,
            {"operands": [rc.Operand("centre_thickness_mm", surface=99)]},
            "there is no surface 99; the lens has 7",
        ),
        (FRONT, {"operands": [rc.Operand("mtf_sagittal")]}, "needs a frequency_per_mm"),
    ],
)
def test_what_makes_no_sense_is_said(variables: list[rc.Variable], targets: dict[str, object], message: str) -> None:
    with_plane = TRIPLET.with_surface(1, radius_of_curvature_mm=np.inf)
    with pytest.raises(rc.InputError, match=message):
        rc.optimised(with_plane, variables, rc.Targets(**targets))  # type: ignore[arg-type]


def triplet_search(**more: object) -> dict[str, object]:
    variables = [rc.Variable.radius(i) for i, s in enumerate(TRIPLET.surfaces) if s.type == "refracting"]
    return {"lens": TRIPLET, "variables": variables, "samples": 3, **more}


def assert_slopes_are_differences(
    lens: rc.Lens, variables: list[rc.Variable], targets: rc.Targets, samples: int
) -> None:
    search = _Search(lens, variables, targets, samples, None)
    assert search.is_exact
    here = np.zeros(len(variables))
    exact, differences = search.jacobian(here), search._differences(here)
    # Rays are aimed within 2.5e-11 of the stop's radius, 1e-10 mm, and a difference is over 1e-2 of a step that moves
    # rays by micrometres: 1e-5 of the largest.
    size = np.abs(differences).max(axis=0)
    assert (np.abs(exact - differences).max(axis=0) < 1e-4 * size).all()


def test_the_jacobian_is_that_of_differences() -> None:
    operands = [
        rc.Operand("distortion_percent", weight=0.01, field_deg=14),
        rc.Operand("edge_thickness_mm", 9.0, surface=0, bound="least"),
        rc.Operand("mtf_tangential", 1.0, weight=0.1, frequency_per_mm=20, field_deg=9),
        rc.Operand("centre_thickness_mm", 5.0, surface=2),
    ]
    variables = [rc.Variable.radius(0), rc.Variable.radius(3), rc.Variable.thickness(1), rc.Variable.thickness(2)]
    targets = rc.Targets(
        fields_deg=(0, 14), wavelengths_nm=(486, 656), wavelength_weights=(1, 2), refocuses=False, operands=operands
    )
    assert_slopes_are_differences(TRIPLET, variables, targets, 3)


@pytest.mark.parametrize(
    ("name", "surfaces"),
    [
        ("anamorphic-65mm", (0, 12, 24)),  # spheres and toroids
        ("view-camera-210mm", (0, 2, 5)),  # before a film that is shifted and tilted
    ],
)
def test_lenses_that_are_not_of_revolution_have_exact_slopes_too(name: str, surfaces: tuple[int, int, int]) -> None:
    lens = rc.Lens.load(name)
    assert not lens.is_rotational
    variables = [rc.Variable.radius(i) for i in surfaces] + [rc.Variable.thickness(surfaces[0], lower_mm=0)]
    # At 5 per mm no step moves a ray by much of a period.
    operands = [rc.Operand("mtf_tangential", 1.0, weight=0.1, frequency_per_mm=5, field_deg=3)]
    for refocuses in (False, True):
        targets = rc.Targets(fields_deg=(0, 5), refocuses=refocuses, operands=operands)
        assert_slopes_are_differences(lens, variables, targets, 2)
    # The object point of a near field moves with such a lens, which the derivatives do not include.
    assert not _Search(lens, variables, rc.Targets(object_distance_m=2.0), 2, None).is_exact


def test_an_anamorphic_lens_becomes_sharper() -> None:
    lens = rc.Lens.load("anamorphic-65mm").focused(np.inf)
    fields = (0, 5)
    found = rc.optimised(
        lens, [rc.Variable.radius(0), rc.Variable.radius(20)], rc.Targets(fields_deg=fields), most_steps=4, samples=3
    )
    before, after = ([of.spot(field, samples=3).rms_radius_mm for field in fields] for of in (lens, found.lens))
    assert np.hypot(*after) < 0.9 * np.hypot(*before)
    assert found.rms_spot_mm < 0.9 * found.rms_spot_before_mm


def test_the_film_follows_as_focusing_moves_it() -> None:
    """Within a thousandth: Lens.focused fills the stop with paraxial heights, the derivative with real ones."""
    from realcam.derivatives.focus import film_distance_by

    for metres in (np.inf, 0.6):
        lens = rc.Lens.load("cooke-triplet-50mm").focused(metres)
        variable = rc.Variable.radius(2)
        step = 1e-5
        ends = [
            lens.with_surface(2, radius_of_curvature_mm=1 / (lens.surfaces[2].curvature_per_mm + side * step))
            .focused(metres)
            .film_distance_mm
            for side in (1, -1)
        ]
        assert film_distance_by(lens, [variable])[0] == pytest.approx((ends[0] - ends[1]) / (2 * step), rel=5e-3)


def test_operands_are_met() -> None:
    operands = [
        rc.Operand("length_mm", 60.0),
        rc.Operand("edge_thickness_mm", 2.0, bound="least", surface=0),
        rc.Operand("distortion_percent", 0.5, 1.0, "most", 16.0),
    ]
    variables = [
        rc.Variable.radius(0),
        rc.Variable.radius(5),
        rc.Variable.thickness(0),
        rc.Variable.thickness(4, 0.1, 30),
    ]
    targets = rc.Targets(fields_deg=(0, 10), operands=operands)
    found = rc.optimised(**triplet_search(variables=variables, targets=targets, most_steps=30))  # type: ignore[arg-type]
    lens = found.lens
    length = sum(s.thickness_mm for s in lens.surfaces[:-1]) + lens.film_distance_mm
    # Weights of 1 against spots of hundredths of a millimetre.
    assert length == pytest.approx(60, abs=0.02)
    front, back = lens.surfaces[0], lens.surfaces[1]
    rim = max(front.clear_semi_diameter_mm, back.clear_semi_diameter_mm)
    assert front.thickness_mm + back.sag_mm(rim) - front.sag_mm(rim) >= 2 - 0.02


def test_a_global_search_looks_all_over_the_bounds() -> None:
    lens, variables = plano_convex(conic=4.0), [rc.Variable.conic(2, -6, 6)]
    near, far = (
        rc.optimised(lens, variables, most_steps=1, samples=3, global_looks=looks).lens.surfaces[2].conic
        for looks in (0, 100)
    )
    # The hyperbola of the test above, a twelfth of the bounds' width away at most; one step of a local search stays.
    assert near == 4
    assert far == pytest.approx(-(1.6**2), abs=1)
    with pytest.raises(rc.InputError, match="finite bounds"):
        rc.optimised(lens, [rc.Variable.conic(2)], global_looks=10)


def test_an_interruption_is_answered_where_that_is_asked_for() -> None:
    def interrupt(count: int, _: float) -> None:
        if count == 3:
            raise KeyboardInterrupt

    found = rc.optimised(**triplet_search(progress=interrupt, answers_interrupt=True))  # type: ignore[arg-type]
    assert found.message == "interrupted"
    assert found.rms_spot_mm <= found.rms_spot_before_mm
    with pytest.raises(KeyboardInterrupt):
        rc.optimised(**triplet_search(progress=interrupt))  # type: ignore[arg-type]
