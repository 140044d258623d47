"""GPU benchmarks of `realcam bench`: lenses, closest hits, paths, live frames and instances."""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np
from frame_scene import frame_camera, frame_objects, frame_scene
from machine import Result
from realcam import Camera, Film, Lens, LiveView, Scene, _core, render


def _gpu_scene() -> Scene:
    """410 000 diffuse triangles under one area light."""
    return frame_scene(spheres=103, boxes=50, sky=0.0)


def gpu_camera(model: str = "full") -> Camera:
    """frame_camera with the film of the GPU benchmarks."""
    return frame_camera(model, Film(36, 24, (1920, 1280)))


def _giga(rate: float) -> float:
    """Rate in 1e9 per second, rounded."""
    return round(rate / 1e9, 3)


def gpu_lens_rays(threads: int) -> Result:
    """Rays per second through lenses, float32, whole frame: ray tracing alone, and with sampling of film and pupil."""
    del threads
    results = {}
    for name in ("double-gauss-50mm", "phone-4mm"):
        lens = Lens.load(name)
        camera = Camera(lens, film=Film(*lens.film_mm, (1920, 1280)), position=(0, 1.5, 4), look_at=(0, 0.3, -4))
        rates = _core._gpu_lens_ray_rates(camera, "cuda")
        results[name] = {
            "surfaces": len(lens.surfaces),
            "traced": _giga(rates["traced"]),
            "generated": _giga(rates["generated"]),
            "passed_share": round(rates["passed"], 4),
        }
    return {"giga_rays_per_second": results}


def gpu_hits(threads: int) -> Result:
    """Closest hits per second of camera rays and of bounces (cosine, uniform), and the build time of BVHs."""
    del threads
    scene = _gpu_scene()
    rates = _core._gpu_hit_rates(scene, gpu_camera(), "cuda")
    large = frame_scene(spheres=100, boxes=0, rows=224, sky=0.0)
    build = _core._gpu_hit_rates(large, gpu_camera(), "cuda")
    return {
        "triangles": scene.triangle_count,
        "giga_rays_per_second": {kind: _giga(rates[kind]) for kind in ("camera", "cosine", "uniform")},
        "build_seconds": {
            str(scene.triangle_count): round(rates["build_seconds"], 3),
            str(large.triangle_count): round(build["build_seconds"], 3),
        },
    }


def gpu_paths(threads: int) -> Result:
    """256 samples of 1920 x 1280 pixels: paths (camera ray and shadow ray) by camera model, rays by number of
    bounces."""
    del threads
    scene = _gpu_scene()
    seconds: dict[str, list[float]] = {}
    for _ in range(4):  # the variants alternate; the first round warms up
        for model in ("pinhole", "thin", "thick", "full"):
            stats = render(scene, gpu_camera(model), effects=(), spp=256, max_bounces=0, device="cuda").stats
            seconds.setdefault(model, []).append(stats.seconds - stats.setup_seconds)
    paths = 256 * 1920 * 1280
    best = {model: min(times) for model, times in seconds.items()}
    rays = {}
    for bounces in (1, 4, 8):
        runs = [
            render(scene, gpu_camera(), effects=(), spp=64, max_bounces=bounces, device="cuda").stats for _ in range(3)
        ]
        rays[str(bounces)] = _giga(max(run.scene_rays / (run.seconds - run.setup_seconds) for run in runs))
    lens_alone = paths / _core._gpu_lens_ray_rates(gpu_camera(), "cuda")["generated"]
    return {
        "triangles": scene.triangle_count,
        "giga_paths_per_second": {model: _giga(paths / s) for model, s in best.items()},
        "giga_rays_per_second_by_bounces": rays,
        "full_over_thin": round(best["full"] / best["thin"], 3),
        "lens_share": round(lens_alone / best["full"], 3),
    }


