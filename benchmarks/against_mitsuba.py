"""The GPU benchmarks' scene in Mitsuba 3 on OptiX: the same triangles, light, camera and number of samples.

    python benchmarks/against_mitsuba.py mitsuba.json

Needs Mitsuba with its CUDA variant. Paths are a camera ray and a shadow ray to the area light (integrator "direct"
with one emitter sample and no BSDF sample). Closest hits are those of rays from the points that a pinhole camera sees,
with directions that are cosine-distributed or uniform over the hemisphere.
"""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Callable
from pathlib import Path

import drjit as dr
import mitsuba as mi
from gpu_benchmarks import gpu_camera
from mitsuba_scene import frame_scene, sensor

(WIDTH, HEIGHT), SPP, ROUNDS = gpu_camera().film.resolution, 256, 4


def best_rate(count: float, work: Callable[[], object]) -> float:
    """Rate of the fastest round in 1e9 per second. count: number of rays or paths of a round."""
    times = []
    for _ in range(ROUNDS):  # the first one compiles
        dr.sync_thread()
        start = time.perf_counter()
        work()
        dr.sync_thread()
        times.append(time.perf_counter() - start)
    return round(count / min(times) / 1e9, 3)


def paths_per_second(scene: mi.Scene, kind: str) -> float:
    """Paths in 1e9 per second through a sensor, "perspective" or "thinlens"."""
    camera = mi.load_dict(sensor(kind, gpu_camera()))
    integrator = mi.load_dict({"type": "direct", "emitter_samples": 1, "bsdf_samples": 0})
    # A wavefront holds at most 2^32 samples, and 32 to a pass are as fast as more.
    passes = SPP // 32

    def render() -> None:
        for i in range(passes):
            dr.eval(mi.render(scene, sensor=camera, integrator=integrator, spp=32, seed=i))

    return best_rate(WIDTH * HEIGHT * SPP, render)


def bounce_rays(scene: mi.Scene, uniform: bool) -> mi.Ray3f:
    """Rays that leave the visible surface of each pixel, uniformly or with a cosine distribution."""
    camera = mi.load_dict(sensor("perspective", gpu_camera()))
    index = dr.arange(mi.UInt32, WIDTH * HEIGHT)
    position = mi.Point2f((index % WIDTH + 0.5) / WIDTH, (index // WIDTH + 0.5) / HEIGHT)
    rays, _ = camera.sample_ray(0.0, 0.5, position, mi.Point2f(0.5))
    hits = scene.ray_intersect(rays)
    sampler = mi.load_dict({"type": "independent"})
    sampler.seed(1, WIDTH * HEIGHT)
    warp = mi.warp.square_to_uniform_hemisphere if uniform else mi.warp.square_to_cosine_hemisphere
    frame = mi.Frame3f(dr.select(dr.dot(hits.n, rays.d) < 0, hits.n, -hits.n))
    bounced = hits.spawn_ray(frame.to_world(warp(sampler.next_2d())))
    bounced.o = dr.select(hits.is_valid(), bounced.o, rays.o)
    bounced.d = dr.select(hits.is_valid(), bounced.d, rays.d)
    dr.eval(bounced)
    return bounced


def hits_per_second(scene: mi.Scene, rays: mi.Ray3f) -> float:
    """Closest hits of the rays in 1e9 per second."""
    return best_rate(WIDTH * HEIGHT, lambda: dr.eval(scene.ray_intersect_preliminary(rays)))


def main(output: Path) -> None:
    mi.set_variant("cuda_ad_rgb")
    scene = frame_scene(spheres=103, boxes=50)
    record = {
        "name": f"Mitsuba {mi.__version__} (OptiX)",
        "triangles": sum(shape.face_count() for shape in scene.shapes()),
        "paths": {kind: paths_per_second(scene, kind) for kind in ("perspective", "thinlens")},
        "closest_hits": {
            "cosine": hits_per_second(scene, bounce_rays(scene, uniform=False)),
            "uniform": hits_per_second(scene, bounce_rays(scene, uniform=True)),
        },
    }
    output.write_text(json.dumps(record, indent=2) + "\n")
    print(output.read_text())


if __name__ == "__main__":
    main(Path(sys.argv[1]))
