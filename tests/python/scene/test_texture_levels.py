"""Textures from afar: what one sample stands for is a mean of many texels."""

from __future__ import annotations

import math

import numpy as np
import pytest
import realcam as rc

from .. import scenes

SQUARES = ((np.arange(256)[:, None] // 16 + np.arange(256)[None] // 16) % 2 * 255).astype(np.uint8)
FINE = ((np.arange(256)[:, None] + np.arange(256)[None]) % 2 * 255).astype(np.uint8)


def floor(texture: np.ndarray, **material: object) -> rc.Scene:
    """A plane 1 m below the camera, to 2 km, with tiles of 4 m."""
    corners, _ = scenes.quad((0, -1, -1000), 2000, 1000, up=(0, 0, -1))
    uvs = np.array([[0, 0], [1000, 0], [1000, 500], [0, 500]], float)
    m = rc.Material(diffuse=(1, 1, 1), texture=texture, **material)  # type: ignore[arg-type]
    return rc.Scene.from_arrays(corners, [[0, 1, 2], [0, 2, 3]], uvs=uvs, materials=[m]).with_environment(1.0)


def rms(a: np.ndarray) -> float:
    return float(np.sqrt(np.mean(a**2)))


def camera(model: str = "pinhole") -> rc.Camera:
    film = rc.Film(24, 16, (96, 64))
    lens = rc.Lens.load("double-gauss-50mm").focused(3.0)
    return rc.Camera(lens, film=film, exposure_time_s=1, model=model)


def test_errors_are_smaller_than_those_of_points_of_the_texture() -> None:
    """Samples of squares that are black or white have the variance p (1 - p), p being the white share of a pixel."""
    taken = camera()
    white = scenes.radiance(floor(SQUARES), taken, spp=4096)[34:, :, 0].clip(0, 1)  # below the horizon
    of_a_point = math.sqrt(float(np.mean(white * (1 - white))))
    for spp, most in ((1, 0.75), (4, 0.5), (64, 0.4)):
        error = rms(scenes.radiance(floor(SQUARES), taken, spp=spp)[34:, :, 0] - white)
        assert error < most * of_a_point / math.sqrt(spp), spp


@pytest.mark.parametrize("shiny", [False, True])  # kernels for Lambert's and Phong's lobes, and those for all others
def test_the_horizon_does_not_shimmer(shiny: bool) -> None:
    """Rows in which a pixel covers many squares, at one sample: grey, where points of them are 0.5 away from that."""
    scene = floor(SQUARES, double_sided=shiny)
    grey = scenes.radiance(scene, camera(), spp=1)[33:36, :, 0]
    assert rms(grey - 0.5) < 0.1


def test_coverage_stays_what_it_is() -> None:
    """Maps of opacity have no levels: through half of the floor the sky is seen, whatever the distance."""
    alpha = np.full((256, 256, 4), 255, np.uint8)
    alpha[..., 3] = FINE
    scene = floor(np.zeros((2, 2), np.uint8), opacity_texture=alpha)
    picture = scenes.radiance(scene, camera(), spp=64)[34:, :, 0]
    assert picture.mean() == pytest.approx(0.5, abs=0.01)
    cut = floor(np.zeros((2, 2), np.uint8), opacity_texture=alpha, opacity_cutoff=0.5)
    assert scenes.radiance(cut, camera(), spp=64)[34:, :, 0].mean() == pytest.approx(0.5, abs=0.05)


def squares_of_triangles() -> rc.Scene:
    """The nearest 12 m of floor(SQUARES), of squares that are white or black."""
    side, columns, rows = 0.25, 80, 48
    x, z = np.meshgrid(np.arange(columns) - columns // 2, np.arange(rows), indexing="ij")
    left, near = (side * x.ravel())[:, None], (-side * z.ravel())[:, None]
    across, away = np.array([[0, 1, 1, 0]]) * side, np.array([[0, 0, 1, 1]]) * side
    corners = np.stack([left + across, np.full((x.size, 4), -1.0), near - away], axis=-1).reshape(-1, 3)
    first = 4 * np.arange(x.size)[:, None]
    faces = np.concatenate([first + np.array([0, 1, 2]), first + np.array([0, 2, 3])])
    # The texture's lower left square, which lies at x = 0 on the near edge, is white.
    white = (x + z).ravel() % 2 == 0
    materials = [rc.Material(diffuse=(0, 0, 0)), rc.Material(diffuse=(1, 1, 1))]
    made = rc.Scene.from_arrays(corners, faces, triangle_materials=np.tile(white.astype(int), 2), materials=materials)
    return made.with_environment(1.0)


def test_out_of_focus_a_texture_is_blurred_by_the_lens_alone() -> None:
    """Squares made of triangles are blurred alike: by the lens, and not by a ray footprint of the lens's width."""
    taken = camera("thin")
    textured, made = (
        scenes.radiance(scene, taken, spp=1024)[50:, :, 0] for scene in (floor(SQUARES), squares_of_triangles())
    )
    # The noise of 1024 samples of squares of contrast 1.
    assert rms(textured - made) < 0.02
    assert textured.std() == pytest.approx(made.std(), rel=0.02)


def test_a_stretched_instance_has_the_levels_of_its_triangles() -> None:
    """The ray footprint is transformed to the frame of the instance's object, stretched by 40 along one axis."""
    card = scenes.quad((0, 0, 0), 1, diffuse=1.0)
    lying = np.array([[1, 0, 0, 0], [0, 0, 1, -1], [0, -1, 0, -6], [0, 0, 0, 1.0]])
    material = rc.Material.metallic_roughness(base_color=(1, 1, 1), roughness=0.9)
    corners = card[0]

    def floor_of(points: np.ndarray) -> rc.Scene:
        made = rc.Scene.from_arrays(
            points, [[0, 1, 2], [0, 2, 3]], uvs=[[0, 0], [2, 0], [2, 0.2], [0, 0.2]], materials=[material]
        )
        return made.with_texture(0, np.random.default_rng(3).integers(0, 255, (256, 256, 4), dtype=np.uint8))

    place = lying @ np.diag([40.0, 5.0, 0.5, 1.0])
    placed = corners @ place[:3, :3].T + place[:3, 3]
    behind = scenes.scene_of(scenes.quad((0, 0, 9), 1)).with_environment(1.0)
    taken = rc.Camera(rc.Lens.load("double-gauss-50mm").focused(5), film=rc.Film(36, 24, (60, 40)), model="pinhole")
    one = rc.render(behind.with_instance(floor_of(corners), place), taken, effects=(), spp=4, device="cpu").pixels
    other = rc.render(behind.with_instance(floor_of(placed)), taken, effects=(), spp=4, device="cpu").pixels
    # The samples are the same; the texture level is chosen at random, and rounding changes very few choices.
    differ = np.abs(one - other).max(axis=2) > 1e-3 * other.max()
    assert one.std() > 0.1 * one.mean()
    assert differ.mean() < 0.01
