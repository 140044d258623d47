"""Random shots for the study of the planner: patterned boards in front of a random camera."""

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
    "zoom-70-210mm",
)
KINDS = ("daylight", "night", "sun", "near", "landscape", "moving", "verge", "verge", "single")
# Effects whose size is set close to their threshold in shots of the kind "verge".
VERGE_EFFECTS = ("defocus", "aberrations", "distortion", "dispersion", "diffraction")
SIZE = (240, 160)  # pixels


@dataclass
class Shot:
    """A scene and a camera, with a name for tables."""

    name: str
    scene: rc.Scene
    camera: rc.Camera


def board(centre: tuple[float, float, float], width: float, patterns: float) -> tuple[np.ndarray, np.ndarray]:
    """Vertices (4, 3), metres, and texture coordinates (4, 2) of a square that faces +z.

    patterns: number of repetitions of the texture across the square.
    """
    x, y, z = centre
    half = width / 2
    corners = np.array(
        [[x - half, y - half, z], [x + half, y - half, z], [x + half, y + half, z], [x - half, y + half, z]]
    )
    return corners, patterns * np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])


def pattern(random: np.random.Generator) -> np.ndarray:
    """(256, 256, 3) uint8: a checkerboard of two greys with a random cell size, and a ramp between them."""
    side = 256
    x, y = np.meshgrid(np.arange(side), np.arange(side))
    cell = int(random.choice([16, 32]))
    picture = np.where((x // cell + y // cell) % 2 == 0, 230, 40).astype(np.uint8)
    picture[: side // 8] = np.linspace(40, 230, side).astype(np.uint8)
    return np.repeat(picture[..., None], 3, axis=2)


def scene_of(boards: list[tuple[np.ndarray, np.ndarray]], random: np.random.Generator) -> rc.Scene:
    """Scene of boards from board(), with a random pattern as their texture."""
    vertices, uvs = (np.concatenate([b[i] for b in boards]) for i in (0, 1))
    faces = [[4 * i + a, 4 * i + b, 4 * i + c] for i in range(len(boards)) for a, b, c in ((0, 1, 2), (0, 2, 3))]
    scene = rc.Scene.from_arrays(vertices, faces, uvs=uvs, materials=[rc.Material(diffuse=(0.8, 0.8, 0.8))])
    return scene.with_texture(0, pattern(random))


def random_lens(kind: str, random: np.random.Generator) -> tuple[rc.Lens, float]:
    """Returns a random lens with random focus, f-number and coatings, and the distance of the subject, m."""
    name = LENSES[int(random.integers(len(LENSES)))]
    lens = rc.Lens.load(name)
    first = lens.first_order()
    nearest = 1.5 * max(0.3, 10 * abs(first.effective_focal_length_mm) / 1000)
    distance = {"near": nearest, "landscape": 100 * nearest}.get(kind, float(nearest * random.uniform(2, 20)))
    lens = lens.focused(distance * (1.0 if kind == "landscape" else float(random.choice([1.0, 1.0, 0.7, 1.5]))))
    # A mirror telephoto can hardly be stopped down, because its central obstruction would block the light.
    choices = 2 if name.startswith("mirror") else 5
    f_number = first.f_number * float(random.choice([1.0, 1.4, 2.0, 4.0, 8.0][:choices]))
    if f_number > first.f_number:
        lens = lens.stopped_down(f_number)
    return lens.with_coating(str(random.choice(["bare", "quarter_wave"]))), distance


def random_scene(
    kind: str, field: float, distance: float, random: np.random.Generator
) -> tuple[rc.Scene, float, list[tuple[np.ndarray, np.ndarray]]]:
    """Returns a random scene, its exposure time, s, and the boards of a moving object, if there is one.

    field: width of the field of view over the distance. distance: of the subject, m.
    """
    boards = []
    for k in (1.0, 1.6, 3.0):
        across, down = (field * distance * float(random.uniform(-side, side)) * k for side in (0.3, 0.2))
        boards.append(board((across, down, -distance * k), 0.5 * field * distance * k, 1))
    back = 12 * distance
    boards.append(board((0, 0, -back), 6 * field * back, 12))
    scene = scene_of(boards, random)
    if kind == "night":
        scene = scene.with_environment(0.05)
        for _ in range(3):
            across, down = (field * distance * float(random.uniform(-side, side)) for side in (0.4, 0.25))
            scene = scene.with_point_light((across, down, -0.95 * distance), (30.0 * distance**2,) * 3)
        return scene, 1 / 15, []
    towards = np.array([0.25 * field, -0.2 * field, 1.0] if kind == "sun" else [0.4, -0.6, -0.7])
    towards = towards / np.linalg.norm(towards)
    scene = scene.with_environment(3000.0).with_sun(tuple(towards), (8e4, 8e4, 8e4))
    return scene, 1 / 200, [board((0, 0, -0.9 * distance), 0.3 * field * distance, 1)]


def with_moving_object(scene: rc.Scene, moving: rc.Scene, speed_m_s: float) -> rc.Scene:
    """Adds an object that moves along +x."""
    start, end = np.eye(4), np.eye(4)
    end[:3, 3] = (speed_m_s, 0, 0)
    return scene.with_instance(moving, name="moving").moved("moving", [start, end], times_s=[0, 1])


def exposed(scene: rc.Scene, camera: rc.Camera) -> rc.Camera:
    """Sets the ISO so that the 90th percentile of the picture's brightness is half of white."""
    direct = rc.render(scene, camera.replace(model="pinhole"), effects=(), spp=32, device="cpu", max_bounces=0)
    bright = float(np.quantile(direct.pixels.mean(axis=2), 0.9))
    return camera.replace(iso=float(np.clip(0.5 / (0.018 * max(bright, 1e-12)), 1e-6, 1e9)))


def composed(
    kind: str, lens: rc.Lens, distance: float, width_mm: float, seeds: list[int]
) -> tuple[rc.Scene, rc.Camera]:
    """Returns the shot for a film of this width; the boards' sizes follow from its field of view."""
    random = np.random.default_rng(seeds)
    focal_length_mm = abs(lens.first_order().effective_focal_length_mm)
    field = width_mm / focal_length_mm
    scene, exposure_s, moving = random_scene(kind, field, distance, random)
    if kind == "moving":
        pixels = float(random.choice([0.1, 0.3, 0.8, 3.0]))
        path_m = pixels * width_mm / SIZE[0] * distance / focal_length_mm
        scene = with_moving_object(scene, scene_of(moving, random), path_m / exposure_s)
    film = rc.Film(width_mm, width_mm * SIZE[1] / SIZE[0], SIZE)
    return scene, exposed(scene, rc.Camera(lens, film=film, exposure_time_s=exposure_s))


def decisions_by_effect(scene: rc.Scene, camera: rc.Camera) -> dict[str, rc.Decision]:
    """The planner's decisions."""
    return {decision.effect: decision for decision in rc.plan(scene, camera, device="cpu").decisions}


def shot_of(kind: str, number: int, seeds: list[int]) -> Shot:
    """Returns a random shot of a kind.

    In the kind "verge", the film's width is such that the planner estimates one effect at 0.8 or 1.25 times its
    threshold.
    """
    random = np.random.default_rng(seeds)
    lens, distance = random_lens(kind, random)
    widest = min(lens.film_mm)
    width_mm = widest * float(random.choice([0.05, 0.3, 1.0]))
    scene, camera = composed(kind, lens, distance, width_mm, [*seeds, 1])
    if kind == "verge":
        effect, ratio = str(random.choice(VERGE_EFFECTS)), float(random.choice([0.8, 1.25]))
        for _ in range(3):
            decision = decisions_by_effect(scene, camera)[effect]
            if decision.unit != "px" or not 0 < decision.size < np.inf:
                break
            width_mm = float(np.clip(width_mm * decision.size / (ratio * decision.threshold), widest / 50, widest))
            scene, camera = composed(kind, lens, distance, width_mm, [*seeds, 1])
        kind = f"verge of {effect}"
    f_number = lens.first_order().f_number
    return Shot(f"{number} {kind} {lens.name} f/{f_number:.1f} {1000 * width_mm / SIZE[0]:.1f} um", scene, camera)


def random_shot(number: int, seed: int) -> Shot:
    """Returns shot `number` of a series; the kinds alternate.

    The kind "single" is the first of up to 40 shots for which the planner keeps exactly one effect.
    """
    kind = KINDS[number % len(KINDS)]
    shot = shot_of(kind, number, [seed, number])
    for further in range(1, 40):
        if kind != "single":
            break
        needed = [d for d in decisions_by_effect(shot.scene, shot.camera).values() if d.size >= d.threshold]
        if len(needed) == 1:
            return Shot(shot.name.replace("single", f"{needed[0].effect} alone"), shot.scene, shot.camera)
        shot = shot_of(kind, number, [seed, number, further])
    return shot
