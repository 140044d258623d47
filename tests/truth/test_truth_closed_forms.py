"""Case C: closed forms that a lens must obey, through the Python API.

tests/cpp/optics/trace/test_perfect_surfaces.cpp has surfaces that image a point perfectly.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest
import realcam as rc

from ..centred_lenses import CENTRED

LENSES = CENTRED
Trace = Callable[..., rc.TraceResult]


def stop(semi_diameter: float) -> rc.Surface:
    return rc.Stop(clear_semi_diameter_mm=semi_diameter)


def parallel(heights: np.ndarray, z: float = -10.0) -> tuple[np.ndarray, np.ndarray]:
    """Rays along the axis at these distances from it, at azimuths of the golden angle."""
    azimuth = 2.4 * np.arange(len(heights))
    origins = np.stack([heights * np.cos(azimuth), heights * np.sin(azimuth), np.full_like(heights, z)], axis=1)
    return origins, np.tile([0.0, 0.0, 1.0], (len(heights), 1))


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
def test_thick_lens(r1: float, r2: float, d: float, n: float, trace: Trace) -> None:
    rim = {"clear_semi_diameter_mm": 5.0}
    front = rc.Surface(radius_of_curvature_mm=r1, thickness_mm=d, material=n, **rim)
    lens = rc.Lens(surfaces=[stop(2), front, rc.Surface(radius_of_curvature_mm=r2, **rim)], film_distance_mm=1000)
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
    origins, directions = parallel(np.array([1e-4]))
    out = trace(lens, origins, directions, start="scene")
    reach = -out.origins_mm[0, 0] / out.directions[0, 0] * out.directions[0, 2]
    crossing = out.origins_mm[0, 2] + reach - lens.vertices_mm[-1]
    # Third order: (1e-4 / 25)^2, and the rounding of the slope of 1e-6.
    assert crossing == pytest.approx(first.back_focal_distance_mm, rel=1e-8)


@pytest.mark.parametrize("name", LENSES)
def test_light_retraces_itself(name: str, trace: Trace) -> None:
    lens = rc.Lens.load(name)
    rng = np.random.default_rng(4)
    first, film = lens.first_order(), lens.film_position_mm
    height = 0.45 * min(lens.film_mm)
    origins = np.stack([*rng.uniform(-height, height, (2, 4000)), np.full(4000, film)], axis=1)
    pupil = 0.55 * first.exit_pupil_diameter_mm * rng.uniform(-1, 1, (4000, 2))
    target = np.concatenate([pupil, np.full((4000, 1), first.exit_pupil_position_mm)], axis=1)
    directions = (target - origins) * np.sign(film - first.exit_pupil_position_mm)
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    out = trace(lens, origins, directions, start="film")
    passed = out.status == rc.RayStatus.OK
    assert passed.sum() > 400
    # Start a little in front of the lens, and go all the way back to the film.
    ahead = out.origins_mm + 5 * out.directions
    back = trace(lens, ahead[passed], -out.directions[passed], start="scene")
    # A ray that grazes a rim may be cut on the way back.
    same = back.status == rc.RayStatus.OK
    assert same.mean() > 0.999
    reach = (film - back.origins_mm[:, 2]) / back.directions[:, 2]
    landed = back.origins_mm + reach[:, None] * back.directions
    # 1e-10 mm in double precision; half a metre of glass and mirrors turns 1e-16 into no more than that.
    assert np.abs(landed - origins[passed])[same].max() < 1e-10
    assert np.abs(back.directions + directions[passed])[same].max() < 1e-10


@pytest.mark.parametrize("name", LENSES)
def test_pupils_obey_the_lagrange_invariant(name: str, trace: Trace) -> None:
    """A ray through the middle of the entrance pupil leaves from the middle of the exit pupil.

    Its slope has changed by the ratio of their diameters.
    """
    lens = rc.Lens.load(name)
    first, slope = lens.first_order(), 1e-5
    # A central obstruction would stop it: the surfaces without theirs.
    surfaces = [
        rc.Surface(
            radius_of_curvature_mm=s.radius_of_curvature_mm,
            thickness_mm=s.thickness_mm,
            material=None if s.material.label == "" else s.material,
            clear_semi_diameter_mm=s.clear_semi_diameter_mm,
            conic=s.conic,
            aspheric_coefficients=s.aspheric_coefficients,
            type=s.type,
        )
        for s in lens.surfaces
    ]
    open_lens = rc.Lens(surfaces=surfaces, film_distance_mm=lens.film_distance_mm, wavelength_nm=lens.wavelength_nm)
    z = -20.0
    origin = [[(z - first.entrance_pupil_position_mm) * slope, 0.0, z]]
    out = trace(open_lens, origin, [[slope, 0.0, 1.0]], start="scene")
    assert out.status[0] == rc.RayStatus.OK
    leaving = out.directions[0, 0] / out.directions[0, 2]
    ratio = first.entrance_pupil_diameter_mm / first.exit_pupil_diameter_mm
    # Third order in 1e-5 and double precision over a small slope.
    assert abs(leaving / slope) == pytest.approx(ratio, rel=1e-7)
    crossing = out.origins_mm[0, 2] - out.origins_mm[0, 0] / leaving
    assert crossing == pytest.approx(first.exit_pupil_position_mm, rel=1e-6, abs=1e-5)
