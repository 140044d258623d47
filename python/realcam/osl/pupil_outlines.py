"""Outlines of the exit pupil as seen from film points, in direction cosines, found by tracing real rays."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .._core import Lens

Doubles = NDArray[np.float64]
Light = Sequence[tuple[float, Doubles]]
"""Wavelengths in nm, each with the shifts (R,) of its direction cosines l at R film points."""
_COLUMNS, _ROWS = 33, 17  # of the grid of directions in which the pupil is searched
_HALVINGS = 7  # bisection steps of each edge point
_AZIMUTHS, _STEPS = 33, 16  # directions and radii at which the central obstruction is searched


@dataclass(frozen=True)
class Outlines:
    """Pupil outlines of film points on the +x axis, at R radii. A pupil is symmetric in m; only its half m >= 0 is
    held."""

    l: Doubles  # noqa: E741
    """(R, P): direction cosines along x of points on the edge; NaN: no edge point was found."""
    m: Doubles
    """(R, P): direction cosines along y, not negative."""
    inner_l: Doubles
    """(R, Q): direction cosines along x of the edge of a central obstruction, in directions about the centre of the
    box; NaN: no light passes in that direction, or the lens has no obstruction."""
    inner_m: Doubles
    boxes: Doubles
    """(R, 3): bounding boxes of the outlines: lowest l, highest l, highest m; NaN: no light reaches the film point."""

    @property
    def lit(self) -> NDArray[np.bool_]:
        """(R,): true if light reaches the film point."""
        return np.isfinite(self.boxes[:, 0])


def rear_boxes(lens: Lens, radii_mm: Doubles) -> Doubles:
    """(R, 3): boxes of the directions from film points on the x axis to the lens's last surface, with a margin."""
    last = lens.surfaces[-1]
    rim_mm = 1.1 * last.clear_semi_diameter_mm
    distance_mm = max(0.5 * lens.film_distance_mm, lens.film_distance_mm - last.sag_mm(last.clear_semi_diameter_mm))
    angles = np.linspace(0, np.pi, 33)
    x = rim_mm * np.cos(angles) - radii_mm[:, None]
    y = rim_mm * np.sin(angles)
    length = np.sqrt(x**2 + y**2 + distance_mm**2)
    directions_l, directions_m = x / length, y / length
    return np.stack([directions_l.min(axis=1), directions_l.max(axis=1), directions_m.max(axis=1)], axis=1)


def passes(lens: Lens, radii_mm: Doubles, l: Doubles, m: Doubles, light: Light) -> NDArray[np.bool_]:  # noqa: E741
    """(R, K): true if a ray from film point (R,) in direction (R, K) passes the lens at any of the wavelengths."""
    passed = np.zeros(l.shape, dtype=bool)
    origins = np.zeros((*l.shape, 3))
    origins[..., 0] = radii_mm[:, None]
    origins[..., 2] = lens.film_position_mm
    for wavelength_nm, shift in light:
        shifted = l + shift[:, None]
        squared_n = 1 - shifted**2 - m**2  # squared direction cosine along the axis
        remaining = ~passed & (squared_n > 0)
        directions = np.stack([shifted[remaining], m[remaining], -np.sqrt(squared_n[remaining])], axis=-1)
        traced = lens.trace(origins[remaining], directions, wavelength_nm=wavelength_nm, dtype="float32")
        passed[remaining] = traced.status == 0
    return passed


