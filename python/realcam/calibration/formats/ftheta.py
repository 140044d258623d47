"""The f-theta model of NVIDIA's formats: a polynomial between the distance in pixels and the angle to the axis.

Sources: documentation of NCore (FThetaCameraModelParameters) and of DriveWorks ("Camera Modeling").
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ..arrays import Array
from ..files.entries import Entries
from ..models.central import CentralModel
from ..models.distortion import BrownConrady
from ..models.projections import Equidistant
from ..models.radial import RationalRadius
from ..models.ray_polynomials import AnglePolynomial
from ..models.terms import Inexpressible, Terms, is_undistorted


def pixel_matrix(centre: Sequence[float], c: float, d: float, e: float) -> Array:
    """Returns the map [c d; e 1] of the distorted plane, with a centre in realcam's pixels."""
    return np.array([[c, d, centre[0]], [e, 1.0, centre[1]], [0.0, 0.0, 1.0]])


def backward_model(coefficients: Sequence[float], matrix: Array, largest_angle: float) -> CentralModel:
    """Returns the model of theta = a1 r + a2 r^2 + ..., theta in radians, r in pixels from the centre."""
    return CentralModel(AnglePolynomial(tuple(coefficients), largest_angle), BrownConrady(), matrix)


def forward_model(coefficients: Sequence[float], matrix: Array, largest_angle: float) -> CentralModel:
    """Returns the model of r = b1 theta + b2 theta^2 + ..., the inverse direction of backward_model."""
    return CentralModel(Equidistant(largest_angle), BrownConrady(RationalRadius(tuple(coefficients))), matrix)


MODEL_OF_DIRECTION = {"PIXELDIST_TO_ANGLE": backward_model, "ANGLE_TO_PIXELDIST": forward_model}


def polynomial(entries: Entries, key: str) -> list[float]:
    """Returns the coefficients from that of the first power on; that of the power 0 must be 0."""
    constant, *rest = [*entries.numbers(key), 0.0, 0.0]  # for lists that are too short
    if constant or rest[0] <= 0 or len(rest) > 64:
        entries.fail(key, "a polynomial with the constant 0, a positive coefficient after it, and at most 62 more")
    return rest


def angle_limit(value: float) -> float:
    """Returns an angle of at most 180 degrees."""
    return min(value, np.pi)


class FTheta(NamedTuple):
    """Parameters of a model.

    direction: a key of MODEL_OF_DIRECTION. coefficients: of ascending powers, the constant 0 first. centre: in
    realcam's pixels. cde: of the matrix [c d; e 1]. largest_angle: radians.
    """

    direction: str
    coefficients: list[float]
    centre: tuple[float, float]
    cde: tuple[float, float, float]
    largest_angle: float


def ftheta_of(terms: Terms) -> FTheta:
    """Returns the f-theta parameters of a model. Raises Inexpressible."""
    (xx, xy, u0), (yx, scale, v0) = terms.matrix[:2].tolist()
    cde = (xx / scale, xy / scale, yx / scale)
    projection = terms.projection
    if isinstance(projection, AnglePolynomial) and is_undistorted(terms):
        coefficients = [k / scale**power for power, k in enumerate(projection.coefficients, start=1)]
        return FTheta("PIXELDIST_TO_ANGLE", [0.0, *coefficients], (u0, v0), cde, projection.limit)
    if not isinstance(projection, Equidistant):
        raise Inexpressible(f"has no model of the kind {type(projection).__name__}")
    terms.without("bottom", "tangential", "prism", "tilt")
    coefficients = [0.0, scale, *(k * scale for k in terms.top)]
    return FTheta("ANGLE_TO_PIXELDIST", coefficients, (u0, v0), cde, projection.largest_angle)


def inverse_coefficients(ftheta: FTheta) -> list[float]:
    """Returns the polynomial of degree 5 of the other direction that fits best up to the largest angle; it is no exact
    inverse."""
    powers = np.arange(1, 6)
    model = MODEL_OF_DIRECTION[ftheta.direction](ftheta.coefficients[1:], np.eye(3), ftheta.largest_angle)
    angles = np.linspace(0, min(ftheta.largest_angle, model.largest_angle) * (1 - 1e-9), 512)
    points = np.column_stack([np.sin(angles), np.zeros_like(angles), np.cos(angles)])
    distances = model.project(points)[0][:, 0]
    x, y = (distances, angles) if ftheta.direction == "ANGLE_TO_PIXELDIST" else (angles, distances)
    is_valid = np.isfinite(x) & np.isfinite(y)
    unit = float(x[is_valid].max())
    columns = (x[is_valid, None] / unit) ** powers
    fitted, *_ = np.linalg.lstsq(columns, y[is_valid], rcond=None)
    return [0.0, *(fitted / unit**powers).tolist()]
