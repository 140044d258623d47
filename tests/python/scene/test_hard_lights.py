"""Lights and cameras at the ends of the range: inside of things, in the sun, far from the origin, close to a lamp.

What is right is a closed form; what a sample sees is decided by rays in double precision.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
import realcam as rc

from ...measurement import Measurement, hold
from .. import scenes
from .test_hard_scenes import (
    ALBEDO,
    CLOSED_FORM,
    ROUNDING,
    grey,
    lit,
    pixel_means,
    relative,
    seen,
    tilted_axes,
    under_point_light,
)

AXES = [(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)]


def looking_along(axis: tuple[float, float, float], at: np.ndarray, **more: object) -> rc.Camera:
    up = (0, 0, 1) if abs(axis[1]) > 0.5 else (0, 1, 0)
    return scenes.pinhole(position=tuple(at), look_at=tuple(at + np.asarray(axis, float)), up=up, **more)


def test_camera_inside_of_a_ball(device: str, backend: str) -> None:
    """A ball that shines inwards, from a hand's width to a planet: its own radiance everywhere, and no sun comes in."""
    sizes, worst, leaks = (0.3, 10.0, 1e4, 1e7), 0.0, 0.0
    for radius in sizes:
        for shines in (True, False):
            colour = 1.0 if shines else 0.0
            material = rc.Material(diffuse=(0.5 - 0.5 * colour,) * 3, emission=(colour,) * 3)
            ball = scenes.sphere(radius, 16, material, inward=True).with_sun((0.1, -1, 0.3), (1e5,) * 3)
            ball = ball.with_environment(1e3).with_point_light((0, 2 * radius, 0), (1e9 * radius**2,) * 3)
            for axis in AXES:
                camera = looking_along(axis, np.array([0.1, -0.05, 0.02]) * radius)
                if shines:
                    worst = max(worst, relative(seen(ball, camera, device, spp=4), 1.0))
                else:
                    image = rc.render(ball, camera, effects=(), spp=16, max_bounces=2, device=device)
                    leaks = max(leaks, float(image.pixels.max()))
    tried = f"balls of {sizes[0]:g} to {sizes[-1]:g} m, 6 directions"
    what = "camera inside of a shining ball: radiance"
    hold(Measurement("Scenes", what, tried, backend, "float32", worst, 4 * ROUNDING, "relative"))
    what = "camera inside of a dark ball: light of sun, sky and lamp outside"
    hold(Measurement("Scenes", what, tried, backend, "float32", leaks, 0, "lx s"))


def test_sun_on_the_optical_axis(device: str, backend: str) -> None:
    """With the sun behind the camera, a wall has albedo / pi times the sun's illuminance; with the sun ahead, 0."""
    worst, against = 0.0, 0.0
    for axis in AXES:
        forward = np.asarray(axis, float)
        camera = looking_along(axis, 3 - forward)
        _, right, up = tilted_axes(tuple(-forward))
        wall = scenes.scene_of(grey(3 + 0.0 * forward, 5, right, up))
        behind = wall.with_sun(axis, (1e5,) * 3)
        worst = max(worst, relative(seen(behind, camera, device), ALBEDO / math.pi * 1e5))
        for model in ("pinhole", "full"):
            facing = rc.Camera(
                rc.Lens.load("double-gauss-50mm").focused(2.0),
                film=scenes.FILM,
                position=camera.position,
                look_at=camera.look_at,
                up=camera.up,
                model=model,
            )
            image = rc.render(wall.with_sun(tuple(-forward), (1e5,) * 3), facing, effects=(), spp=16, device=device)
            assert np.isfinite(image.pixels).all()
            against = max(against, float(image.pixels.max()))
    tried = "6 directions, 384 pixels each"
    what = "sun straight from behind"
    hold(Measurement("Scenes", what, tried, backend, "float32", worst, CLOSED_FORM, "relative"))
    what = "sun straight into the lens: light on what it does not reach"
    hold(Measurement("Scenes", what, tried, backend, "float32", against, 0, "lx s"))


