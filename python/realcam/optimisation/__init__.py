"""Optimisation of a lens: least squares over its variables, and replacement of its glasses."""

from .glass_search import GlassMatch, GlassSearch, nearest_glasses, with_better_glasses
from .operands import Operand
from .optimiser import Optimisation, Targets, optimised

__all__ = [
    "GlassMatch",
    "GlassSearch",
    "Operand",
    "Optimisation",
    "Targets",
    "nearest_glasses",
    "optimised",
    "with_better_glasses",
]
