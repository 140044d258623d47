"""Longitudinal spherical aberration by wavelength."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import ArrayLike

from .._core import Lens
from ..short_text import ShortText
from . import style
from .exit_rays import exit_rays
from .fields import Doubles, checked_count, wavelengths_of


@dataclass(frozen=True, repr=False)
class LongitudinalAberration(ShortText):
    """Intersections of rays of the axial point with the axis.

    wavelengths_nm: (W,); pupil: (P,), heights in the stop in units of its radius, from the axis.
    focus_mm: (W, P), position of the ray's intersection with the axis, behind the film; the first per wavelength is the
      paraxial focus. nan for rays that do not pass.
    """

    wavelengths_nm: Doubles
    pupil: Doubles
    focus_mm: Doubles


def longitudinal_aberration(
    lens: Lens,
    wavelengths_nm: ArrayLike | None = None,
    *,
    samples: int = 33,
    object_distance_m: float | None = None,
) -> LongitudinalAberration:
    """Computed with real rays of the axial point. Defaults: F line, design wavelength, C line; the plane in focus."""
    colours = wavelengths_of(lens, wavelengths_nm)
    pupil = np.linspace(0, 1, checked_count(samples))
    # At 1e-3 of the radius rays are paraxial within 1e-6 of the aberration; the axial ray itself has no intersection.
    heights = np.maximum(pupil, 1e-3)
    pupil_points = np.column_stack([np.zeros(samples), heights])
    focus = np.empty((len(colours), samples))
    for w, colour in enumerate(colours):
        rays = exit_rays(lens, pupil_points, 0.0, float(colour), object_distance_m)
        focus[w] = -rays.points_mm[:, 1] / rays.slopes[:, 1]
    return LongitudinalAberration(colours, pupil, focus)


def plot_longitudinal_aberration(data: LongitudinalAberration, axes: Axes) -> None:
    """Plots the intersections in mm behind the film, with the height in the stop upwards."""
    for curve, (colour, label) in zip(data.focus_mm, style.coloured(data.wavelengths_nm), strict=True):
        axes.plot(curve, data.pupil, color=colour, label=label)
    style.zero_lines(axes, y=False)
    axes.set_xlabel("focus behind the film / mm")
    axes.set_ylabel("height in the stop / its radius")
    axes.set_title("Longitudinal aberration")
    axes.set_ylim(0, 1.02)
    axes.legend(loc="best")
