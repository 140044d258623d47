"""Photographers' figures of a lens: depth of field, angle of view, breathing, exposure, and comparisons."""

from .comparison import FieldFigures as FieldFigures
from .comparison import LensSummary as LensSummary
from .comparison import lens_summary as lens_summary
from .depth import DepthOfField as DepthOfField
from .depth import SharpRange as SharpRange
from .depth import blur_diameter_mm as blur_diameter_mm
from .depth import depth_of_field as depth_of_field
from .figures import Breathing as Breathing
from .figures import ExposureValue as ExposureValue
from .figures import PhotographicFigures as PhotographicFigures
from .figures import angle_of_view_deg as angle_of_view_deg
from .figures import breathing as breathing
from .figures import exposure_value as exposure_value
from .figures import magnification as magnification
from .figures import photographic_figures as photographic_figures
from .figures import working_f_number as working_f_number
