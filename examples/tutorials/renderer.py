"""
Rays of a real lens for your own renderer
=========================================

For users and writers of renderers. realcam can give you the rays of a camera, and leave all else to your program. Here
your program is thirty lines of numpy that see spheres on a floor.
"""

# %%
# A renderer
# ----------
#
# Only one function of it is needed: the radiance along rays. Origins are in metres and directions have length 1,
# both as arrays of shape (N, 3). The floor is y = 0, and the spheres stand on it.

import matplotlib.pyplot as plt
import numpy as np
import realcam as rc

CENTRES = np.array([[-0.55, 0.25, -1.2], [0.0, 0.25, 0.0], [0.4, 0.25, 0.9]])
RADIUS = 0.25
COLOURS = np.array([[0.8, 0.2, 0.1], [0.2, 0.7, 0.3], [0.2, 0.3, 0.8]])
TO_SUN = np.array([0.48, 0.8, 0.36])
SKY = np.array([600.0, 800.0, 1200.0])  # cd/m^2


def radiance(origins: np.ndarray, directions: np.ndarray) -> np.ndarray:
    """(N, 3) cd/m^2."""
    result = np.tile(SKY, (len(origins), 1))
    nearest = np.full(len(origins), np.inf)
    with np.errstate(divide="ignore", invalid="ignore"):
        floor = -origins[:, 1] / directions[:, 1]
        hits = (floor > 0) & (floor < 50)
        points = origins + floor[:, None] * directions
        is_light = (np.floor(4 * points[:, 0]) + np.floor(4 * points[:, 2])) % 2 == 0
    result[hits] = np.where(is_light[hits, None], 4000.0, 700.0)
    nearest[hits] = floor[hits]
    for centre, colour in zip(CENTRES, COLOURS, strict=True):
        apart = origins - centre
        along = np.sum(apart * directions, axis=1)
        rest = along**2 - np.sum(apart**2, axis=1) + RADIUS**2
        distance = -along - np.sqrt(np.maximum(rest, 0))
        hits = (rest > 0) & (distance > 0) & (distance < nearest)
        normals = (apart + distance[:, None] * directions) / RADIUS
        lit = 600 + 4000 * np.maximum(normals @ TO_SUN, 0)
        result[hits] = (lit[:, None] * colour)[hits]
        nearest[hits] = distance[hits]
    return result


# %%
# A camera
# --------
#
# The middle of its film is at ``position``. It is focused on the green sphere, wide open.

camera = rc.Camera(
    rc.Lens.load("biotar-50mm").focused(2.5),
    film=rc.Film(24, 16, (210, 140)),
    position=(0, 0.7, 2.4),
    look_at=(0, 0.25, 0),
    exposure_time_s=1 / 4000,
)

# %%
# The film
# --------
#
# ``ray_chunks`` gives rays in arrays of bounded size: origins, directions, the pixel of each and its *weight*. The
# weight is the irradiance on the pixel where the radiance along the ray is 1. It is 0 where the lens stops a ray. So
# the mean of weight times radiance over the samples of a pixel is its illuminance in lux.


def photograph(camera: rc.Camera, spp: int, seed: int = 0) -> np.ndarray:
    """(H, W, 3) exposure, lux seconds."""
    width, height = camera.film.resolution
    film = np.zeros((width * height, 3))
    for rays in camera.ray_chunks(spp=spp, seed=seed, max_rays=1 << 18):
        light = radiance(rays.origins_m, rays.directions) * rays.weights[:, None] / spp
        for channel in range(3):
            film[:, channel] += np.bincount(rays.pixels, light[:, channel], minlength=len(film))
    return film.reshape(height, width, 3) * camera.exposure_time_s


exposure = photograph(camera, spp=48)

# %%
# 10 / ISO lux seconds are middle grey, 18% of white. The exponent 1 / 2.2 approximates sRGB's transfer curve.

figure, axes = plt.subplots(figsize=(7, 4.7), layout="constrained")
axes.imshow(np.clip(0.018 * camera.iso * exposure, 0, 1) ** (1 / 2.2))
axes.axis("off")

# %%
# Check the light
# ---------------
#
# If the radiance L is the same everywhere, the illuminance in the middle of the picture is pi L / (4 N²). N is the
# *working* f-number, by the angle of the outermost ray at the film. This equation tests weights, pixels and units
# at once.

rays = camera.generate_rays(spp=64)
columns, rows = camera.film.resolution
in_middle = (np.abs(rays.pixels % columns - columns / 2) < 3) & (np.abs(rays.pixels // columns - rows / 2) < 3)
by_rays = np.mean(rays.weights[in_middle])
n = rc.photographic_figures(camera.lens).working_f_number
by_formula = np.pi / (4 * n**2)
print(f"by rays {by_rays:.4f} lux, by formula {by_formula:.4f} lux for 1 cd/m^2")

# %%
# ``examples/mitsuba_rays.py`` does the same with Mitsuba 3, and rays can stay on a GPU
# (:doc:`realcam in Python </docs/python>`).
