"""Entrance-pupil bounds of scene points: where light must enter the lens to reach the film, for connecting paths."""

from __future__ import annotations

from typing import Any

import drjit as dr
import mitsuba as mi
import numpy as np

from .._core import Camera, Film, Lens
from .tables import Table

ANGLES = 64  # cells over the tangent of half the point's angle to the axis
CLOSENESSES = 16  # cells over the point's inverse distance, its closeness
NEAREST = 1.25  # smallest distance in the table, in radii of the lens's front


class Entries:
    """Table of rectangles that bound the entrance pupil of a scene point.

    A rectangle lies in the plane through the front vertex perpendicular to the line to the point, with sides along and
    across the meridional plane. It holds all rays that pass, found with rays that fill film and pupil, with a margin of
    a sixteenth. Etendue is the same on both sides of the lens, so that samples on this side measure the light on the
    film.
    """

    def __init__(self, lens: Lens, film: Film, wavelengths_nm: tuple[float, float] | None) -> None:
        camera = Camera(lens, film=film.replace(resolution=(64, 64)))
        rays = camera.generate_rays(spp=64, wavelengths_nm=wavelengths_nm)
        passed = rays.weights > 0
        o = 1000 * rays.origins_m[passed] + [0, 0, lens.film_position_mm]  # camera axes and lens axes agree
        d = rays.directions[passed].astype(float)
        self.nearest_mm = NEAREST * float(np.linalg.norm(o, axis=1).max())
        closenesses = np.linspace(0, 1, 2 * CLOSENESSES + 1) / self.nearest_mm
        coordinates = [entry_coordinates(o, d, closeness) for closeness in closenesses]
        self.largest_half_tangent = 1.001 * float(max(half_tangent.max() for half_tangent, _, _ in coordinates))
        rows = [rectangles(coordinates[2 * k : 2 * k + 3], self.largest_half_tangent) for k in range(CLOSENESSES)]
        self.table = Table(np.concatenate(rows))

    def sample(self, x: Any, u: Any) -> tuple[Any, Any]:
        """Samples a point of the rectangle of x, a scene point in mm from the front vertex. Returns it and the solid
        angle of the rectangle seen from x, the inverse of the sampling density; 0 if no light passes."""
        distance = dr.norm(x)
        t = x / distance
        radial = dr.sqrt(t.x * t.x + t.y * t.y)
        half_tangent = radial / dr.maximum(1 - t.z, 1e-6)
        column = half_tangent * (ANGLES / self.largest_half_tangent)
        row = dr.minimum(self.nearest_mm / distance, 1) * CLOSENESSES
        is_covered = (column < ANGLES) & (t.z < 1)
        column = mi.UInt32(dr.minimum(column, ANGLES - 1))
        row = mi.UInt32(dr.minimum(row, CLOSENESSES - 1))
        low, high, half_width = self.table(row * ANGLES + column)
        cos = dr.select(radial > 0, t.x / radial, 1.0)
        sin = dr.select(radial > 0, t.y / radial, 0.0)
        along = low + u.x * (high - low)
        across = half_width * (2 * u.y - 1)
        # Unit vector perpendicular to t in the meridional plane, away from the axis; -t.z is the cosine of the point's
        # angle.
        outwards = mi.Vector3f(-t.z * cos, -t.z * sin, radial)
        point = mi.Point3f(along * outwards + across * mi.Vector3f(-sin, cos, 0))
        connection = point - x
        squared = dr.squared_norm(connection)
        cosine = dr.abs(dr.dot(connection, t)) * dr.rsqrt(squared)
        solid_angle = 2 * half_width * (high - low) * cosine / squared
        return point, dr.select(is_covered, solid_angle, 0.0)


def entry_coordinates(
    o: np.ndarray, d: np.ndarray, closeness_per_mm: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Coordinates of rays for the table at one inverse distance from the front vertex.

    o, d: (N, 3), origins in mm from the front vertex, and unit directions towards the scene. Returns tangents of half
    the angle to the axis of the scene points on the rays, and their intersections with the planes of Entries, along and
    across the meridional plane, mm."""
    if closeness_per_mm > 0:
        b = np.sum(o * d, axis=1)
        s = -b + np.sqrt(b**2 - np.sum(o**2, axis=1) + closeness_per_mm**-2)
        x = o + s[:, None] * d
        t = x * closeness_per_mm
    else:
        t = d
    radial = np.hypot(t[:, 0], t[:, 1])
    cos, sin = np.where(radial > 0, t[:, :2].T / np.maximum(radial, 1e-300), [[1.0], [0.0]])
    entry = o - d * (np.sum(o * t, axis=1) / np.sum(d * t, axis=1))[:, None]
    outwards = np.stack([-t[:, 2] * cos, -t[:, 2] * sin, radial], axis=1)
    across = np.stack([-sin, cos, np.zeros_like(sin)], axis=1)
    return radial / (1 - t[:, 2]), np.sum(entry * outwards, axis=1), np.sum(entry * across, axis=1)


def rectangles(coordinates: list[tuple[np.ndarray, np.ndarray, np.ndarray]], largest_half_tangent: float) -> np.ndarray:
    """(ANGLES, 3): lowest and highest coordinate along and largest across the meridional plane; zeros if no light
    passes. Includes the rectangles of neighbouring cells, to cover gaps between the rays."""
    low, high, half = np.full(ANGLES, np.inf), np.full(ANGLES, -np.inf), np.zeros(ANGLES)
    for half_tangent, along, across in coordinates:
        column = np.minimum((half_tangent * ANGLES / largest_half_tangent).astype(int), ANGLES - 1)
        np.minimum.at(low, column, along)
        np.maximum.at(high, column, along)
        np.maximum.at(half, column, np.abs(across))
    near = np.clip(np.arange(ANGLES)[:, None] + [-1, 0, 1], 0, ANGLES - 1)
    low, high, half = low[near].min(axis=1), high[near].max(axis=1), half[near].max(axis=1)
    margin = np.maximum(high - low, half) / 16
    bounds = np.stack([low - margin, high + margin, half + margin], axis=1)
    return np.where(half[:, None] > 0, bounds, 0.0)
