"""Camera models of COLMAP: their parameters, and which of them state a camera's terms.

Source: COLMAP's src/colmap/sensor/models.h.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from ..models.distortion import BrownConrady
from ..models.opencv_models import distortion_of, fisheye_coefficients, fisheye_distortion, opencv_coefficients
from ..models.projections import Equidistant, ExtendedUnified, FieldOfViewAngle, Perspective, Projection
from ..models.radial import RationalRadius, even_powers
from ..models.ray_polynomials import RayPolynomial
from ..models.terms import Inexpressible, Terms, is_undistorted

Coefficients = Sequence[float]


class Model(NamedTuple):
    """focal_lengths: 1 or 2 of them. coefficients: the number of parameters behind the principal point."""

    name: str
    focal_lengths: int
    coefficients: int
    make: Callable[[Coefficients], tuple[Projection, BrownConrady]]

    @property
    def parameters(self) -> int:
        return self.focal_lengths + 2 + self.coefficients


def _polynomial(k: Coefficients) -> tuple[Projection, BrownConrady]:
    return Perspective(), BrownConrady(RationalRadius(even_powers(k)))


def _angle_polynomial(k: Coefficients) -> tuple[Projection, BrownConrady]:
    return Equidistant(), fisheye_distortion(k)


def _thin_prism_fisheye(c: Coefficients) -> tuple[Projection, BrownConrady]:
    k1, k2, p1, p2, k3, k4, sx1, sy1 = c
    radius = RationalRadius(even_powers([k1, k2, k3, k4]))
    return Equidistant(), BrownConrady(radius, (p1, p2), (sx1, 0.0, sy1, 0.0))


def fisheye624(c: Coefficients) -> tuple[Projection, BrownConrady]:
    """Project Aria's FISHEYE624 with k0 to k5, p0, p1, s0 to s3; p0 multiplies r^2 + 2 x^2."""
    p0, p1, *prism = c[6:]
    radius = RationalRadius(even_powers(c[:6]))
    return Equidistant(), BrownConrady(radius, (p1, p0), (prism[0], prism[1], prism[2], prism[3]), is_sequential=True)


def _division(c: Coefficients) -> tuple[Projection, BrownConrady]:
    """The ray of a distorted point (x, y) is (x, y, 1 + k r^2) (A. Fitzgibbon, CVPR 2001)."""
    return RayPolynomial((1.0, 0.0, c[0]), np.pi / 2), BrownConrady()


# By model id.
MODELS = {
    0: Model("SIMPLE_PINHOLE", 1, 0, _polynomial),
    1: Model("PINHOLE", 2, 0, _polynomial),
    2: Model("SIMPLE_RADIAL", 1, 1, _polynomial),
    3: Model("RADIAL", 1, 2, _polynomial),
    4: Model("OPENCV", 2, 4, lambda c: (Perspective(), distortion_of(c))),
    5: Model("OPENCV_FISHEYE", 2, 4, _angle_polynomial),
    6: Model("FULL_OPENCV", 2, 8, lambda c: (Perspective(), distortion_of(c))),
    7: Model("FOV", 2, 1, lambda c: (FieldOfViewAngle(c[0]), BrownConrady())),
    8: Model("SIMPLE_RADIAL_FISHEYE", 1, 1, _angle_polynomial),
    9: Model("RADIAL_FISHEYE", 1, 2, _angle_polynomial),
    10: Model("THIN_PRISM_FISHEYE", 2, 8, _thin_prism_fisheye),
    11: Model("RAD_TAN_THIN_PRISM_FISHEYE", 2, 12, fisheye624),
    12: Model("SIMPLE_DIVISION", 1, 1, _division),
    13: Model("DIVISION", 2, 1, _division),
    14: Model("SIMPLE_FISHEYE", 1, 0, _angle_polynomial),
    15: Model("FISHEYE", 2, 0, _angle_polynomial),
    16: Model("EUCM", 2, 2, lambda c: (ExtendedUnified(c[0], c[1]), BrownConrady())),
}
BY_NAME = {model.name: model for model in MODELS.values()}


def model_and_parameters(terms: Terms) -> tuple[Model, list[float]]:
    """Returns a model with two focal lengths that states the terms, and its parameters. Raises Inexpressible."""
    name, coefficients = _stated(terms)
    return BY_NAME[name], [*terms.pixel_matrix(0.5), *coefficients]


def _stated(terms: Terms) -> tuple[str, list[float]]:
    """Returns the name of a model with two focal lengths and its coefficients."""
    projection = terms.projection
    if isinstance(projection, Perspective):
        if is_undistorted(terms):
            return "PINHOLE", []
        terms.without("prism", "tilt")
        D = [*opencv_coefficients(terms, (8,))]
        return ("FULL_OPENCV", D) if any(D[4:]) else ("OPENCV", D[:4])
    if isinstance(projection, Equidistant):
        terms.within_90_degrees()
        return _fisheye(terms)
    if not is_undistorted(terms):
        raise Inexpressible("has no distortion of its sphere models")
    if isinstance(projection, ExtendedUnified):
        return "EUCM", [projection.alpha, projection.beta]
    if isinstance(projection, FieldOfViewAngle):
        return "FOV", [projection.omega]
    raise Inexpressible(f"has no model of the kind {type(projection).__name__}")


def _fisheye(terms: Terms) -> tuple[str, list[float]]:
    if is_undistorted(terms):
        return "FISHEYE", []
    terms.without("bottom", "tilt")
    p1, p2 = terms.tangential
    if terms.is_sequential:
        return "RAD_TAN_THIN_PRISM_FISHEYE", [*terms.even(terms.top, 6), p2, p1, *terms.prism]
    if any((*terms.tangential, *terms.prism)):
        k1, k2, k3, k4 = terms.even(terms.top, 4)
        sx1, sx2, sy1, sy2 = terms.prism
        if sx2 or sy2:
            raise Inexpressible("has no thin-prism terms of the fourth power")
        return "THIN_PRISM_FISHEYE", [k1, k2, p1, p2, k3, k4, sx1, sy1]
    k = terms.even(terms.top, 6)
    if any(k[4:]):
        return "RAD_TAN_THIN_PRISM_FISHEYE", [*k, *[0.0] * 6]
    return "OPENCV_FISHEYE", fisheye_coefficients(terms)
