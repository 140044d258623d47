"""Complete report of a lens in one file: data and plots."""

from __future__ import annotations

import os

from numpy.typing import ArrayLike

from .. import files
from .._core import InputError, Lens
from ..drawing.themes import theme_named
from . import style
from .fields import bundles_of, three_fields, wavelengths_of
from .report_facts import facts_of
from .report_paper import pdf_of
from .report_plots import FilmPlots, ReportPlots
from .report_web import page_of


def save_report(
    lens: Lens,
    path: str | os.PathLike[str],
    *,
    fields_deg: ArrayLike | None = None,
    wavelengths_nm: ArrayLike | None = None,
    object_distance_m: float | None = None,
    theme: str | None = None,
) -> None:
    """Writes a report as .pdf, or as self-contained .html.

    It begins with drawing, data, prescription and Seidel sums; pages of plots follow.
    fields_deg: three; None is 0, 0.7 and 1 times the largest image height. wavelengths_nm: None is F line, design
    wavelength and C line. object_distance_m: object plane to front vertex; None is the plane in focus.
    theme: "light" or "dark"; None is light for .pdf, and the browser's setting for .html.
    A plot that does not exist for the lens (the distortion grid of a fisheye, for example) is replaced by the reason. A
    lens without rotational symmetry has sections in two planes, maps over the film, and spots, wavefronts and point
    spread functions at four film points; fields_deg must be None.
    Raises ImageFileError for the file, and InputError if no light passes.
    """
    target = files.check_target(path, (".pdf", ".html"))
    if theme is not None:
        theme_named(theme)
    source = bundles_of(lens, object_distance_m, None)
    colours = wavelengths_of(lens, wavelengths_nm)
    plots: ReportPlots
    if lens.is_rotational:
        fields = three_fields(lens, fields_deg, source)
        if len(fields) != 3:
            raise InputError(f"a report shows three fields; found {len(fields)}")
        plots = ReportPlots(source, fields, colours)
        facts = facts_of(source, fields.tolist(), colours)
    else:
        if fields_deg is not None:
            raise InputError(
                f'fields_deg does not apply to lens "{lens.name}", which is not rotationally symmetric: its report '
                "shows predefined film points"
            )
        plots = FilmPlots(source, colours)
        facts = facts_of(source, plots.points, colours)
    if target.suffix.lower() == ".pdf":
        paper = theme or "light"
        with style.themed(paper, 7.0):
            content = pdf_of(facts, plots, paper)
    else:
        with style.themed("light", 7.0):
            content = page_of(facts, plots, theme)
    files.write_whole(target, content)
