"""Table of ellipses that bound the exit pupil as seen from film points, for every focus and f-number.

Directions are sampled uniformly in an ellipse of direction cosines, whose area is the weight of each sample: the
irradiance under unit radiance is the area of the directions that pass. Samples of the ellipse that are blocked are
wasted.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.ndimage import maximum_filter, minimum_filter

from .focus_range import FocusRange
from .pupil_outlines import Doubles, Light, Outlines, outlines, rear_boxes

ROWS, FOCI = 25, 3  # film radii and focus settings of the table
STOPS = (1.0, 2**-0.5, 0.5, 0.25, 0.0625)
"""Stop radii of the table, relative to the fully open stop."""
_QUARTERS = (0.25, 0.5, 0.75)  # positions between two stops at which the interpolated ellipses are tested
_REACH = 1.2
"""Largest film radius of the table in half diagonals of the film, unless the image circle ends before."""
_HOLE_MARGIN = 0.02
"""Margin of the central obstruction, relative to the half axes. Between two stops of the table the obstruction is
smaller than the interpolated one, by nearly as much."""
_MARGIN = 1.002
"""Factor of the half axes that covers points between those at which the ellipses are tested."""
_SMALL_DRIFT = 0.05
"""Chromatic shift over the whole spectrum, relative to the pupil's width, below which one ellipse serves all
wavelengths."""


@dataclass(frozen=True)
class PupilTable:
    """Pupil ellipses by focus, stop and film radius."""

    reach_mm: float
    """Film radius of the last row. Row i of n is at reach (1 - (1 - i / (n - 1))^2), which is denser towards the
    edge."""
    ellipses: Doubles
    """(foci, stops, rows, 5), interpolated linearly, for film points on the +x axis: centre in l; half axes in l and m;
    relative growth of both half-way to the next stop, which follows 4 t (1 - t) in between; and central obstruction as
    a fraction of the half axes, 0 if there is none."""
    drift: Doubles
    """(foci, rows): shift of the centre in l per unit of the colour variable; 0 if it is small everywhere."""


def pupil_table(focusing: FocusRange, colours: Mapping[float, float]) -> PupilTable:
    """Computes the table. colours: colour variable by wavelength in nm; the ellipses hold the light of all of them."""
    reach_mm = _reach_mm(focusing, colours)
    radii_mm = reach_mm * (1 - (1 - np.linspace(0, 1, 2 * ROWS - 1)) ** 2)
    drift = _drift(focusing, radii_mm[::2], colours)
    drifts = _between(_between(drift, 0), 1)
    # Outlines at each stop, for the foci of the table and those half-way; for the foci of the table also at each
    # quarter between the stops.
    at_stops, between = [], []
    cells = range(len(STOPS) - 1)
    for step in range(2 * FOCI - 1):
        parts = (*_QUARTERS, 1.0) if step % 2 == 0 else (1.0,)
        positions = [0.0, *(cell + part for cell in cells for part in parts)]
        light = [(wavelength_nm, colour * drifts[step]) for wavelength_nm, colour in colours.items()]
        outlines_at = _outlines_by_stop(focusing, step / (2 * FOCI - 2), positions, radii_mm, light)
        at_stops.append([outlines_at[stop] for stop in range(len(STOPS))])
        if step % 2 == 0:
            between.append([[outlines_at[cell + part] for part in _QUARTERS] for cell in cells])
    nodes = _without_gaps(np.array([[_ellipses(outline) for outline in row] for row in at_stops[::2]])[:, :, ::2])
    # Growth of each ellipse that is needed to hold all light at neighbouring radii and foci.
    outer = _norms_at(at_stops, nodes, lambda outline: (outline.l, outline.m))
    growth = np.fmax(np.fmax.reduce(outer, axis=-1), 1)
    nodes[..., 1:] *= maximum_filter(growth, (3, 1, 3), mode="nearest")[::2, :, ::2, None] * _MARGIN
    inner = np.fmin.reduce(_norms_at(at_stops, nodes, lambda outline: (outline.inner_l, outline.inner_m)), axis=-1)
    hole = minimum_filter(np.nan_to_num(inner, nan=np.inf), 3, mode="nearest")[::2, :, ::2] - _HOLE_MARGIN
    hole = np.where(np.isfinite(hole) & (hole > _HOLE_MARGIN), hole, 0)
    bulge = np.zeros(hole.shape)
    for focus, cell in np.ndindex(FOCI, len(cells)):
        bulge[focus, cell] = _bulge(between[focus][cell], *_between(nodes[focus], 1)[cell : cell + 2])
    return PupilTable(reach_mm, np.concatenate([nodes, bulge[..., None], hole[..., None]], axis=-1), drift)


def _drift(focusing: FocusRange, radii_mm: Doubles, colours: Mapping[float, float]) -> Doubles:
    """(FOCI, R): chromatic shift of the fully open pupil, from the shortest and the longest wavelength."""
    ends = min(colours), max(colours)
    spread = colours[ends[0]] - colours[ends[1]]
    drift = np.zeros((FOCI, len(radii_mm)))
    if not spread:
        return drift
    widths = []
    for row, focus in zip(drift, np.linspace(0, 1, FOCI), strict=True):
        lens, middles = focusing.lens_at(focus), []
        for wavelength_nm in ends:
            outline = outlines(lens, radii_mm, rear_boxes(lens, radii_mm), [(wavelength_nm, 0 * radii_mm)], 3)
            low, high = np.fmin.reduce(outline.l, axis=1), np.fmax.reduce(outline.l, axis=1)
            middles.append(0.5 * (low + high))
        row[:] = np.nan_to_num((middles[0] - middles[1]) / spread)
        widths.append(np.nan_to_num(high - low, nan=np.inf))
    small: bool = np.abs(spread * drift / widths).max() < _SMALL_DRIFT
    return 0 * drift if small else drift


def _reach_mm(focusing: FocusRange, wavelengths_nm: Iterable[float]) -> float:
    """Radius of the image circle at the focus, infinity or nearest, at which it is larger; at most _REACH half
    diagonals."""
    largest = _REACH * 0.5 * float(np.hypot(*focusing.lens.film_mm))
    edge = 0.0
    for focus in (0.0, 1.0):
        lens = focusing.lens_at(focus)
        low, high = 0.0, largest
        for _ in range(3):
            radii_mm = np.linspace(low, high, 17)
            light = [(wavelength_nm, 0 * radii_mm) for wavelength_nm in wavelengths_nm]
            lit = outlines(lens, radii_mm, rear_boxes(lens, radii_mm), light, 2).lit
            if lit[-1]:
                break
            last = int(np.flatnonzero(lit).max(initial=0))
            low, high = radii_mm[last], radii_mm[last + 1]
        edge = max(edge, high)
    return edge


def _outlines_by_stop(
    focusing: FocusRange, focus: float, positions: Sequence[float], radii_mm: Doubles, light: Light
) -> dict[float, Outlines]:
    """Outlines by position in the list of stops (fractional between them), widest first: each lies within the
    previous."""
    lens = focusing.lens_at(focus)
    boxes, rounds = rear_boxes(lens, radii_mm), 3
    outlines_at = {}
    for position in positions:
        stop = float(np.interp(position, range(len(STOPS)), STOPS))
        closed = lens.with_surface(lens.stop_index, clear_semi_diameter_mm=stop * lens.stop_semi_diameter_mm)
        outlines_at[position] = outlines(closed, radii_mm, boxes, light, rounds)
        boxes, rounds = outlines_at[position].boxes, 1
    return outlines_at


def _ellipses(outline: Outlines) -> Doubles:
    """(R, 3): centre in l and half axes in l and m of the smallest ellipses that enclose the outlines; NaN: no
    light."""
    low, high, top = (box[:, None] for box in outline.boxes.T)
    half = 0.5 * (high - low)
    l = np.nan_to_num((outline.l - 0.5 * (low + high)) / half)  # noqa: E741
    m = np.nan_to_num(outline.m / top)
    middle, ratio, best = np.zeros(len(l)), np.zeros(len(l)), np.full(len(l), np.inf)
    # The area is convex in the centre and in the logarithm of the axes' ratio, so a search with ever finer steps
    # converges.
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
    return np.where(outline.lit[:, None], np.stack(columns, axis=1), np.nan)


def _without_gaps(nodes: Doubles) -> Doubles:
    """Fills ellipses of film points without light with those of a wider stop or the previous row, for interpolation."""
    nodes = nodes.copy()
    for axis in (1, 2):
        moved = np.moveaxis(nodes, axis, 0)
        for previous, node in pairwise(moved):
            unlit = np.isnan(node)
            node[unlit] = previous[unlit]
    return nodes


def _between(nodes: Doubles, axis: int) -> Doubles:
    """Nodes along an axis with linearly interpolated values inserted half-way."""
    moved = np.moveaxis(nodes, axis, 0)
    result = np.empty((2 * len(moved) - 1, *moved.shape[1:]))
    result[::2] = moved
    result[1::2] = 0.5 * (moved[1:] + moved[:-1])
    return np.moveaxis(result, 0, axis)


def _norms(l: Doubles, m: Doubles, ellipses: Doubles) -> Doubles:  # noqa: E741
    """(R, P): elliptical norm of points, 1 on the edge of the ellipses (R, 3)."""
    return np.hypot((l - ellipses[:, :1]) / ellipses[:, 1:2], m / ellipses[:, 2:3])


def _norms_at(
    outlines_at: Sequence[Sequence[Outlines]], nodes: Doubles, points_of: Callable[[Outlines], tuple[Doubles, Doubles]]
) -> Doubles:
    """(foci, stops, radii, P): norms of the points of each outline in its interpolated ellipse."""
    ellipses = _between(_between(nodes, 0), 2)
    return np.array(
        [
            [_norms(*points_of(outline), ellipses[i, j]) for j, outline in enumerate(row)]
            for i, row in enumerate(outlines_at)
        ]
    )


def _bulge(outlines_at: Sequence[Outlines], wide: Doubles, narrow: Doubles) -> Doubles:
    """(rows,): relative growth that the interpolated ellipses need half-way between two stops. With vignetting, the
    pupil is limited by rims at the wide stop and by the stop at the narrow one, so that in between it is larger than
    their interpolation."""
    growths = []
    for part, outline in zip(_QUARTERS, outlines_at, strict=True):
        norms = np.fmax.reduce(_norms(outline.l, outline.m, wide + part * (narrow - wide)), axis=1)
        growths.append((np.fmax(norms, 1) - 1) / (4 * part * (1 - part)))
    bulges: Doubles = maximum_filter(np.max(growths, axis=0), 3, mode="nearest")[::2]
    return bulges
