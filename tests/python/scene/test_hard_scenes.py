"""Scenes at the ends of the range: near and far, large and small, thin, around the camera, far from the origin.

Every picture is compared with a closed form at the points that the camera's rays meet, in double precision.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
import realcam as rc

from ...measurement import Measurement, hold
from .. import scenes

ROUNDING = 2.0**-24  # of a float32, relative
ALBEDO = 0.5
LAMP = 100.0  # cd
# Distance of a point to a light, its square, two cosines, a weight: each some roundings of lengths that are a few times
# as large as the distance.
CLOSED_FORM = 40 * ROUNDING


def relative(measured: np.ndarray, expected: np.ndarray | float) -> float:
    assert np.isfinite(measured).all()
    assert (np.asarray(expected) > 0).all()
    return float(np.abs(measured / expected - 1).max())


def tilted_axes(normal: tuple[float, float, float]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Unit normal, and right and up of a rectangle with it."""
    n = np.asarray(normal, float) / np.linalg.norm(normal)
    right = np.cross((0.3, 1, 0.2), n)
    right /= np.linalg.norm(right)
    return n, right, np.cross(n, right)


def pixel_means(rays: rc.CameraRays, values: np.ndarray) -> np.ndarray:
    shape = (*scenes.FILM.resolution[::-1], -1)
    weights = rays.weights.astype(np.float64)
    return (weights * values).reshape(shape).sum(axis=2) / weights.reshape(shape).sum(axis=2)


def under_point_light(rays: rc.CameraRays, point: np.ndarray, normal: np.ndarray, light: np.ndarray) -> np.ndarray:
    """Radiance of a grey plane: albedo / pi times I cos / d^2, mean over each pixel."""
    o, d = rays.origins_m, rays.directions.astype(np.float64)
    to_light = light - (o + (((point - o) @ normal) / (d @ normal))[:, None] * d)
    return pixel_means(rays, ALBEDO / math.pi * LAMP * (to_light @ normal) / np.linalg.norm(to_light, axis=1) ** 3)


def grey(middle: np.ndarray, half: float, right: np.ndarray, up: np.ndarray) -> scenes.Quad:
    return scenes.quad(tuple(middle), half, right=tuple(right), up=tuple(up), diffuse=ALBEDO)


def lit(scene: rc.Scene, light: np.ndarray) -> rc.Scene:
    return scene.with_point_light(tuple(light), (LAMP,) * 3)


def seen(scene: rc.Scene, camera: rc.Camera, device: str, spp: int = 16) -> np.ndarray:
    return scenes.radiance(scene, camera, spp=spp, device=device)[..., 0]


@pytest.mark.parametrize(("nearest", "farthest"), [(1e-4, 1e-2), (1e-1, 1e7)])
def test_distance_of_what_is_photographed(nearest: float, farthest: float, device: str, backend: str) -> None:
    """A wall that far in front of the lens, and a light half way to it."""
    lens = rc.Lens.load("double-gauss-50mm").focused(3.0).stopped_down(16)
    front = lens.film_position_mm / 1000
    camera = rc.Camera(lens, film=rc.Film(0.6, 0.4, (24, 16)), exposure_time_s=1)
    rays, worst = camera.generate_rays(spp=16), 0.0
    distances = np.geomspace(nearest, farthest, 1 + round(math.log10(farthest / nearest)))
    for distance in distances:
        # The wall is slanted if there is room in front of the lens.
        normal, right, up = tilted_axes((-0.1, 0.2, 1) if distance > 0.05 else (0, 0, 1))
        middle = np.array([0, 0, -front - distance])
        light = middle + distance * (0.5 * normal + 0.2 * right)
        scene = lit(scenes.scene_of(grey(middle, 1 + distance, right, up)), light)
        worst = max(worst, relative(seen(scene, camera, device), under_point_light(rays, middle, normal, light)))
    what = f"wall {nearest:g} to {farthest:g} m in front of the lens: I cos / d^2"
    tried = f"{len(distances)} distances, 384 pixels each"
    # Coordinates count from the film, 0.1 m behind the lens: next to it, roundings are that much larger.
    limit = CLOSED_FORM * max(1.0, 0.1 / nearest / 4)
    hold(Measurement("Scenes", what, tried, backend, "float32", worst, limit, "relative"))


