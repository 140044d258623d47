"""Optimisation of a lens: least squares over its variables, and replacement of its glasses."""

from .glass_search import GlassMatch as GlassMatch
from .glass_search import GlassSearch as GlassSearch
from .glass_search import nearest_glasses as nearest_glasses
from .glass_search import with_better_glasses as with_better_glasses
from .operands import Operand as Operand
from .optimiser import Optimisation as Optimisation
from .optimiser import Targets as Targets
from .optimiser import optimised as optimised
