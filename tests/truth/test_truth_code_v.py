"""Case A: the double Gauss of a CODE V listing, through the Python API."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest
import realcam as rc

from . import code_v_listing as listing

LENS = listing.listed_lens()
Trace = Callable[..., rc.TraceResult]


@pytest.mark.parametrize("lens", [LENS, rc.Lens.load("double-gauss-100mm")], ids=["open", "bundled"])
def test_glasses_are_those_of_the_listing(lens: rc.Lens) -> None:
    for number, name in listing.GLASSES.items():
        for wavelength_nm, index in zip((656.3, 587.6, 486.1), listing.INDICES[name], strict=True):
            assert lens.surfaces[number - 1].material.index(wavelength_nm) == pytest.approx(index, abs=0.51e-6)


@pytest.mark.parametrize("lens", [LENS, rc.Lens.load("double-gauss-100mm")], ids=["open", "bundled"])
@pytest.mark.parametrize("name", listing.FIRST_ORDER)
def test_first_order_data_to_the_printed_digits(name: str, lens: rc.Lens) -> None:
    # Half a unit of the last digit.
    assert getattr(lens.first_order(), name) == pytest.approx(listing.FIRST_ORDER[name], abs=0.51e-4)


def test_lengths_of_the_listing() -> None:
    bundled = rc.Lens.load("double-gauss-100mm")
    assert bundled.vertices_mm[-1] == pytest.approx(77.9674, abs=0.51e-4)  # OAL
    assert bundled.film_distance_mm == pytest.approx(61.0873, abs=0.51e-4)  # IMG DIS
    focus = bundled.first_order().back_focal_distance_mm
    assert focus - bundled.film_distance_mm == pytest.approx(listing.FOCUS, abs=1e-6)


def test_exit_pupil_from_the_last_vertex() -> None:
    distance = LENS.first_order().exit_pupil_position_mm - LENS.vertices_mm[-1]
    assert distance == pytest.approx(listing.EXIT_PUPIL_FROM_LAST_VERTEX, abs=0.51e-4)


def check_ray(field_tangent: float, rows: list[listing.Row], trace: Trace) -> None:
    """Follows a ray from in front of the lens to each surface, and compares where it is and where it goes."""
    direction = np.array([[0.0, field_tangent, 1.0]]) / math.hypot(1, field_tangent)
    # From the listed point on surface 1 back to a plane in front of the lens.
    first = np.array([[rows[0][0], rows[0][1], rows[0][2]]])
    start = first - direction * 40
    before, path = direction[0], 0.0
    for i, (x, y, z, tan_x, tan_y, length, incidence, refraction) in enumerate(rows):
        out = trace(LENS, start, direction, start="scene", surface_count=i + 1)
        assert out.status[0] == rc.RayStatus.OK
        assert out.surface_index[0] == i
        place = out.origins_mm[0] - (0, 0, LENS.vertices_mm[i])
        np.testing.assert_allclose(place, (x, y, z), atol=1e-5, err_msg=f"surface {i + 1}")
        tangents = out.directions[0, :2] / out.directions[0, 2]
        # Six decimals of the tangents, and of the point that the ray starts from.
        np.testing.assert_allclose(tangents, (tan_x, tan_y), atol=1e-6, err_msg=f"surface {i + 1}")
        if i > 0:
            index = LENS.surfaces[i - 1].material.index(LENS.wavelength_nm)
            assert (out.optical_path_mm[0] - path) / index == pytest.approx(length, abs=1e-5), i + 1
        path = out.optical_path_mm[0]
        normal = np.array([0, 0, 1]) - LENS.surfaces[i].curvature_per_mm * place
        for ray_direction, listed in ((before, incidence), (out.directions[0], refraction)):
            sine = np.linalg.norm(np.cross(ray_direction, normal)) / np.linalg.norm(normal)
            assert math.degrees(math.asin(sine)) == pytest.approx(listed, abs=0.51e-2), i + 1
        before = out.directions[0]


def test_every_ray_of_the_listing(trace: Trace) -> None:
    rays = listing.rays_of_the_listing()
    assert len(rays) == 9
    assert all(len(rows) == 11 for _, rows in rays)
    for printed_tangent, rows in rays:
        angle = {0.0: 0.0, 0.176327: 10.0000000023, 0.249328: 14.0000000032}[printed_tangent]
        check_ray(math.tan(math.radians(angle)), rows, trace)
