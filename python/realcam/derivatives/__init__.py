"""Exact derivatives of rays, and of imaging quantities, by the variables of a lens."""

from .._core import Lens
from .gradient import Gradient, gradient
from .rays import RayDerivatives, RayGradient, backpropagate_rays, ray_derivatives

# setattr because the class belongs to the extension; the stub finds the method there.
setattr(Lens, "gradient", gradient)  # noqa: B010

__all__ = ["Gradient", "RayDerivatives", "RayGradient", "backpropagate_rays", "gradient", "ray_derivatives"]
