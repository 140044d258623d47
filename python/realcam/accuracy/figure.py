"""Figure of error over time for all levels of simulation."""

from __future__ import annotations

import html
import os
import textwrap

import numpy as np
from matplotlib.figure import Figure

from .. import files
from .._core import ImageFileError
from ..analysis import style
from ..drawing.figure_files import figure_bytes
from ..drawing.web_page import inline_svg, page_top
from ..html_tables import html_table
from .error_plot import draw_errors, recommendation
from .measurements import Measurements
from .report import tables_of

STYLE = """
body { font: 14px sans-serif; max-width: 75em; margin: 2em auto; padding: 0 1em; background: var(--page);
  color: var(--text); }
svg { width: 100%; height: auto; }
td, th { padding: 0.2em 0.7em; text-align: right; }
table { margin: 1.5em 0; }
td:first-child, th:first-child { text-align: left; }
@media print { body { font-size: 8pt; margin: 0; } svg, table { break-inside: avoid; } }
"""
MAX_CODES = 32.0  # difference that is white in the thumbnails


def save_figure(cost: Measurements, path: str | os.PathLike[str]) -> None:
    """Writes .svg, or .html with tables; the file is self-contained. Raises ImageFileError."""
    target = files.check_target(path, (".svg", ".html"))
    if not cost.levels:
        raise ImageFileError(f"{target}: there is nothing to draw: no level was measured")
    figure = _drawing(cost)
    if target.suffix.lower() == ".svg":
        files.write_whole(target, figure_bytes(figure, ".svg", dpi=110))
    else:
        files.write_whole(target, _page(cost, inline_svg(figure, "cost")).encode())


def _drawing(cost: Measurements) -> Figure:
    size = f"{cost.size[0]} x {cost.size[1]} pixels on {cost.device}"
    plots = [
        (
            f"Levels of simulation: {size}, against {cost.reference}",
            "It leaves out only what this shot does not show",
            cost.levels,
            5.0,
        ),
        (
            "Ways to sample the full lens, against the same without effects",
            "Its samples go where light passes, and some start at the lamps",
            cost.samplings,
            3.0,
        ),
    ]
    plots = [plot for plot in plots if plot[2]]
    heights = [height for *_, height in plots] + [2.4]
    with style.themed("light", 8.0):
        figure = Figure(figsize=(11, sum(heights)), layout="constrained")
        *above, below = np.asarray(figure.subfigures(len(heights), 1, height_ratios=heights)).ravel()
        for cell, (title, reason, levels, _) in zip(above, plots, strict=True):
            draw_errors(cell, levels)
            cell.suptitle("\n".join(filter(None, (title, recommendation(levels, reason)))), fontsize=9)
        columns = (len(cost.levels) + 1) // 2
        thumbnails = np.atleast_1d(below.subplots(2, columns)).ravel()
        for cell in thumbnails:
            cell.set_axis_off()
        for cell, level in zip(thumbnails, cost.levels, strict=False):
            cell.imshow(level.difference, cmap="inferno", vmin=0, vmax=MAX_CODES, interpolation="nearest")
            cell.set_title(textwrap.fill(level.name, 24), fontsize=6)
        below.suptitle(
            f"Difference of the best picture of each level to the reference; white: {MAX_CODES:g} codes", fontsize=9
        )
    return figure


def _page(cost: Measurements, drawing: str) -> str:
    tables = "\n".join(html_table(rows, [title, *heads]) for title, heads, rows in tables_of(cost))
    left_out = [
        f"<p>{html.escape(text)}: {html.escape(', '.join(names))}.</p>"
        for text, names in (
            ("Not possible with this lens on this device", cost.impossible),
            ("Not measured", cost.missing),
        )
        if names
    ]
    return f"""{page_top("What accuracy costs", STYLE, None)}
<p>Bias, noise (with the most samples) and errors in 8-bit codes against {html.escape(cost.reference)}, whose own
noise is {cost.reference_noise_codes:.2g} codes.</p>
{drawing}
{tables}
{"".join(left_out)}
</html>
"""
