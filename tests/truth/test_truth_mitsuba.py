"""Light in whole scenes against Mitsuba 3: means, and blocks of pixels within the noise of both programs.

Both follow paths of up to 24 reflections. Needs the extra `truth` and LLVM (DRJIT_LIBLLVM_PATH); `pytest
tests/truth/test_truth_mitsuba.py -m slow` takes enough samples to hold the means to 0.5%.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest
import realcam as rc

mi = pytest.importorskip("mitsuba", reason="Mitsuba is not installed: pip install 'realcam[truth]'")
try:
    mi.set_variant("llvm_ad_rgb")
    import mitsuba_shots as scenes
except (ImportError, RuntimeError) as error:  # no LLVM, or one that Mitsuba cannot use
    pytest.skip(f"Mitsuba has no LLVM to work with: {error}", allow_module_level=True)

WIDTH, HEIGHT, BLOCK = 96, 64, 8
BOUNCES, FILM_WIDTH_MM = 24, 36.0


def camera() -> rc.Camera:
    film = rc.Film(FILM_WIDTH_MM, FILM_WIDTH_MM * HEIGHT / WIDTH, (WIDTH, HEIGHT))
    lens = rc.Lens.load("double-gauss-50mm").focused(4.0)
    return rc.Camera(lens, film=film, model="pinhole", position=(0.4, 1.4, 4.2), look_at=(0, 0.8, 0))


def ours(scene: rc.Scene, taken: rc.Camera, spp: int, seed: int) -> np.ndarray:
    image = rc.render(scene, taken, effects=(), spp=spp, seed=seed, max_bounces=BOUNCES, device="cpu")
    return np.asarray(image.pixels, float) / taken.exposure_time_s


def mitsuba_scenes(shot: scenes.Shot) -> Callable[[], list[mi.Scene]]:
    """Of a shot with motion, another one for each 1/16 of the exposure every time, each at a moment by chance."""
    if not any(part.moves for part in shot.parts):
        still = [scenes.mitsuba_scene(shot)]
        return lambda: still
    rng = np.random.default_rng(1)
    return lambda: [scenes.mitsuba_scene(shot, (i + rng.random()) / 16) for i in range(16)]


def theirs(peers: list[mi.Scene], sensor: mi.Sensor, falloff: np.ndarray, spp: int, seed: int) -> np.ndarray:
    integrator = mi.load_dict({"type": "path", "max_depth": BOUNCES + 2})
    pictures = [
        np.array(
            mi.render(scene, sensor=sensor, integrator=integrator, spp=spp // len(peers), seed=len(peers) * seed + i),
            float,
        )
        for i, scene in enumerate(peers)
    ]
    return np.mean(pictures, axis=0) * falloff


def falloff_of(taken: rc.Camera) -> np.ndarray:
    """(H, W, 1): irradiance on the film for a radiance of 1, which is what Mitsuba's pinhole gives."""
    rays = taken.generate_rays(spp=16)
    return (np.bincount(rays.pixels, rays.weights, WIDTH * HEIGHT) / 16).reshape(HEIGHT, WIDTH, 1)


def blocks(picture: np.ndarray) -> np.ndarray:
    return picture.reshape(HEIGHT // BLOCK, BLOCK, WIDTH // BLOCK, BLOCK, 3).mean(axis=(1, 3))


def compare(name: str, spp: int, rounds: int) -> tuple[float, float]:
    """The relative difference of the means, and the largest difference of a block in standard errors of both."""
    from mitsuba_scene import sensor as mitsuba_sensor

    shot, taken = scenes.SHOTS[name](), camera()
    mine, peers = scenes.realcam_scene(shot), mitsuba_scenes(shot)
    sensor, falloff = mi.load_dict(mitsuba_sensor("perspective", taken)), falloff_of(taken)
    a = np.array([blocks(ours(mine, taken, spp, seed)) for seed in range(rounds)])
    b = np.array([blocks(theirs(peers(), sensor, falloff, spp, seed)) for seed in range(rounds)])
    variance = (a.var(axis=0, ddof=1) + b.var(axis=0, ddof=1)) / rounds
    # Where nothing is noise (a sky, a lamp), what float32 rounds.
    error = np.sqrt(variance + (1e-4 * a.mean()) ** 2)
    return a.mean() / b.mean() - 1, float(np.abs((a.mean(axis=0) - b.mean(axis=0)) / error).max())


# With 8 rounds a standard error is itself known to a quarter: of 288 blocks and channels the largest of right ones, by
# Student's t with 14 degrees of freedom, exceeds 6.5 in one of 250 comparisons.
LARGEST = 6.5


@pytest.mark.parametrize("name", scenes.SHOTS)
def test_the_same_light_as_mitsuba(name: str) -> None:
    mean, largest = compare(name, spp=64, rounds=8)
    assert largest < LARGEST
    assert math.isfinite(mean) and abs(mean) < 0.02


@pytest.mark.slow
@pytest.mark.parametrize("name", scenes.SHOTS)
def test_the_same_mean_as_mitsuba(name: str) -> None:
    mean, largest = compare(name, spp=1024, rounds=8)
    assert abs(mean) < 0.005
    assert largest < LARGEST
