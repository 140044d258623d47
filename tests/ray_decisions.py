"""Rays that pass a lens in float32 but not in float64, or the reverse, and their distance from an edge.

An edge is a rim, a hole, the rim of the stop, the critical angle of total internal reflection, or a ray that grazes a
surface. Nearness is relative: 1e-6 is a millionth of the rim's radius, or of the sine of the angle.
"""

from __future__ import annotations

import numpy as np
import realcam as rc

from .float32_error import Rays, exact_rays, passes, pupil_boxes, rounded_rays, sample_boxes

SHARE_LIMIT = 1e-5
EDGE_LIMIT = 1e-4

PAIRS_PER_RADIUS = 100
RAYS_PER_PAIR = 12


def decided_otherwise(lens: rc.Lens, rays: Rays) -> np.ndarray:
    """Mask of the rays that pass in only one of float32 and float64."""
    return passes(rays.trace(lens, "float32")) != passes(rays.trace(lens, "float64"))


def rays_at_edges(lens: rc.Lens, seed: int = 2) -> Rays:
    """Rays on both sides of edges, 1e-8 to 1e-3 away in direction cosines.

    An edge is found by bisection in float64 between two rays of one film point, only one of which passes; so every kind
    of edge that ends rays in this lens occurs.
    """
    random = np.random.default_rng(seed)
    radii, cosines = sample_boxes(pupil_boxes(lens), PAIRS_PER_RADIUS, random)
    passing = passes(exact_rays(lens, radii, cosines).trace(lens, "float64"))
    first, second = [], []
    for radius in np.unique(radii):
        inside, outside = (np.flatnonzero((radii == radius) & (passing == side)) for side in (True, False))
        pairs = min(len(inside), len(outside))
        first.append(inside[:pairs])
        second.append(outside[:pairs])
    a, b = np.concatenate(first), np.concatenate(second)
    radii, low, high = radii[a], cosines[a], cosines[b]
    for _ in range(30):
        middle = 0.5 * (low + high)
        inside = passes(exact_rays(lens, radii, middle).trace(lens, "float64"))[:, None]
        low, high = np.where(inside, middle, low), np.where(inside, high, middle)

    count = len(radii) * RAYS_PER_PAIR
    across = cosines[b] - cosines[a]
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    offset = random.choice([-1, 1], count) * 10 ** random.uniform(-8, -3, count)
    near = np.repeat(low, RAYS_PER_PAIR, axis=0) + offset[:, None] * np.repeat(across, RAYS_PER_PAIR, axis=0)
    rays = exact_rays(lens, np.repeat(radii, RAYS_PER_PAIR), near)
    return rounded_rays(rays, random.uniform(0, 2 * np.pi, count))


def distance_to_edge(lens: rc.Lens, rays: Rays) -> np.ndarray:
    """For rays on which float32 and float64 disagree: relative distance from the edge at which one ends the ray."""
    single, double = rays.trace(lens, "float32"), rays.trace(lens, "float64")
    status = np.where(passes(double), single.status, double.status)
    ended = np.where(passes(double), single.surface_index, double.surface_index)
    distance = np.full(len(status), np.inf)
    for index in np.unique(ended):
        at_rim = (ended == index) & (status == int(rc.RayStatus.VIGNETTED))
        distance[at_rim] = _distance_to_rim(lens, rays[at_rim], index)
        for dtype, passed in (("float64", passes(double)), ("float32", passes(single))):
            grazing = (ended == index) & (status != int(rc.RayStatus.VIGNETTED)) & passed
            distance[grazing] = _distance_to_grazing(lens, rays[grazing], index, dtype)
    return distance


def _distance_to_rim(lens: rc.Lens, rays: Rays, index: int) -> np.ndarray:
    surface = lens.surfaces[index]
    rim = lens.stop_semi_diameter_mm if index == lens.stop_index else surface.clear_semi_diameter_mm
    hole = surface.inner_semi_diameter_mm
    met = rays.trace(lens, "float64", surface_count=len(lens.surfaces) - index).origins_mm
    radius = np.hypot(met[:, 0], met[:, 1])
    to_rim = np.abs(radius / rim - 1)
    return np.minimum(to_rim, np.abs(radius / hole - 1)) if hole else to_rim


def _distance_to_grazing(lens: rc.Lens, rays: Rays, index: int, dtype: str) -> np.ndarray:
    """1 less the sine of the angle that the ray makes with the normal, before or behind the surface. The normal is
    along the change of the optical direction, which is a unit vector times the index."""
    crossed = len(lens.surfaces) - 1 - index
    before = rays.trace(lens, dtype, surface_count=crossed).directions if crossed else rays.directions
    behind = rays.trace(lens, dtype, surface_count=crossed + 1).directions
    index_front, index_rear = _indices(lens)[index]
    normal = index_front * behind - index_rear * before
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    squared_cosine = np.minimum(
        *(((d * normal).sum(axis=1) / np.linalg.norm(d, axis=1)) ** 2 for d in (before, behind))
    )
    return squared_cosine / (1 + np.sqrt(1 - squared_cosine))


def _indices(lens: rc.Lens) -> list[tuple[float, float]]:
    """Refractive index in front of and behind each surface."""
    medium, pairs = 1.0, []
    for surface in lens.surfaces:
        front = medium
        if surface.type == "refracting":
            medium = surface.material.index(lens.wavelength_nm)
        pairs.append((front, medium))
    return pairs
