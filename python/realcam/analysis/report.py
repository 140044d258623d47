"""All of a lens on three pages."""

from __future__ import annotations

import html
import io
import math
import os
import textwrap
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import matplotlib
import matplotlib.figure
import matplotlib.ticker
import numpy as np
from matplotlib.axes import Axes
from numpy.typing import ArrayLike

from .. import files
from .._core import ImageFileError, InputError, Lens
from ..drawing.themes import theme_named
from ..figure_files import figure_bytes
from . import style
from .bokeh import bokeh, plot_bokeh
from .distortion import distortion, distortion_grid, plot_distortion, plot_distortion_grid
from .field_curves import field_curves, plot_field_curves
from .fields import Bundles, Doubles, bundles_of, field_angles_deg, three_fields, wavelengths_of
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

PAGE_IN = (8.27, 11.69)
SIDE = {"left": 0.085, "right": 0.975}


def save_report(
    lens: Lens,
    path: str | os.PathLike[str],
    *,
    fields_deg: ArrayLike | None = None,
    wavelengths_nm: ArrayLike | None = None,
    object_distance_m: float | None = None,
    theme: str = "light",
) -> None:
    """Writes .pdf, or .html that holds all it shows.

    fields_deg: three; None is the axis, 0.7 and all of the image height. wavelengths_nm: None is F line, design
    wavelength and C line. object_distance_m: object plane to front vertex; None is the plane in focus.
    What a lens cannot have (a plane grid of a fisheye, say) has its reason in its place.
    Raises ImageFileError for the file, and InputError where no light passes.
    """
    target = Path(path)
    if target.suffix.lower() not in (".pdf", ".html"):
        raise ImageFileError(f"{target}: unknown suffix; .pdf or .html is wanted")
    files.check_target(target)
    source = bundles_of(lens, object_distance_m, None)
    fields = three_fields(lens, fields_deg, source)
    if len(fields) != 3:
        raise InputError(f"a report shows three fields; {len(fields)} are given")
    with style.themed(theme, 7.0):
        pages, report = report_pages(source, fields, wavelengths_of(lens, wavelengths_nm))
        content = _pdf(pages) if target.suffix.lower() == ".pdf" else _html(report, pages, theme)
    files.write_whole(target, content)


def report_pages(source: Bundles, fields: Doubles, colours: Doubles) -> tuple[list[matplotlib.figure.Figure], _Report]:
    """The pages, in the theme in force."""
    report = _Report(source, fields, colours)
    # Titles keep their place: matplotlib would look for it around all ticks, which takes a sixth of the time.
    with matplotlib.rc_context({"axes.titley": 1.02}):
        pages = [report.rays(), report.contrast(), report.light()]
    for axes in (axes for page in pages for axes in page.axes):
        for axis in (axes.xaxis, axes.yaxis):
            locator = axis.get_major_locator()
            if isinstance(locator, matplotlib.ticker.MaxNLocator):
                locator.set_params(nbins=5)
    return pages, report


