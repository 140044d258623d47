"""Exact derivatives of rays, and of imaging quantities, by the variables of a lens."""

from .gradient import Gradient, gradient
from .rays import RayDerivatives, RayGradient, backpropagate_rays, ray_derivatives
from .variable import Variable

__all__ = ["Gradient", "RayDerivatives", "RayGradient", "Variable", "backpropagate_rays", "gradient", "ray_derivatives"]
