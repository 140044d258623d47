"""Report as .pdf: the lens on the first page, plots on the others."""

from __future__ import annotations

import io
import textwrap

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ..drawing.lens_drawings import draw_cross_section
from .report_facts import ReportFacts
from .report_plots import PAGE_IN, ReportPlots
from .style import GREY

LEFT, RIGHT = 0.04, 0.96
SECONDARY_ALPHA = 0.7  # opacity of secondary text
# Column widths of the prescription, inches; the columns of Seidel sums share the remaining width.
PRESCRIPTION_WIDTHS_IN = (0.25, 0.85, 0.72, 0.74, 1.05, 0.62)


def pdf_of(facts: ReportFacts, plots: ReportPlots, theme: str) -> bytes:
    """Content of the .pdf. theme: name of the current theme."""
    from matplotlib.backends.backend_pdf import PdfPages

    content = io.BytesIO()
    with PdfPages(content, metadata={"CreationDate": None}) as pdf:
        pdf.savefig(lens_page(facts, plots, theme), dpi=200)
        for subject, page in plots.pages():
            _head(page, facts.title, subject)
            pdf.savefig(page, dpi=200)
    return content.getvalue()


def lens_page(facts: ReportFacts, plots: ReportPlots, theme: str) -> Figure:
    """Page with the lens's drawing, data and prescription."""
    figure = Figure(figsize=PAGE_IN)
    _head(figure, facts.title, "The lens")
    y = 0.944  # of the next text, as a fraction of the page's height
    for line in textwrap.wrap(facts.source, 150)[:2]:
        figure.text(LEFT, y, line, fontsize=6, va="top", alpha=SECONDARY_ALPHA, parse_math=False)
        y -= 0.0095
    height = (y - 0.015 - 0.665) / len(plots.drawings)
    for k, options in enumerate(plots.drawings):
        axes = figure.add_axes((0.085, y - 0.015 - (k + 1) * height, 0.875, (0.85 if k else 1) * height))
        draw_cross_section(plots.source.lens, axes, theme=theme, **options)
        axes.set_title("")
        axes.grid(visible=False)
    y = _draw_numbers(figure, facts.figures, 0.615)
    _draw_table(figure, facts, y - 0.02)
    return figure


def _head(figure: Figure, title: str, subject: str) -> None:
    """Writes a page's heading."""
    figure.text(LEFT, 0.968, title, fontsize=13, weight="bold", parse_math=False)
    figure.text(LEFT, 0.951, subject, fontsize=10)


def _draw_numbers(figure: Figure, numbers: list[tuple[str, str]], top: float) -> float:
    """Writes names and values in two columns from the height `top` on. Returns their lower end."""
    half, line = -(-len(numbers) // 2), 0.0125
    for index, (name, text) in enumerate(numbers):
        column, row = divmod(index, half)
        left, y = LEFT + 0.46 * column, top - line * row
        figure.text(left, y, name, va="top", alpha=SECONDARY_ALPHA)
        figure.text(left + 0.13, y, text, va="top", parse_math=False)
    return top - line * half


def _draw_table(figure: Figure, facts: ReportFacts, top: float) -> None:
    """Writes the prescription table, in smaller type if there are many surfaces, so that it fits the page."""
    bottom = 0.04
    line = min(0.0145, (top - bottom) / (len(facts.rows) + 2.5))
    size = min(6.5, 72 * PAGE_IN[1] * line / 1.45)
    edges = _edges(facts)
    axes = figure.add_axes((0, 0, 1, 1))
    axes.set_axis_off()
    axes.set_xlim(0, 1)
    axes.set_ylim(0, 1)
    y = top
    _draw_row(axes, edges, y, [_as_math(name) for name in facts.columns], size, facts.prescription_columns)
    axes.plot((LEFT, RIGHT), (y - 0.75 * line, y - 0.75 * line), color=GREY, linewidth=0.6)
    for row in facts.rows:
        y -= line
        if row[1] == "sum":
            axes.plot((LEFT, RIGHT), (y + 0.3 * line, y + 0.3 * line), color=GREY, linewidth=0.6)
        _draw_row(axes, edges, y - 0.2 * line, row, size, facts.prescription_columns)
    note = textwrap.fill(facts.note, 190)
    figure.text(LEFT, y - 1.6 * line, note, fontsize=6, va="top", alpha=SECONDARY_ALPHA, parse_math=False)


def _edges(facts: ReportFacts) -> list[float]:
    """Right edges of the columns, as fractions of the page width."""
    widths = list(PRESCRIPTION_WIDTHS_IN)
    sums = len(facts.columns) - facts.prescription_columns
    if sums:
        widths += [((RIGHT - LEFT) * PAGE_IN[0] - sum(widths)) / sums] * sums
    edges = [LEFT + widths[0] / PAGE_IN[0]]
    for width in widths[1:]:
        edges.append(edges[-1] + width / PAGE_IN[0])
    return edges


def _draw_row(
    axes: Axes, edges: list[float], y: float, cells: list[str] | tuple[str, ...], size: float, prescription: int
) -> None:
    """Writes a row of the table. edges: right edges of its columns. size: of the font, in points. prescription: number
    of the prescription's columns."""
    for k, (cell, edge) in enumerate(zip(cells, edges, strict=True)):
        is_text = prescription > k and k in (1, 4)  # kind and glass
        x = edges[k - 1] + 0.012 if is_text else edge
        axes.text(x, y, cell, fontsize=size, va="center", ha="left" if is_text else "right", parse_math="$" in cell)


def _as_math(name: str) -> str:
    """Typesets the index of a symbol such as S_I as mathtext."""
    letter, underscore, index = name.partition("_")
    return f"${letter}_\\mathrm{{{index}}}$" if underscore and len(letter) == 1 else name.replace("n_d", "$n_d$")
