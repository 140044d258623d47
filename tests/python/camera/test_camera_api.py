"""rc.Camera, Film and generate_rays as a user meets them; the rays are those that render traces."""

from __future__ import annotations

import math

import numpy as np
import pytest
import realcam as rc

from .. import scenes

MODELS = ("pinhole", "thin", "thick", "full")


def test_defaults_and_what_is_kept() -> None:
    lens = rc.Lens.load("phone-4mm")
    camera = rc.Camera(lens)
    assert (camera.model, camera.iso, camera.exposure_time_s) == ("full", 100, 1 / 125)
    # The lens's own film, its longer side 960 pixels.
    assert lens.film_mm == (4.8, 3.6)
    assert camera.film == rc.Film(4.8, 3.6, (960, 720))
    assert rc.Film() == rc.Film(36, 24, (960, 640))
    assert (camera.position, camera.look_at, camera.up) == ((0, 0, 0), (0, 0, -1), (0, 1, 0))
    pose = {"position": np.array([1, 2, 3], np.float32), "look_at": [4, 5, 6]}
    other = rc.Camera(lens, film=rc.Film(2, 1, (20, 10)), exposure_time_s=2, iso=800, model="thin", **pose)
    assert (other.position, other.look_at, other.film.resolution) == ((1, 2, 3), (4, 5, 6), (20, 10))
    assert (other.exposure_time_s, other.iso, other.model) == (2, 800, "thin")
    for name in ("iso", "film", "lens", "position", "model"):
        with pytest.raises(AttributeError):
            setattr(other, name, getattr(camera, name))


@pytest.mark.parametrize(
    ("size", "says"),
    [
        ((36, 24, (0, 640)), "0 x 640 pixels; expected 1 to 32768"),
        ((36, 24, (960, -5)), "960 x -5 pixels"),
        ((36, 24, (1000000, 1)), "1000000 x 1 pixels"),
        *(((*size, (36, 24)), "width and height") for size in ((0, 24), (36, math.nan), (1e-3, 1e170), (1e-300, 24))),
    ],
)
def test_a_film_that_is_none(size: tuple[float, float, tuple[int, int]], says: str) -> None:
    width, height, resolution = size
    for make in (
        lambda: rc.Film(*size),
        lambda: rc.Film().replace(width_mm=width, height_mm=height, resolution=resolution),
        lambda: rc.Film.for_lens(rc.Lens.load("tessar-50mm"), (width, height), resolution),
    ):
        with pytest.raises(rc.InputError, match=says):
            make()


@pytest.mark.parametrize(
    ("name", "values", "says"),
    [
        ("exposure_time_s", (0, math.inf, 1e300, 1e-300), "exposure time"),
        ("iso", (-100, math.nan, 1e300, 1e-300), "ISO"),
        ("model", ("fisheye",), "expected full, full_double, polynomial, thick, mapped, thin or pinhole"),
        ("look_at", ((0, 0, 0), (0, 0, 1e-200)), "look at a point other"),
        ("up", ((0, 0, 2), (0, 0, 0), (0, math.inf, 0), (0, 1e-200, 0)), "up direction"),
        ("position", ((math.nan, 0, 0),), "finite"),
        ("position", ((0, 1e13, 0),), "1e12 m"),
        ("look_at", ((0, 0, -1e300),), "1e12 m"),
    ],
)
def test_a_camera_that_takes_no_picture(name: str, values: tuple[object, ...], says: str) -> None:
    for value in values:
        with pytest.raises(rc.InputError, match=says):
            rc.Camera(rc.Lens.load("tessar-50mm"), **{name: value})  # type: ignore[arg-type]


