"""The solid parts of a lens in its meridional plane: faces, elements, stops. Points are (z, y) in mm, lens frame."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .._core import Lens, Surface
from ..short_text import ShortText

Points = NDArray[np.float64]

_HALF_PROFILE = 40  # points from the axis to the rim, denser towards it, where a steep face turns most


@dataclass(frozen=True, repr=False)
class Face(ShortText):
    """A refracting or reflecting face, from its lower rim to its upper one; with a hole, in two parts."""

    surface: int  #: index in Lens.surfaces
    is_mirror: bool
    is_asphere: bool
    radius_sign: int  #: of the radius of curvature: 1 where its centre lies on the film's side, -1, 0 for a plane
    parts: tuple[Points, ...]


@dataclass(frozen=True, repr=False)
class Element(ShortText):
    """One piece of glass between two faces; with a hole, in two parts. Cemented elements share the points of a face."""

    front: int  #: index of the surface that light meets first
    back: int
    polygons: tuple[Points, ...]  #: closed; the first point is not repeated


@dataclass(frozen=True)
class Blocker:
    """What a stop or an aperture keeps from passing, as lines from `inner` to `outer` distances from the axis."""

    surface: int
    is_stop: bool
    z_mm: float
    opening_mm: float  #: semi-diameter that is open
    outer_mm: float  #: to where the line around the opening is drawn
    obstruction_mm: float  #: semi-diameter that is blocked in the middle; 0: none


@dataclass(frozen=True, repr=False)
class Crossing(ShortText):
    """Two faces that reach into each other: nobody can make such a lens."""

    first: int
    second: int
    depth_mm: float
    radius_mm: float  #: from the axis, where they are farthest into each other
    zones: tuple[Points, ...]  #: polygons of the places that both claim, above and below the axis


def is_glass(lens: Lens, surface: int) -> bool:
    """Whether anything but air lies behind a refracting surface."""
    return lens.surfaces[surface].material.index(lens.wavelength_nm) != 1


def faces_of(lens: Lens) -> tuple[Face, ...]:
    """All faces that bend light, in the order of the light."""
    holes = _holes(lens)
    return tuple(
        Face(
            i,
            surface.type == "mirror",
            surface.conic != 0 or any(surface.aspheric_coefficients.values()),
            int(np.sign(surface.curvature_per_mm)),
            _parts(surface, z, holes[i]),
        )
        for i, (surface, z) in enumerate(zip(lens.surfaces, lens.vertices_mm, strict=True))
        if _bends(surface)
    )


def elements_of(lens: Lens) -> tuple[Element, ...]:
    """The pieces of glass. Glass that light passes twice, before and behind a mirror, is one piece."""
    z = lens.vertices_mm
    elements: dict[frozenset[tuple[float, float]], Element] = {}
    for i, j, direction in _glass(lens):
        front, back = lens.surfaces[i], lens.surfaces[j]
        shape = frozenset({(z[i], front.curvature_per_mm), (z[j], back.curvature_per_mm)})
        polygons = _polygons((front, z[i]), (back, z[j]), direction, _hole_between(front, back))
        elements.setdefault(shape, Element(i, j, polygons))
    return tuple(elements.values())


def blockers_of(lens: Lens) -> tuple[Blocker, ...]:
    """Stop and apertures. Lines around an opening end a little beyond the rim of the surface."""
    largest = max(surface.clear_semi_diameter_mm for surface in lens.surfaces)
    holes = _holes(lens)
    found = []
    for i, (surface, z) in enumerate(zip(lens.surfaces, lens.vertices_mm, strict=True)):
        rim = surface.clear_semi_diameter_mm
        is_stop = surface.type == "stop"
        opening = min(lens.stop_semi_diameter_mm, rim) if is_stop else rim
        blocked = surface.inner_semi_diameter_mm
        if not _bends(surface):
            found.append(Blocker(i, is_stop, z, opening, rim + min(0.1 * largest, rim), blocked))
        elif blocked > holes[i]:
            found.append(Blocker(i, False, z, rim, rim, blocked))
    return tuple(found)


def crossings_of(lens: Lens) -> tuple[Crossing, ...]:
    """Faces that cross inside their rims, which only a lens made with allow_crossing has."""
    return tuple(
        Crossing(first, second, depth, radius, _zones(lens, first, second, radius))
        for first, second, depth, radius in lens.crossings()
    )


def _bends(surface: Surface) -> bool:
    return surface.type in ("refracting", "mirror")


def _glass(lens: Lens) -> Iterator[tuple[int, int, int]]:
    """Faces with glass between them, in the order of the light, and the direction of the light along z."""
    bending = [i for i, surface in enumerate(lens.surfaces) if _bends(surface)]
    in_glass, direction = False, 1
    for i, j in itertools.pairwise(bending):
        if lens.surfaces[i].type == "refracting":
            in_glass = is_glass(lens, i)
        else:
            direction = -direction
        if in_glass:
            yield i, j, direction


def _hole_between(front: Surface, back: Surface) -> float:
    """Glass is bored where both its faces are: a face that alone is blocked in the middle has something on it."""
    hole = min(front.inner_semi_diameter_mm, back.inner_semi_diameter_mm)
    return hole if hole < min(front.clear_semi_diameter_mm, back.clear_semi_diameter_mm) else 0.0


def _holes(lens: Lens) -> list[float]:
    """The semi-diameter of the hole in each face."""
    holes = [surface.inner_semi_diameter_mm if surface.type == "mirror" else 0.0 for surface in lens.surfaces]
    for i, j, _ in _glass(lens):
        hole = _hole_between(lens.surfaces[i], lens.surfaces[j])
        holes[i] = holes[j] = hole
    return holes


def _half(surface: Surface, z: float, hole: float) -> Points:
    """The outline from the hole, or the axis, to the upper rim."""
    rim = surface.clear_semi_diameter_mm
    angle = np.linspace(math.asin(min(hole / rim, 1)), 0.5 * math.pi, _HALF_PROFILE + 1)
    y = rim * np.sin(angle)
    y[0], y[-1] = hole, rim
    return np.column_stack([[z + surface.sag_mm(v) for v in y], y])


def _mirrored(points: Points) -> Points:
    return points[::-1] * (1.0, -1.0)


def _parts(surface: Surface, z: float, hole: float) -> tuple[Points, ...]:
    upper = _half(surface, z, hole)
    if hole > 0:
        return _mirrored(upper), upper
    return (np.concatenate([_mirrored(upper)[:-1], upper]),)


def _polygons(
    front: tuple[Surface, float], back: tuple[Surface, float], direction: int, hole: float
) -> tuple[Points, ...]:
    a, b = _half(*front, hole), _half(*back, hole)
    edge = _edge(front, back, direction)
    upper = np.concatenate([a, edge, b[::-1]])
    if hole > 0:
        return upper, _mirrored(upper)
    lower = np.concatenate([b, edge[::-1], a[::-1]])[:-1] * (1.0, -1.0)
    return (np.concatenate([upper, lower[1:]]),)


def _edge(front: tuple[Surface, float], back: tuple[Surface, float], direction: int) -> Points:
    """The corner between the two upper rims, (0 or 1, 2): the smaller face is carried on flat to the larger rim.

    Where the larger face is in the way of that flat, because the smaller one is sunk into the glass, the edge goes
    straight from rim to rim instead.
    """
    is_back = back[0].clear_semi_diameter_mm < front[0].clear_semi_diameter_mm
    (small, z_small), (large, z_large) = (back, front) if is_back else (front, back)
    r, rim = small.clear_semi_diameter_mm, large.clear_semi_diameter_mm
    if r == rim:
        return np.empty((0, 2))
    flat = z_small + small.sag_mm(r)
    ahead = direction if is_back else -direction
    is_free = all(ahead * (flat - z_large - large.sag_mm(y)) > 0 for y in np.linspace(r, rim, 17))
    return np.array([[flat, rim]]) if is_free else np.empty((0, 2))


def _zones(lens: Lens, first: int, second: int, radius: float) -> tuple[Points, ...]:
    a, b = lens.surfaces[first], lens.surfaces[second]
    rims = a.clear_semi_diameter_mm, b.clear_semi_diameter_mm
    reach = max(rims) if radius > min(rims) else min(rims)
    direction = (-1) ** sum(surface.type == "mirror" for surface in lens.surfaces[: first + 1])
    y = np.union1d(np.linspace(0, reach, 401), [radius])
    # Beyond its own rim a face is edged flat.
    z1, z2 = (
        lens.vertices_mm[i] + np.array([s.sag_mm(min(v, s.clear_semi_diameter_mm)) for v in y])
        for i, s in ((first, a), (second, b))
    )
    overlap = direction * (z1 - z2) > 0
    deepest = int(np.searchsorted(y, radius))
    start, end = deepest, deepest
    while start > 0 and overlap[start - 1]:
        start -= 1
    while end + 1 < len(y) and overlap[end + 1]:
        end += 1
    part = slice(start, end + 1)
    upper = np.concatenate([np.column_stack([z1, y])[part], np.column_stack([z2, y])[part][::-1]])
    return upper, _mirrored(upper)
