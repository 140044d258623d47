"""All plots, by their names on the command line."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import matplotlib.figure
import numpy as np
from matplotlib.axes import Axes

from .._core import InputError, Lens
from . import style
from .bokeh import Bokeh, bokeh, plot_bokeh
from .depth_over_focus import DepthOverFocus, depth_over_focus, plot_depth_over_focus
from .distortion import Distortion, DistortionGrid, distortion, distortion_grid, plot_distortion, plot_distortion_grid
from .field_curves import FieldCurves, field_curves, plot_field_curves
from .field_map import QUANTITIES, FieldMap, field_map, plot_field_map
from .fields import Bundles, Doubles, field_angles_deg
from .film_pupil import FilmPupils, film_pupils, plot_pupil_shapes, plot_relative_illumination
from .lateral_colour import LateralColour, lateral_colour, plot_lateral_colour
from .mtf import (
    Mtf,
    mtf_over_field,
    mtf_over_frequency,
    mtf_through_focus,
    plot_mtf_over_field,
    plot_mtf_over_frequency,
    plot_mtf_through_focus,
)
from .point_spread import PointSpread, plot_point_spread, point_spread
from .ray_fan import RayFan, plot_ray_fan, ray_fan
from .seidel_bars import SeidelBars, plot_seidel_bars, seidel_bars
from .spherical_aberration import LongitudinalAberration, longitudinal_aberration, plot_longitudinal_aberration
from .spot_diagram import SpotDiagram, half_side_mm, plot_spot_diagram, spot_diagram
from .wavefront_map import WavefrontMap, plot_wavefront_map, wavefront_map
from .zernike import ZernikeFit, plot_zernike_fit, zernike_fit


@dataclass(frozen=True)
class Asked:
    """Parameters of a plot; None is the plot's default."""

    lens: Lens
    bundles: Bundles
    fields_deg: Doubles | None = None
    wavelengths_nm: Doubles | None = None
    frequencies_per_mm: Doubles | None = None
    method: str | None = None

    def one_field(self, share: float) -> float:
        if self.fields_deg is None:
            return float(field_angles_deg(self.lens, share, self.bundles)[0])
        if len(self.fields_deg) != 1:
            raise InputError(f"this plot is of one field; {len(self.fields_deg)} are given")
        return float(self.fields_deg[0])

    def one_wavelength(self) -> float | None:
        if self.wavelengths_nm is None:
            return None
        if len(self.wavelengths_nm) != 1:
            raise InputError(f"this plot is of one wavelength; {len(self.wavelengths_nm)} are given")
        return float(self.wavelengths_nm[0])

    @property
    def curves(self) -> dict[str, Any]:
        """Keyword arguments of most analyses."""
        return {
            "fields_deg": self.fields_deg,
            "wavelengths_nm": self.wavelengths_nm,
            "object_distance_m": self.bundles.object_distance_m,
            "bundles": self.bundles,
        }

    @property
    def one(self) -> dict[str, Any]:
        return {"wavelength_nm": self.one_wavelength(), "object_distance_m": self.bundles.object_distance_m}


@dataclass(frozen=True)
class Kind:
    """A kind of plot. help: one line. data: type of compute's result. shape: rows and columns of axes for the data.
    plot: plots the data on all axes."""

    help: str
    data: type
    compute: Callable[[Asked], Any]
    shape: Callable[[Any], tuple[int, int]]
    plot: Callable[[Any, np.ndarray], None]
    square: bool = False
    height: float = 1.0  #: of the figure, relative to `style.SIZES_IN`


def _single(plot: Callable[[Any, Axes], None]) -> dict[str, Any]:
    return {"shape": lambda _: (1, 1), "plot": lambda data, axes: plot(data, axes[0, 0])}


def _plot_fans(data: Any, axes: np.ndarray) -> None:
    for f in range(axes.shape[1]):
        plot_ray_fan(data, axes[0, f], f)
        plot_ray_fan(data, axes[1, f], f, sagittal=True)
    style.legend_beside(axes[0, -1])


def _plot_spots(data: Any, axes: np.ndarray) -> None:
    half = half_side_mm(data) if len(data.defocus_mm) > 1 else 0.0
    for d in range(axes.shape[0]):
        for f in range(axes.shape[1]):
            plot_spot_diagram(data, axes[d, f], f, d, half)
            if d + 1 < axes.shape[0]:
                axes[d, f].set_xlabel("")
    style.legend_beside(axes[0, -1], markerscale=3)


