"""Random scenes and cameras for a recipe."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._core import Camera, Film, InputError, Lens, Material, Scene
from .recipe import MOVES_FOR_S, Recipe

Array = NDArray[np.float64]


@dataclass(frozen=True)
class RandomScene:
    """A scene with its ground truth. categories, middles_m: of the objects, in the order of their ids, from 2.

    board_m: (N, 3), inner corners of the calibration board, row by row; None: no board.
    """

    scene: Scene
    categories: list[str]
    middles_m: Array
    board_m: Array | None


def _shape(category: str) -> tuple[Array, Array]:
    """Vertices and triangles of an object that stands on y = 0 and is 1 m wide and high."""
    if category == "ball":
        across, down = 24, 12
        polar, turn = np.meshgrid(
            np.linspace(0, np.pi, down + 1), np.arange(across) * 2 * np.pi / across, indexing="ij"
        )
        ring = np.sin(polar)
        vertices = 0.5 * np.stack([ring * np.sin(turn), 1 + np.cos(polar), ring * np.cos(turn)], axis=-1).reshape(-1, 3)
        a = (np.arange(down)[:, None] * across + np.arange(across)).ravel()
        b = a - a % across + (a + 1) % across
        return vertices, np.concatenate([np.stack([a, a + across, b + across], 1), np.stack([a, b + across, b], 1)])
    base = np.array([[-0.5, 0, 0.5], [0.5, 0, 0.5], [0.5, 0, -0.5], [-0.5, 0, -0.5]])
    if category == "pyramid":
        return np.vstack([base, [[0, 1, 0]]]), np.array([[i, (i + 1) % 4, 4] for i in range(4)])
    sides = [[i, (i + 1) % 4, 4 + (i + 1) % 4, 4 + i] for i in range(4)]
    quads = np.array([*sides, [4, 5, 6, 7]])
    return np.vstack([base, base + np.array([0, 1, 0])]), np.vstack([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])


@lru_cache(maxsize=64)
def _model(path: str) -> tuple[Scene, Array]:
    """Returns a scene from a file, and the matrix that places it on y = 0 and scales its largest extent to 1 m."""
    scene = Scene.load(path)
    low, high = np.array(scene.bounds_m)
    size = float((high - low).max())
    if not 0 < size < np.inf:
        raise InputError(f"{path}: this model has no size")
    matrix = np.diag([1 / size, 1 / size, 1 / size, 1.0])
    matrix[:3, 3] = -np.array([(low[0] + high[0]) / 2, low[1], (low[2] + high[2]) / 2]) / size
    return scene, matrix


def random_scene(recipe: Recipe, rng: np.random.Generator) -> RandomScene:
    """Returns a scene of objects on a floor under sun and sky."""
    floor = np.array([[-9, 0, 9], [9, 0, 9], [9, 0, -9], [-9, 0, -9]])
    grey = Material(diffuse=tuple(rng.uniform(0.2, 0.6, 3)), name="floor")
    scene = Scene.from_arrays(floor, [[0, 1, 2], [0, 2, 3]], materials=[grey])
    categories: list[str] = []
    middles: list[Array] = []
    sizes = rng.uniform(0.15, 0.5, rng.integers(recipe.objects[0], recipe.objects[1] + 1))
    for i, size in enumerate(sizes):
        position = np.zeros(3)
        for _ in range(100):  # attempts to find free space; if all fail, objects overlap
            position[[0, 2]] = rng.uniform(-0.9, 0.9, 2)
            apart = np.array([np.hypot(*(position - middle)[[0, 2]]) for middle in middles])
            if (apart > 0.75 * (size + sizes[: len(apart)])).all():
                break
        category = recipe.categories[rng.integers(len(recipe.categories))]
        if recipe.models:
            body, own = _model(recipe.models[category])
        else:
            vertices, triangles = _shape(category)
            color = Material(diffuse=tuple(rng.uniform(0.1, 0.9, 3)), name=f"{category} {i}")
            body, own = Scene.from_arrays(vertices, triangles, materials=[color]), np.eye(4)
        name = f"{category} {i}"
        matrix = _standing(position, float(size), rng.uniform(0, 2 * np.pi)) @ own
        scene = scene.with_instance(body, matrix, name=name)
        speed, heading = rng.uniform(*recipe.speed_m_s), rng.uniform(0, 2 * np.pi)
        if speed > 0:
            there = matrix.copy()
            there[[0, 2], 3] += MOVES_FOR_S * speed * np.array([np.cos(heading), np.sin(heading)])
            scene = scene.moved(name, np.stack([matrix, there]), (0.0, MOVES_FOR_S))
        categories.append(category)
        middles.append(position + np.array([0, size / 2, 0]))
    corners = None
    if recipe.board:
        board, inner = _board(recipe.board[0], recipe.board[1], recipe.square_m)
        lean = rng.uniform(-0.6, 0.6, 2)
        matrix = _standing(np.array([rng.uniform(-0.3, 0.3), 0.05, rng.uniform(-0.3, 0.3)]), 1, rng.uniform(0, 6.3))
        c, s = np.cos(lean[0]), np.sin(lean[0])
        matrix = matrix @ np.array([[1, 0, 0, 0], [0, c, -s, 0], [0, s, c, 0], [0, 0, 0, 1]])
        scene = scene.with_instance(board, matrix, name="board")
        corners = inner @ matrix[:3, :3].T + matrix[:3, 3]
    height, turn = rng.uniform(0.3, 1), rng.uniform(0, 2 * np.pi)
    scene = scene.with_environment(tuple(rng.uniform(500, 3000) * np.array([0.8, 0.9, 1])))
    scene = scene.with_sun((np.cos(turn), -height, np.sin(turn)), (60000, 56000, 50000))
    return RandomScene(scene, categories, np.array(middles), corners)


def _standing(position: Array, size: float, turn: float) -> Array:
    c, s = size * np.cos(turn), size * np.sin(turn)
    return np.array([[c, 0, s, position[0]], [0, size, 0, position[1]], [-s, 0, c, position[2]], [0, 0, 0, 1]])


def _board(columns: int, rows: int, square_m: float) -> tuple[Scene, Array]:
    """Returns a chessboard with a white margin, upright on y = 0, and its inner corners, row by row from the upper
    left."""
    material: list[int] = []
    vertices: list[tuple[float, float, float]] = []
    triangles: list[tuple[int, int, int]] = []
    for row in range(-1, rows + 1):
        for column in range(-1, columns + 1):
            inside = 0 <= row < rows and 0 <= column < columns
            material += [1 if inside and (row + column) % 2 == 0 else 0] * 2
            x, y = (column - columns / 2) * square_m, (rows - row) * square_m
            first = len(vertices)
            vertices += [(x, y, 0), (x + square_m, y, 0), (x + square_m, y + square_m, 0), (x, y + square_m, 0)]
            triangles += [(first, first + 1, first + 2), (first, first + 2, first + 3)]
    white, black = (
        Material(diffuse=(v, v, v), double_sided=True, name=n) for v, n in ((0.8, "white"), (0.04, "black"))
    )
    scene = Scene.from_arrays(vertices, triangles, triangle_materials=material, materials=[white, black])
    down, right = np.meshgrid(np.arange(1, rows), np.arange(1, columns), indexing="ij")
    inner = np.stack([(right - columns / 2) * square_m, (rows - down + 1) * square_m, 0.0 * right], axis=-1)
    return scene, inner.reshape(-1, 3)


@lru_cache(maxsize=64)
def _lens(name: str) -> Lens:
    return Lens.load(name)


def _direction(rng: np.random.Generator) -> Array:
    direction: Array = rng.normal(size=3)
    direction /= np.linalg.norm(direction)
    return direction


def _view_from(distance: float, rng: np.random.Generator) -> tuple[Array, Array]:
    """Random camera position at a distance from a random target near the centre of the floor, and the target."""
    turn, rise = rng.uniform(0, 2 * np.pi), rng.uniform(0.15, 0.9)
    away = np.array([np.cos(rise) * np.sin(turn), np.sin(rise), np.cos(rise) * np.cos(turn)])
    target = rng.uniform([-0.2, 0.05, -0.2], [0.2, 0.3, 0.2])
    return target + distance * away, target


def _is_in_a_body(seen: RandomScene, position: Array) -> bool:
    """True if a point lies within 0.05 m of an object's bounding sphere (that of a cube of the object's size)."""
    sizes = 2 * seen.middles_m[:, 1]  # the objects stand on the floor
    return bool((np.linalg.norm(seen.middles_m - position, axis=1) < 0.87 * sizes + 0.05).any())


def random_camera(recipe: Recipe, seen: RandomScene, rng: np.random.Generator) -> Camera:
    """Returns a camera with a random lens, f-number and focus, outside of all objects, looking near the floor's
    centre."""
    from scipy.spatial.transform import Rotation  # slow to load

    lens = _lens(recipe.lenses[rng.integers(len(recipe.lenses))])
    lens = lens.stopped_down(float(lens.f_number * rng.uniform(*recipe.f_stops)))
    film = Film.for_lens(lens, resolution=recipe.size)
    iso = float(np.exp(rng.uniform(*np.log(recipe.iso))))
    camera = Camera(lens, film=film, iso=iso, readout_time_s=recipe.readout_time_s)
    # At this distance about two metres fill the picture's width; a fisheye is closer.
    half_angle = np.radians(min(camera.field_of_view_deg.horizontal, 120) / 2)
    distance = max(0.6, rng.uniform(0.8, 1.3) / np.tan(half_angle))
    position, target = _view_from(distance, rng)
    while _is_in_a_body(seen, position):
        distance *= 1.05
        position, target = _view_from(distance, rng)
    lens = lens.focused(max(1.05 * lens.nearest_focus_m, float(distance * rng.uniform(0.8, 1.2))))
    roll = rng.uniform(-0.2, 0.2)
    up = np.array([np.sin(roll), 1, 0])
    motion: list[Any] = []
    speed_m_s, turn_deg_s = (rng.uniform(*each) for each in (recipe.camera_speed_m_s, recipe.camera_turn_deg_s))
    if speed_m_s > 0 or turn_deg_s > 0:
        way, axis = speed_m_s * _direction(rng), np.radians(turn_deg_s) * _direction(rng)
        turned = Rotation.from_rotvec(MOVES_FOR_S * axis)
        there = position + MOVES_FOR_S * way
        motion = [
            (0.0, tuple(position), tuple(target), tuple(up)),
            (MOVES_FOR_S, tuple(there), tuple(there + turned.apply(target - position)), tuple(turned.apply(up))),
        ]
    return camera.replace(lens=lens, position=tuple(position), look_at=tuple(target), up=tuple(up), motion=motion)
