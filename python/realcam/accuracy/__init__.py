"""Cost of accuracy: render time and error of the same shot at many levels of simulation."""

from .cost import AccuracyCost, accuracy_cost
from .measurements import LevelMeasurements, Measured

__all__ = ["AccuracyCost", "LevelMeasurements", "Measured", "accuracy_cost"]
