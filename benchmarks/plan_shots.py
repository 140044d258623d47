"""Drawn shots for the study of the planner: boards with a pattern before a drawn camera."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import realcam as rc

LENSES = (
    "double-gauss-50mm",
    "phone-4mm",
    "fisheye-10mm",
    "singlet-100mm",
    "tessar-50mm",
    "telephoto-250mm",
    "mirror-telephoto-500mm",
    "zoom-70-210mm-at-70mm",
)


@dataclass
class Shot:
    name: str
    scene: rc.Scene
    camera: rc.Camera


def board(middle: tuple[float, float, float], width: float) -> tuple[np.ndarray, np.ndarray]:
    """Vertices and texture coordinates of a square that faces +z."""
    x, y, z = middle
    half = width / 2
    corners = np.array(
        [[x - half, y - half, z], [x + half, y - half, z], [x + half, y + half, z], [x - half, y + half, z]]
    )
    return corners, np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])


def pattern(random: np.random.Generator) -> np.ndarray:
    """Bars, squares and a ramp, of two greys."""
    side = 256
    x, y = np.meshgrid(np.arange(side), np.arange(side))
    cell = int(random.choice([16, 32, 64]))
    picture = np.where((x // cell + y // cell) % 2 == 0, 230, 40).astype(np.uint8)
    picture[: side // 4] = np.linspace(40, 230, side).astype(np.uint8)
    return np.repeat(picture[..., None], 3, axis=2)


def scene_of(boards: list[tuple[np.ndarray, np.ndarray]], random: np.random.Generator) -> rc.Scene:
    vertices, uvs = (np.concatenate([b[i] for b in boards]) for i in (0, 1))
    faces = [[4 * i + a, 4 * i + b, 4 * i + c] for i in range(len(boards)) for a, b, c in ((0, 1, 2), (0, 2, 3))]
    scene = rc.Scene.from_arrays(vertices, faces, uvs=uvs, materials=[rc.Material(diffuse=(0.8, 0.8, 0.8))])
    return scene.with_texture(0, pattern(random))


def drawn_shot(number: int, seed: int) -> Shot:
    random = np.random.default_rng([seed, number])
    kind = ("daylight", "night", "sun", "near", "far", "moving")[number % 6]
    name = LENSES[int(random.integers(len(LENSES)))]
    lens = rc.Lens.load(name)
    first = lens.first_order()
    nearest = 1.5 * max(0.3, 10 * abs(first.effective_focal_length_mm) / 1000)
    distance = {"near": nearest, "far": 100 * nearest}.get(kind, float(nearest * random.uniform(2, 20)))
    focus = distance * float(random.choice([1.0, 1.0, 0.7, 1.5]))
    lens = lens.focused(focus)
    # A mirror telephoto can hardly be stopped down: its middle is dark.
    most = 2 if name.startswith("mirror") else 5
    f_number = first.f_number * float(random.choice([1.0, 1.4, 2.0, 4.0, 8.0][:most]))
    if f_number > first.f_number:
        lens = lens.stopped_down(f_number)
    lens = lens.with_coating(str(random.choice(["bare", "quarter_wave"])))
    width = min(lens.film_mm) * float(random.choice([0.05, 0.3, 1.0]))
    film = rc.Film(width, width * 2 / 3, (240, 160))
    field = width / abs(lens.first_order().effective_focal_length_mm)
    at = [
        board(
            (
                field * distance * float(random.uniform(-0.3, 0.3)) * k,
                field * distance * float(random.uniform(-0.2, 0.2)),
                -distance * k,
            ),
            0.5 * field * distance * k,
        )
        for k in (1.0, 1.6, 3.0)
    ]
    back = 12 * distance
    at.append(board((0, 0, -back), 6 * field * back))
    scene = scene_of(at, random)
    exposure = 1 / 200
    if kind == "night":
        scene = scene.with_environment(0.05)
        for _ in range(3):
            place = (
                field * distance * float(random.uniform(-0.4, 0.4)),
                field * distance * float(random.uniform(-0.25, 0.25)),
                -0.95 * distance,
            )
            candela = (30.0 * distance**2,) * 3
            scene = scene.with_point_light(place, candela)
        exposure = 1 / 15
    else:
        towards = np.array([0.4, -0.6, -0.7])
        if kind == "sun":
            towards = np.array([0.25 * field, -0.2 * field, 1.0])
        towards = towards / np.linalg.norm(towards)
        scene = scene.with_environment(3000.0).with_sun(tuple(towards), (8e4, 8e4, 8e4))
    camera = rc.Camera(lens, film=film, exposure_time_s=exposure)
    if kind == "moving":
        pixels = float(random.choice([0.1, 0.3, 0.8, 3.0]))
        way = pixels * width / 240 / 1000 * distance / (abs(first.effective_focal_length_mm) / 1000)
        there, further = np.eye(4), np.eye(4)
        further[:3, 3] = (way / exposure, 0, 0)
        object_ = scene_of([board((0, 0, -0.9 * distance), 0.3 * field * distance)], random)
        scene = scene.with_instance(object_, name="moving").moved("moving", [there, further], times_s=[0, 1])
    dim = rc.render(scene, camera.replace(model="pinhole"), effects=(), spp=32, device="cpu", max_bounces=0)
    bright = float(np.quantile(dim.pixels.mean(axis=2), 0.9))
    camera = camera.replace(iso=float(np.clip(0.5 / (0.018 * max(bright, 1e-12)), 1e-6, 1e9)))
    return Shot(f"{number} {kind} {name} f/{f_number:.1f} {1000 * width / 240:.1f} um", scene, camera)
