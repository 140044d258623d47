"""The setting `filter`: pictures of edges and lamps, beside closed forms and other estimators of the same light.

Estimates are means of 16 seeds, whose spread is their standard error; 4.5 of these are allowed. The seeds are fixed.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest
import realcam as rc
from numpy.typing import NDArray

from ..scenes import quad, scene_of, sky

SEEDS = 16
ERRORS = 4.5
FILTERS = ["box", "tent", "gaussian"]


def estimate(of_seed: Callable[[int], NDArray[np.floating]]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Mean over the seeds, and its standard error."""
    values = np.array([of_seed(seed) for seed in range(SEEDS)], float)
    return values.mean(0), values.std(0, ddof=1) / np.sqrt(SEEDS)


def share_below(filter: str, x: float) -> float:
    """Integral of a filter from minus infinity to x."""
    radius = {"box": 0.5, "tent": 1.0, "gaussian": 1.5}[filter]
    at = min(max(x, -radius), radius)
    if filter == "box":
        return at + 0.5
    if filter == "tent":
        return 0.5 * (1 + at) ** 2 if at < 0 else 1 - 0.5 * (1 - at) ** 2

    def integral(to: float) -> float:
        return math.sqrt(math.pi / 8) * math.erf(math.sqrt(2) * to) - math.exp(-4.5) * to

    return 0.5 + integral(at) / (2 * integral(radius))


def lens_camera(model: str = "full", f_number: float = 4.0) -> rc.Camera:
    """8 x 8 pixels of the double Gauss."""
    lens = rc.Lens.load("double-gauss-50mm").focused(2.0).stopped_down(f_number)
    return rc.Camera(lens, film=rc.Film(0.8, 0.8, (8, 8)), exposure_time_s=1.0, model=model)


def stripes() -> rc.Scene:
    """Stripes of random colours, about two per pixel of lens_camera, at 2 m."""
    random = np.random.default_rng(3)
    return scene_of(
        *[quad((0.002 * i - 0.03, 0, -2), 0.001, 0.5, emission=random.uniform(0.1, 2, 3)) for i in range(31)]
    )


@pytest.mark.parametrize("filter", FILTERS)
@pytest.mark.parametrize("edge_px", [3.3, 7.8, 8.6, -0.3])
def test_a_knife_edge_has_the_profile_of_the_filter(device: str, filter: str, edge_px: float) -> None:
    """Light to the left of an edge, which may lie beyond the border of the film."""
    camera = lens_camera("pinhole")
    origins, directions = camera.ray([(edge_px, 4.0)])
    edge = origins[0] + (-2 - origins[0, 2]) / directions[0, 2] * directions[0]
    scene = scene_of(quad((edge[0] - 1, 0, -2), 1, 1, emission=1.0))

    def shares(seed: int) -> NDArray[np.float64]:
        settings = rc.RenderSettings(filter=filter, spp=256, seed=seed, effects=(), max_bounces=0)
        lit = rc.render(sky(), camera, settings=settings, device=device).pixels.astype(float)
        return (rc.render(scene, camera, settings=settings, device=device).pixels / lit).mean((0, 2))

    found, error = estimate(shares)
    wanted = np.array([share_below(filter, edge_px - (column + 0.5)) for column in range(8)])
    # Single precision moves the edge, 1 m beside the centre of its rectangle, by 0.1 um of the 4 mm of a pixel there.
    assert np.all(np.abs(found - wanted) <= ERRORS * error + 1e-4)


@pytest.mark.parametrize("effects", [(), "dispersion"])
@pytest.mark.parametrize("filter", ["tent", "gaussian"])
def test_pictures_equal_the_film_of_gradients(device: str, filter: str, effects: str | tuple[()]) -> None:
    """Gradients divide the light of each sample among all pixels that it reaches."""
    scene, camera = stripes(), lens_camera()
    settings = rc.RenderSettings(filter=filter, spp=64, effects=effects, max_bounces=0)
    film = rc._core._PictureGradient(scene, camera, settings, [], device)
    wanted, wanted_error = estimate(lambda seed: film.picture(seed=1000 + seed, spp=64))
    found, error = estimate(lambda seed: rc.render(scene, camera, settings=settings, seed=seed, device=device).pixels)
    assert np.all(np.abs(found - wanted) < ERRORS * np.hypot(error, wanted_error))
    if effects:
        return  # too noisy for the next test
    # The boxes' picture is another one.
    box, box_error = estimate(
        lambda seed: rc.render(scene, camera, settings=settings.with_(filter="box"), seed=seed, device=device).pixels
    )
    assert np.any(np.abs(box - wanted) > 2 * ERRORS * np.hypot(box_error, wanted_error))


@pytest.mark.parametrize("filter", ["tent", "gaussian"])
def test_traced_lights_have_the_filter(device: str, filter: str) -> None:
    """A small lamp whose light is sampled from its side alone, and from the film's alone; the film cuts its image."""
    scene = scene_of(quad((0.013, 0.004, -2), 0.003, emission=1.0))
    camera = lens_camera(f_number=2.8)

    def picture(light_tracing: str) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        settings = rc.RenderSettings(filter=filter, spp=256, effects=(), max_bounces=0, light_tracing=light_tracing)
        return estimate(
            lambda seed: rc.render(scene, camera, settings=settings, seed=seed, device=device).pixels[..., 0]
        )

    (alone, error), (off, off_error) = picture("alone"), picture("off")
    assert np.all(np.abs(alone - off) <= ERRORS * np.hypot(error, off_error) + 1e-6 * off.max())
    assert np.count_nonzero(off) >= 6


def test_tents_keep_all_light_of_a_point(device: str) -> None:
    """The values of the tents of all pixels at a film point add up to 1, as those of the boxes do."""
    camera = lens_camera()
    origins, directions = camera.ray([(4.3, 3.6)])
    at = origins[0] + (-2 - origins[0, 2]) / directions[0, 2] * directions[0]
    scene = sky(0.0).with_point_light(tuple(at), (1.0, 1.0, 1.0))

    def light(filter: str, seed: int) -> NDArray[np.float32]:
        settings = rc.RenderSettings(filter=filter, spp=64, seed=seed, effects=(), max_bounces=0)
        return rc.render(scene, camera, settings=settings, device=device).pixels[..., 0]

    assert np.count_nonzero(light("box", 0)) < np.count_nonzero(light("tent", 0))
    # The bounds in which samples enter the lens depend on the sampled film, so that the samples are not the same.
    box, box_error = estimate(lambda seed: light("box", seed).sum())
    tent, error = estimate(lambda seed: light("tent", seed).sum())
    assert abs(tent - box) < ERRORS * np.hypot(error, box_error)


def test_the_filter_is_stated() -> None:
    image = rc.render(sky(), lens_camera(), filter="tent", spp=1, effects=(), device="cpu")
    assert image.settings.filter == "tent"
    assert image.metadata()["realcam:filter"] == "tent"
    box = rc.render(sky(), lens_camera(), spp=1, effects=(), device="cpu")
    assert "realcam:filter" not in box.metadata()
    with pytest.raises(rc.InputError, match='filter must be box, tent or gaussian; it is "lanczos"'):
        rc.RenderSettings(filter="lanczos")
