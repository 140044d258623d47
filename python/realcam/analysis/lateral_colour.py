"""Lateral colour: by how much the image is larger in one colour than in another."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import ArrayLike

from .._core import Lens
from . import style
from .fields import Bundles, Doubles, bundles_of, fields_of, texts_of, wavelengths_of


@dataclass(frozen=True)
class LateralColour:
    """fields_deg: (F,); wavelengths_nm: (W,).
    shift_mm: (W, F), height of the chief ray on the film less that of the design wavelength.
    airy_radius_mm: (F,), along y, of the design wavelength.
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
    samples: int = 15,
    object_distance_m: float | None = None,
    bundles: Bundles | None = None,
) -> LateralColour:
    """None: `samples` fields up to the corner of the film; F line, design wavelength, C line; the plane in focus."""
    source = bundles_of(lens, object_distance_m, bundles)
    fields = fields_of(lens, fields_deg, samples, source)
    colours = wavelengths_of(lens, wavelengths_nm)
    design = [source.chief(float(field), lens.wavelength_nm) for field in fields]
    heights = np.array([[source.chief(float(f), float(c)).chief_ray_mm[1] for f in fields] for c in colours])
    airy = [1.22e-6 * b.wavelength_nm / b.index / np.ptp(b.edge_slopes[..., 1]) for b in design]
    return LateralColour(fields, colours, heights - np.array([b.chief_ray_mm[1] for b in design]), np.array(airy))


def plot_lateral_colour(data: LateralColour, axes: Axes) -> None:
    colours = style.wavelength_colours(data.wavelengths_nm)
    for curve, colour, label in zip(data.shift_mm, colours, texts_of(data.wavelengths_nm, "nm"), strict=True):
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
    style.zero_lines(axes, y=False)
    axes.set_xlabel("chief ray's shift on the film / µm")
    axes.set_ylabel("field / °")
    axes.set_title("Lateral colour")
    axes.set_ylim(0, max(float(data.fields_deg.max()), 1e-9))
    axes.legend(loc="best")
