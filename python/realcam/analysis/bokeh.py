"""Bokeh: images of points out of focus."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import ArrayLike

from .._core import InputError, Lens
from ..short_text import ShortText
from .fields import Bundles, Doubles, checked_count, three_fields, wavelengths_of


@dataclass(frozen=True, repr=False)
class Bokeh(ShortText):
    """Images of a point out of focus at F fields and W wavelengths.

    fields_deg: (F,); object_distance_m: object plane to front vertex.
    values_per_mm2: (F, W, N, N), fraction of each wavelength's light per mm^2 of the film, rows from the lowest y;
    centred on the disc of the design wavelength. pitch_mm: sample spacing of all images.
    """

    fields_deg: Doubles
    wavelengths_nm: Doubles
    object_distance_m: float
    values_per_mm2: Doubles
    pitch_mm: float


def bokeh(
    lens: Lens,
    fields_deg: ArrayLike | None = None,
    wavelengths_nm: ArrayLike | None = None,
    *,
    object_distance_m: float | None = None,
    size: int = 96,
    rays: int = 200000,
) -> Bokeh:
    """Images of a point out of focus by geometric ray density. Raises InputError if the point is in focus.

    object_distance_m: None is infinity for a lens that is focused nearer, and thirty focal lengths for one that is
    focused on infinity. size: samples along each side of an image; rays: number of rays for each. fields_deg: None is
    the axis, 0.7 and 1 times the largest image height. wavelengths_nm: None is F line, design wavelength, C line.
    """
    checked_count(size, "size")
    checked_count(rays, "rays")
    distance = _out_of_focus_m(lens) if object_distance_m is None else object_distance_m
    source = Bundles(lens, distance)
    fields = three_fields(lens, fields_deg, source)
    colours = wavelengths_of(lens, wavelengths_nm)
    design = [source.at(float(f), lens.wavelength_nm) for f in fields]
    boxes = [(b.points_mm.min(axis=0), b.points_mm.max(axis=0)) for b in design]
    side = 1.15 * max(float((high - low).max()) for low, high in boxes)
    if not side > 0:
        raise InputError(f"an object at {distance:.6g} m is in focus, so that its image is no disc")
    values = np.empty((len(fields), len(colours), size, size))
    for f, field in enumerate(fields):
        corner = 0.5 * (boxes[f][0] + boxes[f][1]) - 0.5 * side
        for c, colour in enumerate(colours):
            points = lens.film_points(float(field), rays, wavelength_nm=float(colour), object_distance_m=distance)
            column, row = np.floor((points - corner) * (size / side)).astype(int).T
            inside = (column >= 0) & (column < size) & (row >= 0) & (row < size)
            sums = np.bincount(row[inside] * size + column[inside], minlength=size * size).reshape(size, size)
            values[f, c] = sums / len(points) * (size / side) ** 2
    return Bokeh(fields, colours, distance, values, side / size)


def _out_of_focus_m(lens: Lens) -> float:
    """Default object distance."""
    if math.isfinite(lens.focus_distance_m):
        return math.inf
    return 30e-3 * abs(lens.first_order().effective_focal_length_mm)


def plot_bokeh(data: Bokeh, axes: Axes, field: int = 0) -> None:
    """Plots one disc in colour, normalised to its own peak (99.7th percentile)."""
    values = data.values_per_mm2[field]
    order = np.argsort(data.wavelengths_nm)[::-1]  # red first
    channels = [values[order[0]], values[order[len(order) // 2]], values[order[-1]]]
    picture = np.stack(channels, axis=-1)
    bright = float(np.percentile(picture, 99.7)) or float(picture.max())
    half = 0.5 * data.pitch_mm * picture.shape[0]
    axes.imshow(
        np.clip(picture / bright, 0, 1) ** (1 / 2.2),
        origin="lower",
        extent=(-half, half, -half, half),
        interpolation="nearest",
    )
    axes.grid(visible=False)
    axes.set_xlabel("x / mm")
    axes.set_ylabel("y / mm")
    axes.set_title(f"{data.fields_deg[field]:.3g}°, object at {data.object_distance_m:.3g} m")
