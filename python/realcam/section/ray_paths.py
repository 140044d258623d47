"""Paths of rays through a lens, with their points on all surfaces, for drawings."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .._core import Lens, RayStatus
from ..fields import Field, FieldPosition, field_arguments
from ..short_text import ShortText
from .cut import Cut, on_film

Array = NDArray[np.float64]

_FAN = np.linspace(-1, 1, 401)  # points of the stop, in units of its radius, at which rays are aimed


@dataclass(frozen=True, repr=False)
class RayBundle(ShortText):
    """Rays of one field point and one wavelength, in the meridional plane. Lens frame."""

    field: Field
    wavelength_nm: float
    paths_mm: Array  #: (rays, surfaces + 2, 3): points before the lens, on each surface, on the film
    directions_at_film: Array  #: (rays, 3), unit


def bundles_from_object(
    cut: Cut,
    fields: Sequence[Field],
    wavelengths_nm: Sequence[float],
    count: int,
    reach_mm: float,
    object_distance_m: float | None = None,
) -> tuple[RayBundle, ...]:
    """Returns bundles from object points, `count` rays each, uniformly distributed over the rays that pass the lens.

    Paths begin on a plane perpendicular to the bundle, reach_mm in front of the first surface, or at the object if it
    is closer. object_distance_m: from the object plane to the front vertex; None: the plane in focus. Raises
    InputError.
    """
    lens, bundles = cut.lens, []
    for wavelength in wavelengths_nm:
        aimed = [_aimed(cut, field, wavelength, count, object_distance_m) for field in fields]
        for field, (origins, directions) in zip(fields, aimed, strict=True):
            points, out = _points(lens, origins, directions, wavelength, "scene")
            start = _start(lens, points[:, 0], directions, reach_mm, object_distance_m)
            film = on_film(cut, points[:, -1], out)
            paths = np.concatenate([start[:, None], points, film[:, None]], axis=1)
            bundles.append(RayBundle(field, wavelength, paths, out))
    return tuple(bundles)


def bundles_from_film(
    lens: Lens, fields: Sequence[Field], wavelengths_nm: Sequence[float], count: int, reach_mm: float
) -> tuple[RayBundle, ...]:
    """Returns bundles of rays traced backwards from film points, `count` rays each. Paths begin reach_mm in front of
    the lens."""
    bundles = []
    for wavelength in wavelengths_nm:
        for field in fields:
            angles = _passing_angles(lens, field.film_height_mm, wavelength)
            chosen = angles[_drawn_indices(len(angles), count)]
            origins, directions = _film_rays(lens, field.film_height_mm, chosen)
            points, out = _points(lens, origins, directions, wavelength, "film")
            start = points[:, -1] + reach_mm * out
            paths = np.concatenate([origins[:, None], points, start[:, None]], axis=1)[:, ::-1]
            bundles.append(RayBundle(field, wavelength, np.ascontiguousarray(paths), -directions))
    return tuple(bundles)


def _drawn_indices(passing_count: int, count: int) -> NDArray[np.intp]:
    """Returns the indices of `count` rays out of those that pass: uniformly from first to last, or the middle one for a
    count of 1."""
    if passing_count == 0:
        return np.empty(0, np.intp)
    if count == 1:
        return np.array([passing_count // 2])
    return np.unique(np.linspace(0, passing_count - 1, count).round().astype(np.intp))


def _aimed(
    cut: Cut, field: Field, wavelength_nm: float, count: int, object_distance_m: float | None
) -> tuple[Array, Array]:
    """Returns origins and directions (rays, 3) of rays of an object point in front of the lens, in the cut's plane."""
    pupil = np.zeros((len(_FAN), 2))
    pupil[:, cut.axis] = _FAN
    position: FieldPosition = field.angle_deg
    if not cut.lens.is_rotational or cut.axis == 0:
        position = (field.film_height_mm, 0.0) if cut.axis == 0 else (0.0, field.film_height_mm)
    field_keywords = field_arguments(position)
    rays = cut.lens.aim(pupil, object_distance_m=object_distance_m, wavelength_nm=wavelength_nm, **field_keywords)
    passing = np.flatnonzero(rays.status == RayStatus.OK)
    chosen = passing[_drawn_indices(len(passing), count)]
    return rays.origins_mm[chosen], rays.directions[chosen]


