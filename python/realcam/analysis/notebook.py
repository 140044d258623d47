"""What notebooks show of the data of analyses: their plots."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ..figure_files import NOTEBOOK_DPI, figure_bytes
from .bokeh import Bokeh
from .distortion import Distortion, DistortionGrid
from .field_curves import FieldCurves
from .film_pupil import FilmPupils
from .kinds import plot_figure
from .lateral_colour import LateralColour
from .mtf import Mtf
from .point_spread import PointSpread
from .ray_fan import RayFan
from .seidel_bars import SeidelBars
from .spherical_aberration import LongitudinalAberration
from .spot_diagram import SpotDiagram
from .wavefront_map import WavefrontMap
from .zernike import ZernikeFit

KIND_OF: dict[type, str] = {
    Bokeh: "bokeh",
    Distortion: "distortion",
    DistortionGrid: "distortion-grid",
    FieldCurves: "field-curves",
    FilmPupils: "relative-illumination",
    LateralColour: "lateral-colour",
    LongitudinalAberration: "longitudinal",
    Mtf: "mtf",
    PointSpread: "psf",
    RayFan: "ray-fan",
    SeidelBars: "seidel",
    SpotDiagram: "spot",
    WavefrontMap: "wavefront",
    ZernikeFit: "zernike",
}


def kind_of(data: Any) -> str:
    """The plot of the data. MTF is shown along what it has most of: planes, fields or frequencies."""
    if isinstance(data, Mtf):
        planes, fields, frequencies = data.tangential.shape
        if planes > 1:
            return "mtf-focus"
        return "mtf-field" if fields > frequencies else "mtf"
    return KIND_OF[type(data)]


def png(data: Any) -> bytes:
    return figure_bytes(plot_figure(kind_of(data), data, size="small"), ".png", NOTEBOOK_DPI)


_repr: Callable[[Any], bytes] = png
for _type in KIND_OF:
    _type._repr_png_ = _repr  # type: ignore[attr-defined]