def _frames_per_second(shoot: Callable[[int], _core.LiveFrame]) -> float:
    """Rate of 200 frames after 20 for warm-up; each frame is read while the next three are in progress.

    shoot: starts the frame with an index.
    """
    frames: list[_core.LiveFrame] = []
    for i in range(220):
        if i == 20:
            frames[-1].codes.sum()
            begin = time.perf_counter()
        frames.append(shoot(i))
        if len(frames) > 3:
            frames.pop(0).codes.sum()
    frames[-1].codes.sum()
    return round(200 / (time.perf_counter() - begin), 1)


def gpu_frames(threads: int) -> Result:
    """Frames per second of a live view, 640 x 640 pixels of 20 samples, while pose, focus or aperture changes; and the
    time to cancel a frame."""
    del threads
    view = LiveView(_gpu_scene(), device="cuda", max_bounces=0)
    lens = Lens.load("double-gauss-50mm").focused(5.0)

    def camera(lens: Lens = lens, x: float = 0.0) -> Camera:
        return Camera(lens, film=Film(24, 24, (640, 640)), position=(x, 1.5, 4), look_at=(0, 0.3, -4))

    changes: dict[str, Callable[[int], Camera]] = {
        "pose": lambda i: camera(x=0.001 * i),
        "focus": lambda i: camera(lens.focused(4 + 0.01 * i)),
        "stop": lambda i: camera(lens.stopped_down(2.8 + 0.01 * i)),
    }
    rates = {}
    for name, camera_at in changes.items():

        def shoot(i: int, camera_at: Callable[[int], Camera] = camera_at) -> _core.LiveFrame:
            return view.shoot(camera_at(i), spp=20)

        rates[name] = _frames_per_second(shoot)
    return {"frames_per_second": rates, "milliseconds_to_stop": _milliseconds_to_stop(view, camera())}


def _milliseconds_to_stop(view: LiveView, camera: Camera) -> float:
    """Longest time of ten cancellations of a frame that would take minutes."""
    longest = 0.0
    for _ in range(10):
        view.shoot(camera, spp=1 << 20)
        time.sleep(0.05)
        start = time.perf_counter()
        view.cancel()
        longest = max(longest, time.perf_counter() - start)
    return round(1e3 * longest, 2)


def gpu_objects(threads: int) -> Result:
    """Cost of a two-level BVH: 103 spheres as instances against the same triangles; and frames with a moving
    instance."""
    del threads
    scenes = {"triangles": frame_scene(spheres=103, boxes=0, sky=0.0), "objects": frame_objects(103)}
    camera = gpu_camera("pinhole")
    seconds: dict[str, list[float]] = {}
    for _ in range(4):  # the variants alternate; the first round warms up
        for name, scene in scenes.items():
            stats = render(scene, camera, effects=(), spp=256, max_bounces=0, device="cuda").stats
            seconds.setdefault(name, []).append(stats.seconds - stats.setup_seconds)
    hits = {name: _core._gpu_hit_rates(scene, camera, "cuda") for name, scene in scenes.items()}

    scene, view = scenes["objects"], LiveView(scenes["objects"], device="cuda", max_bounces=0)
    small = Camera(camera.lens, film=Film(24, 24, (640, 640)), position=(0, 1.5, 4), look_at=(0, 0.3, -4))
    matrix = np.eye(4)

    def shoot(i: int) -> _core.LiveFrame:
        matrix[:3, 3] = 0.01 * i - 1, 0.3, -2
        view.show(scene.moved("0", matrix))
        return view.shoot(small, spp=20)

    return {
        "giga_paths_per_second": {name: _giga(256 * 1920 * 1280 / min(times)) for name, times in seconds.items()},
        "giga_bounces_per_second": {name: _giga(rates["cosine"]) for name, rates in hits.items()},
        "frames_per_second": _frames_per_second(shoot),
    }


GPU_BENCHMARKS: dict[str, Callable[[int], Result]] = {
    "gpu-lens-rays": gpu_lens_rays,
    "gpu-hits": gpu_hits,
    "gpu-paths": gpu_paths,
    "gpu-frames": gpu_frames,
    "gpu-objects": gpu_objects,
}
