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
    """Returns a function that makes the scenes of a render: a still shot has always the same one.

    A shot with motion has 16 new ones in each call, at a random time in each 1/16 of the exposure.
    """
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
    """(H, W, 1): irradiance on the film for a radiance of 1; Mitsuba's pinhole records the radiance."""
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
    # The second term is the rounding of float32, for blocks without noise (a sky, a lamp).
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


def parallel_mirrors() -> scenes.Shot:
    """A ball between two mirrors, which show it in each other."""
    material = rc.Material(diffuse=(0, 0, 0), mirror=(0.9, 0.9, 0.9), fresnel=False)
    bsdf = {"type": "conductor", "material": "none", "specular_reflectance": {"type": "rgb", "value": 0.9}}
    mirrors = [
        scenes.Part(scenes.quad([x, 0, 1.5], [0, 0, -3], [0, 2.2, 0]), material, {"type": "twosided", "bsdf": bsdf})
        for x in (-1.1, 1.1)
    ]
    ball = scenes.Part(scenes.sphere([0, 0.6, 0], 0.4), *scenes.diffuse((0.8, 0.5, 0.2)))
    return scenes.Shot([*scenes.room(), *mirrors, ball])


def white_room() -> scenes.Shot:
    """Six walls that reflect 0.8 of the light, and a lamp below the ceiling."""
    white, (x, y, z) = scenes.diffuse((0.8, 0.8, 0.8)), (4, 3, 7)
    low, high = [-2, 0, -2], [2, 3, 5]
    sides = [([x, 0, 0], [0, y, 0]), ([x, 0, 0], [0, 0, z]), ([0, y, 0], [0, 0, z])]
    walls = [
        scenes.Part(scenes.quad(corner, [s * c for c in u], [s * c for c in v]), *white)
        for corner, s in ((low, 1), (high, -1))
        for u, v in sides
    ]
    return scenes.Shot([*walls, scenes.room()[2]], sky=0.0)


@pytest.mark.parametrize("shot", [scenes.SHOTS["smooth glass"], parallel_mirrors, white_room])
def test_planned_bounces_show_what_mitsuba_sees_at_depth_64(shot: Callable[[], scenes.Shot]) -> None:
    """Within the threshold of a photograph, 1 code of 8 bits in the mean of 8 x 8 pixels, and the noise of both."""
    from mitsuba_scene import sensor as mitsuba_sensor

    rounds, spp = 8, 128
    mine = scenes.realcam_scene(shot())
    taken = camera().metered(mine, device="cpu")
    sensor, falloff = mi.load_dict(mitsuba_sensor("perspective", taken)), falloff_of(taken)
    integrator = mi.load_dict({"type": "path", "max_depth": 64 + 2})
    peer = scenes.mitsuba_scene(shot())

    def codes(luxes: np.ndarray) -> np.ndarray:
        # 10 / ISO lux seconds are middle grey, 18% of white (ISO 12232).
        linear = np.clip(0.018 * taken.iso * taken.exposure_time_s * np.asarray(blocks(luxes)), 0, 1)
        return 255 * np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)

    def of(pictures: list[np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
        all_codes = np.array([codes(picture) for picture in pictures])
        return codes(np.mean(pictures, axis=0)), all_codes.std(axis=0, ddof=1) / rounds**0.5

    theirs, their_error = of(
        [
            np.array(mi.render(peer, sensor=sensor, integrator=integrator, spp=spp, seed=seed), float) * falloff
            for seed in range(rounds)
        ]
    )

    def largest(**bounces: int) -> float:
        images = [rc.render(mine, taken, effects=(), spp=spp, seed=s, device="cpu", **bounces) for s in range(rounds)]
        ours, our_error = of([np.asarray(image.pixels, float) / taken.exposure_time_s for image in images])
        print(images[0].settings.max_bounces, np.abs(ours - theirs).max(), np.hypot(our_error, their_error).max())
        return float((np.abs(ours - theirs) - LARGEST * np.hypot(our_error, their_error)).max())

    assert largest() < 1
    assert largest(max_bounces=1) > 10