@pytest.mark.parametrize("normal", [(0.0, 1.0, 0.0), (0.3, 1.0, -0.1)])
def test_ground_of_all_sizes_under_the_camera(normal: tuple[float, float, float], device: str, backend: str) -> None:
    """A plain of up to 1e8 m, two triangles, 1.5 m below: lamp-light, and a sky in which it must not shadow itself."""
    n, right, up = tilted_axes(normal)
    foot = -1.5 * n
    camera = scenes.pinhole(look_at=tuple(foot + 2 * up), up=tuple(n))
    light, rays = foot + 0.3 * right + 2 * up + 2 * n, camera.generate_rays(spp=16)
    expected, worst, shadow = under_point_light(rays, foot, n, light), 0.0, 0.0
    sizes = (1e1, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8)
    for half in sizes:
        ground = scenes.scene_of(grey(foot + 0.137 * right, half, right, up))
        worst = max(worst, relative(seen(lit(ground, light), camera, device), expected))
        shadow = max(shadow, relative(seen(ground.with_environment(1.0), camera, device), ALBEDO))
    slope = "level" if normal[0] == 0 else "sloping"
    tried = f"{len(sizes)} sizes, 384 pixels each"
    what = f"{slope} ground of 1e1 to 1e8 m under the camera"
    # The scene's own doubles round 1e8 m to 1.5e-8 m, 1e-8 of the camera's height.
    hold(Measurement("Scenes", f"{what}: I cos / d^2", tried, backend, "float32", worst, CLOSED_FORM, "relative"))
    # A sky of one radiance has no noise: one ray that meets the ground again is a sixteenth of a pixel.
    hold(Measurement("Scenes", f"{what}: self-shadow", tried, backend, "float32", shadow, CLOSED_FORM, "relative"))


@pytest.mark.parametrize("size", [1e-4, 1e-2, 1.0])
def test_shadow_on_the_largest_ground(size: float, device: str, backend: str) -> None:
    """A card, its own size above a plain of 1e8 m: up to twelve orders of size in one scene. The sun slants."""
    n, right, up = tilted_axes((0.0, 1.0, 0.0))
    distance = 0.2 + 300 * size
    width_mm = 50.4 * 10 * size / (distance - 0.1)  # ten cards wide
    towards = (n + 0.4 * up) / math.sqrt(1.16)
    camera = scenes.pinhole(
        rc.Film(width_mm, width_mm / 1.5, (24, 16)), position=tuple(distance * towards), look_at=(0, 0, 0), up=tuple(up)
    )
    sun = (0.6 * right - n) / math.sqrt(1.36)
    card = scenes.quad(tuple(size * n), size, right=tuple(right), up=tuple(up))
    scene = scenes.scene_of(grey(0.137 * up, 1e8, right, up), card).with_sun(tuple(sun), (math.pi,) * 3)
    rays = camera.generate_rays(spp=256)
    o, d = rays.origins_m, rays.directions.astype(np.float64)

    def on_card(start: np.ndarray, direction: np.ndarray) -> np.ndarray:
        at = start + ((size - start @ n) / (direction @ n))[:, None] * direction
        return (np.abs(at @ right) < size) & (np.abs(at @ up) < size)

    ground = o - ((o @ n) / (d @ n))[:, None] * d
    dark = on_card(o, d) | on_card(ground, np.broadcast_to(-sun, d.shape))
    full = ALBEDO / math.sqrt(1.36)
    expected = pixel_means(rays, np.where(dark, 0.0, full))
    measured = seen(scene, camera, device, spp=256)
    assert (expected == 0).sum() > 5
    assert (expected > 0.99 * full).sum() > 100
    # The two edges across the sun's way move by the offset at which shadow rays start, times the sun's slope, 0.6. The
    # ground's pieces are up to 128 times as large as the distance; with 2.5 times that, for their diagonal and shape:
    # 1.5e-6 * 320 = 4.8e-4 of the distance.
    pixel_m2 = (10 * size) ** 2 / 1.5 * math.sqrt(1.16) / 384
    shift = float(np.abs(measured - expected).sum()) / full * pixel_m2 / (2 * 2 * size) / distance
    what = f"shadow of a {2 * size:g} m card on a ground of 1e8 m: displacement"
    tried = "384 pixels of 256 samples, sun 31 degrees from the zenith"
    hold(Measurement("Scenes", what, tried, backend, "float32", shift, 0.6 * 4.8e-4, "of the distance"))


def strips(height: float) -> tuple[np.ndarray, np.ndarray]:
    """A wall of 3 m by 2.4 m in the plane z = 0, its middle in 200 strips of this height, each of two triangles."""
    y = np.concatenate([[-1.2], (np.arange(201) - 100) * height, [1.2]])
    vertices = np.stack([np.tile([-1.5, 1.5], len(y)), np.repeat(y, 2), np.zeros(2 * len(y))], axis=1)
    a = 2 * np.arange(len(y) - 1)[:, None]
    return vertices, np.concatenate([a + np.array(corners) for corners in ([0, 1, 3], [0, 3, 2])])


def fan(count: int) -> tuple[np.ndarray, np.ndarray]:
    """A disc of radius 1.5 m in the plane z = 0, cut like a cake."""
    turn = 2 * math.pi * np.arange(count) / count
    vertices = np.concatenate([[[0, 0, 0]], 1.5 * np.stack([np.cos(turn), np.sin(turn), 0 * turn], axis=1)])
    i = np.arange(count)
    return vertices, np.stack([0 * i, 1 + i, 1 + (i + 1) % count], axis=1)


