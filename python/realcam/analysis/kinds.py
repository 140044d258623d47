"""All plots of the analyses, by their names in `realcam lens plot`."""

from __future__ import annotations

from collections.abc import Callable, Sequence
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
class PlotArguments:
    """Arguments of a plot, with a cache of ray bundles for several plots. None stands for the plot's default.

    fields_deg: (F,); wavelengths_nm: (W,); frequencies_per_mm: (K,), periods per mm on the film.
    method: of the MTF and the point spread function. PlotKind.options are those that apply to a plot.
    """

    lens: Lens
    bundles: Bundles
    fields_deg: Sequence[float] | Doubles | None = None
    wavelengths_nm: Sequence[float] | Doubles | None = None
    frequencies_per_mm: Sequence[float] | Doubles | None = None
    method: str | None = None

    def field_deg(self, default_height: float) -> float:
        """Field angle of a plot of one field. Raises InputError if several are specified.

        default_height: fraction of the largest image height that is reached by the chief ray of the default field.
        """
        field = _only_value(self.fields_deg, "field")
        return float(field_angles_deg(self.lens, default_height, self.bundles)[0]) if field is None else field

    def wavelength_nm(self) -> float | None:
        """The wavelength of a plot of one wavelength. Raises InputError if several are specified."""
        return _only_value(self.wavelengths_nm, "wavelength")

    def frequency_per_mm(self) -> float | None:
        """The frequency of a plot of one frequency. Raises InputError if several are specified."""
        return _only_value(self.frequencies_per_mm, "frequency")

    @property
    def fields_and_wavelengths(self) -> dict[str, Any]:
        """Keyword arguments of analyses over several fields and wavelengths."""
        return {
            "fields_deg": self.fields_deg,
            "wavelengths_nm": self.wavelengths_nm,
            "object_distance_m": self.bundles.object_distance_m,
            "bundles": self.bundles,
        }

    @property
    def monochromatic(self) -> dict[str, Any]:
        """Keyword arguments of analyses at one wavelength. Raises InputError if several are specified."""
        return {"wavelength_nm": self.wavelength_nm(), "object_distance_m": self.bundles.object_distance_m}


def _only_value(values: Sequence[float] | Doubles | None, name: str) -> float | None:
    """The only one of the values; None if none is specified. Raises InputError if there are several."""
    if values is None:
        return None
    if len(values) != 1:
        raise InputError(f"this plot is of one {name}; {len(values)} are given")
    return float(values[0])


# Options of `realcam lens plot`, and the arguments that they set.
_FIELDS, _WAVELENGTHS, _DISTANCE = "--fields-deg", "--wavelengths", "--object-distance"
_FREQUENCIES, _METHOD = "--frequencies", "--method"
_ARGUMENTS: dict[str, Callable[[PlotArguments], Any]] = {
    _FIELDS: lambda a: a.fields_deg,
    _WAVELENGTHS: lambda a: a.wavelengths_nm,
    _DISTANCE: lambda a: a.bundles.object_distance_m,
    _FREQUENCIES: lambda a: a.frequencies_per_mm,
    _METHOD: lambda a: a.method,
}


@dataclass(frozen=True)
class PlotKind:
    """A kind of plot."""

    data: type  #: type of the result of `compute`
    compute: Callable[[PlotArguments], Any]
    shape: Callable[[Any], tuple[int, int]]  #: number of rows and columns of axes for the data
    plot: Callable[[Any, np.ndarray], None]  #: plots the data on an array of axes of that shape
    square: bool = False  #: True if the axes are square
    height: float = 1.0  #: height of the figure, relative to `style.SIZES_IN`
    options: tuple[str, ...] = (_FIELDS, _WAVELENGTHS, _DISTANCE)  #: options of the command line that apply


def _single(plot: Callable[[Any, Axes], None]) -> dict[str, Any]:
    """`shape` and `plot` of a PlotKind with a single axes."""
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