def _plot_bokeh(data: Any, axes: np.ndarray) -> None:
    for f in range(axes.shape[1]):
        plot_bokeh(data, axes[0, f], f)


def _through_focus(asked: Asked) -> Any:
    step = 2 * asked.lens.wavelength_nm * 1e-6 * asked.lens.first_order().f_number ** 2  # the depth of focus
    spread = spot_diagram(asked.lens, [0.0], rings=4, object_distance_m=asked.bundles.object_distance_m)
    step = max(step, float(spread.rms_radius_mm[0, 0]) * 2 * asked.lens.first_order().f_number)
    return spot_diagram(asked.lens, defocus_mm=step * np.array([-2, -1, 0, 1, 2]), **asked.curves)


def _spots_shape(data: Any) -> tuple[int, int]:
    return len(data.defocus_mm), len(data.fields_deg)


def _mtf(asked: Asked, compute: Callable[..., Any]) -> Any:
    given = {**asked.curves, "method": asked.method or "diffraction"}
    if compute is mtf_over_field:
        return compute(asked.lens, asked.frequencies_per_mm, **given)
    if compute is mtf_through_focus:
        frequencies = asked.frequencies_per_mm
        if frequencies is not None and len(frequencies) != 1:
            raise InputError(f"this plot is of one frequency; {len(frequencies)} are given")
        return compute(asked.lens, None if frequencies is None else float(frequencies[0]), **given)
    highest = None if asked.frequencies_per_mm is None else float(asked.frequencies_per_mm.max())
    return compute(asked.lens, highest_per_mm=highest, **given)


def _design_only(asked: Asked) -> dict[str, Any]:
    return {
        "wavelength_nm": asked.one_wavelength(),
        "object_distance_m": asked.bundles.object_distance_m,
        "bundles": asked.bundles,
    }


def _map_of(quantity: str) -> Kind:
    def compute(asked: Asked) -> FieldMap:
        frequencies = asked.frequencies_per_mm
        if frequencies is not None and len(frequencies) != 1:
            raise InputError(f"this plot is of one frequency; {len(frequencies)} are given")
        frequency = None if frequencies is None else float(frequencies[0])
        return field_map(asked.lens, quantity, frequency_per_mm=frequency, **_design_only(asked))

    return Kind(f"{QUANTITIES[quantity].title}, over the film", FieldMap, compute, **_single(plot_field_map))


