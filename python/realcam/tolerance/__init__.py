"""What leaves the factory: tolerances of a lens, and the copies that they allow."""

from .compensators import ElementShift
from .figures import CopyFigures
from .sensitivities import Sensitivity
from .study import ToleranceStudy, tolerance_study
from .tolerances import Tolerance, Tolerances

__all__ = [
    "CopyFigures",
    "ElementShift",
    "Sensitivity",
    "Tolerance",
    "ToleranceStudy",
    "Tolerances",
    "tolerance_study",
]
