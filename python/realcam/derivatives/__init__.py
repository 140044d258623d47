"""Exact derivatives of rays, and of imaging quantities, by the variables of a lens; derivatives of pictures."""

from .gradient import Gradient, gradient
from .picture import render_gradient
from .rays import RayDerivatives, RayGradient, backpropagate_rays, ray_derivatives
from .variable import Variable

__all__ = [
    "Gradient",
    "RayDerivatives",
    "RayGradient",
    "Variable",
    "backpropagate_rays",
    "gradient",
    "ray_derivatives",
    "render_gradient",
]
