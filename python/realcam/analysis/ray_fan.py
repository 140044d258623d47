"""Ray fans: transverse ray aberrations over the stop."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import ArrayLike

from .._core import Lens
from ..short_text import ShortText
from . import style
from .exit_rays import exit_rays
from .fields import Bundles, Doubles, analysis_inputs, checked_count


@dataclass(frozen=True, repr=False)
class RayFan(ShortText):
    """Transverse ray aberrations on the film, relative to the chief ray at the design wavelength.

    fields_deg: (F,); wavelengths_nm: (W,); pupil: (P,), in units of the stop's radius.
    tangential_mm: (F, W, P), along y, of rays through (0, pupil) of the stop.
    sagittal_mm: (F, W, P), along x, of rays through (pupil, 0).
    nan for rays that do not pass.
    """

    fields_deg: Doubles
    wavelengths_nm: Doubles
    pupil: Doubles
    tangential_mm: Doubles
    sagittal_mm: Doubles


def ray_fan(
    lens: Lens,
    fields_deg: ArrayLike | None = None,
    wavelengths_nm: ArrayLike | None = None,
    *,
    samples: int = 41,
    object_distance_m: float | None = None,
    bundles: Bundles | None = None,
) -> RayFan:
    """Computes fans of real rays, with `samples` rays across the stop in each fan.

    object_distance_m: object plane to front vertex; None is that of `bundles`, else the plane in focus. bundles: cache
    of ray bundles that several analyses of the same lens and object distance share; None makes one for this call.
    Other defaults: 0, 0.7 and 1 times the largest image height; F line, design wavelength, C line.
    """
    source, fields, colours = analysis_inputs(lens, fields_deg, wavelengths_nm, object_distance_m, bundles)
    pupil = np.linspace(-1, 1, checked_count(samples))
    zero = np.zeros(samples)
    pupil_points = np.concatenate([np.column_stack([zero, pupil]), np.column_stack([pupil, zero])])
    fans = np.empty((len(fields), len(colours), 2, samples))
    for f, field in enumerate(fields):
        middle = source.chief(field, lens.wavelength_nm).chief_ray_mm
        for w, colour in enumerate(colours):
            points = exit_rays(lens, pupil_points, float(field), float(colour), source.object_distance_m).points_mm
            fans[f, w] = points[:samples, 1] - middle[1], points[samples:, 0] - middle[0]
    return RayFan(fields, colours, pupil, fans[:, :, 0], fans[:, :, 1])


def plot_ray_fan(fan: RayFan, axes: Axes, field: int = 0, *, sagittal: bool = False) -> None:
    """Plots the fan of one field, given by its index."""
    curves = 1e3 * (fan.sagittal_mm if sagittal else fan.tangential_mm)[field]
    for curve, (colour, label) in zip(curves, style.coloured(fan.wavelengths_nm), strict=True):
        axes.plot(fan.pupil, curve, color=colour, label=label)
    style.zero_lines(axes)
    across = "x" if sagittal else "y"
    axes.set_xlabel(f"{across} in the stop / its radius")
    axes.set_ylabel(f"{across} on the film / µm")
    axes.set_title(f"{fan.fields_deg[field]:.3g}°, {'sagittal' if sagittal else 'tangential'}")
    axes.set_xlim(-1, 1)
