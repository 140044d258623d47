"""Flat test objects."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from realcam import Material, Scene


def stars(places_m: Sequence[tuple[float, float, float]], side_m: Sequence[float] | float, radiance: float) -> Scene:
    """Small luminous squares that face a camera which looks to -z."""
    middles = np.array(places_m, float)
    halves = np.broadcast_to(np.asarray(side_m, float) / 2, len(middles))
    square = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]])
    vertices = (middles[:, None, :] + halves[:, None, None] * square).reshape(-1, 3)
    return Scene.from_arrays(vertices, _faces(len(middles)), materials=[Material(emission=(radiance,) * 3)])


def grid_board(middle_m: tuple[float, float, float], width_m: float, cells: int, radiance: float = 1e4) -> Scene:
    """A luminous white square, divided by black lines into cells x cells cells."""
    half = width_m / 2
    corners = np.array(middle_m) + half * np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]])
    uvs = cells * np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    scene = Scene.from_arrays(corners, _faces(1), uvs=uvs, materials=[Material(diffuse=(0.9,) * 3)])
    return scene.with_texture(0, grid_picture()).with_environment(radiance)


def room(half_m: float, cells: int) -> Scene:
    """The inside of a cube around the origin, its walls squared, in even light."""
    walls, uvs = [], []
    for axis in range(3):
        for side in (-1, 1):
            wall = np.zeros((4, 3))
            wall[:, axis] = side
            wall[:, (axis + 1) % 3] = [-1, 1, 1, -1]
            wall[:, (axis + 2) % 3] = [-1, -1, 1, 1]
            walls.append(half_m * wall)
            uvs.append(cells * np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]))
    material = Material(diffuse=(0.9,) * 3, double_sided=True)
    scene = Scene.from_arrays(np.concatenate(walls), _faces(6), uvs=np.concatenate(uvs), materials=[material])
    scene = scene.with_texture(0, grid_picture())
    return scene.with_point_light((0, 0.1 * half_m, 0), (2000 * half_m**2,) * 3)


def grid_picture(side: int = 128, line: int = 8) -> np.ndarray:
    """One cell: white with half a black line at each edge."""
    picture = np.full((side, side, 3), 235, np.uint8)
    picture[: line // 2] = picture[-line // 2 :] = 20
    picture[:, : line // 2] = picture[:, -line // 2 :] = 20
    return picture


def _faces(count: int) -> list[list[int]]:
    return [[4 * i + a, 4 * i + b, 4 * i + c] for i in range(count) for a, b, c in ((0, 1, 2), (0, 2, 3))]
