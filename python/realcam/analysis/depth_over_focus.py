"""Depth of field over the distance in focus, at several apertures."""

from __future__ import annotations

import contextlib
import textwrap
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import ArrayLike, NDArray

from .._core import InputError, Lens
from ..photography.depth import blur_diameter_mm, circle_for, sharp_ranges
from ..photography.formulas import ThinLens
from ..short_text import ShortText
from . import style
from .fields import Doubles, checked_count, numbers_of


@dataclass(frozen=True, repr=False)
class DepthOverFocus(ShortText):
    """Depth of field over the focus distance. Distances are from the film, in metres.

    focus_m: (D,); f_numbers: (N,), as engraved.
    near_m, far_m: (N, D), by real rays. Both are nan if the lens cannot be focused, if no light passes, or if
      aberrations alone blur more than the circle of confusion. far_m is inf if infinity is sharp.
    formula_near_m, formula_far_m: (N, D), of a thin lens with the same focal length and f-number; nan if the lens
      cannot be focused.
    blur_in_focus_mm: (N, D), as in DepthOfField; nan if no light passes or the lens cannot be focused.
    circle_of_confusion_mm: the largest blur that counts as sharp.
    """

    focus_m: Doubles
    f_numbers: Doubles
    near_m: Doubles
    far_m: Doubles
    formula_near_m: Doubles
    formula_far_m: Doubles
    blur_in_focus_mm: Doubles
    circle_of_confusion_mm: float


def depth_over_focus(
    lens: Lens,
    f_numbers: ArrayLike | None = None,
    focus_m: ArrayLike | None = None,
    *,
    samples: int = 21,
    circle_of_confusion_mm: float | None = None,
) -> DepthOverFocus:
    """Depth of field at each aperture and focus distance, on the axis, as by realcam.depth_of_field.

    f_numbers: None is the current f-number, and two and four stops more. focus_m: None is `samples` distances, spaced
    geometrically, from the nearest focus or twelve focal lengths to the hyperfocal distance of the widest aperture.
    circle_of_confusion_mm: None is the film's diagonal / 1500. Raises InputError, also if the lens cannot be focused at
    any of the distances.
    """
    open_f_number = lens.f_number
    stops = open_f_number * np.array([1.0, 2.0, 4.0]) if f_numbers is None else numbers_of(f_numbers, "f_numbers")
    lenses = [lens if stop == open_f_number else lens.stopped_down(float(stop)) for stop in stops]
    circle = circle_for(lens, circle_of_confusion_mm)
    if focus_m is None:
        thin = ThinLens.of(lenses[int(np.argmin(stops))])
        nearest = max(lens.nearest_focus_m, 12e-3 * thin.focal_length_mm)
        distances: Doubles = np.geomspace(
            nearest, max(1e-3 * thin.hyperfocal_mm(circle), 4 * nearest), checked_count(samples)
        )
    else:
        distances = numbers_of(focus_m, "focus_m")
    result = np.full((5, len(stops), len(distances)), np.nan)
    for n, stopped in enumerate(lenses):
        for d, distance in enumerate(distances):
            try:
                focused = stopped.focused(float(distance))
            except InputError:  # outside the focus range of the lens
                continue
            real, formula = sharp_ranges(focused, circle)
            result[:4, n, d] = real.near_m, real.far_m, formula.near_m, formula.far_m
            with contextlib.suppress(InputError):  # no light passes
                result[4, n, d] = blur_diameter_mm(focused)
    if np.isnan(result[2:4]).all():
        raise InputError(f'lens "{lens.name}" cannot be focused at any of these distances')
    near, far, formula_near, formula_far, blur_in_focus = result
    return DepthOverFocus(distances, stops, near, far, formula_near, formula_far, blur_in_focus, circle)


