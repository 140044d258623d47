"""Notebook representations of lenses, point spread functions, pictures and plans; Lens.draw."""

from __future__ import annotations

import html
import io
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ._core import PSF, InputError, Lens, Plan, develop
from .drawing import cross_section
from .drawing.style import Style, data_of
from .drawing.themes import theme_named
from .number_text import number_text, percent_text

if TYPE_CHECKING:
    from matplotlib.figure import Figure

LONGEST_SIDE_PX = 1200


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
    """Draws the meridional section with rays as a matplotlib figure, which notebooks show; the film is on the right.

    plane, rays, rays_from, fields, fields_deg, wavelengths_nm, object_distance_m: see realcam.drawing.cross_section.
    radius_colours: draws faces of positive radius of curvature in blue, of negative in red.
    marks: entrance and exit pupil (EP, XP), principal planes (H, H'), focal points (F, F').
    insets: the rays of each field at the film, magnified.
    ghost: the lens in another state; its elements that have moved are drawn as outlines.
    theme: "light" or "dark". width_px: of the picture. realcam.draw.save_cross_section writes it to a file.
    Raises InputError if no light passes the lens or an option is invalid.
    """
    from .drawing.figure import Row, figure_of  # loads matplotlib

    style = Style(theme_named(theme), radius_colours, marks)
    section = cross_section(
        self,
        plane=plane,
        rays=rays,
        rays_from=rays_from,
        fields=fields,
        fields_deg=fields_deg,
        wavelengths_nm=wavelengths_nm,
        object_distance_m=object_distance_m,
    )
    other = None if ghost is None else cross_section(ghost, plane=plane, rays=0)
    row = Row(self.title or self.name, data_of(self, section), section, other)
    # Rays that start at one film point always meet there: insets would show nothing.
    return figure_of([row], style, width_px=width_px, insets=insets and rays_from == "object")


def lens_png(lens: Lens) -> bytes | None:
    """PNG of the lens; None if it cannot be drawn because no light passes, so that the notebook shows its text."""
    from .figure_files import NOTEBOOK_DPI, figure_bytes

    try:
        return figure_bytes(draw(lens), ".png", NOTEBOOK_DPI)
    except InputError:
        return None


def psf_png(psf: PSF) -> bytes:
    """PNG of a point spread function on a logarithmic scale."""
    from .analysis import style  # loads matplotlib
    from .analysis.point_spread import plot_decades
    from .figure_files import NOTEBOOK_DPI, figure_bytes

    with style.themed():
        figure = style.new_figure(*style.SIZES_IN["small"])
        plot_decades(psf, figure.add_subplot(), f"{', '.join(f'{nm:.4g}' for nm in psf.wavelengths_nm)} nm")
    return figure_bytes(figure, ".png", NOTEBOOK_DPI)


def picture_png(exposure: NDArray[np.float32], iso: float) -> bytes:
    """PNG of a developed exposure, (H, W, 3) lux seconds, reduced to at most LONGEST_SIDE_PX."""
    import matplotlib.image

    step = -(-max(exposure.shape) // LONGEST_SIDE_PX)
    height, width = exposure.shape[0] // step * step, exposure.shape[1] // step * step
    blocks = exposure[:height, :width].reshape(height // step, step, width // step, step, 3)
    file = io.BytesIO()
    matplotlib.image.imsave(file, develop(blocks.mean(axis=(1, 3)), iso, "film"), format="png")
    return file.getvalue()


def plan_html(plan: Plan) -> str:
    rows = [
        (
            decision.effect,
            "kept" if decision.is_kept else "left out",
            f"{number_text(decision.size, 3)} {decision.unit}",
            f"{number_text(decision.threshold, 3)} {decision.unit}",
            "" if decision.time_share is None else percent_text(decision.time_share, signed=True),
            decision.reason,
        )
        for decision in plan.decisions
    ]
    table = table_html(rows, ("effect", "", "size", "threshold", "time", "because"))
    return f"<p>camera model {html.escape(plan.model)}, {html.escape(plan.summary)}</p>{table}"


def table_html(rows: Iterable[Sequence[str]], head: Sequence[str] = ()) -> str:
    def line(cells: Sequence[str], tag: str) -> str:
        return "".join(f'<{tag} style="text-align: left">{html.escape(cell)}</{tag}>' for cell in cells)

    body = "".join(f"<tr>{line(row, 'td')}</tr>" for row in rows)
    top = f"<thead><tr>{line(head, 'th')}</tr></thead>" if head else ""
    return f"<table>{top}<tbody>{body}</tbody></table>"


# setattr because the classes belong to the extension; the stub finds the public names there.
for _type, _name, _function in (
    (Lens, "draw", draw),
    (Lens, "_repr_png_", lens_png),
    (PSF, "_repr_png_", psf_png),
    (Plan, "_repr_html_", plan_html),
):
    setattr(_type, _name, _function)
