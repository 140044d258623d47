"""A lamp, a wall and their shadow in fog: realcam's light beside that of Mitsuba 3's integrator "volpath".

    python benchmarks/fog_against_mitsuba.py [--spp 4096] [--variant scalar_rgb]

Both programs render the same triangles and the same medium with the camera's ideal pinhole. Prints the relative
difference of each channel over the picture and over 4 x 3 parts of it, with the part of it that is noise, as JSON.
"""

from __future__ import annotations

import argparse
import json

import mitsuba as mi
import numpy as np
import realcam as rc

COLUMNS, ROWS = 48, 36
PARTS = (3, 4)  # rows and columns of parts
EXTINCTION, ALBEDO, ANISOTROPY = (0.15, 0.2, 0.3), (0.95, 0.9, 0.8), 0.6
MAX_BOUNCES = 6
RADIANCE = 100.0

Mesh = tuple[np.ndarray, np.ndarray]


def _quad(*corners: tuple[float, float, float]) -> Mesh:
    return np.array(corners, float), np.array([[0, 1, 2], [0, 2, 3]])


FLOOR = _quad((-8, -1, 0), (8, -1, 0), (8, -1, -16), (-8, -1, -16))
WALL = _quad((-1.5, -1, -5), (1.5, -1, -5), (1.5, 1, -5), (-1.5, 1, -5))
LAMP = _quad((-0.5, 0, -7), (0.5, 0, -7), (0.5, 1.6, -7), (-0.5, 1.6, -7))  # behind the wall, faces the camera


def realcam_picture(seed: int, spp: int, device: str) -> np.ndarray:
    """(H, W, 3), in arbitrary units."""
    meshes = [FLOOR, WALL, LAMP]
    scene = rc.Scene.from_arrays(
        np.concatenate([points for points, _ in meshes]),
        np.concatenate([faces + 4 * i for i, (_, faces) in enumerate(meshes)]),
        triangle_materials=np.repeat([0, 0, 1], 2),
        materials=[
            rc.Material(diffuse=(0.5,) * 3),
            rc.Material(diffuse=(0.5,) * 3, emission=(RADIANCE,) * 3),
        ],
    ).with_air(extinction_per_m=EXTINCTION, albedo=ALBEDO, anisotropy=ANISOTROPY)
    settings = {"effects": (), "max_bounces": MAX_BOUNCES, "spp": spp, "seed": seed, "device": device}
    return rc.render(scene, camera(), **settings).pixels.astype(float)


def camera() -> rc.Camera:
    """The pinhole of both programs."""
    lens = rc.Lens.load("double-gauss-50mm").focused(5.0)
    film = rc.Film(32, 24, (COLUMNS, ROWS))
    return rc.Camera(lens, film=film, model="pinhole", position=(0, 0.2, 0), look_at=(0, 0, -6), exposure_time_s=1)


def mitsuba_scene() -> mi.Scene:
    """The same scene; every surface lies in the medium, and so does the camera."""
    import mitsuba_scene as shared

    def rgb(value: tuple[float, ...]) -> dict[str, object]:
        return {"type": "rgb", "value": list(value)}

    medium = mi.load_dict(
        {
            "type": "homogeneous",
            "sigma_t": rgb(EXTINCTION),
            "albedo": rgb(ALBEDO),
            "phase": {"type": "hg", "g": ANISOTROPY},
        }
    )

    def shape(mesh: Mesh, radiance: float = 0.0) -> dict[str, object]:
        """Quadrilaterals, because Mitsuba's meshes take a medium in their dictionary only."""
        a, b, _, d = mesh[0]
        normal = np.cross(b - a, d - a)
        to_world = np.eye(4)
        to_world[:3, 0], to_world[:3, 1] = (b - a) / 2, (d - a) / 2
        to_world[:3, 2], to_world[:3, 3] = normal / np.linalg.norm(normal), (b + d) / 2
        lamp = {"emitter": {"type": "area", "radiance": rgb((radiance,) * 3)}} if radiance else {}
        return {
            "type": "rectangle",
            "to_world": mi.ScalarTransform4f(to_world),
            "bsdf": shared.TWO_SIDED,
            "exterior": medium,
            "interior": medium,
        } | lamp

    sensor = shared.sensor("perspective", camera()) | {"medium": medium}
    parts = {"floor": shape(FLOOR), "wall": shape(WALL), "lamp": shape(LAMP, RADIANCE), "sensor": sensor}
    # MAX_BOUNCES + 1 scatterings, and one more edge to the emitter.
    volpath = {"type": "volpath", "max_depth": MAX_BOUNCES + 2, "rr_depth": 1000}
    return mi.load_dict({"type": "scene", "integrator": volpath} | parts)


def parts_of(picture: np.ndarray) -> np.ndarray:
    """(3, 4, 3): means over parts of the picture."""
    rows, columns = PARTS
    return picture.reshape(rows, ROWS // rows, columns, COLUMNS // columns, 3).mean(axis=(1, 3))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--spp", type=int, default=4096)
    parser.add_argument("--variant", default="scalar_rgb")
    parser.add_argument("--device", default="cpu")
    arguments = parser.parse_args()
    mi.set_variant(arguments.variant)
    scene, passes = mitsuba_scene(), 8
    spp = max(arguments.spp // passes, 1)
    # Several pictures of each, whose scatter is the noise.
    theirs = np.array([parts_of(np.array(mi.render(scene, spp=spp, seed=k))[..., :3]) for k in range(passes)])
    unit = exposure_of_unit_radiance(arguments.device)
    ours = np.array([parts_of(realcam_picture(k, spp, arguments.device) / unit) for k in range(passes)])

    def compare(ours: np.ndarray, theirs: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Relative difference of the means of several pictures, and its standard error."""
        errors = [of.std(axis=0, ddof=1) / of.mean(axis=0) / np.sqrt(passes) for of in (ours, theirs)]
        return ours.mean(axis=0) / theirs.mean(axis=0) - 1, np.hypot(*errors)

    whole, noise_of_whole = compare(ours.mean(axis=(1, 2)), theirs.mean(axis=(1, 2)))
    parts, noise_of_parts = compare(ours, theirs)
    figures = {
        "whole": whole.round(5).tolist(),
        "noise_of_whole": noise_of_whole.round(5).tolist(),
        "parts": parts.round(5).tolist(),
        "noise_of_parts": noise_of_parts.round(5).tolist(),
    }
    print(json.dumps(figures))


def exposure_of_unit_radiance(device: str) -> np.ndarray:
    """(H, W, 1): exposure of each pixel by a uniform enclosure of radiance 1; Mitsuba's pictures are radiances."""
    sky = rc.Scene.from_arrays(np.array([[0, 0, 1e5], [1, 0, 1e5], [0, 1, 1e5]], float), [[0, 1, 2]])
    picture = rc.render(sky.with_environment(1.0), camera(), spp=16, effects=(), max_bounces=0, device=device)
    return picture.pixels.astype(float).mean(axis=-1, keepdims=True)


if __name__ == "__main__":
    main()
