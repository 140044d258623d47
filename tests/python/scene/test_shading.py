"""Lights, shadows and diffuse reflection against closed forms."""

from __future__ import annotations

import math

import numpy as np
import pytest
import realcam as rc

from .. import scenes


def test_point_light_over_a_plane() -> None:
    place, intensity, albedo = np.array([0.5, 0.3, -1.2]), (100.0, 50.0, 25.0), (0.3, 0.6, 0.9)
    scene = scenes.scene_of(scenes.quad((0, 0, -2), 3, diffuse=albedo)).with_point_light(tuple(place), intensity)
    camera = scenes.pinhole()
    points, rays = scenes.points_on_plane(camera, 16, (0, 0, -2), (0, 0, 1))
    distance = np.linalg.norm(place - points, axis=1)
    expected = scenes.mean_over_pixels(rays, (place - points)[:, 2] / distance**3)  # cos / d^2
    measured = scenes.radiance(scene, camera)
    for c in range(3):
        # The same samples, in float32: some twenty roundings of 6e-8.
        np.testing.assert_allclose(measured[..., c], albedo[c] / math.pi * intensity[c] * expected, rtol=2e-5)


@pytest.mark.parametrize("direction", [(0.0, 0.0, -1.0), (0.3, -2.0, -1.0), (0.0, -1.0, 1.0)])
def test_sun_on_a_plane(direction: tuple[float, float, float]) -> None:
    scene = scenes.scene_of(scenes.quad((0, 0, -2), 3, diffuse=0.5)).with_sun(direction, (1e5, 1e4, 1e3))
    cosine = max(0.0, -direction[2] / math.hypot(*direction))  # the last one shines on the back
    expected = 0.5 / math.pi * cosine * np.array([1e5, 1e4, 1e3])
    np.testing.assert_allclose(
        scenes.radiance(scene, scenes.pinhole()), np.broadcast_to(expected, (16, 24, 3)), rtol=2e-5
    )


@pytest.mark.parametrize("tilted", [False, True])
def test_rectangular_area_light(tilted: bool) -> None:
    # Above the floor y = -1, facing down (right x up = -y), or tilted by 45 degrees towards the floor in
    # view.
    up = (0, -math.sqrt(0.5), math.sqrt(0.5)) if tilted else (0, 0, 1)
    light = scenes.quad((0.4, 1, -2), 0.8, 0.5, right=(1, 0, 0), up=up, emission=1000)
    floor = scenes.quad((0, -1, 0), 10, right=(1, 0, 0), up=(0, 0, -1), diffuse=0.7)
    camera = scenes.pinhole(look_at=(0, -1, -2))
    points, rays = scenes.points_on_plane(camera, 256, (0, -1, 0), (0, 1, 0))
    facing = points @ np.cross((1, 0, 0), up) > light[0][0] @ np.cross((1, 0, 0), up)
    assert facing.all()
    irradiance = scenes.polygon_irradiance(points, np.array([0.0, 1.0, 0.0]), light[0])
    expected = scenes.mean_over_pixels(rays, 0.7 / math.pi * 1000 * irradiance)
    measured = scenes.radiance(scenes.scene_of(floor, light), camera, spp=256)[..., 0]
    # cos cos / d^2 over this light has a relative standard deviation below 0.5: 0.5 / 16 = 3% a pixel of 256
    # samples, 0.2% for the mean of 384 pixels; four of them (the samples are stratified, which makes both
    # smaller).
    np.testing.assert_allclose(measured, expected, rtol=0.12)
    assert measured.mean() == pytest.approx(expected.mean(), rel=0.007)


def test_area_light_shines_to_its_front_alone() -> None:
    floor = scenes.quad((0, -1, 0), 10, right=(1, 0, 0), up=(0, 0, -1), diffuse=0.7)
    away = scenes.quad((0, 1, -2), 0.5, right=(1, 0, 0), up=(0, 0, -1), emission=1000)
    np.testing.assert_array_equal(scenes.radiance(scenes.scene_of(floor, away), scenes.pinhole(look_at=(0, -1, -2))), 0)
    # Seen itself: bright from its front, dark from behind.
    front, back = (
        scenes.quad((0, 0, -2), 3, emission=7),
        scenes.quad((0, 0, -2), 3, right=(-1, 0, 0), emission=7),
    )
    np.testing.assert_allclose(scenes.radiance(scenes.scene_of(front), scenes.pinhole()), 7, rtol=1e-6)
    np.testing.assert_array_equal(scenes.radiance(scenes.scene_of(back), scenes.pinhole()), 0)


