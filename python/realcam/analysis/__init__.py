"""Image quality of a lens: each aberration as arrays with units, and as a plot.

import realcam as rc
from matplotlib.figure import Figure

lens = rc.Lens.load("double-gauss-50mm").stopped_down(4)
fans = rc.analysis.ray_fan(lens)  # arrays, at 0, 0.7 and 1 times the largest image height
rc.analysis.plot_ray_fan(fans, Figure().add_subplot(), field=1)

Each analysis has a function that computes and one that plots on matplotlib axes. By default fields go from the axis to
the corner of the film, wavelengths are the F line, the design wavelength and the C line, and the object is in the
plane in focus. KINDS holds all plots by their names on the command line, for plot_figure(); as_json() and
save_numbers() export the arrays of any result; new figures within themed() have a theme's colours.
"""

from ..drawing.figure_files import save_figure
from . import notebook as notebook  # adds notebook representations
from .bokeh import Bokeh, bokeh, plot_bokeh
from .depth_over_focus import DepthOverFocus, depth_over_focus, plot_depth_over_focus
from .distortion import (
    Distortion,
    DistortionGrid,
    distortion,
    distortion_grid,
    plot_distortion,
    plot_distortion_grid,
)
from .field_curves import FieldCurves, field_curves, plot_field_curves
from .field_map import FieldMap, field_map, plot_field_map
from .fields import Bundles, default_frequencies_per_mm, field_angles_deg
from .film_pupil import FilmPupils, film_pupils, plot_pupil_shapes, plot_relative_illumination
from .kinds import KINDS, plot_figure
from .lateral_colour import LateralColour, lateral_colour, plot_lateral_colour
from .mtf import (
    Mtf,
    mtf,
    mtf_over_field,
    mtf_over_frequency,
    mtf_through_focus,
    plot_mtf_over_field,
    plot_mtf_over_frequency,
    plot_mtf_through_focus,
)
from .numbers import as_json, save_numbers
from .point_spread import PointSpread, plot_point_spread, point_spread
from .ray_fan import RayFan, plot_ray_fan, ray_fan
from .report import save_report
from .seidel_bars import SeidelBars, plot_seidel_bars, seidel_bars
from .spherical_aberration import LongitudinalAberration, longitudinal_aberration, plot_longitudinal_aberration
from .spot_diagram import SpotDiagram, plot_spot_diagram, spot_diagram
from .style import themed
from .wavefront_map import WavefrontMap, plot_wavefront_map, wavefront_map
from .zernike import ZernikeFit, fit_zernike, plot_zernike_fit, zernike_fit

__all__ = [
    "KINDS",
    "Bokeh",
    "Bundles",
    "DepthOverFocus",
    "Distortion",
    "DistortionGrid",
    "FieldCurves",
    "FieldMap",
    "FilmPupils",
    "LateralColour",
    "LongitudinalAberration",
    "Mtf",
    "PointSpread",
    "RayFan",
    "SeidelBars",
    "SpotDiagram",
    "WavefrontMap",
    "ZernikeFit",
    "as_json",
    "bokeh",
    "default_frequencies_per_mm",
    "depth_over_focus",
    "distortion",
    "distortion_grid",
    "field_angles_deg",
    "field_curves",
    "field_map",
    "film_pupils",
    "fit_zernike",
    "lateral_colour",
    "longitudinal_aberration",
    "mtf",
    "mtf_over_field",
    "mtf_over_frequency",
    "mtf_through_focus",
    "plot_bokeh",
    "plot_depth_over_focus",
    "plot_distortion",
    "plot_distortion_grid",
    "plot_field_curves",
    "plot_field_map",
    "plot_figure",
    "plot_lateral_colour",
    "plot_longitudinal_aberration",
    "plot_mtf_over_field",
    "plot_mtf_over_frequency",
    "plot_mtf_through_focus",
    "plot_point_spread",
    "plot_pupil_shapes",
    "plot_ray_fan",
    "plot_relative_illumination",
    "plot_seidel_bars",
    "plot_spot_diagram",
    "plot_wavefront_map",
    "plot_zernike_fit",
    "point_spread",
    "ray_fan",
    "save_figure",
    "save_numbers",
    "save_report",
    "seidel_bars",
    "spot_diagram",
    "themed",
    "wavefront_map",
    "zernike_fit",
]