def _spots_through_focus(arguments: PlotArguments) -> Any:
    """Spots on five planes, spaced by half the depth of focus: 2 lambda N^2 of diffraction, or the RMS spot's diameter
    times N if that is larger, with the f-number N."""
    lens = arguments.lens
    step_mm = 2 * lens.wavelength_nm * 1e-6 * lens.first_order().f_number ** 2
    axial = spot_diagram(lens, [0.0], rings=4, object_distance_m=arguments.bundles.object_distance_m)
    step_mm = max(step_mm, float(axial.rms_radius_mm[0, 0]) * 2 * lens.first_order().f_number)
    return spot_diagram(lens, defocus_mm=step_mm * np.array([-2, -1, 0, 1, 2]), **arguments.fields_and_wavelengths)


def _spots_shape(data: Any) -> tuple[int, int]:
    return len(data.defocus_mm), len(data.fields_deg)


def _mtf(arguments: PlotArguments, compute: Callable[..., Any]) -> Any:
    """Calls mtf_over_frequency, mtf_over_field or mtf_through_focus."""
    lens, keywords = arguments.lens, {**arguments.fields_and_wavelengths, "method": arguments.method or "diffraction"}
    if compute is mtf_over_field:
        return compute(lens, arguments.frequencies_per_mm, **keywords)
    if compute is mtf_through_focus:
        return compute(lens, arguments.frequency_per_mm(), **keywords)
    return compute(lens, highest_per_mm=arguments.frequency_per_mm(), **keywords)


def _monochromatic_with_bundles(arguments: PlotArguments) -> dict[str, Any]:
    """Keyword arguments of analyses at one wavelength that take ray bundles."""
    return {**arguments.monochromatic, "bundles": arguments.bundles}


def _map_of(quantity: str) -> PlotKind:
    """Returns the kind of plot of one of field_map's QUANTITIES."""

    def compute(arguments: PlotArguments) -> FieldMap:
        frequency = arguments.frequency_per_mm()
        return field_map(arguments.lens, quantity, frequency_per_mm=frequency, **_monochromatic_with_bundles(arguments))

    options = {
        "illumination": (_WAVELENGTHS,),
        "distortion": (),
        "mtf-x": (_WAVELENGTHS, _DISTANCE, _FREQUENCIES),
        "mtf-y": (_WAVELENGTHS, _DISTANCE, _FREQUENCIES),
    }.get(quantity, (_WAVELENGTHS, _DISTANCE))
    return PlotKind(FieldMap, compute, options=options, **_single(plot_field_map))


