"""Error over time: the ladder as a drawing."""

from __future__ import annotations

import html
import os
import textwrap
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from .. import files
from .._core import ImageFileError
from ..analysis import style
from ..analysis.fields import Doubles
from ..drawing.web_page import colour_variables, inline_svg
from ..figure_files import figure_bytes
from .measurements import Measurements, Rung
from .report import tables_of

MOST_CODES = 32.0  # white in the thumbnails
DASHES = ("-", "--", ":", "-.")


def save_figure(cost: Measurements, path: str | os.PathLike[str]) -> None:
    """Writes .svg, or .html with the table below; either holds all that it shows. Raises ImageFileError."""
    target = Path(path)
    if target.suffix.lower() not in (".svg", ".html"):
        raise ImageFileError(f"{target}: unknown suffix; .svg or .html is wanted")
    if not cost.rungs:
        raise ImageFileError(f"{target}: there is nothing to draw: no level was measured")
    files.check_target(target)
    figure = _drawing(cost)
    if target.suffix.lower() == ".svg":
        files.write_whole(target, figure_bytes(figure, ".svg", dpi=110))
    else:
        files.write_whole(target, _page(cost, inline_svg(figure, "cost")).encode())


def _drawing(cost: Measurements) -> Figure:
    heights = [3.2, 2.6, 1.5] if cost.samplings else [3.2, 1.5]
    with style.themed("light", 9.0):
        figure = Figure(figsize=(12, 2.6 * sum(heights) / 1.5), layout="constrained")
        *above, below = np.asarray(figure.subfigures(len(heights), 1, height_ratios=heights)).ravel()
        _draw_errors(above[0].subplots(), cost.rungs)
        size = f"{cost.size[0]} x {cost.size[1]} pixels on {cost.device}"
        above[0].suptitle(f"{size}, against {cost.reference}", fontsize=9)
        if cost.samplings:
            _draw_errors(above[1].subplots(), cost.samplings)
            above[1].suptitle("Ways to sample the full lens, against the same without effects", fontsize=9)
        columns = (len(cost.rungs) + 1) // 2
        thumbnails = np.atleast_1d(below.subplots(2, columns)).ravel()
        for place in thumbnails:
            place.set_axis_off()
        for place, rung in zip(thumbnails, cost.rungs, strict=False):
            place.imshow(rung.difference, cmap="inferno", vmin=0, vmax=MOST_CODES, interpolation="nearest")
            place.set_title(textwrap.fill(rung.name, 24), fontsize=6)
        below.suptitle(
            f"Difference of the best picture of each level to the reference; white: {MOST_CODES:g} codes", fontsize=8
        )
    return figure


def _draw_errors(axes: Axes, rungs: tuple[Rung, ...]) -> None:
    """A colour for each group of lines, which are told apart by their dashes, and a name at each line's end."""
    groups = list(dict.fromkeys(rung.group for rung in rungs))
    seen = dict.fromkeys(groups, 0)
    for rung in rungs:
        seconds, errors = zip(*((picture.seconds, picture.rmse) for picture in rung.pictures), strict=True)
        axes.plot(
            seconds,
            errors,
            marker="o",
            linestyle="-" if rung.is_recommended else DASHES[seen[rung.group] % len(DASHES)],
            color=style.field_colour(groups.index(rung.group)),
            markersize=5 if rung.is_recommended else 3,
            linewidth=3 if rung.is_recommended else 1.2,
            zorder=3 if rung.is_recommended else 2,
        )
        seen[rung.group] += not rung.is_recommended
    _draw_frontier(axes, rungs)
    axes.set(xscale="log", yscale="log", xlabel="seconds of samples", ylabel="error, root mean square, 8-bit codes")
    for axis in (axes.xaxis, axes.yaxis):
        style.plain_decades(axis)
    _name_lines(axes, rungs, groups)


