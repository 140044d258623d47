"""Depth, and independence of where the world's origin lies."""

from __future__ import annotations

import numpy as np
import pytest
import realcam as rc

from .. import scenes


def room(shift: tuple[float, float, float] = (0, 0, 0)) -> rc.Scene:
    """A few surfaces with edges, shadows, a lamp, a sun and a sky."""
    rng = np.random.default_rng(3)
    cards = []
    for _ in range(12):
        right, up = np.linalg.qr(rng.normal(size=(3, 2)))[0].T
        middle = (*rng.uniform(-0.7, 0.7, 2), rng.uniform(-4, -2))
        cards.append(scenes.quad(middle, 0.2, right=right, up=up, diffuse=rng.uniform(0.2, 0.9, 3)))
    floor = scenes.quad((0, -1, -3), 4, right=(1, 0, 0), up=(0, 0, -1), diffuse=0.5)
    lamp = scenes.quad((0.5, 1.5, -3), 0.3, right=(1, 0, 0), up=(0, 0, 1), emission=300)
    scene = scenes.scene_of(floor, lamp, *cards, shift=shift)
    place = tuple(np.add((0.0, 0.6, -1.0), shift))
    return scene.with_sun((0.4, -1, -0.3), (50, 50, 45)).with_point_light(place, (5, 5, 5)).with_environment((3, 4, 6))


def camera_at(shift: tuple[float, float, float], *, model: str = "full") -> rc.Camera:
    lens = rc.Lens.load("double-gauss-50mm").focused(3.0)
    position, look_at = np.add((0, 0, 0), shift), np.add((0, -0.1, -3), shift)
    return rc.Camera(
        lens,
        film=rc.Film(36, 24, (72, 48)),
        position=tuple(position),
        look_at=tuple(look_at),
        exposure_time_s=1,
        model=model,
    )


def relative_rmse(a: np.ndarray, b: np.ndarray) -> float:
    a, b = a.astype(np.float64), b.astype(np.float64)
    return float(np.sqrt(((a - b) ** 2).mean() / (b**2).mean()))


@pytest.mark.parametrize("shift", [(1e6, 0.0, 0.0), (-1e6, 1e6, 1e6), (12345.678, -987.65, 4321.1)])
def test_a_scene_far_from_the_origin_looks_the_same(shift: tuple[float, float, float]) -> None:
    here = rc.render(room(), camera_at((0, 0, 0)), effects=(), spp=16, seed=5, max_bounces=1)
    there = rc.render(room(shift), camera_at(shift), effects=(), spp=16, seed=5, max_bounces=1)
    # The same samples. At 1e6 m a double has steps of 1e-10 m, a thousandth of float32's at 2 m: coordinates
    # differ in their last bit, and of 55296 samples one or two may land on the other side of an edge. One
    # sample of 16 in one of 3456 pixels is sqrt(1 / 3456) / 16 = 0.1%. Without moving the scene, float32's 6
    # cm there would leave nothing.
    assert relative_rmse(there.pixels, here.pixels) < 2e-3
    assert np.median(np.abs(there.pixels / here.pixels - 1)) < 1e-5
    finite = np.isfinite(here.depth) & np.isfinite(there.depth)
    assert (np.isfinite(here.depth) == np.isfinite(there.depth)).mean() > 0.999
    assert np.median(np.abs(there.depth[finite] / here.depth[finite] - 1)) < 1e-6


def test_a_picture_does_not_depend_on_the_one_before() -> None:
    """The scene stays placed while the camera moves by little; pictures must not show it."""
    scene, step = room(), (0.0, 0.0, 9.0)
    rc.render(scene, camera_at(step), effects=(), spp=1)
    after_move = rc.render(scene, camera_at((0, 0, 0)), effects=(), spp=16, seed=5)
    fresh = rc.render(room(), camera_at((0, 0, 0)), effects=(), spp=16, seed=5)
    # Coordinates ten times as large have ten times the rounding: some ten samples of 55296 at edges.
    assert relative_rmse(after_move.pixels, fresh.pixels) < 5e-3
    other = rc.render(scene.with_environment(0.0), camera_at((0, 0, 0)), effects=(), spp=16, seed=5)
    assert other.pixels.mean() < 0.9 * fresh.pixels.mean()


@pytest.mark.parametrize("model", ["pinhole", "thin", "thick", "full"])
def test_depth_of_a_plane_square_to_the_axis(model: str) -> None:
    """Metres along the axis from the film: the same all over the picture, for a camera anywhere."""
    shift = (10.0, 20.0, 30.0)
    scene = scenes.scene_of(scenes.quad((0, 0, -4), 5, emission=1), shift=shift)
    lens = rc.Lens.load("double-gauss-50mm").focused(2.0)
    camera = rc.Camera(
        lens,
        film=rc.Film(36, 24, (36, 24)),
        position=shift,
        look_at=tuple(np.add((0, 0, -1), shift)),
        model=model,
    )
    depth = rc.render(scene, camera, effects=(), spp=16).depth
    # float32, relative to the camera.
    np.testing.assert_allclose(depth, 4.0, rtol=1e-6)
