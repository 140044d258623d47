"""Scenes small enough to have closed forms."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import realcam as rc

Quad = tuple[np.ndarray, rc.Material]


def quad(
    middle: Sequence[float],
    half_width: float,
    half_height: float | None = None,
    *,
    right: Sequence[float] = (1, 0, 0),
    up: Sequence[float] = (0, 1, 0),
    emission: float | Sequence[float] = 0.0,
    diffuse: float | Sequence[float] = 0.0,
    specular: float = 0.0,
    shininess: float = 0.0,
) -> Quad:
    """A rectangle whose front is on the side of right x up; by default it faces a camera that looks to -z."""
    half_height = half_width if half_height is None else half_height
    r, u = half_width * np.asarray(right, float), half_height * np.asarray(up, float)
    m = np.asarray(middle, float)
    material = rc.Material(
        diffuse=tuple(np.broadcast_to(np.asarray(diffuse, float), 3)),
        emission=tuple(np.broadcast_to(np.asarray(emission, float), 3)),
        specular=(specular,) * 3,
        shininess=shininess,
    )
    return np.stack([m - r - u, m + r - u, m + r + u, m - r + u]), material


def scene_of(*quads: Quad, shift: Sequence[float] = (0, 0, 0), uvs: bool = False) -> rc.Scene:
    """All rectangles in one scene. uvs: (0, 0) to (1, 1), lower left to upper right corner of each."""
    vertices = np.concatenate([corners for corners, _ in quads]) + np.asarray(shift, float)
    faces = [[4 * i + a, 4 * i + b, 4 * i + c] for i in range(len(quads)) for a, b, c in ((0, 1, 2), (0, 2, 3))]
    return rc.Scene.from_arrays(
        vertices,
        faces,
        uvs=np.tile([[0, 0], [1, 0], [1, 1], [0, 1]], (len(quads), 1)) if uvs else None,
        triangle_materials=np.repeat(np.arange(len(quads)), 2),
        materials=[material for _, material in quads],
    )


def shifted(x: float = 0.0, y: float = 0.0, z: float = 0.0) -> np.ndarray:
    """The transform of an instance that is moved alone."""
    matrix = np.eye(4)
    matrix[:3, 3] = x, y, z
    return matrix


def sky(radiance: float = 1.0) -> rc.Scene:
    """Constant radiance all around; the one triangle, which a scene must have, lies far behind the camera."""
    behind = np.array([[0.0, 0.0, 1e5], [1.0, 0.0, 1e5], [0.0, 1.0, 1e5]])
    return rc.Scene.from_arrays(behind, [[0, 1, 2]]).with_environment(radiance)


def sphere(radius: float, segments: int, material: rc.Material, *, inward: bool) -> rc.Scene:
    """A ball of flat triangles around the origin, emitting inwards or outwards."""
    polar = np.linspace(0, np.pi, segments + 1)
    turn = np.linspace(0, 2 * np.pi, 2 * segments, endpoint=False)
    p, t = np.meshgrid(polar, turn, indexing="ij")
    vertices = radius * np.stack([np.sin(p) * np.sin(t), np.cos(p), np.sin(p) * np.cos(t)], axis=-1).reshape(-1, 3)
    n, faces = 2 * segments, []
    for i in range(segments):
        for j in range(n):
            a, b = i * n + j, i * n + (j + 1) % n
            c, d = a + n, b + n
            if i > 0:
                faces.append((a, d, b))
            if i < segments - 1:
                faces.append((a, c, d))
    order = [0, 2, 1] if inward else [0, 1, 2]
    return rc.Scene.from_arrays(vertices, np.array(faces)[:, order], materials=[material])


FILM = rc.Film(24, 16, (24, 16))


def pinhole(film: rc.Film = FILM, **pose: object) -> rc.Camera:
    """A camera without defocus, so that the exact points that a pixel sees are known."""
    lens = rc.Lens.load("double-gauss-50mm").focused(2.0)
    return rc.Camera(lens, film=film, exposure_time_s=1, model="pinhole", **pose)


def radiance(
    scene: rc.Scene, camera: rc.Camera, spp: int = 16, max_bounces: int = 0, device: str = "auto"
) -> np.ndarray:
    """(H, W, 3): the picture in units of one of radiance 1 everywhere, taken with the same samples."""
    picture = rc.render(scene, camera, effects=(), spp=spp, max_bounces=max_bounces, device=device).pixels.astype(
        np.float64
    )
    return picture / rc.render(sky(), camera, effects=(), spp=spp, device=device).pixels


def points_on_plane(
    camera: rc.Camera, spp: int, point: Sequence[float], normal: Sequence[float]
) -> tuple[np.ndarray, rc.CameraRays]:
    """Points (N, 3) where the camera's rays intersect a plane, and the rays."""
    rays = camera.generate_rays(spp=spp)
    o, d, n = rays.origins_m, rays.directions.astype(np.float64), np.asarray(normal, float)
    distance = ((np.asarray(point, float) - o) @ n) / (d @ n)
    return o + distance[:, None] * d, rays


def mean_over_pixels(rays: rc.CameraRays, values: np.ndarray) -> np.ndarray:
    """(H, W): radiance of each ray, weighted as the exposure weights it; rays come pixel by pixel."""
    shape = (FILM.resolution[1], FILM.resolution[0], -1)
    weights = rays.weights.astype(np.float64)
    return (weights * values).reshape(shape).mean(axis=2) / weights.reshape(shape).mean(axis=2)


def polygon_irradiance(points: np.ndarray, normal: np.ndarray, corners: np.ndarray) -> np.ndarray:
    """Irradiance at points (N, 3) from a polygon of radiance 1 above their horizon (Lambert, 1760)."""
    spokes = corners[None] - points[:, None]
    spokes /= np.linalg.norm(spokes, axis=2, keepdims=True)
    total = np.zeros(len(points))
    for i in range(len(corners)):
        a, b = spokes[:, i], spokes[:, (i + 1) % len(corners)]
        edge = np.cross(a, b)
        angle = np.arccos(np.clip((a * b).sum(axis=1), -1, 1))
        total += 0.5 * angle * (edge @ normal) / np.linalg.norm(edge, axis=1)
    return np.abs(total)
