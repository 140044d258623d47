"""Fireflies and noise on glossy spheres: realcam and Mitsuba 3 on the CPU, in one run.

    DRJIT_LIBLLVM_PATH=/usr/lib/x86_64-linux-gnu/libLLVM-19.so python benchmarks/fireflies.py [--threads 2]

Needs the extra `bench`, and LLVM for Mitsuba. Three spheres of rough metal and a floor under a small lamp, a constant
environment, or one with a sun; pictures of a pinhole camera with 32 samples and up to 8 reflections. The reference is
the program's own picture with many more samples, because Mitsuba omits multiple scattering between microfacets.

Brightest dot: largest ratio of a pixel to the reference. Noise: root mean square error over the reference's mean. Noise
of one CPU second: extrapolated by the square root of the time.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable

import mitsuba as mi
import numpy as np
import realcam as rc

mi.set_variant("llvm_ad_rgb")

import mitsuba_shots as shots  # noqa: E402
from mitsuba_scene import sensor  # noqa: E402

SPP, REFERENCE_SPP, ROUNDS, BOUNCES = 32, 4096, 4, 8
Render = Callable[[int, int], np.ndarray]  # renders a picture (H, W) with samples per pixel and seed


def spheres(lamp: bool, sky: float | np.ndarray) -> shots.Shot:
    """The scene with or without the lamp. sky: as in Shot."""
    floor = shots.Part(shots.quad([-2, 0, 2], [4, 0, 0], [0, 0, -4]), *shots.diffuse((0.5, 0.5, 0.5)))
    parts = [floor]
    for x, roughness in ((-1.0, 0.1), (0.0, 0.2), (1.0, 0.35)):
        ball = shots.metal(roughness).parts[-1]
        parts.append(shots.Part(shots.sphere([x, 0.45, 0], 0.45), ball.material, ball.bsdf))
    if lamp:
        light = shots.quad([-0.03, 2.2, 0.5], [0.06, 0, 0], [0, 0, 0.06])
        parts.append(shots.Part(light, *shots.diffuse((0.5, 0.5, 0.5)), radiance=(4e5, 4e5, 4e5)))
    return shots.Shot(parts, sky=sky)


LIGHTS = {
    "small lamp": lambda: spheres(True, 0.0),
    "constant sky": lambda: spheres(False, 100.0),
    "sky with a sun": lambda: spheres(False, shots.uneven_sky()),
}


def programs(shot: shots.Shot, threads: int) -> dict[str, Render]:
    """Both programs with the scene, by name."""
    lens = rc.Lens.load("double-gauss-50mm").focused(4.0)
    camera = rc.Camera(
        lens, film=rc.Film(36, 24, (240, 160)), model="pinhole", position=(0.2, 1.2, 4.2), look_at=(0, 0.4, 0)
    )
    scene, peer = shots.realcam_scene(shot), shots.mitsuba_scene(shot)
    integrator = mi.load_dict({"type": "path", "max_depth": BOUNCES + 2, "rr_depth": 4})

    def ours(spp: int, seed: int) -> np.ndarray:
        image = rc.render(
            scene, camera, effects=(), spp=spp, seed=seed, max_bounces=BOUNCES, device="cpu", threads=threads
        )
        return np.asarray(image.pixels.mean(axis=2), float)

    def theirs(spp: int, seed: int) -> np.ndarray:
        # The sampler with the least noise for this integrator.
        mitsuba_sensor = mi.load_dict(sensor("perspective", camera, "multijitter", spp))
        image = mi.render(peer, sensor=mitsuba_sensor, integrator=integrator, spp=spp, seed=seed)
        return np.asarray(np.array(image).mean(axis=2), float)

    return {"realcam": ours, "Mitsuba path": theirs}


def measure(render: Render) -> tuple[float, float, float]:
    """Returns the brightest dot, the noise, and the CPU seconds of a picture."""
    reference = np.mean([render(REFERENCE_SPP // 4, 1000 + seed) for seed in range(4)], axis=0)
    dots, errors, seconds = [], [], []
    for seed in range(ROUNDS):
        begin = time.process_time()
        picture = render(SPP, seed)
        seconds.append(time.process_time() - begin)
        lit = reference > 1e-3 * reference.mean()
        dots.append((picture[lit] / reference[lit]).max())
        errors.append(np.sqrt(((picture - reference) ** 2).mean()) / reference.mean())
    return float(np.median(dots)), float(np.mean(errors)), min(seconds)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--threads", type=int, default=2)
    threads = parser.parse_args().threads
    mi.set_log_level(mi.LogLevel.Error)
    print("| light | program | brightest dot | noise at 32 samples | CPU s | noise of one CPU second |")
    print("|---|---|---|---|---|---|")
    for light, shot in LIGHTS.items():
        for name, render in programs(shot(), threads).items():
            dot, noise, seconds = measure(render)
            print(f"| {light} | {name} | {dot:.1f} | {noise:.4f} | {seconds:.2f} | {noise * seconds**0.5:.4f} |")


if __name__ == "__main__":
    main()