_MTF = (_FIELDS, _WAVELENGTHS, _DISTANCE, _FREQUENCIES, _METHOD)
KINDS: dict[str, PlotKind] = {
    "ray-fan": PlotKind(
        RayFan,
        lambda a: ray_fan(a.lens, **a.fields_and_wavelengths),
        lambda data: (2, len(data.fields_deg)),
        _plot_fans,
    ),
    "spot": PlotKind(
        SpotDiagram,
        lambda a: spot_diagram(a.lens, **a.fields_and_wavelengths),
        _spots_shape,
        _plot_spots,
        True,
    ),
    "spot-through-focus": PlotKind(
        SpotDiagram,
        _spots_through_focus,
        _spots_shape,
        _plot_spots,
        True,
    ),
    "longitudinal": PlotKind(
        LongitudinalAberration,
        lambda a: longitudinal_aberration(a.lens, a.wavelengths_nm, object_distance_m=a.bundles.object_distance_m),
        options=(_WAVELENGTHS, _DISTANCE),
        **_single(plot_longitudinal_aberration),
    ),
    "field-curves": PlotKind(
        FieldCurves,
        lambda a: field_curves(a.lens, **a.fields_and_wavelengths),
        **_single(plot_field_curves),
    ),
    "distortion": PlotKind(
        Distortion,
        lambda a: distortion(a.lens, a.fields_deg, **_monochromatic_with_bundles(a)),
        **_single(plot_distortion),
    ),
    "distortion-grid": PlotKind(
        DistortionGrid,
        lambda a: distortion_grid(a.lens, **_monochromatic_with_bundles(a)),
        options=(_WAVELENGTHS, _DISTANCE),
        **_single(plot_distortion_grid),
    ),
    "lateral-colour": PlotKind(
        LateralColour,
        lambda a: lateral_colour(a.lens, **a.fields_and_wavelengths),
        **_single(plot_lateral_colour),
    ),
    "seidel": PlotKind(
        SeidelBars,
        lambda a: seidel_bars(
            a.lens,
            None if a.fields_deg is None else a.field_deg(1),
            object_distance_m=a.bundles.object_distance_m,
            bundles=a.bundles,
        ),
        options=(_FIELDS, _DISTANCE),
        **_single(plot_seidel_bars),
    ),
    "wavefront": PlotKind(
        WavefrontMap,
        lambda a: wavefront_map(a.lens, a.field_deg(0), **a.monochromatic),
        **_single(plot_wavefront_map),
    ),
    "zernike": PlotKind(
        ZernikeFit,
        lambda a: zernike_fit(a.lens, a.field_deg(0), **a.monochromatic),
        **_single(plot_zernike_fit),
        height=1.1,
    ),
    "psf": PlotKind(
        PointSpread,
        lambda a: point_spread(
            a.lens,
            a.field_deg(0),
            a.wavelengths_nm,
            method=a.method or "direct",
            size=128,
            object_distance_m=a.bundles.object_distance_m,
        ),
        options=(_FIELDS, _WAVELENGTHS, _DISTANCE, _METHOD),
        **_single(plot_point_spread),
    ),
    "mtf": PlotKind(Mtf, lambda a: _mtf(a, mtf_over_frequency), options=_MTF, **_single(plot_mtf_over_frequency)),
    "mtf-field": PlotKind(Mtf, lambda a: _mtf(a, mtf_over_field), options=_MTF, **_single(plot_mtf_over_field)),
    "mtf-focus": PlotKind(Mtf, lambda a: _mtf(a, mtf_through_focus), options=_MTF, **_single(plot_mtf_through_focus)),
    "relative-illumination": PlotKind(
        FilmPupils,
        lambda a: film_pupils(a.lens, a.fields_deg, **_monochromatic_with_bundles(a)),
        **_single(plot_relative_illumination),
    ),
    "pupil": PlotKind(
        FilmPupils,
        lambda a: film_pupils(a.lens, a.fields_deg, samples=5, **_monochromatic_with_bundles(a)),
        **_single(plot_pupil_shapes),
        height=0.5,
    ),
    **{f"{quantity}-map": _map_of(quantity) for quantity in QUANTITIES},
    "bokeh": PlotKind(
        Bokeh,
        lambda a: bokeh(a.lens, a.fields_deg, a.wavelengths_nm, object_distance_m=a.bundles.object_distance_m),
        lambda data: (1, len(data.fields_deg)),
        _plot_bokeh,
        True,
    ),
    "depth-of-field": PlotKind(
        DepthOverFocus,
        lambda a: depth_over_focus(a.lens),
        options=(),
        **_single(plot_depth_over_focus),
    ),
}


def compute(kind: str, arguments: PlotArguments) -> Any:
    """Computes the data of a plot. Raises InputError for an unknown kind, and for arguments that do not apply to it."""
    if kind not in KINDS:
        raise InputError(f'unknown plot "{kind}"; expected one of {", ".join(KINDS)}')
    options = KINDS[kind].options
    for option, argument in _ARGUMENTS.items():
        if argument(arguments) is not None and option not in options:
            raise InputError(f"the plot {kind} takes no {option}, only {', '.join(options) or 'options of the lens'}")
    return KINDS[kind].compute(arguments)


def plot_figure(
    kind: str, data: Any, *, theme: str = "light", size: str = "large", title: str = ""
) -> matplotlib.figure.Figure:
    """Plots the data of a kind of plot on a new figure.

    data: result of `compute` for the same kind. theme: "light" or "dark". size: "small" or "large", see
    `style.SIZES_IN`; several plots on one figure may enlarge it. Raises InputError for an unknown size or theme.
    """
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
