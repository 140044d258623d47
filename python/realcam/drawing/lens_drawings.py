"""Functions that draw lenses and write the drawings to files. realcam.section has their content as arrays."""

from __future__ import annotations

import math
import os
from collections.abc import Sequence
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from .._core import InputError, Lens
from ..section.section import CrossSection, cross_section
from .draw import draw_section, extent_of, prepare_axes
from .figure import Row, figure_of
from .figure_files import NOTEBOOK_DPI, check_figure_target, figure_bytes, save_figure
from .style import Style, data_of
from .themes import theme_named


def draw(
    self: Lens,
    rays: int = 7,
    *,
    plane: str = "yz",
    rays_from: str = "object",
    fields: Sequence[float] = (0.0, 0.7, 1.0),
    fields_deg: Sequence[float] | None = None,
    wavelengths_nm: Sequence[float] | None = None,
    object_distance_m: float | None = None,
    radius_colours: bool = False,
    marks: bool = False,
    insets: bool = True,
    ghost: Lens | None = None,
    theme: str = "light",
    width_px: int = 1600,
) -> Figure:
    """Draws the meridional section with rays; the film is on the right.

    plane, rays, rays_from, fields, fields_deg, wavelengths_nm, object_distance_m: see realcam.cross_section.
    radius_colours: True: faces with a positive radius of curvature are blue, those with a negative one red.
    marks: True: draws entrance and exit pupil (EP, XP), principal planes (H, H') and focal points (F, F').
    insets: True: draws the rays of each field at the film, magnified.
    ghost: the lens in another state; those of its elements that have moved are drawn as outlines.
    theme: "light" or "dark". width_px: width of the figure in pixels.
    Returns a matplotlib figure, which notebooks show; realcam.drawing.save_cross_section writes it to a file. Raises
    InputError if no light passes the lens or an option is invalid.
    """
    style = Style(theme_named(theme), radius_colours, marks)
    section, other = _sections(
        self,
        ghost,
        plane=plane,
        rays=rays,
        rays_from=rays_from,
        fields=fields,
        fields_deg=fields_deg,
        wavelengths_nm=wavelengths_nm,
        object_distance_m=object_distance_m,
    )
    row = Row(self.title or self.name, data_of(self, section), section, other)
    # Rays that start at one film point always intersect there: insets would show no spot.
    return figure_of([row], style, width_px=width_px, insets=insets and rays_from == "object")


def lens_png(lens: Lens) -> bytes | None:
    """Returns a PNG file of the lens for notebooks; None if it cannot be drawn because no light passes."""
    try:
        return figure_bytes(draw(lens), ".png", NOTEBOOK_DPI)
    except InputError:
        return None


def save_cross_section(lens: Lens, path: str | os.PathLike[str], rays: int = 7, **options: Any) -> None:
    """Writes the figure of Lens.draw, which takes the same options, as .svg, .pdf, .png, .jpg, .tif or .webp.

    Raises ImageFileError and InputError.
    """
    target = check_figure_target(path)
    figure = lens.draw(rays, **options)
    save_figure(figure, target, dpi=figure.dpi)


def draw_cross_section(
    lens: Lens,
    axes: Axes,
    rays: int = 7,
    *,
    plane: str = "yz",
    radius_colours: bool = False,
    marks: bool = False,
    ghost: Lens | None = None,
    theme: str = "light",
    **options: Any,
) -> CrossSection:
    """Draws a cross-section on existing axes, without insets, and returns its arrays.

    options: those of realcam.cross_section. The others are those of Lens.draw.
    """
    style = Style(theme_named(theme), radius_colours, marks)
    section, other = _sections(lens, ghost, plane=plane, rays=rays, **options)
    prepare_axes(axes, extent_of(section, style), style, plane)
    draw_section(section, axes, style, ghost=other)
    # A dollar sign in a title must not begin a formula.
    title = f"{lens.title or lens.name}   {data_of(lens, section)}"
    axes.set_title("".join(c for c in title if c.isprintable()), parse_math=False, color=style.theme.text)
    return section


def _sections(
    lens: Lens, ghost: Lens | None, *, plane: str, **options: Any
) -> tuple[CrossSection, CrossSection | None]:
    """Returns the cross-sections of a lens and of its other state; the latter is without rays."""
    other = None if ghost is None else cross_section(ghost, plane=plane, rays=0)
    return cross_section(lens, plane=plane, **options), other


def draw_states(
    states: Sequence[tuple[str, Lens]],
    *,
    rays_from: str = "object",
    radius_colours: bool = False,
    marks: bool = False,
    insets: bool = True,
    theme: str = "light",
    width_px: int = 1600,
    **options: Any,
) -> Figure:
    """Draws several lenses, or states of one, as rows of the same scale with their films aligned.

    states: (name, lens) pairs, as states_of gives them. options: those of realcam.cross_section. The others are those
    of Lens.draw. Raises InputError.
    """
    if not states:
        raise InputError("there is no lens to draw")
    style = Style(theme_named(theme), radius_colours, marks)
    rows = []
    for name, lens in states:
        section = cross_section(lens, rays_from=rays_from, **options)
        rows.append(Row(name, data_of(lens, section), section))
    return figure_of(rows, style, width_px=width_px, insets=insets and rays_from == "object", align="film")


def save_states(states: Sequence[tuple[str, Lens]], path: str | os.PathLike[str], **options: Any) -> None:
    """Writes the figure of draw_states, which takes the same options, as .svg, .pdf, .png, .jpg, .tif or .webp.

    Raises ImageFileError and InputError.
    """
    target = check_figure_target(path)
    figure = draw_states(states, **options)
    save_figure(figure, target, dpi=figure.dpi)


def states_of(lens: Lens) -> list[tuple[str, Lens]]:
    """Returns (title, lens) of each zoom position; for a lens that does not zoom, of the focus at infinity and, if the
    lens file specifies it, of the nearest focus."""
    zoom: Any = lens if hasattr(lens, "zoom_positions") else None
    if zoom is not None and zoom.zoom_positions:
        return [(f"{lens.title or lens.name}, {name}", zoom.zoomed(name)) for name in zoom.zoom_positions]
    name = lens.title or lens.name
    states = [(f"{name}, focused at infinity", lens.focused(math.inf))]
    if lens.nearest_focus_m > 0:
        states.append((f"{name}, focused at {lens.nearest_focus_m:.4g} m", lens.focused(lens.nearest_focus_m)))
    return states
