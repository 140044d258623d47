"""Scene and camera shared by benchmarks that render a frame."""

from __future__ import annotations

import numpy as np
from realcam import Camera, Film, Lens, Material, Scene

Mesh = tuple[np.ndarray, np.ndarray]  # vertices (V, 3), m, and triangles (T, 3)

FRAME_EMITTER_RADIANCE = 2000.0  # cd/m^2, of the area light of frame_scene_arrays


def frame_scene_arrays(spheres: int = 50, boxes: int = 50, rows: int = 32) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Spheres and boxes on a plane under one area light.

    Returns vertices (V, 3), m, triangles (T, 3), and the material of each triangle: 1 for the light, otherwise 0.
    rows: divisions of a sphere from pole to pole.
    """
    random = np.random.default_rng(1)
    meshes = [_quad([(-50, 0, 50), (50, 0, 50), (50, 0, -50), (-50, 0, -50)])]
    for _ in range(spheres):
        x, z = random.uniform(-4, 4, 2)
        meshes.append(_sphere((x, 0.3, z - 4), 0.3, 2 * rows, rows))
    for _ in range(boxes):
        x, z = random.uniform(-4, 4, 2)
        meshes.append(_box((x, 0.25, z - 4), 0.25))
    lamp = _quad([(-2, 6, -6), (2, 6, -6), (2, 6, -2), (-2, 6, -2)])
    meshes.append(lamp)
    vertices, triangles, base = [], [], 0
    for points, faces in meshes:
        vertices.append(points)
        triangles.append(faces + base)
        base += len(points)
    materials = np.zeros(sum(len(faces) for faces in triangles), int)
    materials[-len(lamp[1]) :] = 1
    return np.concatenate(vertices), np.concatenate(triangles), materials


def frame_scene(spheres: int = 50, boxes: int = 50, rows: int = 32, sky: float = 100.0) -> Scene:
    """The scene of frame_scene_arrays under a sky (cd/m^2); with 50 spheres of 32 rows, about 205 000 triangles."""
    vertices, triangles, materials = frame_scene_arrays(spheres, boxes, rows)
    scene = Scene.from_arrays(
        vertices,
        triangles,
        triangle_materials=materials,
        materials=[Material(), Material(emission=3 * (FRAME_EMITTER_RADIANCE,))],
    )
    return scene.with_environment(sky) if sky else scene


def frame_camera(model: str = "full", film: Film | None = None) -> Camera:
    """The camera of the frame benchmarks: the double Gauss, wide open, at 5 m; 640 x 640 pixels if no film is given."""
    lens = Lens.load("double-gauss-50mm").focused(5.0)
    return Camera(lens, film=film or Film(24, 24, (640, 640)), model=model, position=(0, 1.5, 4), look_at=(0, 0.3, -4))


def _quad(corners: list[tuple[float, float, float]]) -> Mesh:
    return np.array(corners, float), np.array([[0, 1, 2], [0, 2, 3]])


def _box(centre: tuple[float, float, float], half: float) -> Mesh:
    corners = np.array([[x, y, z] for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)], float) * half + centre
    quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
    return corners, np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))])


def _sphere(centre: tuple[float, float, float], radius: float, columns: int = 64, rows: int = 32) -> Mesh:
    polar, azimuth = np.meshgrid(np.linspace(0, np.pi, rows + 1), np.linspace(0, 2 * np.pi, columns + 1), indexing="ij")
    points = np.stack([np.sin(polar) * np.cos(azimuth), np.cos(polar), np.sin(polar) * np.sin(azimuth)], axis=-1)
    row, column = np.meshgrid(np.arange(rows), np.arange(columns), indexing="ij")
    a = (row * (columns + 1) + column).ravel()
    b, c, d = a + 1, a + columns + 1, a + columns + 2
    upper, lower = np.stack([a, b, d], 1), np.stack([a, d, c], 1)
    return points.reshape(-1, 3) * radius + centre, np.concatenate([upper[columns:], lower[:-columns]])


def frame_objects(spheres: int) -> Scene:
    """The spheres of frame_scene at the same positions, without a sky, as instances of one mesh."""
    scene = frame_scene(spheres=0, boxes=0, sky=0.0)
    points, faces = _sphere((0, 0, 0), 0.3)
    sphere = Scene.from_arrays(points, faces)
    random = np.random.default_rng(1)
    for i in range(spheres):
        matrix = np.eye(4)
        x, z = random.uniform(-4, 4, 2)
        matrix[:3, 3] = x, 0.3, z - 4
        scene = scene.with_instance(sphere, matrix, name=str(i))
    return scene
