"""Points of rays on planes and spheres, for which polynomials are fitted."""

from __future__ import annotations

import numpy as np

from .polynomial_fit import Array
from .ray_file import RayPairs

_LEAST_CHIEF_SLOPE = 0.1  # height of the chief ray in the plane behind the lens, per height on the film


def outermost(points: Array) -> float:
    return float(np.hypot(*points.T).max())


def plane_behind(pairs: RayPairs) -> tuple[float, Array]:
    """Returns z of the plane behind the lens and the points of the rays in it, (N, 2): the plane of film_side_mm, or
    one nearer to the film, where the chief ray has crossed the axis."""
    ok = pairs.ok
    radius = np.hypot(*pairs.film_mm.T)
    near = ok & (radius < 0.3 * radius[ok].max())
    near = near if near.any() else ok
    slope = float((pairs.film_mm[near] * pairs.film_side_mm[near]).sum() / (pairs.film_mm[near] ** 2).sum())
    share = (_LEAST_CHIEF_SLOPE - slope) / (1 - slope) if slope < 0.5 * _LEAST_CHIEF_SLOPE else 0.0
    points = pairs.film_side_mm + share * (pairs.film_mm - pairs.film_side_mm)
    return pairs.film_side_z_mm + share * (pairs.film_z_mm - pairs.film_side_z_mm), points


def at_plane(origin: Array, direction: Array, z: float) -> Array:
    crossing: Array = origin + ((z - origin[:, 2]) / direction[:, 2])[:, None] * direction
    return crossing


def largest_distance(origin: Array, direction: Array, z: float) -> float:
    """Returns the largest distance of the rays from the point (0, 0, z)."""
    return float(np.linalg.norm(np.cross(origin - (0, 0, z), direction), axis=1).max())


def at_sphere(origin: Array, direction: Array, z: float, radius: float) -> Array:
    """Returns the points at which rays leave the sphere about (0, 0, z)."""
    offset = origin - (0, 0, z)
    along = (offset * direction).sum(1)
    reach = np.sqrt(radius**2 - (offset**2).sum(1) + along**2)
    leaving: Array = origin + (reach - along)[:, None] * direction
    return leaving


def distances(origin: Array, direction: Array, found: Array, plane_z: float) -> Array:
    """Returns the distances of the fitted positions from the rays, (N,)."""
    at = np.column_stack([found[:, :2], np.where(np.isnan(found[:, 2]), plane_z, found[:, 2])])
    found_distances: Array = np.linalg.norm(np.cross(at - origin, direction), axis=1)
    return found_distances
