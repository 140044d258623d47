"""Random scenes and cameras for a recipe."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._core import Camera, Film, InputError, Lens, Material, Scene
from ..calibration.camera.making import posed
from ..vision.rig import Rig, RigCamera, pose_of
from .calibrated import calibrated_camera, poses_from_first
from .recipe import MOTION_S, Recipe

Array = NDArray[np.float64]


@dataclass(frozen=True)
class RandomScene:
    """A scene with its ground truth.

    categories, centres_m: categories and centres, (N, 3), of the objects, in the order of their ids, which start at 2.
    board_m: (N, 3), inner corners of the calibration board, row by row; None: no board.
    """

    scene: Scene
    categories: list[str]
    centres_m: Array
    board_m: Array | None


def _shape(category: str) -> tuple[Array, Array]:
    """Returns the vertices and triangles of an object that stands on y = 0 and is 1 m wide and high."""
    if category == "ball":
        columns, rows = 24, 12
        polar, azimuth = np.meshgrid(
            np.linspace(0, np.pi, rows + 1), np.arange(columns) * 2 * np.pi / columns, indexing="ij"
        )
        radius = np.sin(polar)
        vertices = 0.5 * np.stack(
            [radius * np.sin(azimuth), 1 + np.cos(polar), radius * np.cos(azimuth)], axis=-1
        ).reshape(-1, 3)
        a = (np.arange(rows)[:, None] * columns + np.arange(columns)).ravel()
        b = a - a % columns + (a + 1) % columns
        return vertices, np.concatenate([np.stack([a, a + columns, b + columns], 1), np.stack([a, b + columns, b], 1)])
    base = np.array([[-0.5, 0, 0.5], [0.5, 0, 0.5], [0.5, 0, -0.5], [-0.5, 0, -0.5]])
    if category == "pyramid":
        return np.vstack([base, [[0, 1, 0]]]), np.array([[i, (i + 1) % 4, 4] for i in range(4)])
    sides = [[i, (i + 1) % 4, 4 + (i + 1) % 4, 4 + i] for i in range(4)]
    quads = np.array([*sides, [4, 5, 6, 7]])
    return np.vstack([base, base + np.array([0, 1, 0])]), np.vstack([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])


@lru_cache(maxsize=64)
def _model(path: str) -> tuple[Scene, Array]:
    """Returns a scene from a file, and the matrix that places it on y = 0 and scales its largest extent to 1 m.

    Raises InputError for a scene without extent.
    """
    scene = Scene.load(path)
    low, high = np.array(scene.bounds_m)
    size = float((high - low).max())
    if not 0 < size < np.inf:
        raise InputError(f"{path}: the model has no size")
    matrix = np.diag([1 / size, 1 / size, 1 / size, 1.0])
    matrix[:3, 3] = -np.array([(low[0] + high[0]) / 2, low[1], (low[2] + high[2]) / 2]) / size
    return scene, matrix


def random_scene(recipe: Recipe, rng: np.random.Generator) -> RandomScene:
    """Returns a scene of objects on a floor under sun and sky."""
    floor = np.array([[-9, 0, 9], [9, 0, 9], [9, 0, -9], [-9, 0, -9]])
    grey = Material(diffuse=tuple(rng.uniform(0.2, 0.6, 3)), name="floor")
    scene = Scene.from_arrays(floor, [[0, 1, 2], [0, 2, 3]], materials=[grey])
    categories: list[str] = []
    centres: list[Array] = []
    sizes = rng.uniform(0.15, 0.5, rng.integers(recipe.objects[0], recipe.objects[1] + 1))
    for i, size in enumerate(sizes):
        position = np.zeros(3)
        for _ in range(100):  # attempts to find free space; if all fail, objects overlap
            position[[0, 2]] = rng.uniform(-0.9, 0.9, 2)
            distances = np.array([np.hypot(*(position - centre)[[0, 2]]) for centre in centres])
            if (distances > 0.75 * (size + sizes[: len(distances)])).all():
                break
        category = recipe.categories[rng.integers(len(recipe.categories))]
        if recipe.models:
            body, normalisation = _model(recipe.models[category])
        else:
            vertices, triangles = _shape(category)
            color = Material(diffuse=tuple(rng.uniform(0.1, 0.9, 3)), name=f"{category} {i}")
            body, normalisation = Scene.from_arrays(vertices, triangles, materials=[color]), np.eye(4)
        name = f"{category} {i}"
        matrix = _upright(position, float(size), rng.uniform(0, 2 * np.pi)) @ normalisation
        scene = scene.with_instance(body, matrix, name=name)
        speed, heading = rng.uniform(*recipe.speed_m_s), rng.uniform(0, 2 * np.pi)
        if speed > 0:
            end = matrix.copy()
            end[[0, 2], 3] += MOTION_S * speed * np.array([np.cos(heading), np.sin(heading)])
            scene = scene.moved(name, np.stack([matrix, end]), (0.0, MOTION_S))
        categories.append(category)
        centres.append(position + np.array([0, size / 2, 0]))
    corners = None
    if recipe.board:
        board, inner = _board(recipe.board[0], recipe.board[1], recipe.square_m)
        lean = rng.uniform(-0.6, 0.6, 2)
        matrix = _upright(np.array([rng.uniform(-0.3, 0.3), 0.05, rng.uniform(-0.3, 0.3)]), 1, rng.uniform(0, 6.3))
        c, s = np.cos(lean[0]), np.sin(lean[0])
        matrix = matrix @ np.array([[1, 0, 0, 0], [0, c, -s, 0], [0, s, c, 0], [0, 0, 0, 1]])
        scene = scene.with_instance(board, matrix, name="board")
        corners = inner @ matrix[:3, :3].T + matrix[:3, 3]
    height, azimuth = rng.uniform(0.3, 1), rng.uniform(0, 2 * np.pi)
    scene = scene.with_environment(tuple(rng.uniform(500, 3000) * np.array([0.8, 0.9, 1])))
    scene = scene.with_sun((np.cos(azimuth), -height, np.sin(azimuth)), (60000, 56000, 50000))
    return RandomScene(scene, categories, np.array(centres), corners)


def _upright(position: Array, size: float, angle: float) -> Array:
    """Returns the (4, 4) matrix that scales, rotates by an angle in radians about y, and moves to a position."""
    c, s = size * np.cos(angle), size * np.sin(angle)
    return np.array([[c, 0, s, position[0]], [0, size, 0, position[1]], [-s, 0, c, position[2]], [0, 0, 0, 1]])


def _board(columns: int, rows: int, square_m: float) -> tuple[Scene, Array]:
    """Returns a chessboard with a white margin, upright on y = 0, and its inner corners.

    The corners are (N, 3), row by row from the upper left.
    """
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
    """Returns a random unit vector, with a uniform distribution of directions."""
    direction: Array = rng.normal(size=3)
    direction /= np.linalg.norm(direction)
    return direction


def _view_from(distance: float, rng: np.random.Generator) -> tuple[Array, Array]:
    """Returns a random camera position, and its target near the centre of the floor, at a distance in metres."""
    azimuth, elevation = rng.uniform(0, 2 * np.pi), rng.uniform(0.15, 0.9)
    direction = np.array([np.cos(elevation) * np.sin(azimuth), np.sin(elevation), np.cos(elevation) * np.cos(azimuth)])
    target = rng.uniform([-0.2, 0.05, -0.2], [0.2, 0.3, 0.2])
    return target + distance * direction, target


def _is_in_a_body(seen: RandomScene, position: Array, margin_m: float) -> bool:
    """Returns True if a point lies within a margin of an object's bounding sphere, that of a cube of its size."""
    sizes = 2 * seen.centres_m[:, 1]  # the objects stand on the floor
    return bool((np.linalg.norm(seen.centres_m - position, axis=1) < 0.87 * sizes + margin_m).any())


