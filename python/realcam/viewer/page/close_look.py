"""Plots of the current lens, for the point that was clicked in the picture."""

from __future__ import annotations

import io
from dataclasses import dataclass

import numpy as np

from ... import analysis
from ..._core import Lens
from ...analysis import kinds
from ...analysis.fields import Bundles
from ...drawing.themes import LIGHT
from ...fields import angle_of_height

# Available plots, by their names in `realcam lens plot`: title, and explanation for the user.
PLOTS = {
    "spot": (
        "Spot diagram",
        "Points at which the rays of one object point reach the film; for a perfect lens they coincide.",
    ),
    "ray-fan": ("Ray fan", "Distance of each ray from the chief ray on the film, over its height in the stop."),
    "mtf": ("MTF", "Contrast of line patterns in the image, over their frequency on the film."),
    "distortion": ("Distortion", "Displacement of points from their positions in a picture without distortion."),
    "relative-illumination": (
        "Relative illumination",
        "Illuminance of the film towards its corner, relative to the centre.",
    ),
    "pupil": ("Pupil shapes", "Outline of the exit pupil seen from the film: cat's eyes towards the corner."),
}
# Plots for lenses without rotational symmetry.
MAPS = {
    "spot-map": ("Spot sizes", "RMS radius of the spots of object points, over the film."),
    "mtf-x-map": ("Contrast across", "Contrast of vertical line patterns in the image, over the film."),
    "mtf-y-map": ("Contrast upright", "Contrast of horizontal line patterns in the image, over the film."),
    "distortion-map": (
        "Distortion map",
        "Displacement of points from their positions in a picture without distortion.",
    ),
    "illumination-map": ("Illumination", "Illuminance over the film, relative to the centre."),
}
_SINGLE_FIELD_PLOTS = ("spot", "ray-fan", "mtf")


@dataclass(frozen=True)
class PlotRequest:
    """Arguments of a plot. kind: a key of PLOTS or MAPS. height_mm: distance of the film point from the axis."""

    kind: str
    lens: Lens
    height_mm: float


def plots_of(lens: Lens) -> dict[str, tuple[str, str]]:
    """Plots that apply to a lens: title and explanation by name."""
    return PLOTS if lens.is_rotational else MAPS


def plot_svg(request: PlotRequest) -> str:
    """Returns the plot as SVG with CSS colours of the page. Raises InputError if there is nothing to plot."""
    fields = None
    if request.kind in _SINGLE_FIELD_PLOTS:
        fields = np.array([angle_of_height(request.lens, request.height_mm)[0]])
    bundles = Bundles(request.lens)
    data = kinds.compute(request.kind, kinds.PlotArguments(request.lens, bundles, fields))
    figure = analysis.plot_figure(request.kind, data, size="small")
    content = io.StringIO()
    figure.savefig(content, format="svg", facecolor="none", transparent=True)
    svg = content.getvalue()
    # CSS colours, because the page's theme may change while the plot is shown.
    return svg[svg.index("<svg") :].replace(LIGHT.text, "currentColor").replace(LIGHT.grid, "var(--rc-grid)")