def _points(lens: Lens, origins: Array, directions: Array, wavelength_nm: float, start: str) -> tuple[Array, Array]:
    """Returns the points of rays on each surface, (rays, surfaces, 3), and their directions after the last one."""
    points, out = [], directions
    for surfaces in range(1, len(lens.surfaces) + 1):
        traced = lens.trace(origins, directions, start=start, surface_count=surfaces, wavelength_nm=wavelength_nm)
        points.append(traced.origins_mm)
        out = traced.directions
    return np.stack(points, axis=1), out


def _start(lens: Lens, first: Array, directions: Array, reach_mm: float, object_distance_m: float | None) -> Array:
    """Returns the start points of the paths, on the rays in front of the first surface. first: points on that
    surface."""
    if not len(first):
        return first
    axis = directions[len(directions) // 2]  # of the bundle
    along = first @ axis
    plane = np.min(along) - reach_mm
    start: Array = first - ((along - plane) / (directions @ axis))[:, None] * directions
    distance = object_distance_m
    if distance is None:
        distance = lens.focus_distance_m - lens.film_position_mm / 1000
    object_z = -1000 * distance
    if math.isfinite(distance):
        object_points = first + ((object_z - first[:, 2]) / directions[:, 2])[:, None] * directions
        if np.any((object_points - start) @ axis > 0):
            start = object_points
    return start


def _film_rays(lens: Lens, height_mm: float, angle: Array) -> tuple[Array, Array]:
    """Returns origins and directions of rays from a film point, at angles (rad) to the axis in the yz plane."""
    zero = np.zeros_like(angle)
    origins = np.column_stack([zero, zero + height_mm, zero + lens.film_position_mm])
    return origins, np.column_stack([zero, np.sin(angle), -np.cos(angle)])


def _passing_angles(lens: Lens, height_mm: float, wavelength_nm: float) -> Array:
    """Returns the angles, rad, in the meridional plane at which rays from a film point pass the lens."""
    count = 2001
    last = lens.surfaces[-1].clear_semi_diameter_mm
    ends = np.arctan2(np.array([-last, last]) * 1.05 - height_mm, lens.film_distance_mm)
    angle = np.linspace(ends[0], ends[1], count)
    # A small stop may lie between two of these rays: the angles are refined between the two that enclose its centre,
    # until enough rays pass.
    for _ in range(4):
        out = lens.trace(*_film_rays(lens, height_mm, angle), start="film", wavelength_nm=wavelength_nm)
        passing: Array = angle[out.status == RayStatus.OK]
        if len(passing) > count // 20:
            break
        bracket = passing if len(passing) else _angles_around_stop_centre(lens, height_mm, angle, wavelength_nm)
        if not len(bracket):
            break
        step = angle[1] - angle[0]
        angle = np.linspace(bracket[0] - step, bracket[-1] + step, count)
    return passing


def _angles_around_stop_centre(lens: Lens, height_mm: float, angle: Array, wavelength_nm: float) -> Array:
    """Returns the angles of the two neighbouring rays that enclose the stop's centre; empty if there are none."""
    behind = len(lens.surfaces) - lens.stop_index
    origins, directions = _film_rays(lens, height_mm, angle)
    out = lens.trace(origins, directions, start="film", surface_count=behind, wavelength_nm=wavelength_nm)
    at_stop = (out.surface_index == lens.stop_index) & (out.status != RayStatus.MISSED)
    y = np.where(at_stop, out.origins_mm[:, 1], np.nan)
    crossing = np.flatnonzero(y[:-1] * y[1:] <= 0)[:1]
    return np.concatenate([angle[crossing], angle[crossing + 1]])
