"""By chance the lens stops more samples of one pixel than of the next: that is taken out when a film is developed."""

from __future__ import annotations

import numpy as np
import pytest
import realcam as rc

from .. import scenes

SPP, SEEDS = 16, 8


def pictures_and_samples(camera: rc.Camera, device: str) -> tuple[np.ndarray, np.ndarray]:
    """(seeds, H, W): an even sky as developed, and the means of the samples that it was developed from."""
    width, height = camera.film.resolution
    developed, sampled = [], []
    for seed in range(SEEDS):
        session = rc.Session(scenes.sky(), camera, effects=(), seed=seed, device=device)
        sampled.append(session.expose((0, 0, width, height), 0, SPP).pixels["irradiance"][..., 0] / SPP)
        session.add(SPP)
        developed.append(session.image().pixels[..., 0].astype(np.float64) / camera.exposure_time_s)
    return np.array(developed), np.array(sampled)


@pytest.mark.parametrize("name", ["double-gauss-50mm", "anamorphic-65mm"])
def test_an_even_sky_has_little_grain_and_its_own_light(name: str, device: str) -> None:
    lens = rc.Lens.load(name)
    width, height = lens.film_mm
    camera = rc.Camera(lens, film=rc.Film(0.7 * width, 0.7 * height, (96, 64)), exposure_time_s=0.5)
    developed, sampled = pictures_and_samples(camera, device)
    noise = [np.sqrt(each.var(axis=0, ddof=1).mean()) for each in (developed, sampled)]
    # One in ninety samples is stopped: at most sqrt(0.011 / 16) = 2.6% of noise. The mean of 25 pixels has a fifth.
    assert noise[1] < 0.03 * sampled.mean()
    assert noise[0] < 0.35 * noise[1]
    # The same light in each block of 16 x 16 pixels, but for what the shares of 4 pixels around it bring: their chance.
    blocks = [each.reshape(SEEDS, 4, 16, 6, 16).mean(axis=(0, 2, 4)) for each in (developed, sampled)]
    error = noise[1] / np.sqrt(16 * 16 * SEEDS)
    assert np.abs(blocks[0] - blocks[1]).max() < 4 * error


def test_the_edge_of_an_image_circle_stays_where_it_is(device: str) -> None:
    """Less and less light passes there from pixel to pixel, and at the end none."""
    lens = rc.Lens.load("fisheye-6mm-220deg")
    camera = rc.Camera(lens, film=rc.Film(*lens.film_mm, (120, 80)), exposure_time_s=1)
    developed, sampled = (each.mean(axis=0) for each in pictures_and_samples(camera, device))
    x, y = (np.arange(120) - 59.5, np.arange(80) - 39.5)
    radius = np.hypot(x[None, :], y[:, None])
    lit = radius[sampled > 0].max()
    assert lit < 59
    assert (developed[sampled == 0] == 0).all()
    for inner in np.arange(0.7, 1, 0.05):
        ring = (radius >= inner * lit) & (radius < (inner + 0.05) * lit)
        # The shares that pass fall from 0.99 to 0.93 and less. With 16 samples a fall by twice the chance of a pixel,
        # 5%, is not yet noticed; it takes one of the five columns around a pixel.
        assert developed[ring].mean() == pytest.approx(sampled[ring].mean(), rel=0.05 / 5)
