"""The pupil of a lens as a film point sees it, for every focus and f-number: a table of ellipses.

Directions are drawn evenly in an ellipse of direction cosines, whose area is then the weight of each: the irradiance of
a field of radiance 1 is the area of what passes. What the ellipse holds beside that is drawn in vain.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.ndimage import maximum_filter, minimum_filter

from .focus_range import FocusRange
from .pupil_outlines import Doubles, Light, Outlines, outlines, rear_boxes

ROWS, FOCI = 25, 3
STOPS = (1.0, 2**-0.5, 0.5, 0.25, 0.0625)
"""Radii of the stop, over that of the stop that is wide open."""
_QUARTERS = (0.25, 0.5, 0.75)
_REACH = 1.2
"""Film radii go on to so many half diagonals of the film, or to where the light ends."""
_HOLE_MARGIN = 0.02
"""Of a pupil's half axes. Between two stops the blocked part is smaller than their mean, by nearly as much."""
_MARGIN = 1.002
"""For what lies between the places at which the ellipses were tried."""
_SMALL_DRIFT = 0.05
"""Of the pupil's width, from one end of the spectrum to the other: an ellipse for all wavelengths is good enough."""


@dataclass(frozen=True)
class PupilTable:
    reach_mm: float
    """The last row's film radius. Row i of n is at reach (1 - (1 - i / (n - 1))^2): closer and closer to the edge."""
    ellipses: Doubles
    """(foci, stops, rows, 5), to be interpolated linearly, for film points on the +x axis: middle in l, half axes in l
    and m; by which share both grow half-way to the next stop, as 4 t (1 - t) on the way there; and the part of the half
    axes within which nothing passes, because the middle of the lens is blocked."""
    drift: Doubles
    """(foci, rows): how far the middle moves in l for each unit of the colour variable; 0 where that is little."""


def pupil_table(focusing: FocusRange, colours: Mapping[float, float]) -> PupilTable:
    """For light of any of these wavelengths in nm, of which the values are the colour variable."""
    reach_mm = _reach_mm(focusing, colours)
    radii_mm = reach_mm * (1 - (1 - np.linspace(0, 1, 2 * ROWS - 1)) ** 2)
    drift = _drift(focusing, radii_mm[::2], colours)
    drifts = _between(_between(drift, 0), 1)
    # At each stop, for the foci of the table and those half-way; for its foci, in each quarter between the stops.
    at_stops, between = [], []
    cells = range(len(STOPS) - 1)
    for step in range(2 * FOCI - 1):
        parts = (*_QUARTERS, 1.0) if step % 2 == 0 else (1.0,)
        places = [0.0, *(cell + part for cell in cells for part in parts)]
        light = [(wavelength_nm, colour * drifts[step]) for wavelength_nm, colour in colours.items()]
        looks = _looks(focusing, step / (2 * FOCI - 2), places, radii_mm, light)
        at_stops.append([looks[stop] for stop in range(len(STOPS))])
        if step % 2 == 0:
            between.append([[looks[cell + part] for part in _QUARTERS] for cell in cells])
    nodes = _lit_everywhere(np.array([[_ellipses(look) for look in row] for row in at_stops[::2]])[:, :, ::2])
    # By how much each ellipse has to grow to hold what passes at the radii and foci about it.
    outer = _norms_at(at_stops, nodes, lambda look: (look.l, look.m))
    growth = np.fmax(np.fmax.reduce(outer, axis=-1), 1)
    nodes[..., 1:] *= maximum_filter(growth, (3, 1, 3), mode="nearest")[::2, :, ::2, None] * _MARGIN
    inner = np.fmin.reduce(_norms_at(at_stops, nodes, lambda look: (look.inner_l, look.inner_m)), axis=-1)
    hole = minimum_filter(np.nan_to_num(inner, nan=np.inf), 3, mode="nearest")[::2, :, ::2] - _HOLE_MARGIN
    hole = np.where(np.isfinite(hole) & (hole > _HOLE_MARGIN), hole, 0)
    bulge = np.zeros(hole.shape)
    for focus, cell in np.ndindex(FOCI, len(cells)):
        bulge[focus, cell] = _bulge(between[focus][cell], *_between(nodes[focus], 1)[cell : cell + 2])
    return PupilTable(reach_mm, np.concatenate([nodes, bulge[..., None], hole[..., None]], axis=-1), drift)


def _drift(focusing: FocusRange, radii_mm: Doubles, colours: Mapping[float, float]) -> Doubles:
    """(FOCI, R): of the pupil wide open, from the wavelengths at both ends."""
    ends = min(colours), max(colours)
    spread = colours[ends[0]] - colours[ends[1]]
    drift = np.zeros((FOCI, len(radii_mm)))
    if not spread:
        return drift
    widths = []
    for row, focus in zip(drift, np.linspace(0, 1, FOCI), strict=True):
        lens, middles = focusing.lens_at(focus), []
        for wavelength_nm in ends:
            look = outlines(lens, radii_mm, rear_boxes(lens, radii_mm), [(wavelength_nm, 0 * radii_mm)], 3)
            low, high = np.fmin.reduce(look.l, axis=1), np.fmax.reduce(look.l, axis=1)
            middles.append(0.5 * (low + high))
        row[:] = np.nan_to_num((middles[0] - middles[1]) / spread)
        widths.append(np.nan_to_num(high - low, nan=np.inf))
    small: bool = np.abs(spread * drift / widths).max() < _SMALL_DRIFT
    return 0 * drift if small else drift