def _name_lines(axes: Axes, rungs: tuple[Rung, ...], groups: list[str]) -> None:
    """Beside the axes, as high as the lines end, but at least a line of text from each other."""
    ends = sorted(
        ((rung.pictures[-1].rmse, rung.pictures[-1].seconds, rung) for rung in rungs), key=lambda end: end[:2]
    )
    axes.autoscale_view()
    low, high = axes.get_ylim()
    height = np.log([error / low for error, _, _ in ends]) / np.log(high / low)
    for error_height, (error, seconds, rung) in zip(_apart(height, 0.05), ends, strict=True):
        axes.annotate(
            f"{rung.name}: recommended" if rung.is_recommended else rung.name,
            (seconds, error),
            (1.01, error_height),
            textcoords=axes.transAxes,
            va="center",
            color=style.field_colour(groups.index(rung.group)),
            weight="bold" if rung.is_recommended else "normal",
            fontsize=8,
            arrowprops={
                "arrowstyle": "-",
                "linewidth": 0.4,
                "color": style.GREY,
                "relpos": (0, 0.5),
                "shrinkA": 0,
                "shrinkB": 2,
            },
        )


def _apart(places: Doubles, least: float) -> Doubles:
    """Rising places, moved as little as a rising pass and a falling one do until all are so far from each other."""
    moved: Doubles = places.copy()
    for k in range(1, len(moved)):
        moved[k] = max(moved[k], moved[k - 1] + least)
    moved[-1] = min(moved[-1], max(1.0, places[-1]))
    for k in range(len(moved) - 2, -1, -1):
        moved[k] = min(moved[k], moved[k + 1] - least)
    return moved


def _draw_frontier(axes: Axes, rungs: tuple[Rung, ...]) -> None:
    """The least error that any of the lines has reached by then."""
    lines = [np.log([(p.seconds, p.rmse) for p in rung.pictures]).T for rung in rungs]
    times = np.linspace(min(line[0, 0] for line in lines), max(line[0, -1] for line in lines), 400)
    errors = [np.interp(times, line[0], line[1], left=np.inf) for line in lines]
    best = np.minimum.accumulate(np.min(errors, axis=0))
    axes.plot(np.exp(times), np.exp(best), color=style.GREY, linewidth=7, alpha=0.25, zorder=0, label="the best of all")
    axes.legend(loc="lower left")


def _page(cost: Measurements, drawing: str) -> str:
    tables = "\n".join(f"<table>\n{_rows([title, *heads], rows)}\n</table>" for title, heads, rows in tables_of(cost))
    left_out = [
        f"<p>{html.escape(text)}: {html.escape(', '.join(names))}.</p>"
        for text, names in (
            ("Cannot be had of this lens on this device", cost.impossible),
            ("Not measured", cost.missing),
        )
        if names
    ]
    return f"""<!doctype html>
<html lang="en">
<meta charset="utf-8">
<title>What accuracy costs</title>
<style>
{colour_variables(None)}
body {{ font: 14px sans-serif; max-width: 75em; margin: 2em auto; padding: 0 1em; background: var(--page);
  color: var(--text); }}
svg {{ width: 100%; height: auto; }}
td, th {{ padding: 0.2em 0.7em; text-align: right; }}
table {{ margin: 1.5em 0; }}
td:first-child, th:first-child {{ text-align: left; }}
@media print {{ body {{ font-size: 8pt; margin: 0; }} svg, table {{ break-inside: avoid; }} }}
</style>
<h1>What accuracy costs</h1>
<p>Bias, noise (with the most samples) and errors in 8-bit codes against {html.escape(cost.reference)}, whose own
noise is {cost.reference_noise_codes:.2g} codes.</p>
{drawing}
{tables}
{"".join(left_out)}
</html>
"""


def _rows(heads: list[str], rows: list[list[str]]) -> str:
    cells = ["".join(f"<th>{html.escape(head)}</th>" for head in heads)]
    cells += ["".join(f"<td>{html.escape(cell)}</td>" for cell in row) for row in rows]
    return "\n".join(f"<tr>{row}</tr>" for row in cells)
