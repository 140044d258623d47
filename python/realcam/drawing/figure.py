"""Figures of cross-sections: one lens, or several states in rows at one scale; with insets of the spots."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from dataclasses import dataclass

import matplotlib
import matplotlib.figure

from .._core import InputError
from ..section.section import CrossSection
from .draw import Extent, draw_section, extent_of, prepare_axes
from .figure_files import ShownFigure
from .inset import draw_inset, shown_in_insets
from .style import Style, legend_of_wavelengths


@dataclass(frozen=True)
class Row:
    """Drawing of one lens at one zoom, focus and f-number, with its title. ghost: another state, drawn as outlines."""

    title: str
    subtitle: str
    section: CrossSection
    ghost: CrossSection | None = None


def figure_of(
    rows: Sequence[Row], style: Style, *, width_px: int = 1600, insets: bool = True, align: str = "front"
) -> matplotlib.figure.Figure:
    """Returns a figure of all rows at one scale, one below the other.

    width_px: width in pixels; a narrow figure has fewer inches, so that its text is not too small.
    align: aligns the rows at the "front" vertex or the "film". Raises InputError.
    """
    if not 200 <= width_px <= 20000:
        raise InputError("the width of a drawing must be 200 to 20000 pixels")
    layout = _Layout(rows, style, min(max(width_px / 160, 5.0), 10.0), insets, align)
    size = (layout.width, layout.height)
    figure = ShownFigure(figsize=size, dpi=width_px / layout.width, facecolor=style.theme.page)
    top = layout.height
    for index, row in enumerate(rows):
        top -= layout.title_height(index)
        extent, shift = layout.extents[index], layout.shifts[index]
        height = layout.heights[index]
        bottom = top - height
        axes = figure.add_axes(layout.relative(layout.left, bottom, layout.plot_width, height))
        last = index == len(rows) - 1
        label = "z from the film / mm" if align == "film" else "z / mm"
        prepare_axes(axes, extent, layout.style, row.section.plane, label if last else "")
        draw_section(row.section, axes, layout.style, shift_mm=shift, ghost=row.ghost)
        _write_titles(figure, layout, index, top)
        fields = shown_in_insets(row.section) if insets else []
        for box, field in zip(layout.inset_boxes(len(fields), bottom, height), fields, strict=True):
            draw_inset(figure.add_axes(layout.relative(*box)), row.section, field, layout.style, layout.scale)
        top = bottom - layout.below(index)
    return figure


class _Layout:
    """Layout of a figure, in inches; all rows have the same scale and the same z limits.

    scale: inches per mm of the lens. shifts: added to z of each row. extents, heights: limits in mm and height of the
    axes of each row. line: height of a line of text.
    """

    right, gap = 0.12, 0.22  # right margin, and gap between drawing and insets
    inset_title = 0.24

    def __init__(self, rows: Sequence[Row], style: Style, width: float, insets: bool, align: str) -> None:
        self.rows, self.width = rows, width
        font = 7.5 if width < 7 else 9.5
        self.style = Style(style.theme, style.radius_colours, style.marks, font)
        self.line, self.left = 1.45 * font / 72, 0.08 * font
        self.with_insets = insets and any(row.section.bundles for row in rows)
        self.inset_width = 0.19 * width if self.with_insets else 0.0
        margins = self.left + self.right + (self.inset_width + self.gap if self.with_insets else 0)
        self.plot_width = width - margins
        self.shifts = [-row.section.film_z_mm if align == "film" else 0.0 for row in rows]
        bounds = [
            _shifted(extent_of(row.section, self.style), shift) for row, shift in zip(rows, self.shifts, strict=True)
        ]
        z_low, z_high = min(b.z_low for b in bounds), max(b.z_high for b in bounds)
        # A tall lens is scaled down, so that the figure is not much taller than wide.
        max_height = max(0.95 * width / len(rows), 0.4 * width)
        self.scale = min(self.plot_width / (z_high - z_low), max_height / max(b.height for b in bounds))
        z_margin = 0.5 * (self.plot_width / self.scale - (z_high - z_low))
        min_height = 0.0
        if self.with_insets:
            inset_count = max(len(shown_in_insets(row.section)) for row in rows)
            min_height = inset_count * (0.48 * self.inset_width + self.inset_title)
        self.extents, self.heights = [], []
        for b in bounds:
            y_margin = max(0.0, 0.5 * (min_height / self.scale - b.height))
            self.extents.append(Extent(z_low - z_margin, z_high + z_margin, b.y_low - y_margin, b.y_high + y_margin))
            self.heights.append(self.extents[-1].height * self.scale)
        self.titles = [self._wrapped(row) for row in rows]
        self.height = sum(self.heights) + sum(self.title_height(i) + self.below(i) for i in range(len(rows)))

    def title_height(self, index: int) -> float:
        """Returns the height of a row's title, subtitle and legend."""
        legend = bool(legend_of_wavelengths(self.rows[index].section, self.style.theme))
        return (len(self.titles[index]) + 1 + legend) * self.line + 0.16

    def below(self, index: int) -> float:
        """Returns the height of the labels below a row's axes."""
        return 2.9 * self.line if index == len(self.rows) - 1 else 1.9 * self.line

    def relative(self, left: float, bottom: float, width: float, height: float) -> tuple[float, float, float, float]:
        """Converts a box from inches to fractions of the figure."""
        return left / self.width, bottom / self.height, width / self.width, height / self.height

    def inset_boxes(self, count: int, bottom: float, height: float) -> list[tuple[float, float, float, float]]:
        """Returns the boxes (left, bottom, width, height) of a row's insets, from bottom to top.

        bottom, height: those of the row's axes.
        """
        if count == 0:
            return []
        cell = height / count
        inset_height = min(cell - self.inset_title, self.inset_width)
        left = self.width - self.right - self.inset_width
        return [(left, bottom + k * cell, self.inset_width, inset_height) for k in range(count)]

    def _wrapped(self, row: Row) -> list[str]:
        characters = int(1.75 * 72 * (self.width - self.left) / (1.15 * self.style.font_pt))
        text = "".join(c for c in row.title if c.isprintable())
        return textwrap.wrap(text, characters) or [""]


def _shifted(extent: Extent, shift: float) -> Extent:
    return Extent(extent.z_low + shift, extent.z_high + shift, extent.y_low, extent.y_high)


def _write_titles(figure: matplotlib.figure.Figure, layout: _Layout, index: int, top: float) -> None:
    """Writes title, subtitle and legend of a row above its axes, whose upper edge is at `top`, in inches."""
    # Titles are plain text, in which a dollar sign must not start a formula.
    row, style = layout.rows[index], layout.style
    x = 0.12 / layout.width
    y = top + layout.title_height(index) - 0.06
    for line in layout.titles[index]:
        figure.text(x, y / layout.height, line, ha="left", va="top", fontsize=1.15 * style.font_pt,
                    color=style.theme.text, parse_math=False)  # fmt: skip
        y -= 1.1 * layout.line
    figure.text(x, y / layout.height, row.subtitle, ha="left", va="top", fontsize=style.font_pt,
                color=style.theme.text, parse_math=False)  # fmt: skip
    y -= layout.line
    for k, (text, colour) in enumerate(legend_of_wavelengths(row.section, style.theme)):
        left = 0.12 + k * 6.5 * style.font_pt / 72
        figure.text(left / layout.width, y / layout.height, text, ha="left", va="top", fontsize=style.font_pt,
                    color=colour)  # fmt: skip
