"""Meshes of simple shapes: metres, y up, counter-clockwise seen from outside."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np


@dataclass(frozen=True)
class Mesh:
    positions: np.ndarray  # (V, 3)
    normals: np.ndarray  # (V, 3), unit
    triangles: np.ndarray  # (T, 3)
    uvs: np.ndarray | None = None  # (V, 2), v downwards as in glTF

    def moved(self, x: float, y: float, z: float) -> Mesh:
        return replace(self, positions=self.positions + np.array([x, y, z]))

    def turned(self, axis: str, angle_deg: float) -> Mesh:
        """About an axis through the origin."""
        c, s = np.cos(np.radians(angle_deg)), np.sin(np.radians(angle_deg))
        i = "xyz".index(axis)
        j, k = (i + 1) % 3, (i + 2) % 3
        rotation = np.eye(3)
        rotation[j, j] = rotation[k, k] = c
        rotation[j, k], rotation[k, j] = -s, s
        return replace(self, positions=self.positions @ rotation.T, normals=self.normals @ rotation.T)


def joined(*meshes: Mesh) -> Mesh:
    """One mesh of several; texture coordinates stay only if all have them."""
    starts = np.cumsum([0, *(len(m.positions) for m in meshes[:-1])])
    uvs = [m.uvs for m in meshes if m.uvs is not None]
    return Mesh(
        np.concatenate([m.positions for m in meshes]),
        np.concatenate([m.normals for m in meshes]),
        np.concatenate([m.triangles + start for m, start in zip(meshes, starts, strict=True)]),
        np.concatenate(uvs) if len(uvs) == len(meshes) else None,
    )


def quad(corner: list[float], along_u: list[float], along_v: list[float], repeat: tuple[float, float] = (1, 1)) -> Mesh:
    """A rectangle that faces along_u x along_v; the picture's left and lower edge are at `corner`."""
    p, u, v = (np.array(a, dtype=float) for a in (corner, along_u, along_v))
    normal = np.cross(u, v) / np.linalg.norm(np.cross(u, v))
    uvs = np.array([[0, 0], [1, 0], [1, 1], [0, 1]]) * np.array(repeat)
    return Mesh(
        np.array([p, p + u, p + u + v, p + v]),
        np.tile(normal, (4, 1)),
        np.array([[0, 1, 2], [0, 2, 3]]),
        np.column_stack([uvs[:, 0], repeat[1] - uvs[:, 1]]),
    )


def box(width: float, height: float, depth: float) -> Mesh:
    """Stands on y = 0, its middle above the origin; the whole picture on each side."""
    w, h, d = width / 2, height, depth / 2
    sides = [
        quad([-w, 0, d], [width, 0, 0], [0, h, 0]),
        quad([w, 0, -d], [-width, 0, 0], [0, h, 0]),
        quad([w, 0, d], [0, 0, -depth], [0, h, 0]),
        quad([-w, 0, -d], [0, 0, depth], [0, h, 0]),
        quad([-w, h, d], [width, 0, 0], [0, 0, -depth]),
        quad([-w, 0, -d], [width, 0, 0], [0, 0, depth]),
    ]
    return joined(*sides)


def smooth_profile(points: list[tuple[float, float] | None], steps: int = 5) -> list[np.ndarray]:
    """Catmull and Rom's curves through (radius, height) points; None is a sharp edge."""
    curves: list[list[tuple[float, float]]] = [[]]
    for point in points:
        if point is None:
            curves.append([curves[-1][-1]])
        else:
            curves[-1].append(point)
    result = []
    for curve in (c for c in curves if len(c) > 1):
        p = np.array(curve)
        if len(p) == 2:
            result.append(p)
            continue
        q = np.concatenate([[2 * p[0] - p[1]], p, [2 * p[-1] - p[-2]]])
        t = np.linspace(0, 1, steps, endpoint=False)[:, None]
        pieces = [
            0.5
            * (
                2 * q[i]
                + (q[i + 1] - q[i - 1]) * t
                + (2 * q[i - 1] - 5 * q[i] + 4 * q[i + 1] - q[i + 2]) * t**2
                + (3 * q[i] - q[i - 1] - 3 * q[i + 1] + q[i + 2]) * t**3
            )
            for i in range(1, len(q) - 2)
        ]
        smooth = np.concatenate([*pieces, p[-1:]])
        smooth[:, 0] = np.maximum(smooth[:, 0], 0)
        result.append(smooth)
    return result


def lathe(points: list[tuple[float, float] | None], segments: int = 48, steps: int = 5) -> Mesh:
    """A profile turned about the y axis, listed from below upwards along its outside."""
    angles = np.linspace(0, 2 * np.pi, segments + 1)
    circle = np.column_stack([np.cos(angles), np.sin(angles)])
    parts = []
    for curve in smooth_profile(points, steps):
        tangent = np.gradient(curve, axis=0)
        tangent /= np.linalg.norm(tangent, axis=1, keepdims=True) + 1e-30
        rings = len(curve)
        radius, height = np.repeat(curve[:, 0], segments + 1), np.repeat(curve[:, 1], segments + 1)
        out, up = np.repeat(tangent[:, 1], segments + 1), np.repeat(-tangent[:, 0], segments + 1)
        cs = np.tile(circle, (rings, 1))
        i, j = np.meshgrid(np.arange(rings - 1), np.arange(segments), indexing="ij")
        a = (i * (segments + 1) + j).reshape(-1)
        b, c, d = a + 1, a + segments + 1, a + segments + 2
        triangles = np.concatenate([np.column_stack([a, c, b]), np.column_stack([b, c, d])])
        positions = np.column_stack([radius * cs[:, 0], height, radius * cs[:, 1]])
        edge = positions[triangles]
        area = np.linalg.norm(np.cross(edge[:, 1] - edge[:, 0], edge[:, 2] - edge[:, 0]), axis=1)
        parts.append(Mesh(positions, np.column_stack([out * cs[:, 0], up, out * cs[:, 1]]), triangles[area > 1e-11]))
    return joined(*parts)


def ball(radius: float, segments: int = 36) -> Mesh:
    """Its middle is the origin."""
    angles = np.linspace(-np.pi / 2, np.pi / 2, segments // 2 + 1)
    return lathe([(max(radius * float(np.cos(a)), 0.0), radius * float(np.sin(a))) for a in angles], segments, 1)


def disc(radius: float, segments: int = 16) -> Mesh:
    """Faces +z, its middle is the origin."""
    angles = np.linspace(0, 2 * np.pi, segments, endpoint=False)
    ring = np.column_stack([radius * np.cos(angles), radius * np.sin(angles), np.zeros(segments)])
    i = np.arange(1, segments - 1)
    return Mesh(ring, np.tile([0.0, 0.0, 1.0], (segments, 1)), np.column_stack([np.zeros_like(i), i, i + 1]))


def rod(start: np.ndarray, end: np.ndarray, radius: float) -> Mesh:
    """Four-sided, without ends: a cable."""
    along = (end - start) / np.linalg.norm(end - start)
    side = np.cross(along, [0.0, 1.0, 0.0])
    side /= np.linalg.norm(side)
    up = np.cross(side, along)
    ways = [side, up, -side, -up]
    positions = np.array([p + radius * w for p in (start, end) for w in ways])
    triangles = [[i, (i + 1) % 4, 4 + i] for i in range(4)] + [[(i + 1) % 4, 4 + (i + 1) % 4, 4 + i] for i in range(4)]
    return Mesh(positions, np.array(ways * 2), np.array(triangles)[:, ::-1])
