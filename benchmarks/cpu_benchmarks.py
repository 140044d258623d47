"""CPU benchmarks of `realcam bench`: lenses, frames and sensors, with ratios measured in one run."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from functools import partial

import numpy as np
from frame_scene import frame_camera, frame_scene
from machine import Result
from realcam import Camera, Film, Lens, Scene, Sensor, _core, lens_names, render


def lens_rays(threads: int) -> Result:
    """Rays per second through the 11 surfaces of the double Gauss, one core, float32, by instruction set."""
    del threads  # one core by definition
    rates = _core._lens_ray_rates(Lens.load("double-gauss-50mm"), 3.0)
    return {f"x86-64-{name}" if name != "native" else name: round(rate / 1e6, 1) for name, rate in rates.items()} | {
        "unit": "million rays a second on one core"
    }


def lens_setup(threads: int) -> Result:
    """Time of the pupil search after a change of focus or stop, on one core and on all."""
    del threads  # one, and all
    times = {}
    for name in lens_names():
        lens = Lens.load(name)
        f_number = lens.first_order().f_number
        stopped = lens.stopped_down(max(11.0, f_number))
        times[name] = {
            state + where: round(1e3 * _best(partial(_core.pupil_setup, changed, on_one_core=not where)), 1)
            for where in ("", ", all cores")
            for state, changed in (("wide_open", lens), ("f/11", stopped))
        }
    worst = max(max(t.values()) for t in times.values())
    return {"milliseconds": times, "worst": worst}


def _best(work: Callable[[], object], rounds: int = 3) -> float:
    """Seconds of the fastest round, because other load of the machine can only increase a time."""
    times = []
    for _ in range(rounds):
        start = time.perf_counter()
        work()
        times.append(time.perf_counter() - start)
    return min(times)


def _sky() -> Scene:
    """Scene with only an environment, so that the time of a picture is that of its camera rays."""
    return Scene.from_arrays([[0, 0, 1e5], [1e-3, 0, 1e5], [0, 1e-3, 1e5]], [[0, 1, 2]]).with_environment(1.0)


def pass_share(threads: int) -> Result:
    """Fraction of the sampled rays that pass the lens, whole frame, wide open."""
    sky = _sky()
    shares = {}
    for name in lens_names():
        lens = Lens.load(name)
        width, height = lens.film_mm
        film = Film(width, height, (300, max(1, round(300 * height / width))))
        stats = render(
            sky, Camera(lens, film=film), effects=(), spp=16, max_bounces=0, device="cpu", threads=threads
        ).stats
        shares[name] = round(stats.passed_rays / stats.sampled_rays, 4)
    return {"share": shares, "worst": min(shares.values())}


def camera_models(threads: int) -> Result:
    """CPU seconds by camera model of 640 x 640 pixels of 20 samples of an environment. An ideal lens that takes as long
    as the full one is not vectorised."""
    sky = _sky()
    cpu: dict[str, list[float]] = {}
    for _ in range(5):  # the models alternate, so that other load of the machine affects all equally
        for model in ("pinhole", "thin", "mapped", "thick", "full"):
            start = time.process_time()
            stats = render(sky, frame_camera(model), spp=20, effects=(), device="cpu", threads=threads).stats
            share = 1 - stats.setup_seconds / stats.seconds
            cpu.setdefault(model, []).append(share * (time.process_time() - start))
    best = {model: min(times) for model, times in cpu.items()}
    return {
        "cpu_seconds": {model: round(seconds, 3) for model, seconds in best.items()},
        "over_full": {model: round(seconds / best["full"], 2) for model, seconds in best.items()},
    }


def frame(threads: int) -> Result:
    """640 x 640 pixels of 20 samples, direct light: CPU seconds by camera model, set-up included."""
    scene = frame_scene()
    cameras = {model: frame_camera(model) for model in ("full", "thick", "thin", "pinhole")}
    cpu: dict[str, list[float]] = {model: [] for model in cameras}
    wall: dict[str, list[float]] = {model: [] for model in cameras}
    # Builds the scene's BVH, whose time does not count.
    render(scene, cameras["pinhole"], effects=(), spp=1, device="cpu", threads=threads)
    for _ in range(5):  # the models alternate, so that other load of the machine affects all equally
        for model, camera in cameras.items():
            start = time.process_time(), time.perf_counter()
            render(scene, camera, effects=(), spp=20, max_bounces=0, device="cpu", threads=threads)
            cpu[model].append(time.process_time() - start[0])
            wall[model].append(time.perf_counter() - start[1])
    best = {model: min(times) for model, times in cpu.items()}
    return {
        "triangles": scene.triangle_count,
        "cpu_seconds": {model: round(seconds, 3) for model, seconds in best.items()},
        "wall_seconds": {model: round(min(times), 3) for model, times in wall.items()},
        "full_over_thin": round(best["full"] / best["thin"], 3),
    }


def sensor(threads: int) -> Result:
    """CPU seconds on one core from exposure to raw values for 24 megapixels, by the mean number of electrons per
    pixel."""
    del threads  # one core by definition
    chip = Sensor.load("sony-imx900-mono").replace(row_noise_e=0.3, hot_pixel_share=1e-4, hot_pixel_current_e_per_s=50)
    pitch_um, lowest_iso = 2.25, chip.iso_range()[0]
    electrons_per_lux_s = chip.electrons_per_um2()[0].sum() * pitch_um**2
    best = {}
    for electrons in (0, 1, 10, 50, 100, 1000, 8000):
        exposure = np.full((4000, 6000, 3), electrons / electrons_per_lux_s, np.float32)
        times = []
        for _ in range(3):
            start = time.process_time()
            _core._expose(chip, exposure, pitch_um, pitch_um, math.inf, 0.01, lowest_iso, "", None, 1, 0, 1)
            times.append(time.process_time() - start)
        best[str(electrons)] = round(min(times), 3)
    return {"megapixels": 24, "cpu_seconds_by_electrons": best, "worst": max(best.values())}


CPU_BENCHMARKS: dict[str, Callable[[int], Result]] = {
    "lens-rays": lens_rays,
    "lens-setup": lens_setup,
    "pass-share": pass_share,
    "camera-models": camera_models,
    "frame": frame,
    "sensor": sensor,
}
