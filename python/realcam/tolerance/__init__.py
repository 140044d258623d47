"""Tolerance analysis: tolerances of a lens, and Monte Carlo copies of it with manufacturing errors."""

from .compensators import ElementShift as ElementShift
from .figures import CopyFigures as CopyFigures
from .sensitivities import Sensitivity as Sensitivity
from .study import ToleranceStudy as ToleranceStudy
from .study import random_copy as random_copy
from .study import tolerance_study as tolerance_study
from .tolerances import Tolerance as Tolerance
from .tolerances import Tolerances as Tolerances
