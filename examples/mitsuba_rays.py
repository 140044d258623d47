"""A photograph of a Mitsuba 3 scene through a real lens: realcam makes the rays, Mitsuba says what they see.

    pip install mitsuba
    python examples/mitsuba_rays.py cornell-box.png

Mitsuba needs LLVM for this, or an NVIDIA GPU (https://mitsuba.readthedocs.io says how to get it).
"""

from __future__ import annotations

import argparse

import drjit as dr
import mitsuba as mi
import numpy as np
import realcam as rc


def photograph(scene: mi.Scene, integrator: mi.SamplingIntegrator, camera: rc.Camera, spp: int) -> np.ndarray:
    """Returns the exposure in lux seconds, (H, W, 3), as rc.render does for a realcam scene.

    The scene is in metres, its radiances in cd/m^2.
    """
    width, height = camera.film.resolution
    film = dr.zeros(mi.Float, 3 * width * height)
    at_once = 4  # samples a pixel: a ray takes 56 bytes here, and more in Mitsuba
    passes = -(-spp // at_once)
    for seed in range(passes):
        rays = camera.generate_rays(spp=at_once, seed=seed)
        radiance = radiance_along(scene, integrator, rays, seed)
        # A ray's weight is the irradiance that a radiance of 1 brings to its pixel, so the pixel's irradiance is the
        # mean of weight times radiance over all its samples, with those that the lens stopped as zeros.
        weight = mi.Float(rays.weights) / (at_once * passes)
        pixel = mi.UInt32(rays.pixels)
        for channel in range(3):
            dr.scatter_add(film, radiance[channel] * weight, 3 * pixel + channel)
    return np.array(film).reshape(height, width, 3) * camera.exposure_time_s


def radiance_along(scene: mi.Scene, integrator: mi.SamplingIntegrator, rays: rc.CameraRays, seed: int) -> mi.Color3f:
    origins = mi.Point3f(np.asarray(rays.origins_m, dtype=np.float32).T)
    directions = mi.Vector3f(np.asarray(rays.directions).T)
    sampler = mi.load_dict({"type": "independent"})
    sampler.seed(seed, len(rays.weights))
    radiance, _, _ = integrator.sample(scene, sampler, mi.RayDifferential3f(mi.Ray3f(origins, directions)))
    return radiance


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("output", help="picture: .png, .exr or another that Mitsuba writes")
    parser.add_argument("--spp", type=int, default=64, help="samples per pixel")
    arguments = parser.parse_args()

    scene = mi.load_dict(mi.cornell_box())
    integrator = mi.load_dict({"type": "path", "max_depth": 6})
    # Mitsuba's Cornell box is 2 m wide around the origin, and open towards +z.
    camera = rc.Camera(
        rc.Lens.load("double-gauss-50mm").focused(4.6),
        film=rc.Film(24, 24, (480, 480)),
        position=(0, 0, 4.8),
        look_at=(0, 0, 0),
        exposure_time_s=2,
    )
    exposure = photograph(scene, integrator, camera, arguments.spp)
    # The exposure scale of a camera: 10 / ISO lux seconds become a middle grey of 18%.
    mi.util.write_bitmap(arguments.output, exposure * np.float32(0.018 * camera.iso), write_async=False)


mi.set_variant("cuda_ad_rgb", "llvm_ad_rgb")

if __name__ == "__main__":
    main()
