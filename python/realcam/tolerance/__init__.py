"""Tolerance analysis: tolerances of a lens, and Monte Carlo copies of it with manufacturing errors."""

from .compensators import ElementShift
from .figures import CopyFigures
from .sensitivities import Sensitivity
from .study import ToleranceStudy, random_copy, tolerance_study
from .tolerances import Tolerance, Tolerances

__all__ = [
    "CopyFigures",
    "ElementShift",
    "Sensitivity",
    "Tolerance",
    "ToleranceStudy",
    "Tolerances",
    "random_copy",
    "tolerance_study",
]