@pytest.mark.parametrize("size", [1e6, 1e7])
def test_far_from_the_origin(size: float, device: str, backend: str) -> None:
    worst = 0.0
    normal, right, up = tilted_axes((0.2, 0.3, 1))
    shifts = [size * np.array(v) for v in ((1.0, 0, 0), (-1.0, 1, 1), (0.1234567, -0.9876543, 0.4321))]
    for shift in shifts:
        # The scene's own doubles round at 1e7 m to 2e-9 m.
        middle, light, ahead = (shift + np.array(v) for v in ((0.03, 0.02, -2), (0.3, 0.4, -1.2), (0, 0, -1)))
        camera = scenes.pinhole(position=tuple(shift), look_at=tuple(ahead))
        expected = under_point_light(camera.generate_rays(spp=16), middle, normal, light)
        scene = lit(scenes.scene_of(grey(middle, 3, right, up)), light)
        worst = max(worst, relative(seen(scene, camera, device), expected))
    what, tried = f"{size:g} m from the origin: I cos / d^2", f"{len(shifts)} places, 384 pixels each"
    hold(Measurement("Scenes", what, tried, backend, "float32", worst, CLOSED_FORM, "relative"))


def test_silhouettes_lie_where_projection_puts_them(device: str, backend: str) -> None:
    """Slanted edge of a card 0.2 m to 1e7 m away; its half-width is the distance, or 1e6 times that up to 1e9 m."""
    shift, edges = 0.0, 0
    for distance in (0.2, 3.0, 1e3, 1e7):
        for half in (distance, 1e6 * distance):
            if half > 1e9:
                continue
            camera = scenes.pinhole()
            right, up = np.array([0.8, 0.6, 0.0]), np.array([-0.6, 0.8, 0.0])
            middle = np.array([0, 0, -distance]) + (0.0123 * distance + half) * right
            card = scenes.quad(tuple(middle), half, right=tuple(right), up=tuple(up), emission=1.0)
            rays = camera.generate_rays(spp=256)
            o, d = rays.origins_m, rays.directions.astype(np.float64)
            at = o + ((-distance - o[:, 2]) / d[:, 2])[:, None] * d
            expected = pixel_means(rays, np.where((at - middle) @ right > -half, 1.0, 0.0))
            measured = seen(scenes.scene_of(card), camera, device, spp=256)
            # The edge runs through some 16 rows at 37 degrees: the area that differs, over its length.
            shift = max(shift, float(np.abs(measured - expected).sum()) / (16 / 0.8))
            edges += 1
    what = "silhouette's edge against projection"
    tried = f"{edges} edges at 0.2 to 1e7 m, cards up to 1e9 m large, 384 pixels of 256 samples each"
    # A pixel of 1 mm on a film at 50 mm is 0.02 of the distance: three roundings of the distance are 1e-5 pixels, in
    # which no more than one of 98304 samples lies: 2e-4 pixels. Corners may be 128 times as far: 1.3e-3.
    hold(Measurement("Scenes", what, tried, backend, "float32", shift, 1.5e-3, "pixels"))


