"""Choices before exposure: film, framing, light and exposure, and the field that the camera covers."""

from __future__ import annotations

import itertools
import math
import warnings

import numpy as np
import pytest
import realcam as rc
from pytest import approx

from .. import scenes

LENS = rc.Lens.load("double-gauss-50mm")
CORNERS = [(-1, 0, -0.5), (1, 0, -0.5), (1, 0, 0.5), (-1, 0, 0.5), (-1, 1, -0.5), (1, 1, -0.5)]
CHAIR = rc.Scene.from_arrays(CORNERS, [(0, 2, 1), (0, 3, 2), (0, 1, 5), (0, 5, 4)])


def test_the_film_of_a_lens() -> None:
    assert rc.Film.for_lens(LENS) == rc.Film(*LENS.film_mm, (960, 640))
    assert rc.Film.for_lens(LENS, size_mm=(12, 18)) == rc.Film(12, 18, (640, 960))
    assert rc.Film.for_lens(LENS, resolution=(100, 100)) == rc.Film(24, 24, (100, 100))
    assert rc.Film.for_lens(LENS, (30, 20), (3, 4)) == rc.Film(30, 20, (3, 4))


def test_framing_puts_the_scene_into_the_picture() -> None:
    """All corners of its box, from the entrance pupil, lie in the field of view, and the widest fills most of it."""
    camera = rc.Camera(LENS, iso=800).framing(CHAIR)
    pupil, field = np.array(camera.entrance_pupil_position_m), camera.field_of_view_deg
    assert camera.iso == 800
    assert camera.look_at == pytest.approx((0, 0.5, 0))
    # Slightly from above and aside: half of the angles of the diagonals of the box's sides.
    elevation, azimuth = 0.5 * math.atan2(1, 1), 0.5 * math.atan2(1, 2)
    right = np.array([math.cos(azimuth), 0, -math.sin(azimuth)])
    backward = np.array([math.sin(azimuth), 0, math.cos(azimuth)])
    view = -math.cos(elevation) * backward - math.sin(elevation) * np.array([0, 1, 0])
    assert np.subtract(camera.look_at, camera.position) / math.dist(camera.look_at, camera.position) == approx(view)
    box = np.array(list(itertools.product((-1, 1), (0, 1), (-0.5, 0.5))))
    away = box - pupil
    depth, up = away @ view, away @ np.cross(right, view)
    across = np.degrees(np.arctan2(np.abs(away @ right), depth)).max()
    upward = np.degrees(np.arctan2(np.abs(up), depth)).max()
    assert max(across / (field.horizontal / 2), upward / (field.vertical / 2)) == pytest.approx(0.9, abs=0.02)
    assert math.isfinite(camera.lens.focus_distance_m)


def test_framing_keeps_what_is_given() -> None:
    camera = rc.Camera(LENS).framing(CHAIR, position=(0, 1, 5), look_at=(0, 0, 0), focus_distance_m=3)
    assert (camera.position, camera.look_at, camera.lens.focus_distance_m) == ((0, 1, 5), (0, 0, 0), 3)


def test_a_metered_picture_is_middle_grey_on_average() -> None:
    """10 / ISO lux seconds become middle grey (ISO 12232); 16 samples of 96 x 64 pixels leave less than 2% of noise."""
    lit = CHAIR.with_environment(1000)
    camera = rc.Camera(LENS, film=rc.Film(36, 24, (96, 64)), iso=400).framing(lit)
    metered = camera.metered(lit, device="cpu")
    assert metered == camera.replace(exposure_time_s=metered.exposure_time_s)
    mean = rc.render(lit, metered, effects=(), spp=64, device="cpu").pixels @ np.array([0.2126, 0.7152, 0.0722])
    assert mean.mean() == pytest.approx(10 / 400, rel=0.02)

    with pytest.raises(rc.InputError, match="no light reaches the film"):
        camera.metered(CHAIR, device="cpu")


def test_metering_counts_the_reflections_that_the_picture_will_have() -> None:
    """A white room reflects its light again and again: what is metered with more of it is exposed for less time."""
    room = scenes.sphere(2, 24, rc.Material(diffuse=(0.9, 0.9, 0.9), emission=(1, 1, 1)), inward=True)
    camera = rc.Camera(LENS)
    times = [camera.metered(room, device="cpu", max_bounces=n).exposure_time_s for n in (0, 1, 8)]
    assert times == sorted(times, reverse=True)
    assert times[0] > 1.2 * times[1] > 1.2 * 1.2 * times[2]


