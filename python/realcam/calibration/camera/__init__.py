"""Cameras with the exact geometry of a calibration and the blur, colours and falloff of a lens."""

from .making import calibrated_camera
from .measuring import GeometryError, geometry_error
from .vignetting import Vignetting

__all__ = ["GeometryError", "Vignetting", "calibrated_camera", "geometry_error"]
