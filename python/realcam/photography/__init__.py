"""Photographers' figures of a lens: depth of field, angle of view, breathing, exposure, and comparisons."""

from .comparison import FieldFigures, LensSummary, lens_summary
from .depth import DepthOfField, SharpRange, blur_diameter_mm, depth_of_field
from .figures import (
    Breathing,
    ExposureValue,
    PhotographicFigures,
    angle_of_view_deg,
    breathing,
    exposure_value,
    magnification,
    photographic_figures,
    working_f_number,
)

__all__ = [
    "Breathing",
    "DepthOfField",
    "ExposureValue",
    "FieldFigures",
    "LensSummary",
    "PhotographicFigures",
    "SharpRange",
    "angle_of_view_deg",
    "blur_diameter_mm",
    "breathing",
    "depth_of_field",
    "exposure_value",
    "lens_summary",
    "magnification",
    "photographic_figures",
    "working_f_number",
]
