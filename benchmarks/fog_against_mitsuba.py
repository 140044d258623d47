"""Scattering media: realcam's light beside that of Mitsuba 3's integrator "volpath".

    python benchmarks/fog_against_mitsuba.py [--scene glass] [--spp 4096] [--variant scalar_rgb]

The scene "fog" is a lamp, a wall and their shadow in fog; "glass" is a ball of milky glass under a lamp. Both programs
render the same triangles and the same medium with the camera's ideal pinhole. Prints the relative difference of each
channel over the picture and over 4 x 3 parts of it, with the part of it that is noise, as JSON.
"""

from __future__ import annotations

import argparse
import json
import tempfile
from pathlib import Path

import mitsuba as mi
import numpy as np
import realcam as rc

COLUMNS, ROWS = 48, 36
PARTS = (3, 4)  # rows and columns of parts
ALBEDO, ANISOTROPY = (0.95, 0.9, 0.8), 0.6
EXTINCTION = {"fog": (0.15, 0.2, 0.3), "glass": (1.5, 2.0, 3.0)}  # per metre
MAX_BOUNCES = {"fog": 6, "glass": 16}
RADIANCE = 100.0
IOR = 1.5

Mesh = tuple[np.ndarray, np.ndarray]


def _quad(*corners: tuple[float, float, float]) -> Mesh:
    return np.array(corners, float), np.array([[0, 1, 2], [0, 2, 3]])


def _ball(centre: tuple[float, float, float], radius: float, rings: int = 12) -> Mesh:
    """Flat triangles, counterclockwise from outside."""
    polar = np.linspace(0, np.pi, rings + 1)[1:-1]
    turn = np.linspace(0, 2 * np.pi, 2 * rings, endpoint=False)
    p, t = np.meshgrid(polar, turn, indexing="ij")
    rim = np.stack([np.sin(p) * np.sin(t), np.cos(p), np.sin(p) * np.cos(t)], axis=-1).reshape(-1, 3)
    n, faces = 2 * rings, []
    top, bottom = len(rim), len(rim) + 1
    for j in range(n):
        k = (j + 1) % n
        faces += [(top, j, k), (bottom, len(rim) - n + k, len(rim) - n + j)]
        for i in range(0, len(rim) - n, n):
            faces += [(i + j, i + n + j, i + n + k), (i + j, i + n + k, i + k)]
    return np.array(centre) + radius * np.concatenate([rim, [[0, 1, 0], [0, -1, 0]]]), np.array(faces)


FLOOR = _quad((-8, -1, 0), (8, -1, 0), (8, -1, -16), (-8, -1, -16))
SCENES: dict[str, dict[str, Mesh]] = {  # "lamp" and "ball" are of other materials than the rest
    "fog": {
        "floor": FLOOR,
        "wall": _quad((-1.5, -1, -5), (1.5, -1, -5), (1.5, 1, -5), (-1.5, 1, -5)),
        # Behind the wall, faces the camera.
        "lamp": _quad((-0.5, 0, -7), (0.5, 0, -7), (0.5, 1.6, -7), (-0.5, 1.6, -7)),
    },
    "glass": {
        "floor": FLOOR,
        "wall": _quad((-8, -1, -9), (8, -1, -9), (8, 7, -9), (-8, 7, -9)),
        "ball": _ball((0, -0.1, -6), 0.85),
        "lamp": _quad((-1.5, 3, -4.5), (-1.5, 3, -7.5), (1.5, 3, -7.5), (1.5, 3, -4.5)),
    },
}


def realcam_picture(name: str, seed: int, spp: int, device: str) -> np.ndarray:
    """(H, W, 3), in arbitrary units."""
    meshes = SCENES[name]
    counts = np.cumsum([0] + [len(points) for points, _ in meshes.values()])
    scattering = tuple(np.multiply(EXTINCTION["glass"], ALBEDO))
    materials = {
        "lamp": rc.Material(diffuse=(0.5,) * 3, emission=(RADIANCE,) * 3),
        "ball": rc.Material(
            diffuse=(0,) * 3,
            transmission=1,
            ior=IOR,
            absorption=tuple(np.subtract(EXTINCTION["glass"], scattering)),
            scattering=scattering,
            scattering_anisotropy=ANISOTROPY,
        ),
    }
    scene = rc.Scene.from_arrays(
        np.concatenate([points for points, _ in meshes.values()]),
        np.concatenate([faces + count for (_, faces), count in zip(meshes.values(), counts, strict=False)]),
        triangle_materials=np.repeat(np.arange(len(meshes)), [len(faces) for _, faces in meshes.values()]),
        materials=[materials.get(part, rc.Material(diffuse=(0.5,) * 3)) for part in meshes],
    )
    if name == "fog":
        scene = scene.with_air(extinction_per_m=EXTINCTION["fog"], albedo=ALBEDO, anisotropy=ANISOTROPY)
    settings = {"effects": (), "max_bounces": MAX_BOUNCES[name], "spp": spp, "seed": seed, "device": device}
    return rc.render(scene, camera(), **settings).pixels.astype(float)


