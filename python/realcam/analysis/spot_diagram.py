"""Spot diagrams by field, wavelength and focus."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import ArrayLike

from .._core import InputError, Lens
from ..fields import FieldPosition, area_weighted_spot, field_arguments, field_text
from ..short_text import ShortText
from . import style
from .exit_rays import exit_rays, hexapolar
from .fields import Bundles, Doubles, analysis_inputs, bundles_of, film_points_of, numbers_of, wavelengths_of


@dataclass(frozen=True, repr=False)
class SpotDiagram(ShortText):
    """Spots of F fields, W wavelengths and D planes.

    defocus_mm: (D,), distances of the planes behind the film.
    points_mm: (D, F, W, N, 2), x and y relative to the chief ray at the design wavelength on that plane; nan for rays
      that do not pass.
    centroid_mm: (D, F, 2), of all wavelengths, relative to the chief ray as points_mm are.
    rms_radius_mm: (D, F), of all wavelengths with equal weights, about their centroid: of the light over the whole
      stop, not of the points, among which those at the edge of the stop count too much.
    airy_radii_mm: (F, 2), along x and y: 1.22 times the design wavelength times the field's working f-number in that
      direction.
    film_mm: (F, 2), fields specified as film points; then fields_deg is nan.
    """

    fields_deg: Doubles
    wavelengths_nm: Doubles
    defocus_mm: Doubles
    points_mm: Doubles
    centroid_mm: Doubles
    rms_radius_mm: Doubles
    airy_radii_mm: Doubles
    film_mm: Doubles | None = None


def spot_diagram(
    lens: Lens,
    fields_deg: ArrayLike | None = None,
    wavelengths_nm: ArrayLike | None = None,
    *,
    film_mm: ArrayLike | None = None,
    defocus_mm: ArrayLike = 0.0,
    rings: int = 10,
    object_distance_m: float | None = None,
    bundles: Bundles | None = None,
) -> SpotDiagram:
    """Spots of a hexapolar pattern with `rings` rings, on the film and on defocused planes.

    film_mm: (F, 2), film points of the chief rays, in place of angles. defocus_mm: (D,), planes, positive behind the
    film.
    object_distance_m: object plane to front vertex; None is that of `bundles`, else the plane in focus. bundles: cache
    of ray bundles that several analyses of the same lens and object distance share; None makes one for this call.
    Other defaults: 0, 0.7 and 1 times the largest image height; F line, design wavelength, C line.
    Raises InputError if no light passes.
    """
    angles: Doubles
    fields: list[FieldPosition]
    if film_mm is None:
        source, angles, colours = analysis_inputs(lens, fields_deg, wavelengths_nm, object_distance_m, bundles)
        fields = [float(angle) for angle in angles]
    else:
        source, colours = bundles_of(lens, object_distance_m, bundles), wavelengths_of(lens, wavelengths_nm)
        fields = film_points_of(film_mm)
        angles = np.full(len(fields), np.nan)
    planes = numbers_of(defocus_mm, "defocus_mm")
    pupil_points = hexapolar(rings)
    points = np.empty((len(planes), len(fields), len(colours), len(pupil_points), 2))
    centroid, rms = np.empty((len(planes), len(fields), 2)), np.empty((len(planes), len(fields)))
    airy = np.empty((len(fields), 2))
    for f, field in enumerate(fields):
        chief_point, chief_slopes = _chief_line(source, field)
        for w, colour in enumerate(colours):
            rays = exit_rays(lens, pupil_points, field, float(colour), source.object_distance_m)
            if np.isnan(rays.points_mm).all():
                raise InputError(f'none of {len(pupil_points)} rays at {field_text(field)} passes lens "{lens.name}"')
            for d, plane in enumerate(planes):
                points[d, f, w] = rays.at(float(plane)) - (chief_point + plane * chief_slopes)
        for d, plane in enumerate(planes):
            centroid[d, f], rms[d, f] = _centroid_and_rms(source, field, colours, float(plane))
            centroid[d, f] -= chief_point + plane * chief_slopes
        bundle = source.at(field, lens.wavelength_nm)
        apertures = np.ptp(bundle.edge_slopes.reshape(-1, 2), axis=0)  # 1 / f-number along x and y
        airy[f] = 1.22e-6 * bundle.wavelength_nm / bundle.index / apertures
    return SpotDiagram(
        angles, colours, planes, points, centroid, rms, airy, None if film_mm is None else np.array(fields)
    )


def _centroid_and_rms(
    source: Bundles, field: FieldPosition, colours: Doubles, defocus_mm: float
) -> tuple[Doubles, float]:
    """Centroid, (2,), mm on the film, and RMS radius about it, mm, of all wavelengths with equal weights."""
    spots = [
        area_weighted_spot(
            source.lens,
            **field_arguments(field),
            wavelength_nm=float(colour),
            object_distance_m=source.object_distance_m,
            film_distance_mm=source.lens.film_distance_mm + defocus_mm,
        )
        for colour in colours
    ]
    centroids = np.array([spot.centroid_mm for spot in spots])
    centroid = centroids.mean(axis=0)
    squares = np.array([spot.rms_radius_mm for spot in spots]) ** 2 + ((centroids - centroid) ** 2).sum(axis=1)
    return centroid, float(np.sqrt(squares.mean()))


def _chief_line(source: Bundles, field: FieldPosition) -> tuple[Doubles, Doubles]:
    """Film point, (2,), mm, and slopes dx/dz, dy/dz of the chief ray at the design wavelength, even if it is blocked.

    The slopes follow from its points on the film and on a plane close behind it. Raises InputError if no light passes.
    """
    lens = source.lens
    step = 1e-3 * max(abs(lens.film_distance_mm), 1.0)
    on_film = np.array(source.chief(field, lens.wavelength_nm).chief_ray_mm)
    behind = lens.bundle(
        **field_arguments(field),
        wavelength_nm=lens.wavelength_nm,
        object_distance_m=source.object_distance_m,
        film_distance_mm=lens.film_distance_mm + step,
        arms=4,
        nodes=1,
    ).chief_ray_mm
    return on_film, (np.array(behind) - on_film) / step


def plot_spot_diagram(spots: SpotDiagram, axes: Axes, field: int = 0, plane: int = 0, half_mm: float = 0.0) -> None:
    """Plots the spot of one field and plane, given by their indices: all wavelengths, and the Airy disc's first dark
    ring.

    half_mm: half the side of the plotted square; 0 fits the spot.
    """
    marks = ("o", "s", "^")
    for w, (colour, label) in enumerate(style.coloured(spots.wavelengths_nm)):
        points_um = 1e3 * spots.points_mm[plane, field, w]
        axes.plot(
            points_um[:, 0],
            points_um[:, 1],
            marks[w % len(marks)],
            color=colour,
            markersize=1.6,
            markeredgewidth=0,
            alpha=0.8,
            label=label,
            rasterized=True,
        )
    angle = np.linspace(0, 2 * np.pi, 73)
    centre, radii = 1e3 * spots.centroid_mm[plane, field], 1e3 * spots.airy_radii_mm[field]
    axes.plot(
        centre[0] + radii[0] * np.cos(angle),
        centre[1] + radii[1] * np.sin(angle),
        color=style.text_colour(),
        linewidth=0.7,
        label="Airy",
    )
    half = 1e3 * (half_mm or half_side_mm(spots, field))
    axes.set_xlim(centre[0] - half, centre[0] + half)
    axes.set_ylim(centre[1] - half, centre[1] + half)
    axes.set_aspect("equal")
    axes.set_xlabel("x / µm")
    axes.set_ylabel("y / µm")
    defocus = f", {1e3 * spots.defocus_mm[plane]:+.3g} µm" if len(spots.defocus_mm) > 1 else ""
    film_point = None if spots.film_mm is None else spots.film_mm[field]
    radius_um = 1e3 * spots.rms_radius_mm[plane, field]
    title = f"{style.field_title(spots.fields_deg[field], film_point)}{defocus}, RMS {radius_um:.3g} µm"
    axes.set_title(title.replace("-", "−"))  # the same minus sign as on the axes


def half_side_mm(spots: SpotDiagram, field: int | None = None) -> float:
    """Half the side of a square about the centroid that contains the spots on all planes, of one field or of all."""
    chosen = slice(None) if field is None else slice(field, field + 1)
    offsets = spots.points_mm[:, chosen] - spots.centroid_mm[:, chosen, None, None]
    return 1.08 * max(float(np.nanmax(np.abs(offsets))), 1.3 * float(spots.airy_radii_mm[chosen].max()))
