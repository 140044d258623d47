"""Calibrations of cameras: twenty file formats, exact projection of points and rays of pixels."""

from .calibration import Calibration
from .camera import GeometryError, Vignetting
from .errors import CalibrationFileError
from .rectification import StereoRectification
from .status import PointStatus

__all__ = ["Calibration", "CalibrationFileError", "GeometryError", "PointStatus", "StereoRectification", "Vignetting"]