def random_cameras(recipe: Recipe, seen: RandomScene, rng: np.random.Generator) -> dict[str, Camera]:
    """Returns the cameras that take a picture together, by name, with a random lens, f-number and focus.

    The first one is named "" unless it belongs to a rig. It lies outside of all objects and is directed at a point near
    the floor's centre; the others are fixed to it.
    """
    lens = recipe.lenses[rng.integers(len(recipe.lenses))]
    names = list(recipe.calibrations) if recipe.rig else ["", "right"] if recipe.stereo_m else [""]
    unposed = {name: _camera_at_origin(recipe, name, lens) for name in names}
    poses = poses_from_first(recipe.calibrations, unposed[names[0]]) if recipe.rig else {}
    reach_m = max((float(np.linalg.norm(pose[:3, 3])) for pose in poses.values()), default=recipe.stereo_m)
    first = _random_camera(recipe, unposed[names[0]], seen, reach_m, rng)
    if len(names) == 1:
        return {names[0]: first}
    if recipe.rig:
        poses = poses_from_first(recipe.calibrations, first)  # focusing moves the centre of projection
        members = {name: RigCamera(posed(_like(unposed[name], first), poses[name])) for name in names[1:]}
    else:
        x_m = recipe.stereo_m
        right = first.replace(motion=[], position=(x_m, 0, 0), look_at=(x_m, 0, -1), up=(0, 1, 0))
        members = {"right": RigCamera(right)}
    keys = first.motion or [(0.0, first.position, first.look_at, first.up)]
    rig_poses = [
        pose_of(first.replace(motion=[], position=position, look_at=look_at, up=up))
        for _, position, look_at, up in keys
    ]
    times_s = tuple(key[0] for key in first.motion)
    return {names[0]: first, **Rig(members, rig_poses if times_s else rig_poses[0], times_s).cameras}


