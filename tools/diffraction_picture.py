"""Renders the picture of docs/diffraction.md: three lamps in front of a board at f/16, without and with diffraction."""

from __future__ import annotations

import sys
from pathlib import Path

import matplotlib.image
import numpy as np
import realcam as rc

SIDE = 420  # of each picture, pixels


def quad(centre: tuple[float, float, float], half_width: float, half_height: float) -> np.ndarray:
    """(4, 3): corners of a rectangle that faces +z, metres."""
    x, y, z = centre
    return np.array(
        [[x + i * half_width, y + j * half_height, z] for i, j in ((-1, -1), (1, -1), (1, 1), (-1, 1))], float
    )


def night() -> rc.Scene:
    """A dim checkerboard and three small lamps of different colours in front of it."""
    board = np.indices((64, 64)).sum(axis=0) % 2 * 180 + 40
    texture = np.repeat(board[:, :, None], 4, axis=2).astype(np.uint8)
    texture[:, :, 3] = 255
    lamps = [((-0.9, 0.5, -4.9), (1.0, 0.8, 0.5)), ((0.0, -0.35, -4.9), (0.6, 0.8, 1.0)), ((0.9, 0.6, -4.9), (1, 1, 1))]
    corners = [quad((0, 0, -5), 1.6, 1.6)] + [quad(centre, 0.004, 0.004) for centre, _ in lamps]
    faces = [[4 * i + a, 4 * i + b, 4 * i + c] for i in range(len(corners)) for a, b, c in ((0, 1, 2), (0, 2, 3))]
    scene = rc.Scene.from_arrays(
        np.concatenate(corners),
        faces,
        uvs=np.tile([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]], (len(corners), 1)),
        triangle_materials=np.repeat(np.arange(len(corners)), 2),
        materials=[rc.Material(diffuse=(0.5, 0.5, 0.5))]
        + [rc.Material(emission=tuple(3e6 * np.array(color))) for _, color in lamps],
    )
    return scene.with_texture(0, texture).with_environment(12.0)


def save_picture(path: Path) -> None:
    """Writes both pictures side by side."""
    lens = rc.Lens.load("double-gauss-50mm").with_iris(blades=6, rotation_deg=8).stopped_down(16).focused(5.0)
    camera = rc.Camera(lens, film=rc.Film(24, 24, (SIDE, SIDE)), exposure_time_s=1.0, iso=400)
    pictures = [
        rc.render(night(), camera, spp=1024, max_bounces=0, effects=effects).developed()
        for effects in ((), ("diffraction",))
    ]
    gap = np.full((SIDE, 6, 3), 255, np.uint8)
    matplotlib.image.imsave(path, np.concatenate([pictures[0], gap, pictures[1]], axis=1))


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: python tools/diffraction_picture.py PICTURE")
    save_picture(Path(sys.argv[1]))
