"""Rays with 50 digits, written straight from the textbook: the judge where programs disagree.

No line is shared with realcam or with a peer: intersections are roots of the sag equation, refraction is Snell's law
for unit vectors. A ray crosses a surface where it meets it within the rim and comes from the side from which light
comes; what else its formula has, past the rim or seen from behind, is no part of a lens.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import mpmath as mp
import numpy as np

from .prescription import Prescription, Rays, Row, Traced

DIGITS = 50
SAMPLES = 129  # along a ray within the surface's rim, to find a bracket of each root


def _sag(row: Row, r2, sqrt):
    """Height over the vertex plane, and its derivative by r^2; of floats or of multi-precision numbers."""
    radius, k = row.radius, row.conic
    if math.isinf(radius):
        height = slope = 0 * r2
    else:
        root = sqrt(1 - (1 + k) * r2 / (radius * radius))
        height = r2 / (radius * (1 + root))
        slope = 1 / (2 * radius * root)
    for power, a in row.coefficients.items():
        height += a * r2 ** (power // 2)
        slope += a * (power // 2) * r2 ** (power // 2 - 1)
    return height, slope


@dataclass(frozen=True)
class _Surface:
    row: Row
    exact: Row  # in multi-precision numbers: doubles are taken as the numbers that they are
    lowest: float  # bounds of the sag within the rim
    highest: float


def _surface(row: Row) -> _Surface:
    radii = row.semi_diameter * np.linspace(0, 1, 257)
    heights = [_sag(row, r * r, math.sqrt)[0] for r in radii.tolist()]
    margin = 1e-3 * row.semi_diameter + 0.02 * (max(heights) - min(heights))
    exact = Row(
        type=row.type,
        semi_diameter=mp.mpf(row.semi_diameter),
        radius=row.radius if math.isinf(row.radius) else mp.mpf(row.radius),
        thickness=mp.mpf(row.thickness),
        index=mp.mpf(row.index),
        conic=mp.mpf(row.conic),
        coefficients={power: mp.mpf(a) for power, a in row.coefficients.items()},
        inner_semi_diameter=mp.mpf(row.inner_semi_diameter),
    )
    return _Surface(row, exact, min(heights) - margin, max(heights) + margin)


def _within_rim(surface: _Surface, origin, direction) -> tuple[float, float] | None:
    """The part of the ray that is no further from the axis than the rim, and no further along it than the surface."""
    (ox, oy, oz), (dx, dy, dz) = origin, direction
    limits = sorted((z - oz) / dz for z in (surface.lowest, surface.highest))
    a, b, c = dx * dx + dy * dy, ox * dx + oy * dy, ox * ox + oy * oy - surface.row.semi_diameter**2
    if a > 1e-30:
        if b * b - a * c <= 0:
            return None
        root = math.sqrt(b * b - a * c)
        limits = [max(limits[0], (-b - root) / a), min(limits[1], (-b + root) / a)]
    elif c > 0:
        return None
    return (limits[0], limits[1]) if limits[0] < limits[1] else None


def _roots(surface: _Surface, origin, direction, sense: int) -> list:
    """Parameters at which the ray meets the surface within its rim and crosses it in the sense of the light."""
    (ox, oy, oz), (dx, dy, dz) = ([float(v) for v in u] for u in (origin, direction))
    part = _within_rim(surface, (ox, oy, oz), (dx, dy, dz))
    if part is None:
        return []
    row, rim2 = surface.row, surface.row.semi_diameter**2

    def over_surface(t: float) -> float:
        # A rounding past the rim must not leave the surface.
        r2 = min((ox + t * dx) ** 2 + (oy + t * dy) ** 2, rim2)
        return sense * (oz + t * dz - _sag(row, r2, math.sqrt)[0])

    grid = [part[0] + (part[1] - part[0]) * i / (SAMPLES - 1) for i in range(SAMPLES)]
    values = [over_surface(t) for t in grid]
    roots = []
    for i in range(SAMPLES - 1):
        if not values[i] < 0 <= values[i + 1]:
            continue
        low, high = grid[i], grid[i + 1]
        for _ in range(30):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if over_surface(middle) < 0 else (low, middle)
        t = mp.mpf(0.5 * (low + high))
        for _ in range(12):
            x, y, z = (o + t * d for o, d in zip(origin, direction, strict=True))
            height, slope = _sag(surface.exact, x * x + y * y, mp.sqrt)
            step = (z - height) / (direction[2] - 2 * slope * (x * direction[0] + y * direction[1]))
            t -= step
            if abs(step) < mp.mpf(10) ** (8 - DIGITS):
                break
        else:
            raise ArithmeticError("Newton's method does not converge")
        roots.append(t)
    return roots


def _cross(exact: Row, direction, point, before, after):
    """The unit direction behind the surface, or None for total internal reflection."""
    x, y, _ = point
    _, slope = _sag(exact, x * x + y * y, mp.sqrt)
    gradient = (-2 * slope * x, -2 * slope * y, mp.mpf(1))
    length = mp.sqrt(sum(g * g for g in gradient))
    normal = [g / length for g in gradient]
    cosine = sum(n * d for n, d in zip(normal, direction, strict=True))
    if cosine < 0:
        normal, cosine = [-n for n in normal], -cosine
    if exact.type == "mirror":
        return [d - 2 * cosine * n for d, n in zip(direction, normal, strict=True)]
    ratio = before / after
    radicand = 1 - ratio * ratio * (1 - cosine * cosine)
    if radicand < 0:
        return None
    step = mp.sqrt(radicand) - ratio * cosine
    return [ratio * d + step * n for d, n in zip(direction, normal, strict=True)]


def _trace_one(surfaces: list[_Surface], origin, direction):
    """Point and direction behind the last surface, and optical path; or the surface at which the ray ends."""
    point = [mp.mpf(float(v)) for v in origin]
    direction = [mp.mpf(float(v)) for v in direction]
    length = mp.sqrt(sum(d * d for d in direction))  # a rounding off one
    direction = [d / length for d in direction]
    path, index, sense = mp.mpf(0), mp.mpf(1), 1
    for i, surface in enumerate(surfaces):
        precise = surface.exact
        roots = _roots(surface, point, direction, sense)
        if len(roots) > 1:
            raise ArithmeticError(f"surface {i} is met {len(roots)} times within its rim")
        if not roots:
            return i
        point = [p + roots[0] * d for p, d in zip(point, direction, strict=True)]
        path += index * roots[0]
        if point[0] ** 2 + point[1] ** 2 < precise.inner_semi_diameter**2:
            return i
        if precise.type == "mirror":
            sense = -sense
        direction = _cross(precise, direction, point, index, precise.index)
        if direction is None:
            return i
        index = precise.index
        if i + 1 < len(surfaces):
            point[2] -= precise.thickness
    vertex = sum(surface.exact.thickness for surface in surfaces[:-1])
    return [*point[:2], point[2] + vertex, *direction, path]


def trace(prescription: Prescription, rays: Rays) -> Traced:
    """Rounded to double only at the end. A ray that is not ok is "ended", whatever the cause."""
    out = Traced.none_yet(len(rays), len(prescription.rows))
    with mp.workdps(DIGITS):
        surfaces = [_surface(row) for row in prescription.rows]
        for i, (origin, direction) in enumerate(zip(rays.origins, rays.directions, strict=True)):
            result = _trace_one(surfaces, origin, direction)
            if isinstance(result, int):
                out.fates[i], out.ended_at[i] = "ended", result
                continue
            figures = [float(v) for v in result]
            out.positions[i], out.directions[i], out.optical_paths[i] = figures[:3], figures[3:6], figures[6]
    return out