def camera() -> rc.Camera:
    """The pinhole of both programs."""
    lens = rc.Lens.load("double-gauss-50mm").focused(5.0)
    film = rc.Film(32, 24, (COLUMNS, ROWS))
    return rc.Camera(lens, film=film, model="pinhole", position=(0, 0.2, 0), look_at=(0, 0, -6), exposure_time_s=1)


def mitsuba_scene(name: str) -> mi.Scene:
    """The same scene. In fog every surface lies in the medium, and so does the camera."""
    import mitsuba_scene as shared

    def rgb(value: tuple[float, ...]) -> dict[str, object]:
        return {"type": "rgb", "value": list(value)}

    medium = mi.load_dict(
        {
            "type": "homogeneous",
            "sigma_t": rgb(tuple(np.array(EXTINCTION[name]) / 10)),  # up to 1
            "scale": 10.0,
            "albedo": rgb(ALBEDO),
            "phase": {"type": "hg", "g": ANISOTROPY},
        }
    )
    fog = {"exterior": medium, "interior": medium} if name == "fog" else {}

    def rectangle(mesh: Mesh, radiance: float) -> dict[str, object]:
        """Quadrilaterals, because Mitsuba's meshes take a medium in their dictionary only."""
        a, b, _, d = mesh[0]
        normal = np.cross(b - a, d - a)
        to_world = np.eye(4)
        to_world[:3, 0], to_world[:3, 1] = (b - a) / 2, (d - a) / 2
        to_world[:3, 2], to_world[:3, 3] = normal / np.linalg.norm(normal), (b + d) / 2
        lamp = {"emitter": {"type": "area", "radiance": rgb((radiance,) * 3)}} if radiance else {}
        return {"type": "rectangle", "to_world": mi.ScalarTransform4f(to_world), "bsdf": shared.TWO_SIDED} | fog | lamp

    def milky_glass(mesh: Mesh) -> mi.Shape:
        with tempfile.TemporaryDirectory() as folder:
            path = str(Path(folder) / "mesh.ply")
            shared.mesh("mesh", *mesh).write_ply(path)
            glass = {"type": "dielectric", "int_ior": IOR, "ext_ior": 1.0}
            ply = {"type": "ply", "filename": path, "face_normals": True}
            return mi.load_dict(ply | {"bsdf": glass, "interior": medium})

    parts = {
        part: milky_glass(mesh) if part == "ball" else rectangle(mesh, RADIANCE if part == "lamp" else 0)
        for part, mesh in SCENES[name].items()
    }
    parts["sensor"] = shared.sensor("perspective", camera()) | ({"medium": medium} if fog else {})
    # One more scattering than bounces, and one more edge to the emitter.
    volpath = {"type": "volpath", "max_depth": MAX_BOUNCES[name] + 2, "rr_depth": 1000}
    return mi.load_dict({"type": "scene", "integrator": volpath} | parts)


def parts_of(picture: np.ndarray) -> np.ndarray:
    """(3, 4, 3): means over parts of the picture."""
    rows, columns = PARTS
    return picture.reshape(rows, ROWS // rows, columns, COLUMNS // columns, 3).mean(axis=(1, 3))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scene", choices=list(SCENES), default="fog")
    parser.add_argument("--spp", type=int, default=4096)
    parser.add_argument("--variant", default="scalar_rgb")
    parser.add_argument("--device", default="cpu")
    arguments = parser.parse_args()
    mi.set_variant(arguments.variant)
    scene, passes = mitsuba_scene(arguments.scene), 8
    spp = max(arguments.spp // passes, 1)
    # Several pictures of each, whose scatter is the noise.
    theirs = np.array([parts_of(np.array(mi.render(scene, spp=spp, seed=k))[..., :3]) for k in range(passes)])
    unit = exposure_of_unit_radiance(arguments.device)
    pictures = [realcam_picture(arguments.scene, k, spp, arguments.device) for k in range(passes)]
    ours = np.array([parts_of(picture / unit) for picture in pictures])

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
