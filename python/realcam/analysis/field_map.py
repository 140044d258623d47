"""Maps over the film, for any symmetry: spots, wavefronts, MTF, illumination and distortion."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes

from .._core import InputError, Lens, RayStatus
from ..fields import STOP_PROBES, area_weighted_spot
from ..short_text import ShortText
from . import style
from .fields import Bundles, Doubles, bundles_of, default_frequencies_per_mm, frequencies_of
from .mtf import diffraction_transfer

Point = tuple[float, float]


@dataclass(frozen=True, repr=False)
class FieldMap(ShortText):
    """A quantity at X x Y points of the film.

    x_mm: (X,), y_mm: (Y,), from the film's centre. values: (Y, X), in `unit`; nan where no light arrives.
    vectors_mm: (Y, X, 2), for "distortion": displacement of the chief ray's film point from the undistorted one.
    frequency_per_mm: for "mtf-x" and "mtf-y", periods per mm.
    """

    quantity: str
    unit: str
    x_mm: Doubles
    y_mm: Doubles
    values: Doubles
    vectors_mm: Doubles | None
    frequency_per_mm: float | None


@dataclass(frozen=True)
class _Quantity:
    title: str  #: of the plot
    unit: str
    #: Value at a film point, from the bundles, the point, the wavelength in nm, and the frequency in periods per mm.
    #: Raises InputError without light.
    compute: Callable[[Bundles, Point, float, float], float]


def _spot(source: Bundles, point: Point, nm: float, _: float) -> float:
    spot = area_weighted_spot(source.lens, film_mm=point, wavelength_nm=nm, object_distance_m=source.object_distance_m)
    return 1e3 * spot.rms_radius_mm


def _wavefront(source: Bundles, point: Point, nm: float, _: float) -> float:
    return source.lens.wavefront(
        film_mm=point, wavelength_nm=nm, object_distance_m=source.object_distance_m, pattern="rings", samples=8
    ).rms_waves


def _mtf_along(axis: int) -> Callable[[Bundles, Point, float, float], float]:
    def mtf(source: Bundles, point: Point, nm: float, frequency: float) -> float:
        transfer = diffraction_transfer(source, point, nm, np.array([frequency]), np.zeros(1))
        return float(np.abs(transfer.otf[axis, 0, 0]))

    return mtf


QUANTITIES = {
    "spot": _Quantity("RMS radius of the spot", "µm", _spot),
    "wavefront": _Quantity("RMS wavefront error", "waves", _wavefront),
    "mtf-x": _Quantity("contrast of a pattern along x", "", _mtf_along(1)),
    "mtf-y": _Quantity("contrast of a pattern along y", "", _mtf_along(0)),
    "illumination": _Quantity(
        "illumination, relative to the film's centre",
        "%",
        lambda source, point, nm, _: source.lens.film_pupil(point, nm).irradiance,
    ),
    "distortion": _Quantity(
        "distortion, relative to half the film's diagonal", "%", lambda *_: np.nan
    ),  # by _distortion
}


def field_map(
    lens: Lens,
    quantity: str = "spot",
    *,
    points: tuple[int, int] = (13, 9),
    wavelength_nm: float | None = None,
    frequency_per_mm: float | None = None,
    object_distance_m: float | None = None,
    bundles: Bundles | None = None,
) -> FieldMap:
    """A map of one of QUANTITIES over the film, whatever symmetry the lens has.

    points: number along x and y, up to the film's edges. frequency_per_mm: of mtf-x and mtf-y; None is 20 for a film
    diagonal of 43 mm, scaled inversely for others. wavelength_nm: None is the design wavelength.
    object_distance_m: object plane to front vertex; None is that of `bundles`, else the plane in focus. bundles: cache
    of ray bundles that several analyses of the same lens and object distance share; None makes one for this call.
    Distortion is relative to the perspective picture that matches the lens's first order at the film's centre in both
    directions; for an anamorphic lens that picture is squeezed. Raises InputError.
    """
    if quantity not in QUANTITIES:
        raise InputError(f'unknown quantity "{quantity}"; expected one of {", ".join(QUANTITIES)}')
    if min(points) < 2:
        raise InputError("points must be at least 2 along x and along y")
    source = bundles_of(lens, object_distance_m, bundles)
    nm = lens.wavelength_nm if wavelength_nm is None else wavelength_nm
    middle = default_frequencies_per_mm(lens)[1] if frequency_per_mm is None else frequency_per_mm
    frequency = float(frequencies_of(middle, "frequency_per_mm").max())
    x, y = (half * np.linspace(-1, 1, n) for half, n in zip(0.5 * np.array(lens.film_mm), points, strict=True))
    vectors = None
    if quantity == "distortion":
        vectors = _distortion(lens, x, y)
        values = 100 * np.hypot(*np.moveaxis(vectors, 2, 0)) / (0.5 * np.hypot(*lens.film_mm))
    else:
        values = np.array(
            [[_or_nan(QUANTITIES[quantity].compute, source, (float(a), float(b)), nm, frequency) for a in x] for b in y]
        )
    if quantity == "illumination":
        values = 100 * values / lens.film_pupil((0.0, 0.0), nm).irradiance
    if np.isnan(values).all():
        raise InputError(f'no light through lens "{lens.name}" reaches any of the film points')
    mtf_frequency = frequency if quantity.startswith("mtf") else None
    return FieldMap(quantity, QUANTITIES[quantity].unit, x, y, values, vectors, mtf_frequency)


def _or_nan(
    compute: Callable[[Bundles, Point, float, float], float], source: Bundles, point: Point, nm: float, frequency: float
) -> float:
    try:
        return compute(source, point, nm, frequency)
    except InputError:  # outside the illuminated field
        return np.nan


def _tangents(lens: Lens, point: Point) -> Doubles:
    """(2,): dx/dz and dy/dz in object space of a film point's chief ray; nan without light.

    If the centre of the stop is obstructed, uses another ray: those of a point at infinity are parallel.
    """
    try:
        rays = lens.aim(STOP_PROBES, film_mm=point, object_distance_m=np.inf)
    except InputError:
        return np.full(2, np.nan)
    passing = np.flatnonzero(rays.status == RayStatus.OK)
    if not passing.size:
        return np.full(2, np.nan)
    direction = rays.directions[passing[0]]
    tangents: Doubles = direction[:2] / direction[2]
    return tangents


def _distortion(lens: Lens, x: Doubles, y: Doubles) -> Doubles:
    """(Y, X, 2), mm: displacements of the chief rays' film points, as FieldMap.vectors_mm; nan without light."""
    step = 1e-4 * float(np.hypot(*lens.film_mm))
    by_x, by_y = (
        (_tangents(lens, (step * (1 - k), step * k)) - _tangents(lens, (-step * (1 - k), -step * k))) / (2 * step)
        for k in (0, 1)
    )
    picture = np.linalg.inv(np.column_stack([by_x, by_y]))  # mm on the film per change of the tangents
    middle = _tangents(lens, (0.0, 0.0))
    points = np.stack(np.meshgrid(x, y), axis=-1)
    tangents = np.array([[_tangents(lens, (float(a), float(b))) for a in x] for b in y])
    vectors: Doubles = points - (tangents - middle) @ picture.T
    return vectors


def plot_field_map(data: FieldMap, axes: Axes) -> None:
    """Plots the map in film coordinates (not upright), for distortion also the ideal and the distorted grid."""
    title = QUANTITIES[data.quantity].title
    if data.frequency_per_mm is not None:
        title += f" at {data.frequency_per_mm:.4g}/mm"
    mesh = axes.pcolormesh(data.x_mm, data.y_mm, data.values, shading="gouraud", cmap="viridis")
    style.colour_bar(axes, mesh, data.unit)
    if data.vectors_mm is not None:
        distorted = np.stack(np.meshgrid(data.x_mm, data.y_mm), axis=-1)
        ideal = distorted - data.vectors_mm
        for lines, colour in ((ideal, style.GREY), (distorted, "white")):
            for family in (lines, lines.swapaxes(0, 1)):
                for line in family:
                    axes.plot(line[:, 0], line[:, 1], color=colour, linewidth=0.7)
    axes.set_aspect("equal")
    axes.grid(visible=False)
    axes.set_xlabel("x on the film / mm")
    axes.set_ylabel("y on the film / mm")
    axes.set_title(title)
