"""Cost of accuracy: render time and error of the same shot at many levels of simulation."""

from .ladder import AccuracyCost, accuracy_cost
from .measurements import Measured, Rung

__all__ = ["AccuracyCost", "Measured", "Rung", "accuracy_cost"]
