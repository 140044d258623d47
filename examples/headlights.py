"""The headlights of a car in fog, between posts along a road, through a real lens.

    python examples/headlights.py fog.png --visibility 60

The car is two lamps above the road, of which each shows its glass and sends a cone of light across the view. The posts
stand in the beams, so that their shadows are visible in the air.
"""

from __future__ import annotations

import argparse
import math

import numpy as np
import realcam as rc

Mesh = tuple[np.ndarray, np.ndarray]  # vertices (V, 3), m, and triangles (T, 3)
CAR = (3.8, 0.7, -20.0)  # between the lamps
AHEAD = (-1.0, -0.02, 0.3)  # where the lamps shine
CANDELA = 40_000.0  # of each lamp, on its axis


def _across() -> np.ndarray:
    """Unit vector across the car, horizontal, such that it and the vertical turn to the direction ahead."""
    across = np.cross((0, 1, 0), AHEAD)
    return across / np.linalg.norm(across)


def disc(middle: np.ndarray, radius: float, sides: int = 24) -> Mesh:
    """A disc that faces ahead of the car."""
    angles = np.linspace(0, 2 * math.pi, sides, endpoint=False)
    right, up = _across(), np.array((0.0, 1.0, 0.0))
    rim = middle + radius * (np.cos(angles)[:, None] * right + np.sin(angles)[:, None] * up)
    around = np.arange(sides)
    return np.vstack([middle, rim]), np.stack([np.zeros(sides, int), 1 + around, 1 + (around + 1) % sides], axis=1)


def post(x: float, z: float, height: float = 1.1, radius: float = 0.12, sides: int = 16) -> Mesh:
    """An upright cylinder on the road."""
    angles = np.linspace(0, 2 * math.pi, sides, endpoint=False)
    foot = np.stack([x + radius * np.cos(angles), np.zeros(sides), z + radius * np.sin(angles)], axis=1)
    a, b = np.arange(sides), (np.arange(sides) + 1) % sides
    sheet = np.concatenate([np.stack([a, a + sides, b], axis=1), np.stack([b, a + sides, b + sides], axis=1)])
    fan = sides + 1 + np.arange(sides - 2)
    top = np.stack([np.full(sides - 2, sides), fan + 1, fan], axis=1)
    return np.concatenate([foot, foot + np.array((0, height, 0))]), np.concatenate([sheet, top])


def street() -> rc.Scene:
    """Road, posts and lamps. Materials: 0 asphalt, 1 posts, 2 the lamps' glass."""
    road = np.array([(-30, 0, 5), (30, 0, 5), (30, 0, -90), (-30, 0, -90)], float)
    parts: list[tuple[Mesh, int]] = [((road, np.array([(0, 1, 2), (0, 2, 3)])), 0)]
    parts += [
        (post(x, z), 1) for x, z in ((2.5, -19.6), (1.5, -18.2), (0, -17.6), (-1.8, -18.4), (-2.5, -16), (-4, -15.5))
    ]
    lamps = [CAR + side * _across() for side in (-0.7, 0.7)]
    parts += [(disc(lamp, 0.09), 2) for lamp in lamps]
    firsts = np.cumsum([0, *(len(vertices) for (vertices, _), _ in parts)])
    scene = rc.Scene.from_arrays(
        np.concatenate([vertices for (vertices, _), _ in parts]),
        np.concatenate([faces + first for ((_, faces), _), first in zip(parts, firsts, strict=False)]),
        triangle_materials=np.repeat([material for _, material in parts], [len(faces) for (_, faces), _ in parts]),
        materials=[
            rc.Material(diffuse=(0.12, 0.12, 0.13)),
            rc.Material(diffuse=(0.6, 0.6, 0.58)),
            rc.Material(diffuse=(0, 0, 0), emission=(4000, 3800, 3300)),
        ],
    )
    for lamp in lamps:
        light = tuple(CANDELA * np.array((1.0, 0.95, 0.83)))
        in_front = tuple(lamp + 0.01 * np.array(AHEAD))
        scene = scene.with_spot_light(in_front, AHEAD, light, inner_cone_deg=4, outer_cone_deg=18)
    return scene.with_environment((0.02, 0.03, 0.05))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("output")
    parser.add_argument("--visibility", type=float, default=50.0, metavar="METRES")
    parser.add_argument("--lens", default="double-gauss-50mm")
    parser.add_argument("--width", type=int, default=960, metavar="PIXELS")
    parser.add_argument("--spp", type=int, default=256)
    arguments = parser.parse_args()
    lens = rc.Lens.load(arguments.lens).focused(13.0).wide_open()
    film = rc.Film(36, 24, (arguments.width, arguments.width * 2 // 3))
    view = {"position": (-0.6, 1.3, -5), "look_at": (-0.4, 1.0, -19)}
    camera = rc.Camera(lens, film=film, exposure_time_s=1 / 30, iso=400, **view)
    scene = street().with_air(arguments.visibility, anisotropy=0.7)
    # Paths that pass a lamp closely after some scatterings are rare and bright: the clamp limits what each adds.
    image = rc.render(scene, camera, spp=arguments.spp, effects={"dispersion"}, max_bounces=8, clamp_cd_m2=20)
    image.save(arguments.output)


if __name__ == "__main__":
    main()
