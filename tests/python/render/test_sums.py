"""Accumulation on the film: a million samples, light and dark together, short and long exposures."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
import realcam as rc

from ...measurement import Measurement, breaks, hold
from .. import scenes

ROUNDING = 2.0**-24  # of a float32, relative
MILLION = 1_000_000
BRIGHT = 1e8


def one_pixel(**more: object) -> rc.Camera:
    lens = rc.Lens.load("double-gauss-50mm").focused(3.0)
    return rc.Camera(lens, film=rc.Film(4, 4, (1, 1)), **{"exposure_time_s": 1, **more})


def exposure(scene: rc.Scene, camera: rc.Camera, device: str, spp: int) -> float:
    """By samples of the pixel alone: light that is traced from lamps has sums and random numbers of its own."""
    settings = rc.RenderSettings(effects=(), spp=spp, max_bounces=0, light_tracing="off")
    return float(rc.render(scene, camera, settings, device=device).pixels[0, 0, 0])


def test_a_million_samples_of_a_pixel_do_not_drift(device: str, backend: str) -> None:
    camera = one_pixel()
    weights = camera.generate_rays(spp=MILLION).weights
    exact = math.fsum(weights) / MILLION
    found = exposure(scenes.sky(), camera, device, MILLION)
    tried = "1 pixel, 1e6 samples of a lens in a constant field"
    # The picture is a float32: half a step. Anything more is drift.
    worst = abs(found / exact - 1)
    hold(Measurement("Sums", "mean of a million samples", tried, backend, "float32", worst, ROUNDING, "relative"))
    naive = abs(float(np.add.accumulate(weights)[-1]) / MILLION / exact - 1)
    what = "mean of a million samples, summed in float32"
    breaks(Measurement("Sums", what, tried, "core", "float32", naive, ROUNDING, "relative"))


def test_dim_light_beside_a_light_1e8_times_as_bright(device: str, backend: str) -> None:
    """In one pixel, some samples in a million see a speck of radiance 1e8, and the others a wall of radiance 1."""
    camera = one_pixel()

    def view(wall: float, speck: float) -> rc.Scene:
        return scenes.scene_of(
            scenes.quad((0, 0, -3), 2, emission=wall), scenes.quad((0.013, 0.009, -2.999), 3e-4, emission=speck)
        )

    both, bright, dim = (exposure(view(*v), camera, device, MILLION) for v in ((1, BRIGHT), (0, BRIGHT), (1, 0)))
    assert bright > 10 * dim > 0
    tried = "1 pixel, 1e6 samples; a speck 1e8 times as bright as the wall"
    # Three pictures are rounded, and the sum `both` is the largest of them.
    limit = 3 * ROUNDING * both / dim
    worst = abs(both - bright - dim) / dim
    hold(Measurement("Sums", "dim light in a pixel", tried, backend, "float32", worst, limit, "relative"))
    rays = camera.generate_rays(spp=MILLION)
    at = rays.origins_m + (-2.999 - rays.origins_m[:, 2:]) / rays.directions[:, 2:] * rays.directions
    hit = (np.abs(at[:, 0] - 0.013) < 3e-4) & (np.abs(at[:, 1] - 0.009) < 3e-4)
    naive = np.add.accumulate(rays.weights * np.where(hit, np.float32(BRIGHT), np.float32(1)))[-1] / MILLION
    only_bright = np.add.accumulate(rays.weights * np.where(hit, np.float32(BRIGHT), np.float32(0)))[-1] / MILLION
    lost = abs(float(naive) - float(only_bright) - dim) / dim
    what = "dim light in a pixel, summed in float32"
    breaks(Measurement("Sums", what, tried, "core", "float32", lost, limit, "relative"))


@pytest.mark.parametrize("kind", ["lamp", "environment"])
def test_light_that_1e8_times_brighter_light_does_not_outshine(kind: str, device: str, backend: str) -> None:
    """The bright one lies below the floor: all there is comes from the dim one, whose samples must not be lost."""
    floor = scenes.quad((0, -1, 0), 10, right=(1, 0, 0), up=(0, 0, -1), diffuse=0.7)
    camera = scenes.pinhole(look_at=(0, -1, -2))
    if kind == "lamp":
        dim = scenes.quad((0, 1, -2), 0.5, right=(1, 0, 0), up=(0, 0, 1), emission=1)
        bright = scenes.quad((0, -5, -2), 0.5, right=(1, 0, 0), up=(0, 0, 1), emission=BRIGHT)
        scene = scenes.scene_of(floor, dim, bright)
        points, rays = scenes.points_on_plane(camera, 256, (0, -1, 0), (0, 1, 0))
        irradiance = scenes.polygon_irradiance(points, np.array([0.0, 1.0, 0.0]), dim[0])
        expected = float(scenes.mean_over_pixels(rays, 0.7 / math.pi * irradiance).mean())
    else:
        image = np.ones((8, 16), np.float32)
        image[6, 3] = BRIGHT
        scene = scenes.scene_of(floor).with_environment(np.repeat(image[..., None], 3, axis=2))
        expected = 0.7
    measured = scenes.radiance(scene, camera, spp=256, device=device)[..., 0].mean()
    # The dim light gets a sixteenth of the samples or more: a relative standard deviation of 4 (and some of its own)
    # over 98304 samples is 1.3%; four of them.
    worst = abs(measured / expected - 1)
    what, tried = f"dim {kind} beside one 1e8 times as bright", "a floor, 384 pixels of 256 samples"
    hold(Measurement("Sums", what, tried, backend, "float32", worst, 0.052, "relative"))


def lit_room() -> rc.Scene:
    wall = scenes.quad((0, 0, -2), 3, right=(0.8, 0, 0.6), diffuse=0.5)
    lamp = scenes.quad((0, 0.3, -1.2), 0.1, emission=5000)
    return scenes.scene_of(wall, lamp).with_point_light((0.5, 0.3, -0.8), (100, 50, 25)).with_environment(30.0)


def test_exposure_scales_with_time_over_18_orders(device: str, backend: str) -> None:
    lens = rc.Lens.load("double-gauss-50mm").focused(2.0)

    def picture(time_s: float) -> np.ndarray:
        camera = rc.Camera(lens, film=scenes.FILM, exposure_time_s=time_s)
        return rc.render(lit_room(), camera, effects=(), max_bounces=1, spp=16, device=device).pixels.astype(np.float64)

    second, worst = picture(1), 0.0
    assert (second > 0).all()
    times = (1e-9, 1e-4, 1 / 125, 30.0, 1e9)
    for time_s in times:
        scaled = picture(time_s)
        assert np.isfinite(scaled).all()
        worst = max(worst, float(np.abs(scaled / time_s / second - 1).max()))
    tried = f"{len(times)} times from 1e-9 to 1e9 s, 1152 values each"
    # One rounding on either side.
    hold(Measurement("Sums", "exposure over its time", tried, backend, "float32", worst, 2 * ROUNDING, "relative"))


@pytest.mark.picture_files
@pytest.mark.parametrize("time_s", [1e-9, 1e9, 1e30, 1e38])
def test_nothing_becomes_infinite(time_s: float, device: str, tmp_path: Path) -> None:
    """The brightest lights that a scene may have, one of them 1e-7 m off a wall; and the files of the picture."""
    oiio = pytest.importorskip("OpenImageIO")
    wall = scenes.quad((0, 0, -2), 3, diffuse=1.0, specular=1.0, shininess=1e9)
    lamp = scenes.quad((0, 0.3, -1.2), 0.1, emission=1e20)
    scene = scenes.scene_of(wall, lamp).with_point_light((0.01, 0.01, -2 + 1e-7), (1e20,) * 3).with_environment(1e20)
    camera = rc.Camera(
        rc.Lens.load("double-gauss-50mm").focused(2.0), film=scenes.FILM, exposure_time_s=time_s, iso=100
    )
    image = rc.render(scene, camera, effects=(), spp=64, max_bounces=2, device=device)
    assert np.isfinite(image.pixels).all()
    assert (image.pixels >= 0).all()
    for tone in ("film", "linear"):
        assert (image.developed(tone) == 255).all()
    for name in ("huge.exr", "huge.png"):
        image.save(tmp_path / name)
        buffer = oiio.ImageBuf(str(tmp_path / name))
        stored = buffer.get_pixels()
        assert np.isfinite(stored[..., :3]).all()
        assert float(buffer.spec().get_string_attribute("realcam:exposure_time_s")) == time_s
        if name == "huge.exr":
            np.testing.assert_array_equal(stored[..., :3], image.pixels)
