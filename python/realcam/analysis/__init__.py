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

from ..drawing.figure_files import save_figure as save_figure
from . import notebook as notebook
from .bokeh import Bokeh as Bokeh
from .bokeh import bokeh as bokeh
from .bokeh import plot_bokeh as plot_bokeh
from .depth_over_focus import DepthOverFocus as DepthOverFocus
from .depth_over_focus import depth_over_focus as depth_over_focus
from .depth_over_focus import plot_depth_over_focus as plot_depth_over_focus
from .distortion import Distortion as Distortion
from .distortion import DistortionGrid as DistortionGrid
from .distortion import distortion as distortion
from .distortion import distortion_grid as distortion_grid
from .distortion import plot_distortion as plot_distortion
from .distortion import plot_distortion_grid as plot_distortion_grid
from .field_curves import FieldCurves as FieldCurves
from .field_curves import field_curves as field_curves
from .field_curves import plot_field_curves as plot_field_curves
from .field_map import FieldMap as FieldMap
from .field_map import field_map as field_map
from .field_map import plot_field_map as plot_field_map
from .fields import Bundles as Bundles
from .fields import default_frequencies_per_mm as default_frequencies_per_mm
from .fields import field_angles_deg as field_angles_deg
from .film_pupil import FilmPupils as FilmPupils
from .film_pupil import film_pupils as film_pupils
from .film_pupil import plot_pupil_shapes as plot_pupil_shapes
from .film_pupil import plot_relative_illumination as plot_relative_illumination
from .kinds import KINDS as KINDS
from .kinds import plot_figure as plot_figure
from .lateral_colour import LateralColour as LateralColour
from .lateral_colour import lateral_colour as lateral_colour
from .lateral_colour import plot_lateral_colour as plot_lateral_colour
from .mtf import Mtf as Mtf
from .mtf import mtf as mtf
from .mtf import mtf_over_field as mtf_over_field
from .mtf import mtf_over_frequency as mtf_over_frequency
from .mtf import mtf_through_focus as mtf_through_focus
from .mtf import plot_mtf_over_field as plot_mtf_over_field
from .mtf import plot_mtf_over_frequency as plot_mtf_over_frequency
from .mtf import plot_mtf_through_focus as plot_mtf_through_focus
from .numbers import as_json as as_json
from .numbers import save_numbers as save_numbers
from .point_spread import PointSpread as PointSpread
from .point_spread import plot_point_spread as plot_point_spread
from .point_spread import point_spread as point_spread
from .ray_fan import RayFan as RayFan
from .ray_fan import plot_ray_fan as plot_ray_fan
from .ray_fan import ray_fan as ray_fan
from .report import save_report as save_report
from .seidel_bars import SeidelBars as SeidelBars
from .seidel_bars import plot_seidel_bars as plot_seidel_bars
from .seidel_bars import seidel_bars as seidel_bars
from .spherical_aberration import LongitudinalAberration as LongitudinalAberration
from .spherical_aberration import longitudinal_aberration as longitudinal_aberration
from .spherical_aberration import plot_longitudinal_aberration as plot_longitudinal_aberration
from .spot_diagram import SpotDiagram as SpotDiagram
from .spot_diagram import plot_spot_diagram as plot_spot_diagram
from .spot_diagram import spot_diagram as spot_diagram
from .style import themed as themed
from .wavefront_map import WavefrontMap as WavefrontMap
from .wavefront_map import plot_wavefront_map as plot_wavefront_map
from .wavefront_map import wavefront_map as wavefront_map
from .zernike import ZernikeFit as ZernikeFit
from .zernike import fit_zernike as fit_zernike
from .zernike import plot_zernike_fit as plot_zernike_fit
from .zernike import zernike_fit as zernike_fit
