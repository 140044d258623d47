"""Bright dots and noise on glossy spheres, realcam and Mitsuba 3 on the CPU, in one run.

    DRJIT_LIBLLVM_PATH=/usr/lib/x86_64-linux-gnu/libLLVM-19.so python benchmarks/fireflies.py [--threads 2]

Needs the extra `bench`, and LLVM for Mitsuba. Three spheres of rough metal and a floor under a small lamp, a constant
sky, or a sky with a sun; a pinhole's picture of 32 samples, up to 8 reflections. Each program is measured against its
own picture of many more samples, because single reflections on microfacets lose light that realcam keeps.

Brightest dot: the largest of any pixel's value over that of the reference. Noise: root mean square error over the
reference's mean. At equal time: the noise of one second, with which it falls as one over the square root.
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
Take = Callable[[int, int], np.ndarray]


def spheres(lamp: bool, sky: float | np.ndarray) -> shots.Shot:
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


def programs(shot: shots.Shot, threads: int) -> dict[str, Take]:
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
        # Of the samplers the one that does best with this integrator.
        eye = mi.load_dict(sensor("perspective", camera, "multijitter", spp))
        image = mi.render(peer, sensor=eye, integrator=integrator, spp=spp, seed=seed)
        return np.asarray(np.array(image).mean(axis=2), float)

    return {"realcam": ours, "Mitsuba path": theirs}


def measure(take: Take) -> tuple[float, float, float]:
    """The brightest dot, the noise, and CPU seconds of a picture."""
    reference = np.mean([take(REFERENCE_SPP // 4, 1000 + seed) for seed in range(4)], axis=0)
    dots, errors, seconds = [], [], []
    for seed in range(ROUNDS):
        begin = time.process_time()
        picture = take(SPP, seed)
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
        for name, take in programs(shot(), threads).items():
            dot, noise, seconds = measure(take)
            print(f"| {light} | {name} | {dot:.1f} | {noise:.4f} | {seconds:.2f} | {noise * seconds**0.5:.4f} |")


if __name__ == "__main__":
    main()
