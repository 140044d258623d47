"""The GPU benchmarks' scene in Mitsuba 3 on OptiX: the same triangles, light, camera and number of samples.

    python benchmarks/against_mitsuba.py mitsuba.json

Needs Mitsuba with its CUDA variant. Paths are a camera ray and a shadow ray to the area light (integrator "direct"
with one emitter sample and no BSDF sample). Closest hits are those of rays that leave what a pinhole sees by the cosine
and evenly over the hemisphere.
"""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Callable
from pathlib import Path

import drjit as dr
import mitsuba as mi
import numpy as np
from realcam.bench import frame_scene_arrays

WIDTH, HEIGHT, SPP, ROUNDS = 1920, 1280, 256, 4


def mesh(name: str, vertices: np.ndarray, faces: np.ndarray, radiance: float = 0.0) -> mi.Mesh:
    properties = mi.Properties()
    properties["mesh_bsdf"] = mi.load_dict({"type": "diffuse", "reflectance": {"type": "rgb", "value": 0.5}})
    if radiance:
        properties["mesh_emitter"] = mi.load_dict({"type": "area", "radiance": {"type": "rgb", "value": radiance}})
    result = mi.Mesh(name, len(vertices), len(faces), props=properties)
    parameters = mi.traverse(result)
    parameters["vertex_positions"] = vertices.astype(np.float32).ravel()
    parameters["faces"] = faces.astype(np.uint32).ravel()
    parameters.update()
    return result


def sensor(kind: str) -> dict:
    # The double Gauss at 5 m: 51.9 mm, f/2.
    settings = {
        "type": kind,
        "fov": 2 * np.degrees(np.arctan(18 / 52.5)),
        "fov_axis": "x",
        "to_world": mi.ScalarTransform4f().look_at(origin=[0, 1.5, 4], target=[0, 0.3, -4], up=[0, 1, 0]),
        "film": {
            "type": "hdrfilm",
            "width": WIDTH,
            "height": HEIGHT,
            "pixel_format": "rgb",
            "rfilter": {"type": "box"},
        },
        "sampler": {"type": "independent"},
    }
    if kind == "thinlens":
        settings |= {"aperture_radius": 0.013, "focus_distance": 5.0}
    return settings


def best_rate(count: float, work: Callable[[], object]) -> float:
    times = []
    for _ in range(ROUNDS):  # the first one compiles
        dr.sync_thread()
        start = time.perf_counter()
        work()
        dr.sync_thread()
        times.append(time.perf_counter() - start)
    return round(count / min(times) / 1e9, 3)


def paths_per_second(scene: mi.Scene, kind: str) -> float:
    camera = mi.load_dict(sensor(kind))
    integrator = mi.load_dict({"type": "direct", "emitter_samples": 1, "bsdf_samples": 0})
    # A wavefront holds at most 2^32 samples, and 32 to a pass are as fast as more.
    passes = SPP // 32

    def render() -> None:
        for i in range(passes):
            dr.eval(mi.render(scene, sensor=camera, integrator=integrator, spp=32, seed=i))

    return best_rate(WIDTH * HEIGHT * SPP, render)


def bounce_rays(scene: mi.Scene, uniform: bool) -> mi.Ray3f:
    camera = mi.load_dict(sensor("perspective"))
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
    return best_rate(WIDTH * HEIGHT, lambda: dr.eval(scene.ray_intersect_preliminary(rays)))


def main(output: Path) -> None:
    mi.set_variant("cuda_ad_rgb")
    vertices, faces, materials = frame_scene_arrays(spheres=103, boxes=50)
    lamp = materials == 1
    scene = mi.load_dict(
        {"type": "scene", "a": mesh("a", vertices, faces[~lamp]), "b": mesh("b", vertices, faces[lamp], 2000.0)}
    )
    record = {
        "name": f"Mitsuba {mi.__version__} (OptiX)",
        "triangles": len(faces),
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