KINDS_WITH_METHODS = ("mtf", "mtf-field", "mtf-focus", "psf")
KINDS: dict[str, Kind] = {
    "ray-fan": Kind(
        "where rays land, by where they cross the stop",
        RayFan,
        lambda a: ray_fan(a.lens, **a.curves),
        lambda data: (2, len(data.fields_deg)),
        _plot_fans,
    ),
    "spot": Kind(
        "where rays land", SpotDiagram, lambda a: spot_diagram(a.lens, **a.curves), _spots_shape, _plot_spots, True
    ),
    "spot-through-focus": Kind(
        "spots on planes beside the film", SpotDiagram, _through_focus, _spots_shape, _plot_spots, True
    ),
    "longitudinal": Kind(
        "where rays from the axis come back to it, by colour",
        LongitudinalAberration,
        lambda a: longitudinal_aberration(a.lens, a.wavelengths_nm, object_distance_m=a.bundles.object_distance_m),
        **_single(plot_longitudinal_aberration),
    ),
    "field-curves": Kind(
        "tangential and sagittal focus over the field",
        FieldCurves,
        lambda a: field_curves(a.lens, **a.curves),
        **_single(plot_field_curves),
    ),
    "distortion": Kind(
        "the chief ray against the paraxial one",
        Distortion,
        lambda a: distortion(a.lens, a.fields_deg, **_design_only(a)),
        **_single(plot_distortion),
    ),
    "distortion-grid": Kind(
        "a grid of squares as it appears on the film",
        DistortionGrid,
        lambda a: distortion_grid(a.lens, **_design_only(a)),
        **_single(plot_distortion_grid),
    ),
    "lateral-colour": Kind(
        "the image's size by colour",
        LateralColour,
        lambda a: lateral_colour(a.lens, **a.curves),
        **_single(plot_lateral_colour),
    ),
    "seidel": Kind(
        "third-order aberrations by surface",
        SeidelBars,
        lambda a: seidel_bars(
            a.lens,
            None if a.fields_deg is None else a.one_field(1),
            object_distance_m=a.bundles.object_distance_m,
            bundles=a.bundles,
        ),
        **_single(plot_seidel_bars),
    ),
    "wavefront": Kind(
        "optical path differences over the stop",
        WavefrontMap,
        lambda a: wavefront_map(a.lens, a.one_field(0), **a.one),
        **_single(plot_wavefront_map),
    ),
    "zernike": Kind(
        "the wavefront as Zernike polynomials, in Noll's order",
        ZernikeFit,
        lambda a: zernike_fit(a.lens, a.one_field(0), **a.one),
        **_single(plot_zernike_fit),
        height=1.1,
    ),
    "psf": Kind(
        "the light of a point on the film, with diffraction",
        PointSpread,
        lambda a: point_spread(
            a.lens,
            a.one_field(0),
            a.wavelengths_nm,
            method=a.method or "direct",
            size=128,
            object_distance_m=a.bundles.object_distance_m,
        ),
        **_single(plot_point_spread),
    ),
    "mtf": Kind(
        "contrast over frequency", Mtf, lambda a: _mtf(a, mtf_over_frequency), **_single(plot_mtf_over_frequency)
    ),
    "mtf-field": Kind(
        "contrast over the field", Mtf, lambda a: _mtf(a, mtf_over_field), **_single(plot_mtf_over_field)
    ),
    "mtf-focus": Kind(
        "contrast through focus", Mtf, lambda a: _mtf(a, mtf_through_focus), **_single(plot_mtf_through_focus)
    ),
    "relative-illumination": Kind(
        "the light of an even field on the film",
        FilmPupils,
        lambda a: film_pupils(a.lens, a.fields_deg, **_design_only(a)),
        **_single(plot_relative_illumination),
    ),
    "pupil": Kind(
        "the pupil's outline over the field: cat's eyes",
        FilmPupils,
        lambda a: film_pupils(a.lens, a.fields_deg, samples=5, **_design_only(a)),
        **_single(plot_pupil_shapes),
        height=0.5,
    ),
    **{f"{quantity}-map": _map_of(quantity) for quantity in QUANTITIES},
    "bokeh": Kind(
        "points out of focus",
        Bokeh,
        lambda a: bokeh(a.lens, a.fields_deg, a.wavelengths_nm, object_distance_m=a.bundles.object_distance_m),
        lambda data: (1, len(data.fields_deg)),
        _plot_bokeh,
        True,
    ),
    "depth-of-field": Kind(
        "what is sharp over the distance in focus, by aperture",
        DepthOverFocus,
        lambda a: depth_over_focus(a.lens),
        **_single(plot_depth_over_focus),
    ),
}


def compute(kind: str, asked: Asked) -> Any:
    """The data of a plot. Raises InputError for an unknown kind."""
    if kind not in KINDS:
        raise InputError(f'unknown plot "{kind}"; expected one of {", ".join(KINDS)}')
    if asked.method is not None and kind not in KINDS_WITH_METHODS:
        raise InputError(f"--method goes with {', '.join(KINDS_WITH_METHODS)}; {kind} has one way alone")
    return KINDS[kind].compute(asked)


def plot_figure(
    kind: str, data: Any, *, theme: str = "light", size: str = "large", title: str = ""
) -> matplotlib.figure.Figure:
    """A figure of the data. size: "small" or "large", by the inches of `style.SIZES_IN`."""
    if size not in style.SIZES_IN:
        raise InputError(f'unknown size "{size}"; expected small or large')
    width, height = style.SIZES_IN[size]
    height *= KINDS[kind].height
    rows, columns = KINDS[kind].shape(data)
    if rows * columns > 1:  # several plots: each at least at a readable size
        width = max(width, (1.4 if size == "small" else 2.5) * columns + 0.8)
        each = (0.9 if KINDS[kind].square else 0.8) * width / columns
        height = each * rows + (0.5 if title else 0)
    font = 8.0 if size == "small" else 10.0
    if rows * columns > 1:
        font *= 0.8
    with style.themed(theme, font):
        figure = style.new_figure(width, height)
        axes = np.array(figure.subplots(rows, columns, squeeze=False))
        KINDS[kind].plot(data, axes)
        if title:
            figure.suptitle(title, fontsize=font, parse_math=False)
    return figure