def plot_depth_over_focus(data: DepthOverFocus, axes: Axes) -> None:
    """Plots bands by real rays and dashed lines by the formula; ranges up to infinity are cut at the top."""
    finite = data.formula_far_m[np.isfinite(data.formula_far_m)]
    top = 3 * float(max(data.focus_m.max(), np.median(finite) if len(finite) else 0.0))
    fine = np.geomspace(data.focus_m.min(), data.focus_m.max(), 400)
    # From the smallest aperture, whose band is the widest, to the largest, so that no band is hidden.
    for n in np.argsort(-data.f_numbers):
        colour = style.field_colour(int(n))
        near, far = (np.minimum(_between(data.focus_m, edge[n], fine), 2 * top) for edge in (data.near_m, data.far_m))
        axes.fill_between(fine, near, far, color=colour, alpha=0.25, linewidth=0)
        axes.plot(fine, near, color=colour, label=_label(data, int(n)))
        axes.plot(fine, far, color=colour)
        for edge in (data.formula_near_m[n], data.formula_far_m[n]):
            axes.plot(fine, np.minimum(_between(data.focus_m, edge, fine), 2 * top), "--", color=colour, linewidth=0.8)
    axes.plot(data.focus_m, data.focus_m, color=style.GREY, linewidth=0.8, label="in focus")
    axes.plot([], [], "--", color=style.GREY, linewidth=0.8, label="by formula")
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlim(float(data.focus_m.min()), float(data.focus_m.max()))
    axes.set_ylim(float(np.nanmin(data.formula_near_m)), top)
    for axis in (axes.xaxis, axes.yaxis):
        style.plain_decades(axis)
    axes.set_xlabel("focused at / m")
    axes.set_ylabel("sharp from and to / m")
    axes.set_title(f"depth of field, blur up to {1000 * data.circle_of_confusion_mm:.3g} µm")
    style.legend_beside(axes)


def _label(data: DepthOverFocus, n: int) -> str:
    """Legend text: the aperture, with the distances and reasons of gaps in its curve."""
    is_focused = ~np.isnan(data.formula_near_m[n])
    has_light = ~np.isnan(data.blur_in_focus_mm[n])
    gaps = {
        "cannot be focused": ~is_focused,
        "no light passes": is_focused & ~has_light,
        "blurred by aberrations": has_light & np.isnan(data.near_m[n]),
    }
    lines = [f"f/{data.f_numbers[n]:.3g}"]
    for reason, is_missing in gaps.items():
        if is_missing.any():
            where = "" if is_missing.all() else f" at {_ranges(data.focus_m, is_missing)}"
            lines += textwrap.wrap(f"no curve{where}: {reason}", 32)
    return "\n".join(lines)


def _ranges(positions_m: Doubles, is_in: NDArray[np.bool_]) -> str:
    """Text of the intervals of consecutive distances for which is_in is True."""
    order = np.argsort(positions_m)
    found = np.flatnonzero(is_in[order])
    intervals = np.split(positions_m[order][found], np.flatnonzero(np.diff(found) > 1) + 1)
    ends = (dict.fromkeys(f"{interval[end]:.3g}" for end in (0, -1)) for interval in intervals)
    return " and ".join(f"{' to '.join(texts)} m" for texts in ends)


def _between(focus_m: Doubles, edge_m: Doubles, fine_m: Doubles) -> Doubles:
    """Interpolates a limit of the sharp range, edge_m, from the focus distances focus_m to fine_m.

    Inverse distances are nearly linear in each other, which also extrapolates the focus distance at which the limit
    reaches infinity.
    """
    order = np.argsort(-focus_m)
    inverse_focus, inverse_edge = 1 / focus_m[order], 1 / edge_m[order]
    finite = np.flatnonzero(inverse_edge > 0)[:2]  # the two nearest to infinity
    if len(finite) == 2:
        slope, start = np.polyfit(inverse_focus[finite], inverse_edge[finite], 1)
        # Inverse limits below 0, beyond infinity, in place of 0.
        inverse_edge = np.where(inverse_edge == 0, np.minimum(start + slope * inverse_focus, 0), inverse_edge)
    interpolated = np.interp(1 / fine_m, inverse_focus, inverse_edge)
    with np.errstate(divide="ignore"):
        edges: Doubles = np.where(interpolated <= 0, np.inf, 1 / interpolated)
    return edges
