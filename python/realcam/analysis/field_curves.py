"""Astigmatic field curves: foci of rays close to each chief ray."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import ArrayLike

from .._core import InputError, Lens
from ..short_text import ShortText
from . import style
from .fields import Bundles, Doubles, analysis_inputs


@dataclass(frozen=True, repr=False)
class FieldCurves(ShortText):
    """Tangential and sagittal foci over F fields at W wavelengths, and the Petzval surface.

    fields_deg: (F,); wavelengths_nm: (W,).
    tangential_mm, sagittal_mm: (W, F), foci of real rays close to the chief ray, along the axis, behind the film.
    petzval_mm: (F,), Petzval surface at the design wavelength, to third order; nan for afocal lenses, from 90
      degrees on, and for lenses without third-order sums (Lens.seidel).
    """

    fields_deg: Doubles
    wavelengths_nm: Doubles
    tangential_mm: Doubles
    sagittal_mm: Doubles
    petzval_mm: Doubles


def field_curves(
    lens: Lens,
    fields_deg: ArrayLike | None = None,
    wavelengths_nm: ArrayLike | None = None,
    *,
    samples: int = 81,
    object_distance_m: float | None = None,
    bundles: Bundles | None = None,
) -> FieldCurves:
    """Computes field curves.

    object_distance_m: object plane to front vertex; None is that of `bundles`, else the plane in focus. bundles: cache
    of ray bundles that several analyses of the same lens and object distance share; None makes one for this call.
    Other defaults: `samples` fields from the axis to the film's corner; the design wavelength.
    """
    wavelengths = lens.wavelength_nm if wavelengths_nm is None else wavelengths_nm
    source, fields, colours = analysis_inputs(lens, fields_deg, wavelengths, object_distance_m, bundles, samples)
    light = [[source.chief(float(field), float(colour)) for field in fields] for colour in colours]
    return FieldCurves(
        fields,
        colours,
        np.array([[b.tangential_focus_mm for b in row] for row in light]),
        np.array([[b.sagittal_focus_mm for b in row] for row in light]),
        np.array([_petzval_mm(source, float(field)) for field in fields]),
    )


def _petzval_mm(source: Bundles, field_deg: float) -> float:
    """Position of the Petzval surface behind the film, at the paraxial chief ray's height, mm; nan if it is
    undefined."""
    lens = source.lens
    try:
        sums = lens.seidel(field_deg, object_distance_m=source.object_distance_m)
    except InputError:
        return float("nan")
    focus = -sums.marginal_height_mm[-1] / sums.marginal_slope[-1]  # behind the last vertex
    height = sums.chief_height_mm[-1] + focus * sums.chief_slope[-1]
    curvature = sums.petzval_curvature_per_mm.sum()
    return float(focus - lens.film_distance_mm + 0.5 * curvature * height**2)


def plot_field_curves(curves: FieldCurves, axes: Axes) -> None:
    """Plots the foci in mm behind the film, with the field upwards."""
    for w, (colour, label) in enumerate(style.coloured(curves.wavelengths_nm)):
        suffix = f", {label}" if len(curves.wavelengths_nm) > 1 else ""
        axes.plot(curves.tangential_mm[w], curves.fields_deg, color=colour, label=f"tangential{suffix}")
        axes.plot(curves.sagittal_mm[w], curves.fields_deg, "--", color=colour, label=f"sagittal{suffix}")
    axes.plot(curves.petzval_mm, curves.fields_deg, ":", color=style.GREY, label="Petzval")
    style.set_field_axis(axes, curves.fields_deg)
    shown = np.concatenate([[0.0], curves.tangential_mm.ravel(), curves.sagittal_mm.ravel()])
    low, high = np.nanmin(shown), np.nanmax(shown)
    margin = 0.15 * (high - low) or 1.0
    axes.set_xlim(low - margin, high + margin)  # the Petzval curve may be cut off
    axes.set_xlabel("focus behind the film / mm")
    axes.set_title("Field curves")
    axes.legend(loc="best")