def test_daylight_is_what_a_sunny_day_is() -> None:
    """Sunny 16: f/16 and 1 / ISO seconds expose sunlit things of middle reflectance, within half a stop."""
    floor = scenes.scene_of(scenes.quad((0, 0, 0), 9, up=(0, 0, -1), diffuse=0.18))
    camera = rc.Camera(LENS.stopped_down(16), position=(0, 4, 0.1), look_at=(0, 0, 0), exposure_time_s=1 / 125, iso=100)
    lit = floor.with_daylight(camera)
    assert lit.has_light
    assert not floor.has_light
    ratio = camera.metered(lit, device="cpu").exposure_time_s * 125
    assert 2**-0.75 < ratio < 2**0.75


def test_a_scene_without_light_warns_and_says_what_to_do() -> None:
    camera = rc.Camera(LENS, film=rc.Film(resolution=(2, 2))).framing(CHAIR)
    with pytest.warns(UserWarning, match=r"no light.*with_daylight\(camera\)") as caught:
        rc.render(CHAIR, camera, effects=(), spp=1, device="cpu")
    assert caught[0].filename == __file__
    with pytest.warns(UserWarning, match="no light") as caught:
        rc.render(CHAIR, camera, effects=(), spp=1, device="cpu", progress=True)
    assert len(caught) == 1
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        rc.render(CHAIR.with_daylight(camera), camera, effects=(), spp=1, device="cpu")


@pytest.mark.parametrize("model", ["pinhole", "thin", "thick", "full"])
@pytest.mark.parametrize("focus_m", [math.inf, 0.8])
def test_the_field_of_view_is_that_of_the_rays(model: str, focus_m: float) -> None:
    """Rays of the outermost of 2000 pixels, whose half width is a 2000th of the field: 0.02 degrees. Those of a real
    lens spread over its pupil where a film point is not conjugate to infinity; their mean is meant."""
    lens = LENS.focused(focus_m).stopped_down(8)
    for size, side in (((36.0, 24.0 / 2000), 0), ((36.0 / 2000, 24.0), 1)):
        pixels = (2000, 1) if side == 0 else (1, 2000)
        strip = rc.Camera(lens, film=rc.Film(*size, pixels), model=model)
        rays = strip.generate_rays(spp=64)
        passed = rays.weights > 0
        means = [rays.directions[(rays.pixels == pixel) & passed].astype(float).mean(axis=0) for pixel in (0, 1999)]
        angles = [math.atan2(mean[side], -mean[2]) for mean in means]
        whole = rc.Camera(lens, film=rc.Film(36, 24, (3, 2)), model=model).field_of_view_deg
        assert abs(math.degrees(angles[0] - angles[1])) == pytest.approx(whole[side], abs=0.1)


def test_the_field_of_view_of_an_ideal_lens() -> None:
    """At infinity the image of an ideal lens of focal length f lies at f tan w."""
    focal_length = LENS.first_order().effective_focal_length_mm
    field = rc.Camera(LENS.focused(math.inf), film=rc.Film(36, 24, (3, 2)), model="pinhole").field_of_view_deg
    for angle, size in zip(field, (36, 24, math.hypot(36, 24)), strict=True):
        assert angle == pytest.approx(2 * math.degrees(math.atan(size / 2 / focal_length)), rel=1e-6)  # float32
    assert field.diagonal > field.horizontal > field.vertical


def test_the_entrance_pupil_is_where_pinhole_rays_meet() -> None:
    camera = rc.Camera(LENS, position=(1, 2, 3), look_at=(-4, 5, 6), up=(0.1, 1, 0), model="pinhole")
    pupil = camera.entrance_pupil_position_m
    assert pupil is not None
    origins = camera.replace(film=rc.Film(resolution=(3, 2))).generate_rays().origins_m
    assert np.abs(origins - pupil).max() < 1e-7  # float32 over the 0.1 m from film to pupil


def test_a_telecentric_lens_has_no_entrance_pupil_in_reach() -> None:
    """A stop in the rear focal plane of a thin lens: 1/f = (n - 1) / r."""
    surfaces = [
        rc.Surface(radius_of_curvature_mm=50, thickness_mm=1e-6, material=1.5, clear_semi_diameter_mm=10),
        rc.Surface(thickness_mm=100, clear_semi_diameter_mm=10),
        rc.Stop(clear_semi_diameter_mm=2),
    ]
    lens = rc.Lens(surfaces=surfaces, film_distance_mm=10, allow_overlap=True)
    data = lens.first_order()
    exact = data.back_focal_distance_mm + 100
    telecentric = lens.with_surface(1, thickness_mm=exact)
    assert rc.Camera(telecentric, model="thick").entrance_pupil_position_m is None