def _reach_mm(focusing: FocusRange, wavelengths_nm: Iterable[float]) -> float:
    """Where the light ends, at the focus at which it ends last."""
    most = _REACH * 0.5 * float(np.hypot(*focusing.lens.film_mm))
    edge = 0.0
    for focus in (0.0, 1.0):
        lens = focusing.lens_at(focus)
        low, high = 0.0, most
        for _ in range(3):
            radii_mm = np.linspace(low, high, 17)
            light = [(wavelength_nm, 0 * radii_mm) for wavelength_nm in wavelengths_nm]
            lit = outlines(lens, radii_mm, rear_boxes(lens, radii_mm), light, 2).lit
            if lit[-1]:
                break
            at = int(np.flatnonzero(lit).max(initial=0))
            low, high = radii_mm[at], radii_mm[at + 1]
        edge = max(edge, high)
    return edge


def _looks(
    focusing: FocusRange, focus: float, places: Sequence[float], radii_mm: Doubles, light: Light
) -> dict[float, Outlines]:
    """By places between the stops, the widest first: each outline lies within the one before."""
    lens = focusing.lens_at(focus)
    boxes, rounds = rear_boxes(lens, radii_mm), 3
    looks = {}
    for place in places:
        stop = float(np.interp(place, range(len(STOPS)), STOPS))
        closed = lens.with_surface(lens.stop_index, clear_semi_diameter_mm=stop * lens.stop_semi_diameter_mm)
        looks[place] = outlines(closed, radii_mm, boxes, light, rounds)
        boxes, rounds = looks[place].boxes, 1
    return looks


def _ellipses(look: Outlines) -> Doubles:
    """(R, 3): the smallest ellipses with their middle on the l axis that hold the outlines; NaN: dark."""
    low, high, top = (box[:, None] for box in look.boxes.T)
    half = 0.5 * (high - low)
    l = np.nan_to_num((look.l - 0.5 * (low + high)) / half)  # noqa: E741
    m = np.nan_to_num(look.m / top)
    middle, ratio, best = np.zeros(len(l)), np.zeros(len(l)), np.full(len(l), np.inf)
    # The area is convex in the middle and in the logarithm of the ratio of the axes: finer and finer steps find it.
    for scale in 0.6 * 0.4 ** np.arange(6):
        about_middle, about_ratio = middle.copy(), ratio.copy()
        for step_middle, step_ratio in np.ndindex(9, 9):
            c = about_middle + scale * (step_middle / 4 - 1)
            k = about_ratio + scale * (step_ratio / 4 - 1)
            area = ((l - c[:, None]) ** 2 + (np.exp(k)[:, None] * m) ** 2).max(axis=1) / np.exp(k)
            better = area < best
            best, middle, ratio = np.where(better, area, best), np.where(better, c, middle), np.where(better, k, ratio)
    size = np.sqrt(best * np.exp(ratio))
    columns = [0.5 * (low + high)[:, 0] + middle * half[:, 0], size * half[:, 0], size / np.exp(ratio) * top[:, 0]]
    return np.where(look.lit[:, None], np.stack(columns, axis=1), np.nan)


def _lit_everywhere(nodes: Doubles) -> Doubles:
    """Where no light passes, there is the ellipse of a wider stop or of the film point before, to interpolate with."""
    nodes = nodes.copy()
    for axis in (1, 2):
        moved = np.moveaxis(nodes, axis, 0)
        for before, node in pairwise(moved):
            dark = np.isnan(node)
            node[dark] = before[dark]
    return nodes


def _between(nodes: Doubles, axis: int) -> Doubles:
    """The nodes of an axis, and what linear interpolation makes of them half-way."""
    moved = np.moveaxis(nodes, axis, 0)
    result = np.empty((2 * len(moved) - 1, *moved.shape[1:]))
    result[::2] = moved
    result[1::2] = 0.5 * (moved[1:] + moved[:-1])
    return np.moveaxis(result, 0, axis)


def _norms(l: Doubles, m: Doubles, ellipses: Doubles) -> Doubles:  # noqa: E741
    """(R, P): 1 on the edge of the ellipses (R, 3)."""
    return np.hypot((l - ellipses[:, :1]) / ellipses[:, 1:2], m / ellipses[:, 2:3])


def _norms_at(
    looks: Sequence[Sequence[Outlines]], nodes: Doubles, points_of: Callable[[Outlines], tuple[Doubles, Doubles]]
) -> Doubles:
    """(foci, stops, radii, P): the norms of points of each outline in the ellipse that is interpolated for it."""
    tried = _between(_between(nodes, 0), 2)
    return np.array(
        [[_norms(*points_of(look), tried[i, j]) for j, look in enumerate(row)] for i, row in enumerate(looks)]
    )


def _bulge(looks: Sequence[Outlines], wide: Doubles, narrow: Doubles) -> Doubles:
    """(rows,): what the ellipses between two stops lack in the middle. Where rims cut the light off, the pupil follows
    the stop on its way in, and then no longer: it is larger between two stops than their mean."""
    lacking = []
    for part, look in zip(_QUARTERS, looks, strict=True):
        norms = np.fmax.reduce(_norms(look.l, look.m, wide + part * (narrow - wide)), axis=1)
        lacking.append((np.fmax(norms, 1) - 1) / (4 * part * (1 - part)))
    bulges: Doubles = maximum_filter(np.max(lacking, axis=0), 3, mode="nearest")[::2]
    return bulges
