"""Plots of a report: rays, contrast and colour, waves and light."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Callable
from functools import partial
from typing import Any

import matplotlib
import matplotlib.figure
import matplotlib.ticker
import numpy as np
from matplotlib.axes import Axes

from .._core import InputError
from ..fields import FieldPosition, field_arguments
from .bokeh import bokeh, plot_bokeh
from .distortion import distortion, distortion_grid, plot_distortion, plot_distortion_grid
from .field_curves import field_curves, plot_field_curves
from .field_map import QUANTITIES, field_map, plot_field_map
from .fields import Bundles, Doubles, field_angles_deg
from .film_pupil import film_pupils, plot_pupil_shapes, plot_relative_illumination
from .lateral_colour import lateral_colour, plot_lateral_colour
from .mtf import (
    Mtf,
    mtf_over_field,
    mtf_over_frequency,
    mtf_through_focus,
    plot_mtf_over_field,
    plot_mtf_over_frequency,
    plot_mtf_through_focus,
)
from .point_spread import plot_point_spread, point_spread
from .pupil_function import UnevenWavefrontError
from .ray_fan import plot_ray_fan, ray_fan
from .seidel_bars import plot_seidel_bars, seidel_bars
from .spherical_aberration import longitudinal_aberration, plot_longitudinal_aberration
from .spot_diagram import plot_spot_diagram, spot_diagram
from .wavefront_map import plot_wavefront_map, wavefront_map
from .zernike import plot_zernike_fit, zernike_fit

PAGE_IN = (8.27, 11.69)  # A4
PLOTS_TOP = 0.94  # upper end of the plots, as a fraction of the page's height; headings follow above
SIDE = {"left": 0.085, "right": 0.975}


class ReportPlots:
    """Plots of a rotationally symmetric lens, one figure per subject, in the current theme.

    source: ray bundles of the lens. fields: (3,), degrees; colours: (W,), wavelengths, nm.
    """

    def __init__(self, source: Bundles, fields: Doubles, colours: Doubles) -> None:
        self.lens, self.source, self.fields, self.colours = source.lens, source, fields, colours
        self.mtf_method = "diffraction"
        self.common: dict[str, Any] = {"object_distance_m": source.object_distance_m, "bundles": source}
        self.at_fields: dict[str, Any] = {**self.common, "fields_deg": fields, "wavelengths_nm": colours}
        # All curves over the field share one set of fields, and so the ray bundles.
        largest = float(np.abs(fields).max())
        self.scan: Doubles = field_angles_deg(self.lens, np.linspace(0, 1, 51), source)
        if not math.isclose(self.scan[-1], largest, rel_tol=1e-3):
            self.scan = np.linspace(0, largest, 51)
        self.over_field: dict[str, Any] = {**self.common, "fields_deg": self.scan}
        # Curves that need only chief rays are cheap, and get more fields.
        fine = np.interp(np.linspace(0, 50, 101), np.arange(51), self.scan)
        self.chief_rays: dict[str, Any] = {**self.common, "fields_deg": fine}

    @property
    def drawings(self) -> list[dict[str, Any]]:
        """Cross-sections of the lens, as arguments of Lens.draw."""
        return [{"fields_deg": self.fields.tolist(), "object_distance_m": self.source.object_distance_m}]

    def pages(self) -> list[tuple[str, matplotlib.figure.Figure]]:
        """Subjects and their figures, of size PAGE_IN; the area above PLOTS_TOP is free for headings."""
        # A fixed title position: matplotlib's placement around all ticks takes a sixth of the time.
        with matplotlib.rc_context({"axes.titley": 1.02}):
            pages = self._pages()
        for axes in (axes for _, page in pages for axes in page.axes):
            for axis in (axes.xaxis, axes.yaxis):
                locator = axis.get_major_locator()
                if isinstance(locator, matplotlib.ticker.MaxNLocator):
                    locator.set_params(nbins=5)
        return pages

    def _pages(self) -> list[tuple[str, matplotlib.figure.Figure]]:
        return [
            ("Rays", self.rays()),
            ("Contrast and colour", self.contrast()),
            ("Waves and light", self.light()),
        ]

    def rays(self) -> matplotlib.figure.Figure:
        """Page of ray fans, spots, longitudinal aberration, field curves and distortion."""
        figure = matplotlib.figure.Figure(figsize=PAGE_IN)
        grid = figure.add_gridspec(4, 3, top=0.9, bottom=0.05, hspace=0.42, wspace=0.34, **SIDE)
        fans = ray_fan(self.lens, samples=45, **self.at_fields)
        spots = spot_diagram(self.lens, **self.at_fields)
        for f in range(3):
            plot_ray_fan(fans, figure.add_subplot(grid[0, f]), f)
            plot_ray_fan(fans, figure.add_subplot(grid[1, f]), f, sagittal=True)
            plot_spot_diagram(spots, figure.add_subplot(grid[2, f]), f)
        handles, labels = figure.axes[2].get_legend_handles_labels()
        figure.legend(handles, labels, loc="upper right", ncols=4, bbox_to_anchor=(0.975, 0.938), markerscale=3)
        _add_plot(figure, grid[3, 0], self._longitudinal, plot_longitudinal_aberration)
        _add_plot(figure, grid[3, 1], lambda: field_curves(self.lens, **self.chief_rays), plot_field_curves)
        _add_plot(figure, grid[3, 2], lambda: distortion(self.lens, **self.chief_rays), plot_distortion)
        return figure

    def contrast(self) -> matplotlib.figure.Figure:
        """Page of MTF, lateral colour and Seidel sums."""
        figure = matplotlib.figure.Figure(figsize=PAGE_IN)
        grid = figure.add_gridspec(3, 2, top=0.91, bottom=0.095, hspace=0.3, wspace=0.5, left=0.085, right=0.86)
        over = {**self.over_field, "wavelengths_nm": self.colours}
        for cell, compute, plot in (
            (grid[0, 0], lambda: self._mtf(mtf_over_frequency, **self.at_fields), plot_mtf_over_frequency),
            (grid[0, 1], lambda: self._mtf(mtf_through_focus, **self.at_fields), plot_mtf_through_focus),
            (grid[1, 0], lambda: self._mtf(mtf_over_field, **over), plot_mtf_over_field),
            (grid[1, 1], lambda: lateral_colour(self.lens, **{**over, **self.chief_rays}), plot_lateral_colour),
            (grid[2, :], self._seidel, plot_seidel_bars),
        ):
            _add_plot(figure, cell, compute, plot)
        return figure

    def light(self) -> matplotlib.figure.Figure:
        """Page of wavefronts, point spread functions, pupils, illumination, Zernike terms, distortion and bokeh."""
        figure = matplotlib.figure.Figure(figsize=PAGE_IN)
        grid = figure.add_gridspec(4, 3, top=0.92, bottom=0.05, hspace=0.4, wspace=0.5, left=0.085, right=0.95)
        distance = self.source.object_distance_m
        for f, field in enumerate(self.fields):
            _add_plot(
                figure,
                grid[0, f],
                partial(wavefront_map, self.lens, float(field), samples=64, object_distance_m=distance),
                plot_wavefront_map,
            )
            _add_plot(figure, grid[1, f], partial(self._psf, float(field)), plot_point_spread)
        _add_plot(
            figure, grid[2, :2], lambda: film_pupils(self.lens, self.scan[::10], **self.common), plot_pupil_shapes
        )
        _add_plot(
            figure,
            grid[2, 2],
            lambda: film_pupils(self.lens, self.scan[::2], **self.common),
            plot_relative_illumination,
        )
        _add_plot(
            figure,
            grid[3, 0].subgridspec(1, 2, width_ratios=(0.45, 0.55), wspace=0)[1],  # leaves room for names
            lambda: zernike_fit(self.lens, float(self.fields[1]), samples=24, object_distance_m=distance),
            plot_zernike_fit,
        )
        _add_plot(figure, grid[3, 1], lambda: distortion_grid(self.lens, **self.common), plot_distortion_grid)
        _add_plot(
            figure,
            grid[3, 2],
            lambda: bokeh(self.lens, self.fields[1:2], self.colours, rays=100000, size=72),
            plot_bokeh,
        )
        return figure

    def _longitudinal(self) -> Any:
        return longitudinal_aberration(
            self.lens, self.colours, samples=25, object_distance_m=self.source.object_distance_m
        )

    def _seidel(self) -> Any:
        return seidel_bars(self.lens, min(float(np.abs(self.fields).max()), 60.0), **self.common)

    def _mtf(self, compute: Callable[..., Mtf], **keywords: Any) -> Mtf:
        """Diffraction MTF. A wavefront that is too uneven for it switches this and all later plots to geometric MTF."""
        try:
            return compute(self.lens, method=self.mtf_method, **keywords)
        except UnevenWavefrontError:
            self.mtf_method = "geometric"
            return compute(self.lens, method=self.mtf_method, **keywords)

    def _psf(self, field: FieldPosition) -> Any:
        """Point spread function; geometric for wide spots, for which diffraction would take seconds."""
        bundle = self.source.at(field, self.lens.wavelength_nm)
        spot = float(np.ptp(bundle.points_mm, axis=0).max())
        # Wavelength x f-number in the direction of the wider pupil, mm.
        detail = 1e-6 * bundle.wavelength_nm / float(np.ptp(bundle.edge_slopes.reshape(-1, 2), axis=0).max())
        geometric = {"method": "geometric", "pitch_um": 1e3 * 1.3 * spot / 64} if spot > 60 * detail else {}
        return point_spread(
            self.lens,
            **field_arguments(field),
            size=64,
            object_distance_m=self.source.object_distance_m,
            **geometric,  # type: ignore[arg-type]
        )


class FilmPlots(ReportPlots):
    """Plots of a lens without rotational symmetry: maps over the film, and plots at four film points."""

    def __init__(self, source: Bundles, colours: Doubles) -> None:
        self.lens, self.source, self.colours = source.lens, source, colours
        half = 0.5 * np.array(self.lens.film_mm)
        self.points = [(float(x), float(y)) for x, y in half * np.array([(0, 0), (0.7, 0), (0, 0.7), (0.7, 0.7)])]

    @property
    def drawings(self) -> list[dict[str, Any]]:
        return [{"plane": plane, "object_distance_m": self.source.object_distance_m} for plane in ("yz", "xz")]

    def _pages(self) -> list[tuple[str, matplotlib.figure.Figure]]:
        return [("Over the film", self.maps()), ("Points of the film", self.film_points())]

    def maps(self) -> matplotlib.figure.Figure:
        """Page of maps over the film."""
        figure = matplotlib.figure.Figure(figsize=PAGE_IN)
        grid = figure.add_gridspec(3, 2, top=0.91, bottom=0.06, hspace=0.3, wspace=0.3, **SIDE)
        for k, quantity in enumerate(QUANTITIES):
            compute = partial(field_map, self.lens, quantity, points=(9, 7), bundles=self.source)
            _add_plot(figure, grid[k // 2, k % 2], compute, plot_field_map)
        return figure

    def film_points(self) -> matplotlib.figure.Figure:
        """Page of spots, wavefronts and point spread functions at four film points."""
        figure = matplotlib.figure.Figure(figsize=PAGE_IN)
        grid = figure.add_gridspec(4, 3, top=0.91, bottom=0.05, hspace=0.45, wspace=0.5, left=0.085, right=0.95)
        for k, point in enumerate(self.points):
            spot = partial(spot_diagram, self.lens, wavelengths_nm=self.colours, film_mm=[point], bundles=self.source)
            wavefront = partial(
                wavefront_map, self.lens, film_mm=point, samples=64, object_distance_m=self.source.object_distance_m
            )
            _add_plot(figure, grid[k, 0], spot, plot_spot_diagram)
            _add_plot(figure, grid[k, 1], wavefront, plot_wavefront_map)
            _add_plot(figure, grid[k, 2], partial(self._psf, point), plot_point_spread)
        for axes in figure.axes:
            handles, labels = axes.get_legend_handles_labels()
            if handles:
                figure.legend(handles, labels, loc="upper right", ncols=4, bbox_to_anchor=(0.95, 0.945), markerscale=3)
                break
        return figure


def _add_plot(
    figure: matplotlib.figure.Figure, cell: Any, compute: Callable[[], Any], plot: Callable[[Any, Axes], None]
) -> None:
    """Adds a plot; if its computation raises InputError, writes the reason in its place."""
    axes = figure.add_subplot(cell)
    try:
        plot(compute(), axes)
    except InputError as error:
        axes.set_axis_off()
        # Wrapped to the plot's width, because matplotlib wraps to the page. A character's width is about half its size.
        width_in = axes.get_position().width * figure.get_size_inches()[0]
        characters = max(int(72 * width_in / (0.55 * matplotlib.rcParams["font.size"])), 12)
        reason = textwrap.fill(str(error), characters)
        axes.text(0.5, 0.5, reason, ha="center", va="center", parse_math=False)
