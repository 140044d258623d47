"""spp="auto": as many samples as the noise needs, by tiles of the film, and no bias from stopping."""

from __future__ import annotations

import time
import warnings

import numpy as np
import pytest
import realcam as rc

from .. import scenes

LENS = rc.Lens.load("tessar-50mm").focused(3.0)
SIDE = 32


def camera(**more: object) -> rc.Camera:
    return rc.Camera(LENS, film=rc.Film(24, 24, (SIDE, SIDE)), **{"exposure_time_s": 1, **more})


def half_noisy() -> rc.Scene:
    """On the left a light that is the same everywhere, on the right a wall in the half shadow of a board."""
    glowing = scenes.quad((-1.5, 0, -3), 1.5, 3, emission=0.5)
    wall = scenes.quad((1.5, 0, -3), 1.5, 3, diffuse=0.8)
    lamp = scenes.quad((2.5, 0, 3), 1.5, emission=2.0, right=(-1, 0, 0))
    return scenes.scene_of(glowing, wall, lamp, scenes.quad((1.6, 0, -0.4), 0.25, diffuse=0.5))


def tiles(squares: np.ndarray) -> np.ndarray:
    """Root mean squares of tiles of 16 pixels."""
    return np.sqrt(squares.reshape(SIDE // 16, 16, SIDE // 16, 16, 3).mean(axis=(1, 3, 4)))


@pytest.fixture(scope="module")
def converged() -> np.ndarray:
    return rc.render(half_noisy(), camera(), effects=(), spp=8192, seed=77).pixels.astype(np.float64)


def test_every_tile_reaches_the_noise_and_none_gets_many_more_samples(device: str, converged: np.ndarray) -> None:
    goal = 0.005
    image = rc.render(half_noisy(), camera(), effects=(), spp="auto", noise=goal, device=device, layers="sample_count")
    counts = image.layers["sample_count"]
    assert image.spp == pytest.approx(counts.mean(), abs=0.51)
    assert image.shortfall == ""
    # The emitter's only noise comes from sampling the lens.
    assert counts[:, : SIDE // 4].mean() < counts.mean() / 2
    mean = converged.reshape(SIDE // 16, 16, SIDE // 16, 16, 3).mean(axis=(1, 3, 4))
    noise = tiles((image.pixels - converged) ** 2) / mean
    # The margin covers the noise estimate from two halves of 128 pixels each, known within 8%, and the noise of the
    # converged picture itself.
    assert noise.max() < 1.2 * goal
    uniform = rc.render(half_noisy(), camera(), effects=(), spp=image.spp, device=device)
    # The noisy tiles have more samples than then, and errors fall at least with their square root; either is known
    # within 8%.
    fewer = counts[:, SIDE // 2 :].mean() / counts.mean()
    assert fewer > 1.4
    of_uniform = tiles((uniform.pixels - converged) ** 2) / mean
    assert of_uniform[:, 1].max() > 0.84 * np.sqrt(fewer) * noise[:, 1].max()


def test_codes_are_those_of_the_developed_picture(device: str, converged: np.ndarray) -> None:
    iso = 18 / float(converged.mean())
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        image = rc.render(half_noisy(), camera(iso=iso), effects=(), spp="auto", noise_codes=3, device=device)

    def codes(exposure: np.ndarray) -> np.ndarray:
        linear = np.clip(0.018 * iso * exposure, 0, 1)
        return 255 * np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)

    noise = tiles((codes(image.pixels.astype(np.float64)) - codes(converged)) ** 2)
    assert 1.5 < noise.max() < 3.6
    # Clipped pixels have no noise.
    white = rc.render(scenes.sky(), camera(iso=1e4 * iso), effects=(), spp="auto", device=device)
    assert white.spp == 16


LAMP = scenes.scene_of(scenes.quad((0, 0, -4), 0.004, emission=1e5))
POINT = scenes.scene_of(scenes.quad((0, 0, 9), 1)).with_point_light((0, 0, -4), (1e4,) * 3)


@pytest.mark.parametrize(
    ("scene", "focus_m", "resolution"),
    [
        (LAMP, 1.0, (48, 32)),
        (POINT, 1.0, (12, 8)),
        (POINT, 4.0, (24, 16)),
    ],
)
def test_the_noise_of_lamps_is_told(scene: rc.Scene, focus_m: float, resolution: tuple[int, int], device: str) -> None:
    """Lamps have samples of their own (light tracing), which are few for a picture of few pixels."""
    lens = rc.Lens.load("double-gauss-50mm").focused(focus_m)
    view = rc.Camera(lens, film=rc.Film(24, 16, resolution), position=(0, 0, 0), exposure_time_s=1, iso=1e-3)
    told, pictures = [], []
    for seed in range(30):
        session = rc.Session(scene, view, device=device, effects=(), seed=seed, max_bounces=0)
        told.append(session.add_until(1e-3, max_spp=16).noise)
        pictures.append(session.image().pixels.astype(np.float64))
    rows, columns = np.indices(resolution[::-1])
    across, down = (max(1, (side + 8) // 16) for side in resolution)
    tile = rows * down // resolution[1] * across + columns * across // resolution[0]
    variance, mean = np.var(pictures, axis=0, ddof=1), np.mean(pictures, axis=0)
    spread = 0.0  # of the noisiest half of a tile, as a share of its light or of a hundredth of white
    for half in range(2 * across * down):
        pixels = (2 * tile + (rows + columns) % 2) == half
        light = max(float(mean[pixels].mean()), 0.01 / (0.018 * view.iso))
        spread = max(spread, float(np.sqrt(variance[pixels].mean())) / light)
    assert spread > 0
    ratio = float(np.sqrt(np.mean(np.square(told)))) / spread
    # For independent samples the change equals the error, and 2^-0.6 of it is reported if two doublings by chance show
    # a faster rate. If the error falls like 1 / n, the change is sqrt(5) times the error. 30 seeds with a few lit
    # pixels each know either within a fifth.
    assert 0.8 * 0.85 < ratio < 1.2 * 2.24


def test_what_cannot_be_reached_is_said(device: str) -> None:
    with pytest.warns(UserWarning, match=r"noise is .* not 0\.001; a pixel there needs about .* samples"):
        image = rc.render(half_noisy(), camera(), effects=(), spp="auto", noise=0.001, max_spp=64, device=device)
    assert image.shortfall
    assert 8 < image.spp <= 64
    session = rc.Session(half_noisy(), camera(), device=device, effects=())
    reached = session.add_until(0.001, max_spp=64)
    assert not reached.is_reached
    assert reached.noise > 0.001
    assert reached.spp_wanted > 64
    again = session.add_until(1.05 * reached.noise, max_spp=256)
    assert again.is_reached
    assert session.samples.max() <= 256


@pytest.mark.parametrize("settings", [{"light_tracing": "off"}, {"layers": "dual_pixel_left"}, {"model": "thin"}])
def test_lamps_that_no_sample_may_have_met_are_told(settings: dict[str, object], device: str) -> None:
    """A pixel sees 9 cm at 6 m; a lamp of 3 mm is a thousandth of that, and the pixels' samples alone look for it."""
    lens = rc.Lens.load("tessar-50mm").focused(6.0)
    settings = dict(settings)
    model = str(settings.pop("model", "full"))
    at = rc.Camera(lens, film=rc.Film(24, 24, (SIDE, SIDE)), exposure_time_s=1, model=model)

    def reached(lamp_m: float, place: tuple[float, float, float], **more: object) -> rc.ReachedNoise:
        wall = scenes.quad((0, 0, -6.5), 3, emission=0.01)
        scene = scenes.scene_of(scenes.quad(place, lamp_m / 2, emission=1e4), wall)
        session = rc.Session(scene, at, device=device, effects=(), **more)
        return session.add_until(0.05, max_spp=64)

    missed = reached(0.003, (0.3, 0.2, -6), **settings)
    assert not missed.is_reached
    assert "lamps that fill only 1/" in missed.shortfall
    # Five over its share of the pixel, which is (0.003 / 0.09)^2 but for the blur.
    assert 3000 < missed.spp_wanted < 20000
    behind_the_camera = reached(0.003, (0.3, 0.2, 6), **settings)
    assert behind_the_camera.is_reached
    assert behind_the_camera.shortfall == ""
    if model == "full":
        assert reached(0.003, (0.3, 0.2, -6)).is_reached


def test_a_picture_ends_after_its_seconds(device: str) -> None:
    rc.render(half_noisy(), camera(), effects=(), spp=1, device=device)  # what a device needs once
    start = time.perf_counter()
    with pytest.warns(UserWarning, match="noise"):
        image = rc.render(
            half_noisy(), camera(), effects=(), spp="auto", noise=1e-5, max_spp=2**24, seconds=0.5, device=device
        )
    # A busy machine may be several times slower than it was for the first samples.
    assert time.perf_counter() - start < 10
    assert image.spp >= 8


def test_the_same_bits_on_any_number_of_threads_and_after_add() -> None:
    def image(threads: int) -> rc.Image:
        return rc.render(half_noisy(), camera(), effects=(), spp="auto", noise=0.02, threads=threads, device="cpu")

    assert image(1) == image(2)
    session = rc.Session(half_noisy(), camera(), device="cpu", effects=())
    session.add(8)
    session.add_until(0.02)
    np.testing.assert_allclose(session.image().pixels, image(0).pixels, rtol=1e-6)
    session.add(4)  # goes on behind all samples that were taken
    assert session.samples.min() >= 20


def test_layers_and_progress_go_along(device: str) -> None:
    shares: list[float] = []
    image = rc.render(
        half_noisy(),
        camera(),
        effects=(),
        spp="auto",
        noise=0.02,
        layers="normal",
        progress=shares.append,
        device=device,
    )
    assert np.isfinite(image.layers["normal"]).all()
    assert shares == sorted(shares)
    assert shares[-1] == 1
    # Long enough that a fast GPU is asked before it is done.
    goal = {"spp": "auto", "noise": 1e-9, "max_spp": 2**24, "seconds": 30}
    with pytest.raises(rc.Cancelled):
        rc.render(half_noisy(), camera(), effects=(), progress=lambda _: False, device=device, **goal)
