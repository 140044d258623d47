"""Renders the picture of docs/motion.md: a rotating and a passing board, without and with motion blur, and with a
rolling shutter."""

from __future__ import annotations

import sys
from pathlib import Path

import matplotlib.image
import numpy as np
import realcam as rc

SIDE = 320  # of each picture, pixels
EXPOSURE_S, READOUT_S = 1 / 125, 1 / 40


def board(half_width: float, half_height: float, cells: tuple[int, int]) -> rc.Scene:
    """A rectangle of light and dark squares in the plane z = 0, centred at the origin. cells: squares across and
    down."""
    corners = [[i * half_width, j * half_height, 0.0] for i, j in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    squares = np.indices(cells[::-1]).sum(axis=0) % 2 * 190 + 40
    texture = np.kron(squares, np.ones((16, 16)))[:, :, None].repeat(3, axis=2).astype(np.uint8)
    scene = rc.Scene.from_arrays(
        np.array(corners),
        [[0, 1, 2], [0, 2, 3]],
        uvs=np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]),
        materials=[rc.Material(diffuse=(0.8, 0.8, 0.8))],
    )
    return scene.with_texture(0, texture)


def transform(x: float, y: float, z: float, rotation_deg: float = 0.0) -> np.ndarray:
    """(4, 4): rotation about z and translation."""
    c, s = np.cos(np.radians(rotation_deg)), np.sin(np.radians(rotation_deg))
    matrix = np.eye(4)
    matrix[:2, :2] = [[c, -s], [s, c]]
    matrix[:3, 3] = x, y, z
    return matrix


def street() -> rc.Scene:
    """A board that rotates six times a second, and a post that passes at 12 m/s, in front of a wall."""
    scene = rc.Scene.from_arrays(
        np.array([[-9.0, -9.0, -12.0], [9.0, -9.0, -12.0], [9.0, 9.0, -12.0], [-9.0, 9.0, -12.0]]),
        [[0, 1, 2], [0, 2, 3]],
        materials=[rc.Material(diffuse=(0.25, 0.3, 0.35))],
    )
    times = np.linspace(0, 0.04, 9)
    scene = scene.with_instance(board(0.9, 0.12, (12, 2)), name="propeller")
    scene = scene.moved("propeller", [transform(-0.9, 0.0, -6, 360 * 6 * t) for t in times], times_s=times)
    scene = scene.with_instance(board(0.15, 1.6, (2, 22)), name="post")
    return scene.moved("post", [transform(0.8 + 12 * (t - 0.02), 0.0, -6) for t in times], times_s=times)


def save_picture(path: Path) -> None:
    """Writes the three pictures side by side."""
    lens = rc.Lens.load("double-gauss-50mm").focused(6.0).stopped_down(5.6)
    camera = rc.Camera(lens, film=rc.Film(32, 32, (SIDE, SIDE)), exposure_time_s=EXPOSURE_S)
    camera = camera.replace(shutter_opens_s=0.004, readout_time_s=READOUT_S)
    scene = street().with_environment(900.0).with_sun((0.3, -0.4, -0.85), (9e3, 9e3, 9e3))
    pictures = [
        rc.render(scene, camera, spp=256, max_bounces=1, effects=effects).developed()
        for effects in (("-motion_blur", "-rolling_shutter"), ("-rolling_shutter",), ())
    ]
    gap = np.full((SIDE, 6, 3), 255, np.uint8)
    matplotlib.image.imsave(path, np.concatenate([pictures[0], gap, pictures[1], gap, pictures[2]], axis=1))


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: python tools/motion_picture.py PICTURE")
    save_picture(Path(sys.argv[1]))
