"""Plot style: themes, and colours of wavelengths and fields."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any

import matplotlib
import matplotlib.figure
import numpy as np
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.cm import ScalarMappable
from matplotlib.ticker import FuncFormatter, LogLocator, NullLocator
from numpy.typing import NDArray

from ..drawing.figure_files import ShownFigure
from ..drawing.themes import theme_named
from .fields import texts_of

SIZES_IN = {"small": (4.2, 3.0), "large": (8.0, 5.6)}  # width and height of a figure with one plot, in inches
# Colours with a contrast of at least 3 to both the white and the dark page; the panel of costs has them, too.
PALETTE = (
    *("#4a78d6", "#c7791a", "#2f9a58", "#d9493c", "#9467bd", "#15939f", "#b0608f"),
    *("#80803a", "#5b8f9e", "#e0709a", "#a0642d", "#8f8f8f", "#6f9a1f", "#c05ac8"),
)
BLUE, GREEN, RED = PALETTE[0], PALETTE[2], PALETTE[3]
GREY = "#808080"


def wavelength_colours(wavelengths_nm: NDArray[np.float64]) -> list[str]:
    """Colours from blue (shortest) over green to red (longest); green for a single wavelength."""
    count = len(wavelengths_nm)
    order = np.argsort(np.argsort(wavelengths_nm))
    if count == 1:
        return [GREEN]
    if count <= 3:
        return [(BLUE, GREEN, RED)[int(rank) if count == 3 else 2 * int(rank)] for rank in order]
    return [matplotlib.colors.to_hex(matplotlib.colormaps["turbo"](0.1 + 0.8 * rank / (count - 1))) for rank in order]


def field_colour(index: int) -> str:
    """Colour of the field, or another parameter, with this index; the colours repeat after fourteen."""
    return PALETTE[index % len(PALETTE)]


@contextmanager
def themed(theme: str = "light", font_size: float = 8.0) -> Iterator[None]:
    """Context in which new figures have the theme's colours and lines. Raises InputError for an unknown theme."""
    colours = theme_named(theme)
    page, text = colours.page, colours.text
    settings: Any = {
        "figure.facecolor": page,
        "savefig.facecolor": page,
        "axes.facecolor": page,
        "axes.edgecolor": text,
        "axes.labelcolor": text,
        "text.color": text,
        "xtick.color": text,
        "ytick.color": text,
        "grid.color": colours.grid,
        "grid.linewidth": 0.5,
        "axes.linewidth": 0.6,
        "lines.linewidth": 1.1,
        "axes.spines.top": False,
        "axes.spines.right": False,
        "axes.grid": True,
        "axes.axisbelow": True,
        "font.size": font_size,
        "axes.titlesize": font_size,
        "axes.labelsize": font_size,
        "xtick.labelsize": 0.9 * font_size,
        "ytick.labelsize": 0.9 * font_size,
        "legend.fontsize": 0.85 * font_size,
        "legend.frameon": False,
        "legend.handlelength": 1.4,
        "legend.borderaxespad": 0.2,
        "axes.formatter.limits": (-4, 5),
    }
    with matplotlib.rc_context(settings):
        yield


def text_colour() -> str:
    """Text colour of the current theme, for lines without a colour of their own."""
    return str(matplotlib.rcParams["text.color"])


def tick_size_pt() -> float:
    """Font size of tick labels in the current theme, in points."""
    return float(matplotlib.rcParams["ytick.labelsize"])


def new_figure(width_in: float, height_in: float) -> matplotlib.figure.Figure:
    """Returns a figure that notebooks display, with matplotlib's constrained layout."""
    return ShownFigure(figsize=(width_in, height_in), layout="constrained")


def coloured(wavelengths_nm: NDArray[np.float64]) -> list[tuple[str, str]]:
    """(colour, legend text) of each wavelength."""
    return list(zip(wavelength_colours(wavelengths_nm), texts_of(wavelengths_nm, "nm"), strict=True))


def field_limits(fields_deg: NDArray[np.float64]) -> tuple[float, float]:
    """Returns the limits of an axis of field angles, which contains the optical axis."""
    low, high = min(float(fields_deg.min()), 0.0), max(float(fields_deg.max()), 0.0)
    return low, high if high > low else low + 1e-9


def set_field_axis(axes: Axes, fields_deg: NDArray[np.float64]) -> None:
    """Formats the y axis as field angle upwards, and draws the line x = 0."""
    zero_lines(axes, y=False)
    axes.set_ylim(*field_limits(fields_deg))
    axes.set_ylabel("field / °")


def field_title(field_deg: float, film_mm: Sequence[float] | NDArray[np.float64] | None) -> str:
    """Text of a field for titles: its angle, or its film point."""
    return f"{field_deg:.3g}°" if film_mm is None else f"({film_mm[0]:.3g}, {film_mm[1]:.3g}) mm"


def zero_lines(axes: Axes, x: bool = True, y: bool = True) -> None:
    """Draws thin lines through the origin. x: the vertical line x = 0; y: the horizontal line y = 0."""
    if y:
        axes.axhline(0, color=GREY, linewidth=0.6, zorder=1)
    if x:
        axes.axvline(0, color=GREY, linewidth=0.6, zorder=1)


def legend_beside(axes: Axes, **options: Any) -> None:
    """Places the legend outside the axes, where it covers no curve. options: of Axes.legend, override the position."""
    axes.legend(**{"loc": "upper left", "bbox_to_anchor": (1.01, 1.0), **options})


def colour_bar(axes: Axes, picture: ScalarMappable, label: str) -> None:
    """Adds the colour scale of a picture beside its axes."""
    figure = axes.get_figure()
    assert figure is not None
    bar = figure.colorbar(picture, ax=axes, shrink=0.8)
    bar.set_label(label)
    bar.outline.set_visible(False)


def plain_decades(axis: Axis) -> None:
    """Sets the ticks of a logarithmic axis to 1, 2 and 5 of each decade, as plain numbers without powers of ten."""
    axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_minor_locator(NullLocator())
