"""What accuracy costs: the same shot at many levels of simulation, each with its time and its error."""

from .ladder import AccuracyCost, accuracy_cost
from .measurements import Measured, Rung

__all__ = ["AccuracyCost", "Measured", "Rung", "accuracy_cost"]