def test_shadow_of_a_square() -> None:
    place = np.array([0.0, 0.0, -1.0])
    wall, blocker = scenes.quad((0, 0, -3), 5, diffuse=0.5), scenes.quad((0.1, 0.05, -2), 0.15, diffuse=0.0)
    camera = scenes.pinhole(position=(0, 0, 1.0))
    scene = scenes.scene_of(wall, blocker).with_point_light(tuple(place), (100, 100, 100))
    points, rays = scenes.points_on_plane(camera, 64, (0, 0, -3), (0, 0, 1))
    distance = np.linalg.norm(place - points, axis=1)
    lit = 0.5 / math.pi * 100 * (place - points)[:, 2] / distance**3

    def inside(at: np.ndarray) -> np.ndarray:
        return (np.abs(at[:, 0] - 0.1) < 0.15) & (np.abs(at[:, 1] - 0.05) < 0.15)

    halfway = 0.5 * (points + place)  # the shadow rays pass the plane of the blocker, z = -2, half way
    blocked = inside(halfway)
    hidden = inside(
        rays.origins_m
        + (points - rays.origins_m) * ((-2 - rays.origins_m[:, 2]) / (-3 - rays.origins_m[:, 2]))[:, None]
    )
    expected = scenes.mean_over_pixels(rays, np.where(blocked | hidden, 0.0, lit))
    measured = scenes.radiance(scene, camera, spp=64)[..., 0]
    assert (expected == 0).sum() > 20
    assert (measured[expected == 0] == 0).all()
    # Samples within rounding of the shadow's edge may fall on either side: allow one of 64 in a pixel.
    np.testing.assert_allclose(measured, expected, rtol=2e-5, atol=lit.max() / 64)
    without = scenes.scene_of(wall).with_point_light(tuple(place), (100, 100, 100))
    np.testing.assert_allclose(
        scenes.radiance(without, camera, spp=64)[..., 0], scenes.mean_over_pixels(rays, lit), rtol=2e-5
    )


def test_several_lights_add_up() -> None:
    floor = scenes.quad((0, -1, 0), 10, right=(1, 0, 0), up=(0, 0, -1), diffuse=0.7)
    lamp = scenes.quad((0.4, 1, -2), 0.8, 0.5, right=(1, 0, 0), up=(0, 0, 1), emission=20)
    camera = scenes.pinhole(look_at=(0, -1, -2))
    bare, with_lamp = scenes.scene_of(floor), scenes.scene_of(floor, lamp)
    sun, point = ((0, -1, -0.5), (30, 30, 30)), ((0, 0.5, -2), (12, 12, 12))
    total = with_lamp.with_sun(*sun).with_point_light(*point)
    # The lamp throws shadows of the sun and of nothing else here: it is above the point light.
    parts = [with_lamp, with_lamp.with_sun(*sun), with_lamp.with_point_light(*point)]
    single = [scenes.radiance(scene, camera, spp=1024)[..., 0].mean() for scene in parts]
    expected = single[1] + single[2] - single[0]
    together = scenes.radiance(total, camera, spp=1024)[..., 0].mean()
    # One of three lights is chosen for each sample, so that its relative standard deviation is sqrt(2) or
    # less times the differences of the lights: below 2 over 393216 samples, 0.3%; four of them for both
    # sides.
    assert together == pytest.approx(expected, rel=0.015)
    assert not bare.has_light


@pytest.mark.parametrize("bounces", [0, 1, 4, 16])
def test_furnace(bounces: int) -> None:
    """Inside a closed shell that shines and reflects alike everywhere: L (1 + a + a^2 + ...)."""
    albedo = 0.7
    shell = scenes.sphere(2.0, 16, rc.Material(diffuse=(albedo,) * 3, emission=(1, 1, 1)), inward=True)
    expected = sum(albedo**n for n in range(bounces + 2))
    measured = scenes.radiance(shell, scenes.pinhole(), spp=64, max_bounces=bounces)
    # In a ball each light sample brings exactly the mean. Flat facets make it vary by a few percent, and the mean over
    # 24576 paths by less than 0.1%. The remaining tolerance is for shadow rays and light at the facets' seams.
    assert measured.mean() == pytest.approx(expected, rel=0.003)


@pytest.mark.parametrize("bounces", [0, 2])
def test_convex_body_in_a_furnace(bounces: int) -> None:
    """A ball under a constant sky reflects a L towards everywhere."""
    ball = scenes.sphere(1.3, 24, rc.Material(diffuse=(0.6, 0.6, 0.6)), inward=False).with_environment(1.0)
    camera = scenes.pinhole(rc.Film(24, 16, (48, 32)), position=(0, 0, 4))
    measured = scenes.radiance(ball, camera, spp=16, max_bounces=bounces)
    # A cosine-distributed sample of a constant sky has no noise: float32 roundings only. The picture's corner
    # sees 14.4 mm / 52 mm of 4 m aside, 1.1 m: all of it lies within the ball.
    np.testing.assert_allclose(measured, 0.6, rtol=1e-4)