SLIVERS = {
    "1e2": strips(3e-2 / 5),
    "1e4": strips(3e-4),
    "1e6": strips(3e-6),
    "1e7": strips(3e-7),
    "fan": fan(40_000),
}


@pytest.mark.parametrize("aspect", SLIVERS)
def test_slivers(aspect: str, device: str, backend: str) -> None:
    """A wall of thin triangles is the wall that it would be of two; some without area are thrown in."""
    vertices, faces = SLIVERS[aspect]
    faces = np.concatenate([faces, faces[:5, [0, 0, 1]], faces[:5, [1, 1, 1]]])
    normal, right, up = tilted_axes((0.1, 0.4, 1))
    middle = np.array([0.03, 0.02, -3.0])
    world = vertices @ np.stack([right, up, normal]) + middle
    wall = rc.Scene.from_arrays(world, faces, materials=[rc.Material(diffuse=(ALBEDO,) * 3)])
    assert "without area" in wall.warnings[0]
    # So near that strips of 3e-7 m, 60 um together, still fill a part of the picture.
    height = min(1.0, 3 * np.ptp(np.unique(vertices[:, 1])[1:-1])) if "fan" not in aspect else 0.5
    camera = scenes.pinhole(rc.Film(24, max(16 * height, 1e-3), (24, 16)), look_at=tuple(middle), up=tuple(up))
    light = middle + 0.9 * normal + 0.4 * right
    expected = under_point_light(camera.generate_rays(spp=16), middle, normal, light)
    worst = relative(seen(lit(wall, light), camera, device), expected)
    shadow = relative(seen(wall.with_environment(1.0), camera, device), ALBEDO)
    name = f"slivers of {aspect} : 1" if "fan" not in aspect else "fan of 4e4 slivers"
    tried = f"{len(faces)} triangles, 384 pixels"
    hold(Measurement("Scenes", f"{name}: I cos / d^2", tried, backend, "float32", worst, CLOSED_FORM, "relative"))
    hold(Measurement("Scenes", f"{name}: self-shadow", tried, backend, "float32", shadow, CLOSED_FORM, "relative"))


def box_of_slivers(size: float, gap: float) -> rc.Scene:
    """A closed black box around the origin. Cuts divide each face, some only about `gap` times the size apart."""
    rng = np.random.default_rng(1)
    cuts = np.concatenate([[-1, 1], rng.uniform(-0.9, 0.9, 8)])
    cuts = np.unique(np.concatenate([cuts, cuts[2:] + gap * rng.uniform(0.5, 2, 8)]))
    n = len(cuts)
    u, v = (c.ravel() for c in np.meshgrid(cuts, cuts, indexing="ij"))
    i, j = (c.ravel() for c in np.meshgrid(np.arange(n - 1), np.arange(n - 1), indexing="ij"))
    a, b, c, d = i * n + j, (i + 1) * n + j, (i + 1) * n + j + 1, i * n + j + 1
    quads = np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
    vertices, faces = [], []
    for axis in range(3):
        for side in (-1.0, 1.0):
            faces.append(quads + len(vertices) * n * n)
            vertices.append(np.roll(np.stack([np.full_like(u, side), u, v], axis=1), axis, axis=1))
    turned = np.concatenate(vertices) @ np.linalg.qr(rng.normal(size=(3, 3)))[0]
    black = rc.Material(diffuse=(0, 0, 0))
    return rc.Scene.from_arrays(size * turned, np.concatenate(faces), materials=[black])


def test_no_light_leaks_between_slivers(device: str, backend: str) -> None:
    """The camera is in a closed box under a bright sky, and its fisheye sees half of the box."""
    lens = rc.Lens.load("fisheye-10mm")
    lit_pixels, samples = 0, 0
    for size in (0.3, 1.0, 1e3, 1e7):
        for gap in (1e-3, 1e-6, 1e-9):
            scene = box_of_slivers(size, gap).with_environment(1e6)
            for look in ((0.1, 0.2, -1), (-0.3, 1, 0.2)):
                position = 0.02 * size * np.array([1.0, 0.5, 0.3])
                film = rc.Film(*lens.film_mm, (96, 64))
                camera = rc.Camera(lens, film=film, position=tuple(position), look_at=tuple(position + look))
                image = rc.render(scene, camera, effects=(), spp=16, max_bounces=0, device=device)
                lit_pixels += int((image.pixels != 0).any(axis=2).sum())
                samples += image.stats.passed_rays
    tried = f"{samples:,} rays in boxes of 0.3 to 1e7 m, cut into slivers of up to 1e9 : 1"
    what = "light through the seams of a closed box of slivers"
    hold(Measurement("Scenes", what, tried, backend, "float32", lit_pixels, 0, "pixels"))
