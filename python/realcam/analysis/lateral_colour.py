"""Lateral colour: the difference of image heights between wavelengths."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import ArrayLike

from .._core import Lens
from ..short_text import ShortText
from . import style
from .fields import Bundles, Doubles, analysis_inputs


@dataclass(frozen=True, repr=False)
class LateralColour(ShortText):
    """Chief-ray heights of W wavelengths at F fields, relative to the design wavelength.

    fields_deg: (F,); wavelengths_nm: (W,).
    shift_mm: (W, F), height of the chief ray on the film minus that at the design wavelength.
    airy_radius_mm: (F,), along y, at the design wavelength.
    """

    fields_deg: Doubles
    wavelengths_nm: Doubles
    shift_mm: Doubles
    airy_radius_mm: Doubles


def lateral_colour(
    lens: Lens,
    fields_deg: ArrayLike | None = None,
    wavelengths_nm: ArrayLike | None = None,
    *,
    samples: int = 81,
    object_distance_m: float | None = None,
    bundles: Bundles | None = None,
) -> LateralColour:
    """Computes lateral colour.

    object_distance_m: object plane to front vertex; None is that of `bundles`, else the plane in focus. bundles: cache
    of ray bundles that several analyses of the same lens and object distance share; None makes one for this call.
    Other defaults: `samples` fields from the axis to the film's corner; F line, design wavelength, C line.
    """
    source, fields, colours = analysis_inputs(lens, fields_deg, wavelengths_nm, object_distance_m, bundles, samples)
    design = [source.chief(float(field), lens.wavelength_nm) for field in fields]
    heights = np.array([[source.chief(float(f), float(c)).chief_ray_mm[1] for f in fields] for c in colours])
    airy = [1.22e-6 * b.wavelength_nm / b.index / np.ptp(b.edge_slopes[..., 1]) for b in design]
    return LateralColour(fields, colours, heights - np.array([b.chief_ray_mm[1] for b in design]), np.array(airy))


def plot_lateral_colour(data: LateralColour, axes: Axes) -> None:
    """Plots the shifts, with the field upwards and the Airy radius for comparison."""
    for curve, (colour, label) in zip(data.shift_mm, style.coloured(data.wavelengths_nm), strict=True):
        axes.plot(1e3 * curve, data.fields_deg, color=colour, label=label)
    for side in (-1, 1):
        axes.plot(
            side * 1e3 * data.airy_radius_mm,
            data.fields_deg,
            ":",
            color=style.GREY,
            linewidth=0.8,
            label="Airy radius" if side > 0 else "_nolegend_",
        )
    style.set_field_axis(axes, data.fields_deg)
    axes.set_xlabel("chief ray's shift on the film / µm")
    axes.set_title("Lateral colour")
    axes.legend(loc="best")
