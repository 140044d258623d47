"""Light from all around: constant skies and images of the surroundings."""

from __future__ import annotations

import math

import numpy as np
import pytest
import realcam as rc

from .. import scenes

AXES = {
    "+x": (1, 0, 0),
    "-x": (-1, 0, 0),
    "+y": (0, 1, 0),
    "-y": (0, -1, 0),
    "+z": (0, 0, 1),
    "-z": (0, 0, -1),
}


def facing(normal: tuple[float, float, float], albedo: float) -> tuple[rc.Scene, rc.Camera]:
    """A plane through the origin, wider than the picture, and a camera square in front of it."""
    n = np.asarray(normal, float)
    n /= np.linalg.norm(n)
    side = np.array([0.0, 0.0, 1.0]) if abs(n[1]) > 0.9 else np.array([0.0, 1.0, 0.0])
    right = np.cross(side, n)
    right /= np.linalg.norm(right)
    up = np.cross(n, right)
    plane = scenes.scene_of(scenes.quad((0, 0, 0), 2, right=right, up=up, diffuse=albedo))
    return plane, scenes.pinhole(position=tuple(2 * n), look_at=(0, 0, 0), up=tuple(up))


def pixel_directions(height: int, width: int, parts: int) -> tuple[np.ndarray, np.ndarray]:
    """Directions (H, W, parts^2, 3) within the pixels of a latitude-longitude image, and the solid angle of
    each.

    Row 0 is up, the middle column lies towards -z; seen from inside, columns grow to the right: +x.
    """
    polar = math.pi * (np.arange(height * parts) + 0.5) / (height * parts)
    azimuth = 2 * math.pi * ((np.arange(width * parts) + 0.5) / (width * parts) - 0.5)
    p, a = np.meshgrid(polar, azimuth, indexing="ij")
    d = np.stack([np.sin(p) * np.sin(a), np.cos(p), -np.sin(p) * np.cos(a)], axis=-1)
    solid = np.sin(p) * (math.pi / (height * parts)) * (2 * math.pi / (width * parts))

    def split(values: np.ndarray, tail: tuple[int, ...]) -> np.ndarray:
        blocks = values.reshape(height, parts, width, parts, *tail)
        return np.moveaxis(blocks, 2, 1).reshape(height, width, parts**2, *tail)

    return split(d, (3,)), split(solid, ())


def irradiance(image: np.ndarray, normal: tuple[float, float, float]) -> float:
    """Irradiance of a plane under an image (H, W) of radiance, by the midpoint rule on 32 x 32 parts of each pixel."""
    directions, solid = pixel_directions(*image.shape, 32)
    n = np.asarray(normal, float) / np.linalg.norm(normal)
    return float((image[..., None] * np.maximum(0, directions @ n) * solid).sum())


def grey(image: np.ndarray) -> np.ndarray:
    return np.repeat(image[..., None], 3, axis=2).astype(np.float32)


@pytest.mark.parametrize("axis", AXES)
def test_constant_sky_over_an_open_plane(axis: str) -> None:
    """E = pi L, and so the plane's radiance is albedo times L."""
    plane, camera = facing(AXES[axis], 0.4)
    measured = scenes.radiance(plane.with_environment((3.0, 2.0, 1.0)), camera)
    # Cosine-distributed samples of a constant have no noise.
    np.testing.assert_allclose(measured, np.broadcast_to(0.4 * np.array([3.0, 2.0, 1.0]), (16, 24, 3)), rtol=2e-5)


def test_wall_takes_its_share_of_the_sky() -> None:
    """Beside a black wall as long and high as the world, the floor sees half of the sky."""
    floor = scenes.quad((0, 0, 0), 1e4, right=(1, 0, 0), up=(0, 0, -1), diffuse=0.5)
    wall = scenes.quad((0.6, 1e4, 0), 1e4, right=(0, 0, 1), up=(0, 1, 0))
    camera = scenes.pinhole(position=(0, 2, 0), look_at=(0, 0, 0), up=(0, 0, -1))
    measured = scenes.radiance(scenes.scene_of(floor, wall).with_environment(1.0), camera, spp=256)
    # Half of the 98304 samples are blocked: their mean has 0.5 / sqrt(98304) / 0.5 = 0.3%; four of them. The
    # wall's end, 10 km away, is 1e-4 of the sky.
    assert measured.mean() == pytest.approx(0.25, rel=0.013)


def test_the_picture_sees_the_image_the_right_way_round() -> None:
    values = np.arange(1, 33, dtype=np.float32).reshape(4, 8)
    behind = scenes.sky(0.0).with_environment(grey(values))
    for look in AXES.values():
        up = (0, 0, 1) if look[1] else (0, 1, 0)
        camera = scenes.pinhole(look_at=look, up=up)
        rays = camera.generate_rays(spp=16)
        d = rays.directions.astype(np.float64)
        row = np.floor(np.arccos(np.clip(d[:, 1], -1, 1)) / math.pi * 4).astype(int)
        column = np.floor((0.5 + np.arctan2(d[:, 0], -d[:, 2]) / (2 * math.pi)) * 8).astype(int) % 8
        expected = scenes.mean_over_pixels(rays, values[np.clip(row, 0, 3), column])
        measured = scenes.radiance(behind, camera)[..., 0]
        # A sample within rounding of a pixel's edge may see the next one: one of 16, a step of at most 31.
        assert np.abs(measured - expected).max() <= 31 / 16
        assert np.median(np.abs(measured / expected - 1)) < 1e-5
        assert (np.abs(measured / expected - 1) < 1e-4).mean() > 0.9


@pytest.mark.parametrize("axis", AXES)
@pytest.mark.parametrize("pixel", [(1, 3), (2, 0), (5, 9), (0, 12)])
def test_one_bright_pixel_lights_what_faces_it(axis: str, pixel: tuple[int, int]) -> None:
    image = np.zeros((8, 16))
    image[pixel] = 100.0
    plane, camera = facing(AXES[axis], 0.8)
    measured = scenes.radiance(plane.with_environment(grey(image)), camera, spp=64)[..., 0]
    expected = 0.8 / math.pi * irradiance(image, AXES[axis])
    # Samples fall into the pixel only; sine and cosine over its 22 degrees vary by less than their mean:
    # 24576 samples have 0.6%, and the midpoint rule 1e-4.
    assert measured.mean() == pytest.approx(expected, rel=0.02, abs=1e-9)


def test_closed_form_of_a_bright_pixel_overhead() -> None:
    """L (delta azimuth) (sin^2 b - sin^2 a) / 2 between polar angles a and b; proves the quadrature too."""
    image = np.zeros((8, 16))
    image[2, 5] = 100.0
    a, b = 2 * math.pi / 8, 3 * math.pi / 8
    closed = 100 * (2 * math.pi / 16) * (math.sin(b) ** 2 - math.sin(a) ** 2) / 2
    assert irradiance(image, (0, 1, 0)) == pytest.approx(closed, rel=1e-4)
    plane, camera = facing((0, 1, 0), 0.8)
    measured = scenes.radiance(plane.with_environment(grey(image)), camera, spp=256)
    # Four times the samples of the test above, and half its tolerance.
    assert measured.mean() == pytest.approx(0.8 / math.pi * closed, rel=0.01)


def test_a_black_image_gives_no_light() -> None:
    plane, camera = facing((0, 1, 0), 0.5)
    dark = plane.with_environment(np.zeros((4, 8, 3)))
    np.testing.assert_array_equal(rc.render(dark, camera, effects=(), spp=4).pixels, 0)
