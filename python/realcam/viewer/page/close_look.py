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
    "spot": ("Spot diagram", "Where the rays of one object point meet the film; a perfect lens would make a dot."),
    "ray-fan": ("Ray fan", "How far each ray lands from the chief ray, by where it crosses the stop."),
    "mtf": ("MTF", "The contrast that is left of stripes, by how fine they are on the film."),
    "distortion": ("Distortion", "How much farther out points appear than in a picture with straight lines."),
    "relative-illumination": ("Relative illumination", "How dark the picture becomes towards its corner."),
    "pupil": ("Pupil shapes", "The outline of the light as the film sees it: cat's eyes towards the corner."),
}
# Plots for lenses without rotational symmetry.
MAPS = {
    "spot-map": ("Spot sizes", "How far from each other the rays of one object point land, over the film."),
    "mtf-x-map": ("Contrast across", "The contrast that is left of upright stripes, over the film."),
    "mtf-y-map": ("Contrast upright", "The contrast that is left of level stripes, over the film."),
    "distortion-map": ("Distortion map", "How far points appear from where a picture with straight lines has them."),
    "illumination-map": ("Illumination", "How dark the picture becomes towards its corners."),
}
_OF_ONE_FIELD = ("spot", "ray-fan", "mtf")


@dataclass(frozen=True)
class Look:
    """Arguments of a plot. height_mm: distance of the film point from the axis."""

    kind: str
    lens: Lens
    height_mm: float


def plots_of(lens: Lens) -> dict[str, tuple[str, str]]:
    """Plots that apply to a lens: title and explanation by name."""
    return PLOTS if lens.is_rotational else MAPS


def plot_svg(look: Look) -> str:
    """Returns the plot as SVG with CSS colours of the page. Raises InputError if there is nothing to plot."""
    fields = None
    if look.kind in _OF_ONE_FIELD:
        fields = np.array([angle_of_height(look.lens, look.height_mm)[0]])
    bundles = Bundles(look.lens)
    data = kinds.compute(look.kind, kinds.Asked(look.lens, bundles, fields))
    figure = analysis.plot_figure(look.kind, data, size="small")
    content = io.StringIO()
    figure.savefig(content, format="svg", facecolor="none", transparent=True)
    svg = content.getvalue()
    # CSS colours, because the page's theme may change while the plot is shown.
    return svg[svg.index("<svg") :].replace(LIGHT.text, "currentColor").replace(LIGHT.grid, "var(--rc-grid)")
