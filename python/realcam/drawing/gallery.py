"""Contact sheets of lenses: a grid of small cross-sections."""

from __future__ import annotations

import math
import os
from collections.abc import Sequence
from dataclasses import replace

import matplotlib.figure
from matplotlib.axes import Axes

from .._core import InputError, Lens, lens_names
from ..number_text import optics_text
from ..section import cross_section
from .draw import draw_section, extent_of, prepare_axes
from .figure_files import check_figure_target, save_figure
from .style import Style
from .themes import theme_named

CELL_INCHES = (2.6, 2.0)


def save_gallery(
    path: str | os.PathLike[str],
    lenses: Sequence[Lens] | None = None,
    columns: int = 6,
    *,
    theme: str = "light",
    titles: bool = True,
) -> None:
    """Writes cross-sections of lenses as .svg, .pdf, .png, .jpg, .tif or .webp.

    lenses: None: all bundled lenses, by name. columns: number of columns of the grid. theme: "light" or "dark".
    titles: True: name, focal length in mm and f-number are above each drawing.
    Each drawing has its own scale. A film far behind the glass is left out, so that the glass is large enough to see.
    Raises ImageFileError if the file cannot be written, and InputError for no lenses, no columns or an unknown theme.
    """
    style = Style(theme_named(theme))
    target = check_figure_target(path)
    if columns < 1:
        raise InputError(f"columns: {columns} is too few; expected 1 or more")
    if lenses is None:
        lenses = [Lens.load(name) for name in lens_names()]
    if not lenses:
        raise InputError("a contact sheet needs at least one lens")
    columns = min(columns, len(lenses))
    rows = math.ceil(len(lenses) / columns)
    figure = matplotlib.figure.Figure(
        figsize=(columns * CELL_INCHES[0], rows * CELL_INCHES[1]), facecolor=style.theme.page, layout="constrained"
    )
    grid = figure.subplots(rows, columns, squeeze=False).ravel()
    for lens, axes in zip(lenses, grid, strict=False):
        _draw_cell(lens, axes, style)
        if titles:
            _write_title(lens, axes, style)
    for axes in grid[len(lenses) :]:
        axes.set_axis_off()
    save_figure(figure, target, dpi=150)


def _draw_cell(lens: Lens, axes: Axes, style: Style) -> None:
    section = replace(cross_section(lens), focus_group=None)  # its note is wider than a cell
    prepare_axes(axes, extent_of(section, style), style)
    draw_section(section, axes, style)
    left, right, half_height = _window(lens)
    axes.set_xlim(left, right)
    axes.set_ylim(-half_height, half_height)
    axes.set_axis_off()


def _write_title(lens: Lens, axes: Axes, style: Style) -> None:
    # A dollar sign in a name must not begin a formula.
    name = "".join(c for c in lens.name if c.isprintable())
    axes.set_title(
        f"{name}\n{optics_text(lens)}",
        fontsize=7,
        color=style.theme.text,
        parse_math=False,
    )


def _window(lens: Lens) -> tuple[float, float, float]:
    """Returns the left end, right end and half height of a cell, in mm: they contain the glass with a margin, and the
    film if it is close enough."""
    front, back = min(lens.vertices_mm), max(lens.vertices_mm)
    rim = max(surface.clear_semi_diameter_mm for surface in lens.surfaces)
    reach = max(back - front, 2 * rim)
    right = min(max(lens.film_position_mm, back) + 0.05 * reach, back + 0.8 * reach)
    half_film = 0.5 * math.hypot(*lens.film_mm) if lens.film_position_mm < right else 0.0
    return front - 0.25 * reach, right, 1.08 * max(rim, half_film)
