"""Distortion: the chief ray's film height against the paraxial one."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import ArrayLike

from .._core import InputError, Lens
from ..short_text import ShortText
from . import style
from .fields import Bundles, Doubles, bundles_of, checked_count, fields_of

PROJECTIONS = ("tangent", "angle")


@dataclass(frozen=True, repr=False)
class Distortion(ShortText):
    """Distortion over the field.

    fields_deg: (F,); real_mm, paraxial_mm: (F,), heights of the chief ray on the film.
    percent: (F,), 100 (real / paraxial - 1); 0, its limit, on the axis.
    projection: the paraxial height is proportional to the "tangent" of the field angle or to the "angle" (f-theta).
    """

    fields_deg: Doubles
    real_mm: Doubles
    paraxial_mm: Doubles
    percent: Doubles
    projection: str


@dataclass(frozen=True, repr=False)
class DistortionGrid(ShortText):
    """Image of a plane grid of squares perpendicular to the axis.

    ideal_mm, real_mm: (N, N, 2), film points of the grid's nodes by the paraxial and the real lens; real_mm is nan
    where no light arrives.
    """

    ideal_mm: Doubles
    real_mm: Doubles


def distortion(
    lens: Lens,
    fields_deg: ArrayLike | None = None,
    *,
    wavelength_nm: float | None = None,
    projection: str | None = None,
    film_distance_mm: float | None = None,
    samples: int = 81,
    object_distance_m: float | None = None,
    bundles: Bundles | None = None,
) -> Distortion:
    """Compares heights of real chief rays with paraxial ones, on the film or another plane.

    film_distance_mm: last vertex to that plane, None is the film; first_order().back_focal_distance_mm is the paraxial
    focus of infinity. projection: None is "tangent" for fields up to 60 degrees, and "angle" for larger ones, because
    tangents diverge at 90.
    object_distance_m: object plane to front vertex; None is that of `bundles`, else the plane in focus. bundles: cache
    of ray bundles that several analyses of the same lens and object distance share; None makes one for this call.
    Other defaults: `samples` fields from the axis to the film's corner; the design wavelength.
    Raises InputError for "tangent" from 90 degrees on.
    """
    source = bundles_of(lens, object_distance_m, bundles)
    fields = fields_of(lens, fields_deg, samples, source)
    nm = lens.wavelength_nm if wavelength_nm is None else wavelength_nm
    kind = projection or ("tangent" if float(np.abs(fields).max()) <= 60 else "angle")
    if kind not in PROJECTIONS:
        raise InputError(f'unknown projection "{kind}"; expected tangent or angle')
    if kind == "tangent" and float(np.abs(fields).max()) >= 90:
        raise InputError('the projection "tangent" is not defined at 90 deg and beyond; use "angle"')
    plane = lens.film_distance_mm if film_distance_mm is None else film_distance_mm
    real = np.array([_height_at(source, float(field), nm, plane) for field in fields])
    angle = np.radians(fields)
    paraxial = paraxial_height_mm(source, nm, plane) * (np.tan(angle) if kind == "tangent" else angle)
    with np.errstate(invalid="ignore", divide="ignore"):
        percent = np.where(fields == 0, 0.0, 100 * (real - paraxial) / paraxial)
    return Distortion(fields, real, paraxial, percent, kind)


def _height_at(source: Bundles, field_deg: float, wavelength_nm: float, film_distance_mm: float) -> float:
    """Height of the real chief ray, mm, in the plane at this distance from the last vertex. Raises InputError if no
    light passes."""
    if film_distance_mm == source.lens.film_distance_mm:
        return source.chief(field_deg, wavelength_nm).chief_ray_mm[1]
    bundle = source.lens.bundle(
        field_deg,
        wavelength_nm=wavelength_nm,
        object_distance_m=source.object_distance_m,
        film_distance_mm=film_distance_mm,
        arms=4,
        nodes=1,
    )
    return bundle.chief_ray_mm[1]


def paraxial_height_mm(source: Bundles, wavelength_nm: float, film_distance_mm: float) -> float:
    """Height of the paraxial chief ray in a plane, per tangent of the field angle."""
    lens = source.lens
    sums = lens.seidel(45.0, wavelength_nm=wavelength_nm, object_distance_m=source.object_distance_m)
    return float(sums.chief_height_mm[-1] + film_distance_mm * sums.chief_slope[-1])


def distortion_grid(
    lens: Lens,
    *,
    lines: int = 11,
    wavelength_nm: float | None = None,
    object_distance_m: float | None = None,
    bundles: Bundles | None = None,
) -> DistortionGrid:
    """Computes a grid of lines x lines nodes that covers the film in the paraxial image, and its real image.

    Defaults as for distortion().
    Raises InputError if the film's corner is at 80 degrees or more: no plane grid fills the picture.
    """
    checked_count(lines, "lines")
    source = bundles_of(lens, object_distance_m, bundles)
    curve = distortion(lens, wavelength_nm=wavelength_nm, samples=15, bundles=source)
    if curve.fields_deg.max() >= 80:
        raise InputError(
            "a plane grid cannot fill the picture of a lens whose field extends to 80 deg or more from the axis"
        )
    nm = lens.wavelength_nm if wavelength_nm is None else wavelength_nm
    scale = paraxial_height_mm(source, nm, lens.film_distance_mm)
    paraxial = np.abs(scale) * np.tan(np.radians(curve.fields_deg))
    half = 0.5 * np.array(lens.film_mm)
    y, x = np.meshgrid(half[1] * np.linspace(-1, 1, lines), half[0] * np.linspace(-1, 1, lines), indexing="ij")
    radius = np.hypot(x, y)
    # The ratio of heights is a smooth even function: a polynomial in the squared height through the curve's points.
    ratio = np.ones(len(paraxial))
    ratio[1:] = np.abs(curve.real_mm[1:]) / paraxial[1:]
    top = paraxial[-1] ** 2
    fit = np.polynomial.Chebyshev.fit(paraxial[1:] ** 2, ratio[1:], min(6, len(paraxial) - 2), domain=(0, top))
    node_ratio = np.where(radius**2 <= 1.002 * top, fit(np.minimum(radius**2, top)), np.nan)
    ideal = np.stack([x, y], axis=-1)
    return DistortionGrid(ideal, ideal * node_ratio[..., None])


def plot_distortion(data: Distortion, axes: Axes) -> None:
    """Plots distortion in percent, with the field upwards."""
    axes.plot(data.percent, data.fields_deg, color=style.GREEN)
    style.set_field_axis(axes, data.fields_deg)
    against = "f tan θ" if data.projection == "tangent" else "f θ"
    axes.set_xlabel(f"distortion against {against} / %")
    axes.set_title("Distortion")
    largest = float(np.nanmax(np.abs(data.percent)))
    axes.set_xlim(-1.15 * largest - 1e-3, 1.15 * largest + 1e-3)


def plot_distortion_grid(grid: DistortionGrid, axes: Axes) -> None:
    """Plots the paraxial and the real image of the grid in film coordinates."""
    for lines, colour, label in ((grid.ideal_mm, style.GREY, "paraxial"), (grid.real_mm, style.RED, "real")):
        for family in (lines, lines.swapaxes(0, 1)):
            for line in family:
                axes.plot(line[:, 0], line[:, 1], color=colour, linewidth=0.7, label=label)
                label = "_nolegend_"
    axes.set_aspect("equal")
    axes.grid(visible=False)
    axes.set_xlabel("x on the film / mm")
    axes.set_ylabel("y on the film / mm")
    axes.set_title("Distortion of a grid")
    style.legend_beside(axes)
