"""Error over time: the ladder as a drawing."""

from __future__ import annotations

import html
import io
import os
from pathlib import Path

import matplotlib
import matplotlib.figure
import matplotlib.ticker
import numpy as np
from matplotlib.axes import Axes

from .. import files
from .._core import ImageFileError
from .measurements import Measurements, Rung
from .report import tables_of

MOST_CODES = 32.0  # white in the thumbnails


def save_figure(cost: Measurements, path: str | os.PathLike[str]) -> None:
    """Writes .svg, or .html with the table below; either holds all that it shows. Raises ImageFileError."""
    target = Path(path)
    if target.suffix.lower() not in (".svg", ".html"):
        raise ImageFileError(f"{target}: unknown suffix; .svg or .html is wanted")
    if not cost.rungs:
        raise ImageFileError(f"{target}: there is nothing to draw: no level was measured")
    files.check_target(target)
    drawing = _drawing(cost)
    text = drawing if target.suffix.lower() == ".svg" else _page(cost, drawing)
    files.write_whole(target, text.encode())


def _drawing(cost: Measurements) -> str:
    count = len(cost.rungs)
    heights = [3.2, 2.4, 1.5] if cost.samplings else [3.2, 1.5]
    figure = matplotlib.figure.Figure(figsize=(12, 2.6 * sum(heights) / 1.5), layout="constrained")
    *above, below = np.asarray(figure.subfigures(len(heights), 1, height_ratios=heights)).ravel()
    _draw_errors(above[0].subplots(), cost.rungs)
    above[0].suptitle(f"{cost.size[0]} x {cost.size[1]} pixels on {cost.device}, against {cost.reference}", fontsize=9)
    if cost.samplings:
        _draw_errors(above[1].subplots(), cost.samplings)
        above[1].suptitle("Ways to sample the full lens, against the same without effects", fontsize=9)
    columns = (count + 1) // 2
    thumbnails = np.atleast_1d(below.subplots(2, columns)).ravel()
    for place in thumbnails:
        place.set_axis_off()
    for place, rung in zip(thumbnails, cost.rungs, strict=False):
        place.imshow(rung.difference, cmap="inferno", vmin=0, vmax=MOST_CODES, interpolation="nearest")
        place.set_title(rung.name, fontsize=6)
    below.suptitle(
        f"Difference of the best picture of each level to the reference; white: {MOST_CODES:g} codes", fontsize=8
    )
    text = io.StringIO()
    with matplotlib.rc_context({"svg.fonttype": "none", "svg.hashsalt": "realcam"}):
        figure.savefig(text, format="svg", dpi=110, metadata={"Date": None})
    return text.getvalue()


def _draw_errors(axes: Axes, rungs: tuple[Rung, ...]) -> None:
    colours = matplotlib.colormaps["tab20"](np.arange(len(rungs)) % 20)
    for rung, colour in zip(rungs, colours, strict=True):
        _draw_rung(axes, rung, colour)
    _draw_frontier(axes, rungs)
    axes.set(xscale="log", yscale="log", xlabel="seconds of samples", ylabel="error, root mean square, 8-bit codes")
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_locator(matplotlib.ticker.LogLocator(subs=(1, 2, 5)))
        axis.set_major_formatter("{x:g}")
        axis.set_minor_formatter(matplotlib.ticker.NullFormatter())
    axes.grid(which="both", alpha=0.2)
    axes.legend(loc="upper left", bbox_to_anchor=(1.01, 1), fontsize=8, frameon=False)


def _draw_rung(axes: Axes, rung: Rung, colour: np.ndarray) -> None:
    seconds = [picture.seconds for picture in rung.pictures]
    errors = [picture.rmse for picture in rung.pictures]
    axes.plot(seconds, errors, "o-", color=colour, markersize=4, linewidth=1.2, label=rung.name)


def _draw_frontier(axes: Axes, rungs: tuple[Rung, ...]) -> None:
    """The least error that any of the lines has reached by then."""
    lines = [np.log([(p.seconds, p.rmse) for p in rung.pictures]).T for rung in rungs]
    times = np.linspace(min(line[0, 0] for line in lines), max(line[0, -1] for line in lines), 400)
    errors = [np.interp(times, line[0], line[1], left=np.inf) for line in lines]
    best = np.minimum.accumulate(np.min(errors, axis=0))
    axes.plot(np.exp(times), np.exp(best), color="black", linewidth=5, alpha=0.15, label="frontier", zorder=0)


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
body {{ font: 14px sans-serif; max-width: 75em; margin: 2em auto; padding: 0 1em; }}
svg {{ width: 100%; height: auto; }}
td, th {{ padding: 0.2em 0.7em; text-align: right; }}
td:first-child, th:first-child {{ text-align: left; }}
</style>
<h1>What accuracy costs</h1>
<p>Bias, noise (with the most samples) and errors in 8-bit codes against {html.escape(cost.reference)}, whose own
noise is {cost.reference_noise_codes:.2g} codes.</p>
{drawing[drawing.index("<svg") :]}
{tables}
{"".join(left_out)}
</html>
"""


def _rows(heads: list[str], rows: list[list[str]]) -> str:
    cells = ["".join(f"<th>{html.escape(head)}</th>" for head in heads)]
    cells += ["".join(f"<td>{html.escape(cell)}</td>" for cell in row) for row in rows]
    return "\n".join(f"<tr>{row}</tr>" for row in cells)