class _Report:
    def __init__(self, source: Bundles, fields: Doubles, colours: Doubles) -> None:
        self.lens, self.source, self.fields, self.colours = source.lens, source, fields, colours
        self.mtf_method = "diffraction"
        self.common: dict[str, Any] = {"object_distance_m": source.object_distance_m, "bundles": source}
        self.three: dict[str, Any] = {**self.common, "fields_deg": fields, "wavelengths_nm": colours}
        # One set of fields for all curves over the field.
        top = float(np.abs(fields).max())
        self.scan: Doubles = field_angles_deg(self.lens, np.linspace(0, 1, 11), source)
        if not math.isclose(self.scan[-1], top, rel_tol=1e-3):
            self.scan = np.linspace(0, top, 11)
        self.over_field: dict[str, Any] = {**self.common, "fields_deg": self.scan}
        # These need chief rays alone, which cost little.
        fine = np.interp(np.linspace(0, 10, 25), np.arange(11), self.scan)
        self.chief_rays: dict[str, Any] = {**self.common, "fields_deg": fine}

    def rays(self) -> matplotlib.figure.Figure:
        figure = self._page("Rays")
        grid = figure.add_gridspec(4, 3, top=0.885, bottom=0.05, hspace=0.42, wspace=0.34, **SIDE)
        fans = ray_fan(self.lens, samples=45, **self.three)
        spots = spot_diagram(self.lens, rings=7, **self.three)
        for f in range(3):
            plot_ray_fan(fans, figure.add_subplot(grid[0, f]), f)
            plot_ray_fan(fans, figure.add_subplot(grid[1, f]), f, sagittal=True)
            plot_spot_diagram(spots, figure.add_subplot(grid[2, f]), f)
        handles, labels = figure.axes[2].get_legend_handles_labels()
        figure.legend(handles, labels, loc="upper right", ncols=4, bbox_to_anchor=(0.975, 0.921), markerscale=3)
        self._try(figure, grid[3, 0], self._longitudinal, plot_longitudinal_aberration)
        self._try(figure, grid[3, 1], lambda: field_curves(self.lens, **self.chief_rays), plot_field_curves)
        self._try(figure, grid[3, 2], lambda: distortion(self.lens, **self.chief_rays), plot_distortion)
        return figure

    def contrast(self) -> matplotlib.figure.Figure:
        figure = self._page("Contrast and colour")
        grid = figure.add_gridspec(3, 2, top=0.885, bottom=0.095, hspace=0.3, wspace=0.5, left=0.085, right=0.86)
        over = {**self.over_field, "wavelengths_nm": self.colours}
        for place, compute, plot in (
            (grid[0, 0], lambda: self._mtf(mtf_over_frequency, **self.three), plot_mtf_over_frequency),
            (grid[0, 1], lambda: self._mtf(mtf_through_focus, **self.three), plot_mtf_through_focus),
            (grid[1, 0], lambda: self._mtf(mtf_over_field, **over), plot_mtf_over_field),
            (grid[1, 1], lambda: lateral_colour(self.lens, **{**over, **self.chief_rays}), plot_lateral_colour),
            (grid[2, :], self._seidel, plot_seidel_bars),
        ):
            self._try(figure, place, compute, plot)
        return figure

    def light(self) -> matplotlib.figure.Figure:
        figure = self._page("Waves and light")
        grid = figure.add_gridspec(4, 3, top=0.895, bottom=0.05, hspace=0.4, wspace=0.5, left=0.085, right=0.95)
        distance = self.source.object_distance_m
        for f, field in enumerate(self.fields):
            self._try(
                figure,
                grid[0, f],
                partial(wavefront_map, self.lens, float(field), samples=32, object_distance_m=distance),
                plot_wavefront_map,
            )
            self._try(figure, grid[1, f], partial(self._psf, float(field)), plot_point_spread)
        self._try(figure, grid[2, :2], lambda: film_pupils(self.lens, self.scan[::2], **self.common), plot_pupil_shapes)
        self._try(
            figure, grid[2, 2], lambda: film_pupils(self.lens, self.scan, **self.common), plot_relative_illumination
        )
        self._try(
            figure,
            grid[3, 0],
            lambda: zernike_fit(self.lens, float(self.fields[1]), samples=24, object_distance_m=distance),
            plot_zernike_fit,
        )
        self._try(figure, grid[3, 1], lambda: distortion_grid(self.lens, **self.common), plot_distortion_grid)
        self._try(
            figure,
            grid[3, 2],
            lambda: bokeh(self.lens, self.fields[1:2], self.colours, rays=100000, size=72),
            plot_bokeh,
        )
        return figure

    def heading(self) -> list[tuple[str, str]]:
        """What is known of the lens as it stands, by its names."""
        lens, first = self.lens, self.lens.first_order()
        focus = lens.focus_distance_m
        return [
            ("focal length", f"{first.effective_focal_length_mm:.5g} mm"),
            ("f-number", f"f/{first.f_number:.3g}"),
            ("in focus", "infinity" if math.isinf(focus) else f"{focus:.4g} m from the film"),
            (
                "film",
                f"{lens.film_mm[0]:.4g} x {lens.film_mm[1]:.4g} mm, {lens.film_distance_mm:.5g} mm behind the lens",
            ),
            ("fields", ", ".join(f"{field:.3g}°" for field in self.fields)),
            ("wavelengths", ", ".join(f"{nm:.5g}" for nm in self.colours) + " nm"),
        ]

    @property
    def title(self) -> str:
        # Titles are text from files: characters that do not print are left out.
        return "".join(c for c in (self.lens.title or self.lens.name or "lens") if c.isprintable())

    def _page(self, subject: str) -> matplotlib.figure.Figure:
        figure = matplotlib.figure.Figure(figsize=PAGE_IN)
        figure.text(0.04, 0.968, self.title, fontsize=13, weight="bold", parse_math=False)
        figure.text(0.04, 0.95, subject, fontsize=10)
        words = [
            "   ".join(f"{name}: {value}" for name, value in part) for part in (self.heading()[:4], self.heading()[4:])
        ]
        figure.text(0.04, 0.934, words[0], fontsize=7, parse_math=False)
        figure.text(0.04, 0.922, words[1], fontsize=7, parse_math=False)
        return figure

    @staticmethod
    def _try(
        figure: matplotlib.figure.Figure, place: Any, compute: Callable[[], Any], plot: Callable[[Any, Axes], None]
    ) -> None:
        """What this lens cannot have has the reason in its place, and the rest is shown."""
        axes = figure.add_subplot(place)
        try:
            plot(compute(), axes)
        except InputError as error:
            axes.set_axis_off()
            # In lines of the place's width: matplotlib's own wrap is by the page. A letter is about half its size wide.
            width_in = axes.get_position().width * figure.get_size_inches()[0]
            letters = max(int(72 * width_in / (0.55 * matplotlib.rcParams["font.size"])), 12)
            reason = textwrap.fill(str(error), letters)
            axes.text(0.5, 0.5, reason, ha="center", va="center", parse_math=False)

    def _longitudinal(self) -> Any:
        return longitudinal_aberration(
            self.lens, self.colours, samples=25, object_distance_m=self.source.object_distance_m
        )

    def _seidel(self) -> Any:
        return seidel_bars(self.lens, min(float(np.abs(self.fields).max()), 60.0), **self.common)

    def _mtf(self, compute: Callable[..., Mtf], **given: Any) -> Mtf:
        """MTF, by rays alone on all of the page where the wavefront of a field is too uneven for a transfer
        function."""
        try:
            return compute(self.lens, method=self.mtf_method, **given)
        except UnevenWavefrontError:
            self.mtf_method = "geometric"
            return compute(self.lens, method=self.mtf_method, **given)

    def _psf(self, field: float) -> Any:
        """The point spread function, by rays alone where waves would take seconds because the spot is wide."""
        bundle = self.source.at(field, self.lens.wavelength_nm)
        spot = float(np.ptp(bundle.points_mm, axis=0).max())
        detail = 1e-6 * bundle.wavelength_nm / float(np.ptp(bundle.edge_slopes.reshape(-1, 2), axis=0).max())
        distance = self.source.object_distance_m
        if spot > 60 * detail:
            pitch = 1e3 * 1.3 * spot / 64
            return point_spread(
                self.lens, field, method="geometric", size=64, pitch_um=pitch, object_distance_m=distance
            )
        return point_spread(self.lens, field, size=64, object_distance_m=distance)


