"""Wavefront maps over the pupil."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes

from .._core import Lens
from ..short_text import ShortText
from . import style
from .fields import Doubles


@dataclass(frozen=True, repr=False)
class WavefrontMap(ShortText):
    """Optical path differences over the stop.

    map_waves: (N, N), rows from the lowest y of the stop, columns from the lowest x, over the stop's bounding
    square; nan where no ray passes. Positive where the wavefront is ahead of the reference sphere about the chief ray's
    film point.
    """

    field_deg: float
    wavelength_nm: float
    map_waves: Doubles
    rms_waves: float
    peak_to_valley_waves: float
    strehl: float
    film_mm: tuple[float, float] | None = None


def wavefront_map(
    lens: Lens,
    field_deg: float = 0.0,
    *,
    wavelength_nm: float | None = None,
    samples: int = 48,
    remove: str | None = None,
    object_distance_m: float | None = None,
    film_mm: tuple[float, float] | None = None,
) -> WavefrontMap:
    """Map of Lens.wavefront. remove, film_mm: see there. Defaults: the design wavelength; the plane in focus."""
    wavefront = lens.wavefront(
        field_deg,
        wavelength_nm=wavelength_nm,
        samples=samples,
        remove=remove,
        object_distance_m=object_distance_m,
        film_mm=film_mm,
    )
    return WavefrontMap(
        field_deg,
        wavefront.wavelength_nm,
        wavefront.map_waves(),
        wavefront.rms_waves,
        wavefront.peak_to_valley_waves,
        wavefront.strehl,
        film_mm,
    )


def plot_wavefront_map(data: WavefrontMap, axes: Axes) -> None:
    """Plots the map in waves; colours are centred on its mean."""
    mean = float(np.nanmean(data.map_waves))
    span = float(np.nanmax(np.abs(data.map_waves - mean))) or 1.0
    picture = axes.imshow(
        data.map_waves,
        origin="lower",
        extent=(-1, 1, -1, 1),
        cmap="RdBu_r",
        vmin=mean - span,
        vmax=mean + span,
        interpolation="nearest",
    )
    axes.grid(visible=False)
    axes.set_xlabel("x in the stop / its radius")
    axes.set_ylabel("y in the stop / its radius")
    axes.set_title(f"{style.field_title(data.field_deg, data.film_mm)}, RMS {data.rms_waves:.3g} waves")
    style.colour_bar(axes, picture, "waves")