@pytest.mark.parametrize("distance", [1.0, 10.0, 1000.0])
def test_lamp_close_to_a_floor(distance: float, device: str, backend: str) -> None:
    """A hundredth and a thousandth of the camera's distance above it: the lamp must not shadow itself."""
    worst = 0.0
    for gap in (1e-2 * distance, 1e-3 * distance):
        half = 20 * gap
        floor = scenes.quad((0, 0, 0), 2 * distance, up=(0, 0, -1), diffuse=ALBEDO)
        lamp = scenes.quad((0, gap, 0), half, up=(0, 0, 1), emission=1e4)
        film = rc.Film(24 * 3 * half / distance, 16 * 3 * half / distance, (24, 16))
        camera = scenes.pinhole(film, position=(0, 0.3 * distance, distance), look_at=(0, 0, 1.5 * half))
        points, rays = scenes.points_on_plane(camera, 16, (0, 0, 0), (0, 1, 0))
        irradiance = scenes.polygon_irradiance(points, np.array([0.0, 1.0, 0.0]), lamp[0])
        expected = pixel_means(rays, ALBEDO / math.pi * 1e4 * irradiance)
        scene = scenes.scene_of(floor, lamp)
        # Only rows that see the floor at least a few gaps away from the lamp.
        beside = slice(8, None)
        # Samples of the lamp alone (0), and rays scattered by the floor as well (1): neither surface lights itself.
        for bounces in (0, 1):
            measured = scenes.radiance(scene, camera, spp=1024, max_bounces=bounces, device=device)[..., 0]
            worst = max(worst, abs(float(measured[beside].mean() / expected[beside].mean()) - 1))
    what = f"lamp 0.01 and 0.001 of {distance:g} m off a floor: polygon formula"
    # The lamp's halves are chosen alike, whichever is seen larger, and its edge is seen at a grazing angle: a relative
    # standard deviation of 1.3 over 196608 samples is 0.3%; four. Drawn evenly by area, it would be 3.
    tried = "192 pixels of 1024 samples each, direct light and a bounce"
    hold(Measurement("Scenes", what, tried, backend, "float32", worst, 0.012, "relative"))


def test_shade_close_to_a_lamp(device: str, backend: str) -> None:
    """No light gets through a shade 1e-2 to 1e-5 of the distance in front of the lamp, whatever the distance."""
    most = 0.0
    for size in (1.0, 1e4):
        for gap in (1e-2, 1e-4, 1e-5):
            floor = scenes.quad((0, -size, 0), 10 * size, up=(0, 0, -1), diffuse=0.7)
            lamp = scenes.quad((0, size, -2 * size), 0.5 * size, up=(0, 0, 1), emission=1)
            shade_half = 0.5 * size * (1 + 1e-6) + 20 * gap * size
            shade = scenes.quad((0, size * (1 - gap), -2 * size), shade_half, up=(0, 0, 1))
            camera = scenes.pinhole(look_at=(0, -size, -2 * size))
            most = max(most, float(seen(scenes.scene_of(floor, lamp, shade), camera, device, spp=64).max()))
    tried = "6 shades, 384 pixels of 64 samples each"
    what = "shade 1e-2 to 1e-5 of the distance before a lamp: light through it"
    hold(Measurement("Scenes", what, tried, backend, "float32", most, 0, "of the lamp"))


def test_small_lamps_far_away(device: str, backend: str) -> None:
    """A millimetre that shines from up to 1e5 m, aslant: its float corners would round it to nothing."""
    worst, distances = 0.0, (1e2, 1e3, 1e4, 1e5)
    card = scenes.quad((0, 0, 0), 1, right=(-1, 0, 0), diffuse=ALBEDO)  # faces the lamp, as the camera does
    camera = scenes.pinhole(position=(0, 0, -1), look_at=(0, 0, 0))
    direction, right, up = tilted_axes((0.6, 0.5, 0.7))
    for distance in distances:
        lamp = scenes.quad(tuple(-distance * direction), 5e-4, right=tuple(right), up=tuple(up), emission=1e12)
        expected = ALBEDO / math.pi * 1e12 * 1e-6 * direction[2] / distance**2
        found = seen(scenes.scene_of(card, lamp), camera, device).mean()
        worst = max(worst, abs(float(found / expected) - 1))
    what, tried = "lamp of 1 mm at 1e2 to 1e5 m: L A cos / d^2", f"{len(distances)} distances, 384 pixels of 16 samples"
    # The card is 1.3 m wide in the picture: at 100 m its cosines and distances differ by 1e-2, in the mean by 1e-4.
    hold(Measurement("Scenes", what, tried, backend, "float32", worst, 3e-4, "relative"))