def test_generated_rays_shapes_and_units() -> None:
    lens = rc.Lens.load("double-gauss-50mm").focused(2.0)
    camera = rc.Camera(lens, film=rc.Film(36, 24, (6, 4)), position=(10, 20, 30), look_at=(10, 20, 29))
    rays = camera.generate_rays(spp=5, seed=1)
    count = 6 * 4 * 5
    assert (rays.origins_m.shape, rays.origins_m.dtype) == ((count, 3), np.float64)
    assert (rays.directions.shape, rays.directions.dtype) == ((count, 3), np.float32)
    assert (rays.weights.shape, rays.weights.dtype) == ((count,), np.float32)
    assert (rays.pixels.shape, rays.pixels.dtype) == ((count,), np.int32)
    np.testing.assert_array_equal(rays.pixels, np.repeat(np.arange(24), 5))
    # Eleven refractions in float32, each with a few roundings of 6e-8.
    np.testing.assert_allclose(np.linalg.norm(rays.directions, axis=1), 1, atol=2e-6)
    passing = rays.weights > 0
    assert passing.mean() > 0.9
    assert (rays.weights >= 0).all()
    # On the front element: within its rim, and the film's distance in front of the camera's position; metres.
    front = lens.surfaces[0]
    offset = (rays.origins_m - (10, 20, 30))[passing]
    sag = [front.sag_mm(r) for r in 1000 * np.hypot(offset[:, 0], offset[:, 1])]
    np.testing.assert_allclose(-1000 * offset[:, 2], lens.film_position_mm - np.array(sag), atol=2e-5)
    assert np.hypot(offset[:, 0], offset[:, 1]).max() <= front.clear_semi_diameter_mm / 1000 * (1 + 1e-6)
    # The first pixel is the picture's upper left corner.
    corner = rays.directions[passing & (rays.pixels == 0)].mean(axis=0)
    assert corner[0] < -0.2
    assert corner[1] > 0.1
    for name, wrong in (("spp", 0), ("spp", -1), ("seed", -1)):
        with pytest.raises(rc.InputError, match=name):
            camera.generate_rays(**{name: wrong})


def collected(scene: rc.Scene, camera: rc.Camera, seed: int) -> np.ndarray:
    """First channel of the exposure in lux seconds from 32 samples, before control variates reduce the noise."""
    width, height = camera.film.resolution
    sums = rc.Session(scene, camera, effects=(), seed=seed).expose((0, 0, width, height), 0, 32).pixels
    return camera.exposure_time_s * sums["irradiance"][..., 0] / 32


@pytest.mark.parametrize("model", MODELS)
def test_render_traces_the_rays_that_are_generated(model: str) -> None:
    """An image of the surroundings, looked up here for each ray, makes the picture that render makes."""
    rng = np.random.default_rng(2)
    values = rng.uniform(0, 10, (8, 16)).astype(np.float32)
    scene = scenes.sky(0.0).with_environment(np.repeat(values[..., None], 3, axis=2))
    lens = rc.Lens.load("wide-22mm")
    camera = rc.Camera(lens, film=rc.Film(24, 16, (24, 16)), look_at=(0.5, 0.2, -1), exposure_time_s=0.25, model=model)
    rays = camera.generate_rays(spp=32, seed=9)
    d = rays.directions.astype(np.float64)
    row = (np.arccos(np.clip(d[:, 1], -1, 1)) / math.pi * 8).astype(int)
    column = ((0.5 + np.arctan2(d[:, 0], -d[:, 2]) / (2 * math.pi)) * 16).astype(int)
    light = rays.weights * values[np.minimum(row, 7), np.minimum(column, 15)]
    expected = 0.25 * np.bincount(rays.pixels, light, minlength=384).reshape(16, 24) / 32
    picture = collected(scene, camera, seed=9)
    # float32 on both sides; a sample within rounding of an edge may see the neighbouring value, 1 / 32 of a
    # pixel.
    close = np.abs(picture / expected - 1) < 1e-5
    assert close.mean() > 0.98
    np.testing.assert_allclose(picture, expected, atol=0.25 * 10 / 32 * float(rays.weights.max()), rtol=1e-5)
    if model != "full":  # which stops no sample, so that nothing is taken out of its pictures
        rendered = rc.render(scene, camera, effects=(), spp=32, seed=9).pixels[..., 0]
        np.testing.assert_allclose(rendered, picture, rtol=1e-6)
    other = collected(scene, camera, seed=10)
    assert (np.abs(other / expected - 1) < 1e-5).mean() < 0.9 or model == "pinhole"


def test_rays_depend_on_seed_pixel_and_sample_alone() -> None:
    lens = rc.Lens.load("tessar-50mm")
    camera = rc.Camera(lens, film=rc.Film(36, 24, (6, 4)))
    few, many = camera.generate_rays(spp=4, seed=3), camera.generate_rays(spp=16, seed=3)
    first = many.directions.reshape(24, 16, 3)[:, :4].reshape(-1, 3)
    np.testing.assert_array_equal(few.directions, first)
    assert (camera.generate_rays(spp=4, seed=4).directions != few.directions).any()
    np.testing.assert_array_equal(camera.generate_rays(spp=4, seed=3).directions, few.directions)
