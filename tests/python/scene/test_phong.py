"""Phong's lobe: energy, shape, and the light that it passes on."""

from __future__ import annotations

import math

import numpy as np
import pytest
import realcam as rc

from .. import scenes

SPOT = rc.Film(1.5, 1, (24, 16))  # a field of 1.7 degrees: one angle of view


def lobe(shininess: float, mirrored: np.ndarray, directions: np.ndarray) -> np.ndarray:
    """Reflectance per steradian of Phong's lobe as Lafortune and Willems (1994) normalise it."""
    cosine = directions @ mirrored
    value = (shininess + 2) / (2 * math.pi) * np.maximum(0, cosine) ** shininess
    return np.where(cosine > 0, value, 0.0)


def albedo(shininess: float, view_deg: float) -> float:
    """Share of a constant sky that the lobe sends to a viewer: quadrature over the hemisphere about +y."""
    t = math.radians(view_deg)
    mirrored = np.array([math.sin(t), math.cos(t), 0.0])
    height = (np.arange(600) + 0.5) / 600
    turn = 2 * math.pi * (np.arange(1200) + 0.5) / 1200
    c, a = np.meshgrid(height, turn, indexing="ij")
    s = np.sqrt(1 - c**2)
    directions = np.stack([s * np.cos(a), c, s * np.sin(a)], axis=-1)
    return float((lobe(shininess, mirrored, directions) * c).mean() * 2 * math.pi)


def camera_at(view_deg: float) -> rc.Camera:
    t = math.radians(view_deg)
    return scenes.pinhole(SPOT, position=(-2 * math.sin(t), 2 * math.cos(t), 0), look_at=(0, 0, 0), up=(0, 0, 1))


def plane(specular: float, shininess: float, diffuse: float = 0.0, half: float = 10.0) -> scenes.Quad:
    up = (0, 0, -1)
    return scenes.quad((0, 0, 0), half, up=up, specular=specular, shininess=shininess, diffuse=diffuse)


@pytest.mark.parametrize("view_deg", [0, 40, 70])
@pytest.mark.parametrize("shininess", [0, 1, 10])
def test_constant_sky_in_a_lobe(shininess: float, view_deg: float) -> None:
    scene = scenes.scene_of(plane(0.8, shininess)).with_environment(1.0)
    measured = scenes.radiance(scene, camera_at(view_deg), spp=1024)[..., 0].mean()
    # Sky samples follow the cosine, and the lobe's reflectance over its mean has a variance of (n + 2)^2 / (4
    # (n + 1)), up to 3.3 at n = 10 (more at oblique views, where the mean is less): 393216 samples have 0.3%
    # to 0.5%.
    assert measured == pytest.approx(0.8 * albedo(shininess, view_deg), rel=0.015)


@pytest.mark.parametrize("bounces", [1, 4])
def test_no_energy_is_made_in_a_shining_shell(bounces: int) -> None:
    """Inside a shell of radiance 1: between the sums for the lobe's largest and smallest albedo."""
    material = rc.Material(diffuse=(0.3,) * 3, specular=(0.4,) * 3, shininess=8, emission=(1, 1, 1))
    shell = scenes.sphere(2.0, 16, material, inward=True)
    measured = scenes.radiance(shell, scenes.pinhole(), spp=256, max_bounces=bounces)[..., 0].mean()
    # 98304 paths of a relative standard deviation below 1.5: 0.5%; four of them.
    upper = sum(0.7**n for n in range(bounces + 2))
    lower = sum((0.3 + 0.4 * albedo(8, 90)) ** n for n in range(bounces + 2))
    assert 0.98 * lower < measured < 1.02 * upper


@pytest.mark.parametrize(("specular", "diffuse", "shininess"), [(0.9, 0.0, 20), (0.5, 0.4, 5), (0.0, 0.8, 0)])
def test_light_of_a_wall_that_a_floor_passes_on(specular: float, diffuse: float, shininess: float) -> None:
    """One bounce: a sun lights a wall square on and a floor not at all; the floor shows the wall."""
    floor = plane(specular, shininess, diffuse, half=0.3)
    wall = scenes.quad((0, 3, -3), 3, diffuse=0.8)
    scene = scenes.scene_of(floor, wall).with_sun((0, 0, -1), (100, 100, 100))
    camera = scenes.pinhole(SPOT, position=(0, 2, 2), look_at=(0, 0, 0))

    # Quadrature over the wall, seen from the middle of the floor; the field of view is 5 cm there, 2% of the
    # wall's distance, over which the radiance is odd to first order.
    x, y = np.meshgrid((np.arange(800) + 0.5) / 800 * 6 - 3, (np.arange(800) + 0.5) / 800 * 6, indexing="ij")
    to_wall = np.stack([x, y, np.full_like(x, -3.0)], axis=-1)
    squared = (to_wall**2).sum(axis=-1)
    direction = to_wall / np.sqrt(squared)[..., None]
    mirrored = np.array([0.0, math.sqrt(0.5), -math.sqrt(0.5)])
    reflectance = diffuse / math.pi + specular * lobe(shininess, mirrored, direction)
    solid = -direction[..., 2] / squared * (6 / 800) ** 2
    expected = 0.8 / math.pi * 100 * float((reflectance * direction[..., 1] * solid).sum())

    np.testing.assert_array_equal(scenes.radiance(scene, camera, spp=16), 0)
    measured = scenes.radiance(scene, camera, spp=1024, max_bounces=1)[..., 0].mean()
    # A path counts or not, with about even chances, times a cosine: a relative standard deviation of 1.5 over
    # 393216 paths is 0.25%; four of them, and the field of view.
    assert measured == pytest.approx(expected, rel=0.012)


def test_highlight_of_a_point_light() -> None:
    """Closed form: kd / pi plus the lobe, times I cos / d^2."""
    place, shininess = np.array([1.0, 2.0, 0.5]), 30.0
    scene = scenes.scene_of(plane(0.6, shininess, diffuse=0.2)).with_point_light(tuple(place), (10, 10, 10))
    camera = scenes.pinhole(position=(-1.5, 2, 0), look_at=(0, 0, 0), up=(0, 0, 1))
    points, rays = scenes.points_on_plane(camera, 16, (0, 0, 0), (0, 1, 0))
    to_light = place - points
    distance = np.linalg.norm(to_light, axis=1, keepdims=True)
    to_light /= distance
    mirrored = rays.directions * [1, -1, 1]
    cosine = np.maximum(0, (mirrored * to_light).sum(axis=1))
    reflectance = 0.2 / math.pi + 0.6 * (shininess + 2) / (2 * math.pi) * cosine**shininess
    expected = scenes.mean_over_pixels(rays, reflectance * 10 * to_light[:, 1] / distance[:, 0] ** 2)
    # float32: cos^30 turns an error of 1e-7 into 3e-6.
    np.testing.assert_allclose(scenes.radiance(scene, camera)[..., 0], expected, rtol=1e-4)
    assert expected.max() > 5 * np.median(expected)
