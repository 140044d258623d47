"""Wavefronts through the Python API: the CODE V listing (case A), and another program.

tests/cpp/optics/analysis/test_wavefront.cpp has perfect lenses and closed forms.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest
import realcam as rc

from ..measurement import Measurement, hold
from . import code_v_listing as listing

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