def _camera_at_origin(recipe: Recipe, name: str, lens: str) -> Camera:
    """Returns a camera of the recipe with a lens, before it is stopped down, focused and posed."""
    if not recipe.calibrations:
        loaded = _lens(lens)
        return Camera(loaded, film=Film.for_lens(loaded, resolution=recipe.picture_size()))
    is_rig = bool(recipe.rig)
    of_file = name if is_rig else recipe.calibration_camera
    size = recipe.picture_size(of_file)
    return calibrated_camera(recipe.rig or recipe.calibration, of_file, is_rig, size, lens, recipe.film_width_mm)


def _like(camera: Camera, first: Camera) -> Camera:
    """Returns the camera with the f-number, or the nearest that its lens has, and the focus and ISO of another one."""
    lens = camera.lens.stopped_down(max(camera.lens.f_number, first.lens.f_number))
    lens = lens.focused(max(1.05 * lens.nearest_focus_m, first.lens.focus_distance_m))
    return camera.replace(lens=lens, iso=first.iso, readout_time_s=first.readout_time_s)


def _random_camera(
    recipe: Recipe, camera: Camera, seen: RandomScene, reach_m: float, rng: np.random.Generator
) -> Camera:
    """Returns the camera with a random f-number, focus and pose. reach_m: distance of the farthest camera beside it."""
    from scipy.spatial.transform import Rotation  # slow to load

    lens = camera.lens.stopped_down(float(camera.lens.f_number * rng.uniform(*recipe.f_stops)))
    iso = float(np.exp(rng.uniform(*np.log(recipe.iso))))
    camera = camera.replace(lens=lens, iso=iso, readout_time_s=recipe.readout_time_s)
    # At this distance the picture's width covers about two metres; a fisheye is closer.
    half_angle = np.radians(min(camera.field_of_view_deg.horizontal, 120) / 2)
    distance = max(0.6, rng.uniform(0.8, 1.3) / np.tan(half_angle))
    position, target = _view_from(distance, rng)
    while _is_in_a_body(seen, position, 0.05 + reach_m):
        distance *= 1.05
        position, target = _view_from(distance, rng)
    lens = lens.focused(max(1.05 * lens.nearest_focus_m, float(distance * rng.uniform(0.8, 1.2))))
    roll = rng.uniform(-0.2, 0.2)
    up = np.array([np.sin(roll), 1, 0])
    motion: list[Any] = []
    speed_m_s, turn_deg_s = (rng.uniform(*each) for each in (recipe.camera_speed_m_s, recipe.camera_turn_deg_s))
    if speed_m_s > 0 or turn_deg_s > 0:
        velocity, angular_velocity = speed_m_s * _direction(rng), np.radians(turn_deg_s) * _direction(rng)
        rotation = Rotation.from_rotvec(MOTION_S * angular_velocity)
        end = position + MOTION_S * velocity
        motion = [
            (0.0, tuple(position), tuple(target), tuple(up)),
            (MOTION_S, tuple(end), tuple(end + rotation.apply(target - position)), tuple(rotation.apply(up))),
        ]
    return camera.replace(lens=lens, position=tuple(position), look_at=tuple(target), up=tuple(up), motion=motion)