def outlines(lens: Lens, radii_mm: Doubles, boxes: Doubles, light: Light, rounds: int) -> Outlines:
    """Finds the outlines inside of boxes (R, 3), which are first tightened `rounds` times."""
    for _ in range(rounds):
        boxes = _narrowed(lens, radii_mm, boxes, light)

    def passing(l: Doubles, m: Doubles) -> NDArray[np.bool_]:  # noqa: E741
        return passes(lens, radii_mm, l, m, light)

    grid_l, grid_m = _grid(boxes)
    shape = (len(radii_mm), _ROWS, _COLUMNS)
    passed = passing(grid_l.reshape(len(radii_mm), -1), grid_m.reshape(len(radii_mm), -1)).reshape(shape)
    width = (boxes[:, 1] - boxes[:, 0])[:, None] / (_COLUMNS - 1)
    height = boxes[:, 2][:, None] / (_ROWS - 1)
    row_lit: NDArray[np.bool_] = np.any(passed, axis=2)
    column_lit: NDArray[np.bool_] = np.any(passed, axis=1)
    row_m, column_l = grid_m[:, :, 0], grid_l[:, 0, :]
    first = np.take_along_axis(grid_l, passed.argmax(axis=2)[..., None], 2)[..., 0]
    last = np.take_along_axis(grid_l, _COLUMNS - 1 - passed[:, :, ::-1].argmax(axis=2)[..., None], 2)[..., 0]
    top = np.take_along_axis(grid_m, _ROWS - 1 - passed[:, ::-1].argmax(axis=1)[:, None], 1)[:, 0]
    lows, highs = first - width, last + width
    tops = top + height
    for _ in range(_HALVINGS):
        middle_low, middle_high, middle_top = 0.5 * (lows + first), 0.5 * (highs + last), 0.5 * (tops + top)
        rows = passing(np.hstack([middle_low, middle_high, column_l]), np.hstack([row_m, row_m, middle_top]))
        low_in, high_in, top_in = np.split(rows, [_ROWS, 2 * _ROWS], axis=1)
        first, lows = np.where(low_in, middle_low, first), np.where(low_in, lows, middle_low)
        last, highs = np.where(high_in, middle_high, last), np.where(high_in, highs, middle_high)
        top, tops = np.where(top_in, middle_top, top), np.where(top_in, tops, middle_top)
    edge_l = np.hstack([np.where(row_lit, lows, np.nan), np.where(row_lit, highs, np.nan), column_l])
    edge_m = np.hstack([row_m, row_m, np.where(column_lit, tops, np.nan)])
    missing = np.isnan(edge_l) | np.isnan(edge_m)
    edge_l[missing] = edge_m[missing] = np.nan
    blocked = any(surface.inner_semi_diameter_mm for surface in lens.surfaces)
    inner_l, inner_m = _inner_edges(boxes, passing) if blocked else np.full((2, len(radii_mm), _AZIMUTHS), np.nan)
    return Outlines(edge_l, edge_m, inner_l, inner_m, boxes)


def _inner_edges(boxes: Doubles, passing: Callable[[Doubles, Doubles], NDArray[np.bool_]]) -> tuple[Doubles, Doubles]:
    """Edges of the central obstruction: first directions in which light passes, outwards from the centre of each
    box."""
    angles = np.linspace(0, np.pi, _AZIMUTHS)
    middle, half, top = 0.5 * (boxes[:, 0] + boxes[:, 1]), 0.5 * (boxes[:, 1] - boxes[:, 0]), boxes[:, 2]

    def directions(fraction: Doubles) -> tuple[Doubles, Doubles]:
        """Directions at fractions (R, azimuths) of the distance from the centre to the ellipse inscribed in the box."""
        return (
            middle[:, None] + half[:, None] * fraction * np.cos(angles),
            top[:, None] * fraction * np.sin(angles),
        )

    shape = (len(boxes), _AZIMUTHS)
    passed = np.stack([passing(*directions(np.full(shape, step / _STEPS))) for step in range(_STEPS)], axis=-1)
    first = passed.argmax(axis=-1) / _STEPS
    before = np.maximum(first - 1 / _STEPS, 0)
    for _ in range(_HALVINGS):
        tried = 0.5 * (before + first)
        lit = passing(*directions(tried))
        first, before = np.where(lit, tried, first), np.where(lit, before, tried)
    l, m = directions(before)  # noqa: E741
    dark = ~passed.any(axis=-1)
    l[dark] = m[dark] = np.nan
    return l, m


def _grid(boxes: Doubles) -> tuple[Doubles, Doubles]:
    """(R, rows, columns): grid of directions over the boxes, from m = 0 upwards."""
    across = np.linspace(0, 1, _COLUMNS)
    l = boxes[:, 0, None] + across * (boxes[:, 1] - boxes[:, 0])[:, None]  # noqa: E741
    m = boxes[:, 2, None] * np.linspace(0, 1, _ROWS)
    shape = (len(boxes), _ROWS, _COLUMNS)
    return np.broadcast_to(l[:, None, :], shape).copy(), np.broadcast_to(m[:, :, None], shape).copy()


def _narrowed(lens: Lens, radii_mm: Doubles, boxes: Doubles, light: Light) -> Doubles:
    """Tightens boxes to the grid points that pass light plus one cell; NaN if no light passes."""
    l, m = _grid(boxes)  # noqa: E741
    passed = passes(lens, radii_mm, l.reshape(len(boxes), -1), m.reshape(len(boxes), -1), light)
    passed = passed.reshape(l.shape)
    columns: NDArray[np.bool_] = np.any(passed, axis=1)
    rows: NDArray[np.bool_] = np.any(passed, axis=2)
    cell = (boxes[:, 1] - boxes[:, 0]) / (_COLUMNS - 1)
    first = boxes[:, 0] + cell * (columns.argmax(axis=1) - 1)
    last = boxes[:, 0] + cell * (_COLUMNS - columns[:, ::-1].argmax(axis=1))
    top = boxes[:, 2] / (_ROWS - 1) * (_ROWS - rows[:, ::-1].argmax(axis=1))
    narrowed = np.stack(
        [np.maximum(first, boxes[:, 0]), np.minimum(last, boxes[:, 1]), np.minimum(top, boxes[:, 2])], 1
    )
    narrowed[~np.any(columns, axis=1)] = np.nan
    return narrowed
