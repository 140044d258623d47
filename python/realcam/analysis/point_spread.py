"""Point spread functions by geometric rays, Fourier transform or direct sum, with plots."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import ArrayLike

from .._core import PSF, Lens
from ..drawing.figure_files import NOTEBOOK_DPI, figure_bytes
from ..short_text import ShortText
from . import style
from .fields import Doubles, numbers_of


@dataclass(frozen=True, repr=False)
class PointSpread(ShortText):
    """Point spread function of one field.

    method: "direct", "fft" or "geometric", as for Lens.psf. x_um, y_um: (size,), coordinates of the samples.
    values: (size, size), fraction of the light per um^2, rows from the lowest y. centre_mm: film point of
    x_um = y_um = 0. strehl: nan for the method "geometric". energy: as in PSF.
    film_mm: the field as a film point; then field_deg is meaningless. None: the field is field_deg.
    """

    field_deg: float
    method: str
    x_um: Doubles
    y_um: Doubles
    values: Doubles
    centre_mm: tuple[float, float]
    strehl: float
    energy: float
    film_mm: tuple[float, float] | None = None


def point_spread(
    lens: Lens,
    field_deg: float = 0.0,
    wavelengths_nm: ArrayLike | None = None,
    *,
    method: str = "direct",
    size: int = 64,
    pitch_um: float | None = None,
    object_distance_m: float | None = None,
    film_mm: tuple[float, float] | None = None,
) -> PointSpread:
    """Lens.psf about the centroid. film_mm: film point in place of the field angle. Defaults: the design wavelength;
    the plane in focus."""
    colours = None if wavelengths_nm is None else list(numbers_of(wavelengths_nm, "wavelengths_nm"))
    psf: PSF = lens.psf(
        field_deg,
        colours,
        method=method,
        size=size,
        pitch_um=pitch_um,
        object_distance_m=object_distance_m,
        film_mm=film_mm,
        centre="centroid",
    )
    return PointSpread(
        field_deg, method, psf.x_um, psf.y_um, psf.values, psf.centre_mm, psf.strehl, psf.energy, film_mm
    )


def plot_point_spread(data: PointSpread, axes: Axes) -> None:
    """Plots a point spread function in decades below its peak."""
    plot_decades(data, axes, f"{style.field_title(data.field_deg, data.film_mm)}, {data.method}")


def plot_decades(data: PointSpread | PSF, axes: Axes, title: str) -> None:
    """Plots values in decades below their peak. title: followed by the Strehl ratio, if known."""
    half = 0.5 * (data.x_um[1] - data.x_um[0])
    with np.errstate(divide="ignore"):
        decades = np.log10(data.values / data.values.max())
    picture = axes.imshow(
        np.maximum(decades, -4),
        origin="lower",
        extent=(data.x_um[0] - half, data.x_um[-1] + half, data.y_um[0] - half, data.y_um[-1] + half),
        cmap="inferno",
        vmin=-4,
        vmax=0,
        interpolation="nearest",
    )
    axes.grid(visible=False)
    axes.set_xlabel("x / µm")
    axes.set_ylabel("y / µm")
    strehl = "" if np.isnan(data.strehl) else f", Strehl {data.strehl:.2g}"
    axes.set_title(f"{title}{strehl}")
    style.colour_bar(axes, picture, "decades relative to the peak")


def psf_png(psf: PSF) -> bytes:
    """PNG of a point spread function on a logarithmic scale, for notebooks."""
    with style.themed():
        figure = style.new_figure(*style.SIZES_IN["small"])
        plot_decades(psf, figure.add_subplot(), f"{', '.join(f'{nm:.4g}' for nm in psf.wavelengths_nm)} nm")
    return figure_bytes(figure, ".png", NOTEBOOK_DPI)
