"""Benchmarks: figures of the machine at hand, with ratios taken in one run."""

from __future__ import annotations

import math
import platform
import subprocess
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np

from . import _core
from ._core import Camera, Film, Lens, Material, Scene, Sensor, lens_names
from .render import render

Result = dict[str, object]


def machine() -> Result:
    """Processor, system, version and commit: what a figure means nothing without."""
    return {
        "processor": _processor(),
        "system": f"{platform.system()} {platform.release()}",
        "devices": _core.devices(),
        "realcam": _core.__version__,
        "commit": _commit(),
        "date": time.strftime("%Y-%m-%d", time.gmtime()),
    }


def _processor() -> str:
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
    except OSError:
        return platform.processor()
    return next((line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")), platform.machine())


def _commit() -> str | None:
    command = ["git", "-C", str(Path(__file__).parent), "describe", "--always", "--dirty", "--abbrev=12"]
    try:
        return subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()
    except (OSError, subprocess.CalledProcessError):
        return None


def lens_rays(threads: int) -> Result:
    """Rays per second through the 11 surfaces of the double Gauss, one core, float32, by instruction set."""
    del threads  # one core by definition
    rates = _core._lens_ray_rates(Lens.load("double-gauss-50mm"), 3.0)
    return {f"x86-64-{name}" if name != "native" else name: round(rate / 1e6, 1) for name, rate in rates.items()} | {
        "unit": "million rays a second on one core"
    }


def lens_setup(threads: int) -> Result:
    """Time to find the pupil again after a change of focus or stop, on one core and on all."""
    del threads  # one, and all
    times = {}
    for name in lens_names():
        lens = Lens.load(name)
        radius = 0.5 * math.hypot(*lens.film_mm)
        f_number = lens.first_order().f_number
        stopped = lens.stopped_down(max(11.0, f_number))
        times[name] = {
            state + where: round(1e3 * _best(partial(_core.pupil_setup, changed, radius, on_one_core=not where)), 1)
            for where in ("", ", all cores")
            for state, changed in (("wide_open", lens), ("f/11", stopped))
        }
    worst = max(max(t.values()) for t in times.values())
    return {"milliseconds": times, "worst": worst}


def _best(work: Callable[[], object], rounds: int = 3) -> float:
    """Seconds of the fastest round: other programs can only slow one down."""
    times = []
    for _ in range(rounds):
        start = time.perf_counter()
        work()
        times.append(time.perf_counter() - start)
    return min(times)


def _sky() -> Scene:
    """Nothing but a sky, so that a picture costs what its camera rays cost."""
    return Scene.from_arrays([[0, 0, 1e5], [1e-3, 0, 1e5], [0, 1e-3, 1e5]], [[0, 1, 2]]).with_environment(1.0)


def pass_share(threads: int) -> Result:
    """Share of the sampled rays that pass the lens, whole frame, wide open."""
    speck = _sky()
    shares = {}
    for name in lens_names():
        lens = Lens.load(name)
        width, height = lens.film_mm
        film = Film(width, height, (300, max(1, round(300 * height / width))))
        stats = render(
            speck, Camera(lens, film=film), effects=(), spp=16, max_bounces=0, device="cpu", threads=threads
        ).stats
        shares[name] = round(stats.passed_rays / stats.sampled_rays, 4)
    return {"share": shares, "worst": min(shares.values())}


def camera_models(threads: int) -> Result:
    """640 x 640 pixels of 20 samples of a sky: CPU seconds by camera model. An ideal lens that takes as long as every
    surface has lost its vector code."""
    sky = _sky()
    cpu: dict[str, list[float]] = {}
    for _ in range(5):  # in turns, so that what else the machine does falls on all alike
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


FRAME_EMITTER_RADIANCE = 2000.0  # cd/m^2, of the area light of frame_scene_arrays


def frame_scene_arrays(spheres: int = 50, boxes: int = 50, rows: int = 32) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Spheres and boxes on a plane under one area light: vertices (m), triangles, a material (1: light) for each."""
    random = np.random.default_rng(1)
    meshes = [_quad([(-50, 0, 50), (50, 0, 50), (50, 0, -50), (-50, 0, -50)])]
    for _ in range(spheres):
        x, z = random.uniform(-4, 4, 2)
        meshes.append(_sphere((x, 0.3, z - 4), 0.3, 2 * rows, rows))
    for _ in range(boxes):
        x, z = random.uniform(-4, 4, 2)
        meshes.append(_box((x, 0.25, z - 4), 0.25))
    lamp = _quad([(-2, 6, -6), (2, 6, -6), (2, 6, -2), (-2, 6, -2)])
    meshes.append(lamp)
    vertices, triangles, base = [], [], 0
    for points, faces in meshes:
        vertices.append(points)
        triangles.append(faces + base)
        base += len(points)
    materials = np.zeros(sum(len(faces) for faces in triangles), int)
    materials[-len(lamp[1]) :] = 1
    return np.concatenate(vertices), np.concatenate(triangles), materials


def frame_scene(spheres: int = 50, boxes: int = 50, rows: int = 32, sky: float = 100.0) -> Scene:
    """The scene of frame_scene_arrays under a sky (cd/m^2); with 50 spheres of 32 rows, about 205 000 triangles."""
    vertices, triangles, materials = frame_scene_arrays(spheres, boxes, rows)
    scene = Scene.from_arrays(
        vertices,
        triangles,
        triangle_materials=materials,
        materials=[Material(), Material(emission=3 * (FRAME_EMITTER_RADIANCE,))],
    )
    return scene.with_environment(sky) if sky else scene


def frame_camera(model: str = "full", film: Film | None = None) -> Camera:
    """The camera of the frame benchmarks: the double Gauss, wide open, at 5 m; 640 x 640 pixels if no film is given."""
    lens = Lens.load("double-gauss-50mm").focused(5.0)
    return Camera(lens, film=film or Film(24, 24, (640, 640)), model=model, position=(0, 1.5, 4), look_at=(0, 0.3, -4))


Mesh = tuple[np.ndarray, np.ndarray]


def _quad(corners: list[tuple[float, float, float]]) -> Mesh:
    return np.array(corners, float), np.array([[0, 1, 2], [0, 2, 3]])


def _box(centre: tuple[float, float, float], half: float) -> Mesh:
    corners = np.array([[x, y, z] for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)], float) * half + centre
    quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
    return corners, np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))])


def _sphere(centre: tuple[float, float, float], radius: float, columns: int = 64, rows: int = 32) -> Mesh:
    polar, azimuth = np.meshgrid(np.linspace(0, np.pi, rows + 1), np.linspace(0, 2 * np.pi, columns + 1), indexing="ij")
    points = np.stack([np.sin(polar) * np.cos(azimuth), np.cos(polar), np.sin(polar) * np.sin(azimuth)], axis=-1)
    row, column = np.meshgrid(np.arange(rows), np.arange(columns), indexing="ij")
    a = (row * (columns + 1) + column).ravel()
    b, c, d = a + 1, a + columns + 1, a + columns + 2
    upper, lower = np.stack([a, b, d], 1), np.stack([a, d, c], 1)
    return points.reshape(-1, 3) * radius + centre, np.concatenate([upper[columns:], lower[:-columns]])


def frame(threads: int) -> Result:
    """640 x 640 pixels of 20 samples, direct light: CPU seconds by camera model, set-up included."""
    scene = frame_scene()
    cameras = {model: frame_camera(model) for model in ("full", "thick", "thin", "pinhole")}
    cpu: dict[str, list[float]] = {model: [] for model in cameras}
    wall: dict[str, list[float]] = {model: [] for model in cameras}
    # Builds the scene's BVH, which is no part of a picture.
    render(scene, cameras["pinhole"], effects=(), spp=1, device="cpu", threads=threads)
    for _ in range(5):  # in turns, so that what else the machine does falls on all alike
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
    """A sensor of 24 megapixels: CPU seconds from film to raw on one core, by the electrons of a pixel."""
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


def _gpu_scene() -> Scene:
    """410 000 diffuse triangles under one area light."""
    return frame_scene(spheres=103, boxes=50, sky=0.0)


def gpu_camera(model: str = "full") -> Camera:
    """frame_camera with the film of the GPU benchmarks."""
    return frame_camera(model, Film(36, 24, (1920, 1280)))


def _giga(rate: float) -> float:
    return round(rate / 1e9, 3)


def gpu_lens_rays(threads: int) -> Result:
    """Rays per second through lenses on a GPU, float32, whole frame: traced alone, and with film and pupil samples."""
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
    """Closest hits per second of camera rays and of bounces (cosine, uniform), and the time to build hierarchies."""
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
    """256 samples of 1920 x 1280 pixels: paths of a camera and a shadow ray by camera model, rays by bounces."""
    del threads
    scene = _gpu_scene()
    seconds: dict[str, list[float]] = {}
    for _ in range(4):  # in turns; the first round warms up
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
    """Of 200 frames, shot by their number and each read while the next three are under way; the first 20 warm up."""
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
    """Frames per second of a live view, 640 x 640 pixels of 20 samples, while camera, focus or stop change; a stop."""
    del threads
    view = _core.LiveView(_gpu_scene(), device="cuda", max_bounces=0)
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


def _milliseconds_to_stop(view: _core.LiveView, camera: Camera) -> float:
    """The longest of ten stops of a frame that would take minutes."""
    longest = 0.0
    for _ in range(10):
        view.shoot(camera, spp=1 << 20)
        time.sleep(0.05)
        start = time.perf_counter()
        view.cancel()
        longest = max(longest, time.perf_counter() - start)
    return round(1e3 * longest, 2)


def frame_objects(spheres: int) -> Scene:
    """The spheres of frame_scene, in the same places and without a sky, as objects that share one."""
    scene = frame_scene(spheres=0, boxes=0, sky=0.0)
    points, faces = _sphere((0, 0, 0), 0.3)
    sphere = Scene.from_arrays(points, faces)
    random = np.random.default_rng(1)
    for i in range(spheres):
        matrix = np.eye(4)
        x, z = random.uniform(-4, 4, 2)
        matrix[:3, 3] = x, 0.3, z - 4
        scene = scene.with_instance(sphere, matrix, name=str(i))
    return scene


def gpu_objects(threads: int) -> Result:
    """The price of two levels: 103 spheres as objects against their triangles alone; and moving one of them."""
    del threads
    scenes = {"triangles": frame_scene(spheres=103, boxes=0, sky=0.0), "objects": frame_objects(103)}
    camera = gpu_camera("pinhole")
    seconds: dict[str, list[float]] = {}
    for _ in range(4):  # in turns; the first round warms up
        for name, scene in scenes.items():
            stats = render(scene, camera, effects=(), spp=256, max_bounces=0, device="cuda").stats
            seconds.setdefault(name, []).append(stats.seconds - stats.setup_seconds)
    hits = {name: _core._gpu_hit_rates(scene, camera, "cuda") for name, scene in scenes.items()}

    scene, view = scenes["objects"], _core.LiveView(scenes["objects"], device="cuda", max_bounces=0)
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


GPU_BENCHMARKS = ("gpu-lens-rays", "gpu-hits", "gpu-paths", "gpu-frames", "gpu-objects")

BENCHMARKS: dict[str, Callable[[int], Result]] = {
    "lens-rays": lens_rays,
    "lens-setup": lens_setup,
    "pass-share": pass_share,
    "camera-models": camera_models,
    "frame": frame,
    "sensor": sensor,
    "gpu-lens-rays": gpu_lens_rays,
    "gpu-hits": gpu_hits,
    "gpu-paths": gpu_paths,
    "gpu-frames": gpu_frames,
    "gpu-objects": gpu_objects,
}