def _pdf(pages: list[matplotlib.figure.Figure]) -> bytes:
    from matplotlib.backends.backend_pdf import PdfPages

    content = io.BytesIO()
    with PdfPages(content, metadata={"CreationDate": None}) as pdf:
        for page in pages:
            pdf.savefig(page, dpi=200)
    return content.getvalue()


def _html(report: _Report, pages: list[matplotlib.figure.Figure], theme: str) -> bytes:
    pictures = []
    for number, page in enumerate(pages):
        text = figure_bytes(page, ".svg", dpi=130, salt=f"realcam-{number}").decode()
        pictures.append(text[text.index("<svg") :])
    title = html.escape(report.title)
    rows = "\n".join(f"<tr><th>{html.escape(a)}</th><td>{html.escape(b)}</td></tr>" for a, b in report.heading())
    paper, ink = theme_named(theme).page, theme_named(theme).text
    drawn = "\n".join(pictures)
    return f"""<!doctype html>
<html lang="en">
<meta charset="utf-8">
<title>{title}</title>
<style>
body {{ font: 14px sans-serif; max-width: 60em; margin: 2em auto; padding: 0 1em; background: {paper}; color: {ink}; }}
svg {{ width: 100%; height: auto; }}
th {{ text-align: left; padding-right: 1em; font-weight: normal; opacity: 0.7; }}
</style>
<h1>{title}</h1>
<table>
{rows}
</table>
{drawn}
</html>
""".encode()
