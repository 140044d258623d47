"""Smooth normals of surfaces."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .surface import NORMAL_DELTAS, POINT_DELTAS, Surface, Values, next_corners, sums


def with_smooth_normals(surface: Surface) -> Surface:
    """Returns the surface with the normals of its points, and their changes if the points are displaced."""
    normals = _smooth_normals(surface)
    values = {"normals": Values(normals, "point")}
    if POINT_DELTAS in surface.values:
        rows = surface.values[POINT_DELTAS].rows
        moved = (replace(surface, points=surface.points + rows[:, k : k + 3]) for k in range(0, rows.shape[1], 3))
        values[NORMAL_DELTAS] = Values(
            np.hstack([_smooth_normals(at_sample) - normals for at_sample in moved]), "point"
        )
    return surface.with_values(**values)


def _smooth_normals(surface: Surface) -> NDArray[Any]:
    """Returns the normals of points, (P, 3): the means of the adjacent faces' normals, weighted by area."""
    points = np.asarray(surface.points, np.float64)[surface.corners]
    face_of = np.repeat(np.arange(len(surface.counts)), surface.counts)
    centres = sums(face_of, points, len(surface.counts)) / surface.counts[:, None]
    local = points - centres[face_of]
    areas = sums(face_of, np.cross(local, local[next_corners(surface.counts)]), len(surface.counts))
    normals = sums(surface.corners, areas[face_of], len(surface.points))
    size = np.linalg.norm(normals, axis=-1, keepdims=True)
    return np.asarray(normals / np.where(size > 0, size, 1))
