"""Outlines of a lens in its meridional plane: faces, elements, stops. Points are (z, y) in mm, lens frame."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from .._core import Lens, Surface
from ..short_text import ShortText
from .cut import Cut, Points

_HALF_PROFILE = 40  # intervals from the axis to the rim, denser towards the rim, where a steep face curves most


@dataclass(frozen=True, repr=False)
class Face(ShortText):
    """Refracting or reflecting face, from lower to upper rim; in two parts if it has a hole."""

    surface: int  #: index in Lens.surfaces
    is_mirror: bool
    is_asphere: bool
    radius_sign: int  #: of the radius of curvature: 1 if its centre lies on the film's side, else -1; 0 for a plane
    parts: tuple[Points, ...]


@dataclass(frozen=True, repr=False)
class Element(ShortText):
    """Glass between two faces; in two parts if it has a hole. Cemented elements share the points of a face."""

    front: int  #: index of the surface that light hits first
    back: int
    polygons: tuple[Points, ...]  #: closed polygons; the first point is not repeated


@dataclass(frozen=True, repr=False)
class Blocker(ShortText):
    """Opaque parts of a stop, an aperture or a face with a central obstruction, as line segments."""

    surface: int
    is_stop: bool
    z_mm: float
    obstruction_mm: float  #: semi-diameter of the central obstruction; 0: no obstruction
    lines: tuple[Points, ...]  #: (2, 2) each: two around the opening, if any, then the obstruction, if any


@dataclass(frozen=True, repr=False)
class Overlap(ShortText):
    """Overlap of two faces, which makes the lens impossible to manufacture."""

    first: int
    second: int
    depth_mm: float
    radius_mm: float  #: distance from the axis of the deepest overlap
    zones: tuple[Points, ...]  #: polygons of the overlap, above and below the axis


def is_glass(lens: Lens, surface: int) -> bool:
    """Returns True if the medium behind a refracting surface is not air."""
    return lens.surfaces[surface].material.index(lens.wavelength_nm) != 1


def faces_of(cut: Cut) -> tuple[Face, ...]:
    """Returns the refracting and reflecting faces, in the order of the light."""
    holes = _holes(cut.lens)
    return tuple(
        Face(
            i,
            surface.type == "mirror",
            surface.conic != 0 or any(surface.aspheric_coefficients.values()),
            int(np.sign(_curvature(cut, i))),
            _parts(cut, i, holes[i]),
        )
        for i, surface in enumerate(cut.lens.surfaces)
        if _bends(surface)
    )


def _curvature(cut: Cut, surface: int) -> float:
    """Returns the curvature at the vertex, in the plane of the drawing."""
    shape = cut.lens.surfaces[surface]
    is_x = cut.axis == 0 and shape.form is not None
    return 1 / shape.radius_of_curvature_x_mm if is_x else shape.curvature_per_mm


def elements_of(cut: Cut) -> tuple[Element, ...]:
    """Returns the glass elements. Glass that light passes twice, before and after a mirror, is one element."""
    lens = cut.lens
    elements: dict[frozenset[tuple[float, float]], Element] = {}
    for i, j, direction in _glass(lens):
        shape = frozenset({(lens.vertices_mm[k], lens.surfaces[k].curvature_per_mm) for k in (i, j)})
        polygons = _polygons(cut, i, j, direction, _hole_between(lens.surfaces[i], lens.surfaces[j]))
        elements.setdefault(shape, Element(i, j, polygons))
    return tuple(elements.values())


def blockers_of(cut: Cut) -> tuple[Blocker, ...]:
    """Returns the stop, apertures and central obstructions.

    Lines around an opening end slightly beyond the rim of the surface.
    """
    lens = cut.lens
    largest = max(surface.clear_semi_diameter_mm for surface in lens.surfaces)
    holes = _holes(lens)
    blockers = []
    for i, (surface, z) in enumerate(zip(lens.surfaces, lens.vertices_mm, strict=True)):
        rim = surface.clear_semi_diameter_mm
        is_stop = surface.type == "stop"
        opening = min(lens.stop_semi_diameter_mm, rim) if is_stop else rim
        blocked = surface.inner_semi_diameter_mm
        if not _bends(surface):
            outer = rim + min(0.1 * largest, rim)
        elif blocked > holes[i]:
            outer = opening = rim
        else:
            continue
        ends = [] if outer == opening else [(-outer, -opening), (opening, outer)]
        if blocked > 0:
            ends.append((-blocked, blocked))
        lines = tuple(cut.placed(i, (0.0, 0.0), pair) for pair in ends)
        blockers.append(Blocker(i, is_stop, z, blocked, lines))
    return tuple(blockers)


def overlaps_of(lens: Lens) -> tuple[Overlap, ...]:
    """Returns the faces that overlap inside their rims, which is possible only with allow_overlap."""
    return tuple(
        Overlap(first, second, depth, radius, _zones(lens, first, second, radius))
        for first, second, depth, radius in lens.overlaps()
    )


def _bends(surface: Surface) -> bool:
    return surface.type in ("refracting", "mirror")


def _glass(lens: Lens) -> Iterator[tuple[int, int, int]]:
    """Yields pairs of faces with glass between them, in the order of the light, and the direction of the light along
    z."""
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
    """Returns the semi-diameter of the hole in an element; 0 if there is none.

    A hole requires an obstruction on both faces; on one face alone it is an opaque spot.
    """
    hole = min(front.inner_semi_diameter_mm, back.inner_semi_diameter_mm)
    return hole if hole < min(front.clear_semi_diameter_mm, back.clear_semi_diameter_mm) else 0.0


def _holes(lens: Lens) -> list[float]:
    """Returns the semi-diameters of the holes in the faces; 0: no hole."""
    holes = [surface.inner_semi_diameter_mm if surface.type == "mirror" else 0.0 for surface in lens.surfaces]
    for i, j, _ in _glass(lens):
        hole = _hole_between(lens.surfaces[i], lens.surfaces[j])
        holes[i] = holes[j] = hole
    return holes


def _half(cut: Cut, surface: int, hole: float, side: int = 1) -> Points:
    """Returns the outline of a face from the hole, or the axis, to the rim. side: 1 for the upper half, -1 for the
    lower."""
    rim = cut.lens.surfaces[surface].clear_semi_diameter_mm
    angle = np.linspace(math.asin(min(hole / rim, 1)), 0.5 * math.pi, _HALF_PROFILE + 1)
    y = rim * np.sin(angle)
    y[0], y[-1] = hole, rim
    return cut.placed(surface, cut.sag(surface, side * y), side * y)


def _parts(cut: Cut, surface: int, hole: float) -> tuple[Points, ...]:
    """Returns the outline of a face, in two parts if it has a hole (semi-diameter `hole`)."""
    lower, upper = _half(cut, surface, hole, -1)[::-1], _half(cut, surface, hole)
    if hole > 0:
        return lower, upper
    return (np.concatenate([lower[:-1], upper]),)


def _polygons(cut: Cut, front: int, back: int, direction: int, hole: float) -> tuple[Points, ...]:
    """Returns the outline of an element between two faces, as Element.polygons. direction: of the light along z."""
    halves = []
    for side in (1, -1):
        a, b = _half(cut, front, hole, side), _half(cut, back, hole, side)
        halves.append((a, _edge(cut, front, back, direction, side), b))
    (a, edge, b), (lower_a, lower_edge, lower_b) = halves
    upper = np.concatenate([a, edge, b[::-1]])
    if hole > 0:
        return upper, np.concatenate([lower_a, lower_edge, lower_b[::-1]])[::-1]
    lower = np.concatenate([lower_b, lower_edge[::-1], lower_a[::-1]])[:-1]
    return (np.concatenate([upper, lower[1:]]),)


def _edge(cut: Cut, front: int, back: int, direction: int, side: int) -> Points:
    """Returns the corner of an element's edge between two rims on one side, (1, 2): the smaller face is extended flat
    to the larger rim.

    Returns (0, 2), for an edge that is straight from rim to rim, if the rims are equal, if the flat would intersect the
    larger face, or if surfaces are tilted or decentred.
    """
    rims = [cut.lens.surfaces[i].clear_semi_diameter_mm for i in (front, back)]
    if rims[0] == rims[1] or not cut.is_in_place:
        return np.empty((0, 2))
    is_back = rims[1] < rims[0]
    small, large = (back, front) if is_back else (front, back)
    r, rim = min(rims), max(rims)
    z = cut.lens.vertices_mm
    flat = z[small] + cut.sag(small, [side * r])[0]
    ahead = direction if is_back else -direction
    beyond = side * np.linspace(r, rim, 17)
    is_free = np.all(ahead * (flat - z[large] - cut.sag(large, beyond)) > 0)
    return np.array([[flat, side * rim]]) if is_free else np.empty((0, 2))


def _zones(lens: Lens, first: int, second: int, radius: float) -> tuple[Points, ...]:
    """Returns the polygons of an overlap, see Overlap. radius: distance from the axis of the deepest overlap, mm."""
    a, b = lens.surfaces[first], lens.surfaces[second]
    rims = a.clear_semi_diameter_mm, b.clear_semi_diameter_mm
    reach = max(rims) if radius > min(rims) else min(rims)
    direction = (-1) ** sum(surface.type == "mirror" for surface in lens.surfaces[: first + 1])
    y = np.union1d(np.linspace(0, reach, 401), [radius])
    # Beyond its rim a face continues flat.
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
    return upper, upper[::-1] * (1.0, -1.0)
