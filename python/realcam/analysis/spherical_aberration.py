"""Longitudinal spherical aberration by colour: where rays from the axis come back to it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import ArrayLike

from .._core import Lens
from ..short_text import ShortText
from . import style
from .exit_rays import exit_rays
from .fields import Doubles, wavelengths_of


@dataclass(frozen=True, repr=False)
class LongitudinalAberration(ShortText):
    """wavelengths_nm: (W,); pupil: (P,), heights in the stop as shares of its radius, from the axis.
    focus_mm: (W, P), where the ray crosses the axis, behind the film; the first of each colour is the paraxial focus.
      nan where no ray passes.
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
    """By real rays of the axis point. None: F line, design wavelength, C line; the plane in focus."""
    colours = wavelengths_of(lens, wavelengths_nm)
    pupil = np.linspace(0, 1, samples)
    # Rays so close to the axis are paraxial within 1e-6 of their aberration; on the axis itself there is no crossing.
    heights = np.maximum(pupil, 1e-3)
    places = np.column_stack([np.zeros(samples), heights])
    focus = np.empty((len(colours), samples))
    for w, colour in enumerate(colours):
        rays = exit_rays(lens, places, 0.0, float(colour), object_distance_m)
        focus[w] = -rays.points_mm[:, 1] / rays.slopes[:, 1]
    return LongitudinalAberration(colours, pupil, focus)


def plot_longitudinal_aberration(data: LongitudinalAberration, axes: Axes) -> None:
    for curve, (colour, label) in zip(data.focus_mm, style.coloured(data.wavelengths_nm), strict=True):
        axes.plot(curve, data.pupil, color=colour, label=label)
    style.zero_lines(axes, y=False)
    axes.set_xlabel("focus behind the film / mm")
    axes.set_ylabel("height in the stop / its radius")
    axes.set_title("Longitudinal aberration")
    axes.set_ylim(0, 1.02)
    axes.legend(loc="best")
