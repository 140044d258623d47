"""Wavefronts through the Python API: the CODE V listing (case A), closed forms (case C), and another program."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest
import realcam as rc

from ..measurement import Measurement, hold
from . import code_v_listing as listing
from .perfect_lenses import ellipsoid, folded_paraboloid

LENS = listing.listed_lens()
FIELDS = {field.field_deg: field for field in listing.FIELD_ABERRATIONS}


def largest(values: np.ndarray) -> float:
    return float(np.abs(values).max())


def measured(what: str, tried: str, worst: float, limit: float, unit: str = "waves") -> None:
    hold(Measurement("Truth", f"{what}, from Python", tried, "core", "float64", worst, limit, unit))


def places_on_the_stop(field: listing.FieldAberrations) -> np.ndarray:
    """Stop points, in units of the stop's radius, of the listing's rays, which are given in the real entrance pupil."""
    angle = math.radians(field.field_deg)
    direction = np.array([0.0, math.sin(angle), math.cos(angle)])
    origins = np.array([(x, y, field.pupil_distance) for x, y, *_ in field.rays]) - 80 * direction
    out = LENS.trace(origins, np.tile(direction, (len(origins), 1)), start="scene", surface_count=LENS.stop_index + 1)
    assert (out.status == rc.RayStatus.OK).all()
    return out.origins_mm[:, :2] / LENS.stop_semi_diameter_mm


def test_optical_path_differences_of_the_listing() -> None:
    worst, tried = 0.0, 0
    for angle, field in FIELDS.items():
        wavefront = LENS.wavefront(angle, pupil=places_on_the_stop(field))
        worst = max(worst, largest(wavefront.opd_waves - [ray[4] for ray in field.rays]))
        tried += len(field.rays)
    # Half a unit of the last digit.
    measured("optical path differences of a double Gauss as CODE V prints them", f"{tried} rays", worst, 0.51e-3)


def test_ray_aberrations_of_the_listing() -> None:
    worst = 0.0
    for angle, field in FIELDS.items():
        spot = LENS.spot(angle, pupil=places_on_the_stop(field))
        offsets = spot.points_mm - spot.chief_ray_mm
        worst = max(worst, largest(offsets - [ray[2:4] for ray in field.rays]))
        assert spot.chief_ray_mm == pytest.approx((0, field.height), abs=0.51e-6)
    # Half a unit of the last digit, and a hundredth of that of the entrance pupil's distance.
    measured("transverse ray aberrations of a double Gauss as CODE V prints them", "28 rays", worst, 1e-6, "mm")


@pytest.mark.parametrize("angle", [a for a in FIELDS if a > 0])
def test_chief_rays_of_the_listing(angle: float, trace: Callable[..., rc.TraceResult]) -> None:
    field = FIELDS[angle]
    step = 1e-4
    aimed = LENS.aim([[0, 0], [step, 0], [-step, 0], [0, step], [0, -step]], angle)
    assert (aimed.status == rc.RayStatus.OK).all()
    origin, direction = aimed.origins_mm[0], aimed.directions[0]
    # The real entrance pupil: where the chief ray, in front of the lens, aims at the axis.
    pupil = origin[2] - origin[1] / direction[1] * direction[2]
    assert pupil == pytest.approx(field.pupil_distance, abs=0.51e-4)
    # X-FOCUS and Y-FOCUS: where rays beside the chief ray cross it, across and in the plane of the field.
    out = trace(LENS, aimed.origins_mm, aimed.directions, start="scene")
    slopes = out.directions[:, :2] / out.directions[:, 2:]
    film = out.origins_mm[:, :2] + slopes * (LENS.film_position_mm - out.origins_mm[:, 2:])
    sagittal = -(film[1, 0] - film[2, 0]) / (slopes[1, 0] - slopes[2, 0])
    tangential = -(film[3, 1] - film[4, 1]) / (slopes[3, 1] - slopes[4, 1])
    assert sagittal == pytest.approx(field.foci[0], abs=1e-6)
    # The listed foci differ from the limit by 2.2e-5 and -1.5e-5: the error, in the presence of coma, of a one-sided
    # difference with a ray 5e-4 of the pupil above the chief ray.
    assert tangential == pytest.approx(field.foci[1], abs=2.5e-5)


def test_the_reference_sphere_of_the_axis() -> None:
    wavefront = LENS.wavefront(0.0)
    first = LENS.first_order()
    assert wavefront.centre_mm == pytest.approx((0, 0, LENS.film_position_mm), abs=1e-12)
    # To the exit pupil of the listing, 53.1569 in front of the last vertex.
    assert wavefront.reference_radius_mm == pytest.approx(61.087268 + 53.1569, abs=0.6e-4)
    assert wavefront.reference_radius_mm == pytest.approx(LENS.film_position_mm - first.exit_pupil_position_mm)


def test_paraboloid_mirror_is_perfect() -> None:
    wavefront = folded_paraboloid().wavefront(pattern="hexapolar", samples=20)
    measured("optical path difference of a folded paraboloid", "1261 rays", largest(wavefront.opd_waves), 1e-6)
    assert wavefront.strehl == pytest.approx(1, abs=1e-9)
    assert folded_paraboloid().spot(samples=20).max_radius_mm < 1e-9


@pytest.mark.parametrize("n", [1.4, 1.5168, 1.9])
def test_ellipsoid_is_perfect(n: float) -> None:
    wavefront = ellipsoid(n).wavefront(pattern="hexapolar", samples=20)
    measured(f"optical path difference of an ellipsoid of index {n}", "1261 rays", largest(wavefront.opd_waves), 1e-6)


def test_aplanatic_meniscus_is_perfect() -> None:
    """A concave surface about the near object, then one to which it lies at R / n from the centre: imaged at n R."""
    n, radius = 1.6, 30.0
    lens = rc.Lens(
        surfaces=[
            rc.Stop(clear_semi_diameter_mm=12),
            rc.Surface(
                radius_of_curvature_mm=-20,
                thickness_mm=radius + radius / n - 20,
                material=n,
                clear_semi_diameter_mm=16,
            ),
            rc.Surface(radius_of_curvature_mm=-radius, clear_semi_diameter_mm=29),
        ],
        film_distance_mm=1.0,
    )
    image = -radius - n * radius
    wavefront = lens.wavefront(object_distance_m=0.020, film_distance_mm=image, pattern="hexapolar", samples=20)
    measured("optical path difference of an aplanatic meniscus", "1261 rays", largest(wavefront.opd_waves), 1e-6)


@pytest.mark.parametrize("defocus_mm", [-0.3, 0.02, 2.0])
def test_defocused_paraboloid(defocus_mm: float) -> None:
    """Nearly pure W020 at f/10: RMS W020 / sqrt 12, Strehl ratio (sin(pi W020) / (pi W020))^2."""
    lens = folded_paraboloid(defocus_mm, semi_diameter_mm=5.0)
    wavefront = lens.wavefront(pattern="rings", samples=40)
    # From the focus on, all rays have one path: the sphere about the film's point, of radius R, cuts them at
    # D (1 - cos T) - (R - sqrt(R^2 - D^2 sin^2 T)) from where it cuts the axis.
    half = math.atan(5.0 / 200)
    radius = wavefront.reference_radius_mm
    sagitta = (defocus_mm * math.sin(2 * half)) ** 2 / radius
    w020 = defocus_mm * 2 * math.sin(half) ** 2 - sagitta / (1 + math.sqrt(1 - sagitta / radius))
    w020 *= 1e6 / lens.wavelength_nm
    # The fourth-order part, 6e-4 of it, is in both by its square only.
    assert wavefront.rms_waves == pytest.approx(abs(w020) / math.sqrt(12), rel=1e-6)
    assert wavefront.strehl == pytest.approx(np.sinc(w020) ** 2, abs=1e-5)
    assert wavefront.strehl_marechal == pytest.approx(math.exp(-((2 * math.pi * wavefront.rms_waves) ** 2)))
    focused = lens.wavefront(pattern="rings", samples=40, remove="focus")
    assert focused.rms_waves < 2e-4 * wavefront.rms_waves


def test_spherical_aberration_goes_over_into_its_third_order() -> None:
    """A plano-convex singlet, closed more and more: W / r^4 at the edge of the stop, extrapolated, is W040."""
    surfaces = [
        rc.Stop(clear_semi_diameter_mm=10),
        rc.Surface(radius_of_curvature_mm=51.68, thickness_mm=4, material=1.5168, clear_semi_diameter_mm=11),
        rc.Surface(clear_semi_diameter_mm=11),
    ]
    open_lens = rc.Lens(surfaces=surfaces, film_distance_mm=90)
    focus = open_lens.first_order().back_focal_distance_mm
    shares = np.array([0.2, 0.1, 0.05])
    edge = open_lens.wavefront(film_distance_mm=focus, pupil=[[0, share] for share in shares]).opd_waves / shares**4
    once = (4 * edge[1:] - edge[:-1]) / 3
    third_order = open_lens.seidel(0).coefficients_waves[:, 0].sum()
    # Rounding: 1e-10 waves over 0.05^4.
    assert (16 * once[1] - once[0]) / 15 == pytest.approx(third_order, abs=3e-5)


# Optiland 0.6.3, chief_ray strategy, of the prescription "phone-4mm" with constant indices (12 aspheres, stop at the
# front): W in waves at five points of the stop. As in realcam, the reference sphere is centred on the chief ray's image
# point; it goes through the centre of the paraxial exit pupil.
STOP_POINTS = np.array([(0, -0.9), (0.9, 0), (0, 0.5), (-0.3, -0.4), (0.7, 0)])
OPTILAND = {
    (math.inf, 0.0): (-0.141604427, -0.141604427, -0.121326875, -0.121326875, -0.140645018),
    (math.inf, 10.0): (0.050607516, -0.029136872, -0.043223033, -0.084815637, -0.015040780),
    (math.inf, 20.0): (-0.055861989, -0.061273713, -0.027182765, -0.075850980, 0.020662935),
    (0.300, 0.0): (-3.124552720, -3.124552720, -1.042726925, -1.042726925, -1.945978411),
    (0.300, 10.0): (-2.802055087, -2.967402476, -0.924284551, -0.975424250, -1.793312162),
    (0.300, 20.0): (-2.553396887, -2.870735311, -0.797232009, -0.882039391, -1.679580442),
}


def test_an_aspheric_lens_as_optiland_has_it() -> None:
    lens = rc.Lens.load("phone-4mm")
    pupil = np.array([0, 0, lens.first_order().exit_pupil_position_mm])
    worst = 0.0
    for (object_m, angle), listed in OPTILAND.items():
        wavefront = lens.wavefront(angle, object_distance_m=object_m, pupil=STOP_POINTS)
        aimed = lens.aim(STOP_POINTS, angle, object_distance_m=object_m)
        out = lens.trace(aimed.origins_mm, aimed.directions, start="scene")
        # From one sphere to the other about the same centre: R - sqrt(R^2 - p^2) of each, p the ray's distance.
        offset = np.linalg.norm(np.cross(out.origins_mm - wavefront.centre_mm, out.directions), axis=1)
        sagitta = [
            r - math.copysign(1, r) * np.sqrt(r**2 - offset**2)
            for r in (wavefront.reference_radius_mm, np.linalg.norm(wavefront.centre_mm - pupil))
        ]
        on_its_sphere = wavefront.opd_waves + (sagitta[0] - sagitta[1]) * 1e6 / lens.wavelength_nm
        worst = max(worst, largest(on_its_sphere - listed))
    measured("optical path differences of a phone lens against Optiland", "30 rays", worst, 1e-6)
