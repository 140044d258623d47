"""Textures: which way up, repetition, and the transfer function."""

from __future__ import annotations

import numpy as np
import pytest
import realcam as rc

from .. import scenes


def wall(uvs: np.ndarray, pixels: np.ndarray) -> rc.Scene:
    """A rectangle that fills the picture under a sky of radiance 1; uvs from lower left, anticlockwise."""
    corners, material = scenes.quad((0, 0, -2), 0.48, 0.32, diffuse=1.0)
    scene = rc.Scene.from_arrays(corners, [[0, 1, 2], [0, 2, 3]], uvs=uvs, materials=[material])
    return scene.with_texture(0, pixels).with_environment(1.0)


UNIT_SQUARE = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], float)
# The rectangle spans 24 mm x 16 mm of film and more: 0.96 m at 2 m with an image distance of about 51 mm.


def rgba(codes: np.ndarray) -> np.ndarray:
    return np.concatenate([np.repeat(codes[..., None], 3, axis=2), np.full((*codes.shape, 1), 255)], axis=2).astype(
        np.uint8
    )


def linear(code: float) -> float:
    """IEC 61966-2-1."""
    v = code / 255
    return v / 12.92 if v <= 0.04045 else ((v + 0.055) / 1.055) ** 2.4


def quadrants(picture: np.ndarray) -> np.ndarray:
    """Values in the middle of the four quarters of a (16, 24, 3) picture: (2, 2, 3)."""
    return picture[[4, 11]][:, [6, 17]]


def test_row_0_is_at_v_1_and_column_0_at_u_0() -> None:
    colours = np.zeros((64, 64, 4), np.uint8)
    colours[:32, :32] = (255, 0, 0, 255)
    colours[:32, 32:] = (0, 255, 0, 255)
    colours[32:, :32] = (0, 0, 255, 255)
    colours[32:, 32:] = (255, 255, 255, 255)
    measured = quadrants(scenes.radiance(wall(UNIT_SQUARE, colours), scenes.pinhole()))
    expected = [[(1, 0, 0), (0, 1, 0)], [(0, 0, 1), (1, 1, 1)]]
    # Far from the edges of the texture's blocks; a constant sky has no noise.
    np.testing.assert_allclose(measured, expected, atol=1e-5)


def test_uvs_turn_a_texture() -> None:
    codes = np.zeros((64, 64))
    codes[:32, :32] = 255
    # A quarter turn: u runs up the picture, v to its left.
    turned = np.array([[0, 1], [0, 0], [1, 0], [1, 1]], float)
    measured = quadrants(scenes.radiance(wall(turned, rgba(codes)), scenes.pinhole()))[..., 0]
    # u < 0.5, v > 0.5: the lower left quarter.
    np.testing.assert_allclose(measured, [[0, 0], [1, 0]], atol=1e-5)


@pytest.mark.parametrize("offset", [(0, 0), (3, -2), (-7, 11)])
def test_textures_repeat(offset: tuple[int, int]) -> None:
    codes = np.zeros((64, 64))
    codes[:32, :32] = 255
    measured = quadrants(scenes.radiance(wall(UNIT_SQUARE + offset, rgba(codes)), scenes.pinhole()))[..., 0]
    np.testing.assert_allclose(measured, [[1, 0], [0, 0]], atol=1e-5)


@pytest.mark.parametrize("code", [0, 5, 10, 11, 118, 188, 255])
def test_codes_are_srgb(code: int) -> None:
    measured = scenes.radiance(wall(UNIT_SQUARE, rgba(np.full((4, 4), code))), scenes.pinhole())
    np.testing.assert_allclose(measured, linear(code), rtol=1e-4, atol=1e-9)


def test_between_texels_light_is_interpolated_linearly() -> None:
    """Two columns: between their middles, u = 1/4 and 3/4, the reflectance is a straight line in light."""
    scene = wall(UNIT_SQUARE, rgba(np.array([[0, 255], [0, 255]])))
    camera = scenes.pinhole()
    points, rays = scenes.points_on_plane(camera, 16, (0, 0, -2), (0, 0, 1))
    u = (points[:, 0] + 0.48) / 0.96
    # Past the middles the texture repeats: back towards the other column.
    triangle = np.interp(u, [-0.25, 0.25, 0.75, 1.25], [1, 0, 1, 0])
    expected = scenes.mean_over_pixels(rays, triangle)
    measured = scenes.radiance(scene, camera)[..., 0]
    # Half a texel of float32 coordinates.
    np.testing.assert_allclose(measured, expected, atol=1e-5)
