"""Exact derivatives of rays, and of what a lens does, by the numbers that it is made of."""

from .._core import Lens
from .gradient import Gradient, gradient
from .rays import RayDerivatives, RayGradient, backpropagate_rays, ray_derivatives

# The class is the extension's, whose stub has the method.
setattr(Lens, "gradient", gradient)  # noqa: B010

__all__ = ["Gradient", "RayDerivatives", "RayGradient", "backpropagate_rays", "gradient", "ray_derivatives"]
